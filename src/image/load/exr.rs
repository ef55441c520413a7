//! OpenEXR, read.

use std::fs::File;
use std::io::BufReader;

use ::exr::compression::Compression;
use ::exr::error::Error;
use ::exr::image::read::image::ReadLayers;
use ::exr::image::read::layers::ReadChannels;
use ::exr::math::Vec2;
use ::exr::meta::BlockDescription;
use ::exr::meta::header::Header;

use super::{Problem, side, square};
use crate::image::{Image, MAX_SIZE};

impl From<Error> for Problem {
    fn from(error: Error) -> Problem {
        match error {
            Error::Io(error) => Problem::Io(error),
            other => Problem::Damaged(other.to_string()),
        }
    }
}

/// Whether the decoder refuses whatever is wrong with a file. That of B44 computes with numbers of
/// a file unchecked, that of DWA allocates as much as a file says.
fn is_safe(compression: Compression) -> bool {
    use Compression::*;
    matches!(compression, Uncompressed | RLE | ZIP1 | ZIP16 | PIZ | PXR24)
}

/// The bytes of the largest picture and its opacity. The decoder allocates a whole block before it
/// reads any of it.
const MAX_BLOCK: u64 = 16 * (MAX_SIZE as u64).pow(2);

/// Refuses the part of a file that would be read, where the decoder could not refuse it by itself
/// or only after it has decoded all of it.
fn check_part(part: &Header) -> Result<(), Problem> {
    side(part.layer_size.width(), part.layer_size.height())?;
    if !is_safe(part.compression) {
        return Err(Problem::Compression(part.compression));
    }
    let Vec2(width, height) = match part.blocks {
        BlockDescription::Tiles(tiles) => tiles.tile_size,
        BlockDescription::ScanLines => Vec2(
            part.layer_size.width(),
            part.compression.scan_lines_per_block(),
        ),
    };
    let numbers = [width, height, part.channels.bytes_per_pixel].map(|number| number as u64);
    match numbers.into_iter().fold(1, u64::saturating_mul) {
        0..=MAX_BLOCK => Ok(()),
        bytes => Err(Problem::Damaged(format!("a block of it has {bytes} bytes"))),
    }
}

pub(super) fn read(file: BufReader<File>) -> Result<Image, Problem> {
    let file = ::exr::block::read(file, false)?;
    let channels = ["R", "G", "B"];
    let has = |part: &Header, name| part.channels.list.iter().any(|own| own.name.eq(name));
    // The first that has them is the one that is read.
    let mut parts = file.headers().iter();
    if let Some(part) = parts.find(|part| channels.iter().all(|name| has(part, name))) {
        check_part(part)?;
    }
    ::exr::image::read::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |Vec2(width, height), _| square(width, height),
            |image, Vec2(column, row_from_top), (red, green, blue): (f32, f32, f32)| {
                if let Ok(image) = image {
                    let size = image.size() as usize;
                    let first = ((size - 1 - row_from_top) * size + column) * 3;
                    image.samples_mut()[first..first + 3].copy_from_slice(&[red, green, blue]);
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_chunks(file)?
        .layer_data
        .channel_data
        .pixels
}
