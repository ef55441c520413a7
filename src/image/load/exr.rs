//! OpenEXR, read.

use std::fs::File;
use std::io::BufReader;

use ::exr::block::UncompressedBlock;
use ::exr::block::reader::ChunksReader;
use ::exr::compression::Compression;
use ::exr::error::Error;
use ::exr::math::Vec2;
use ::exr::meta::BlockDescription;
use ::exr::meta::attribute::SampleType;
use ::exr::meta::header::Header;
use ::exr::prelude::f16;

use super::layers::{self, Layer, Role};
use super::{LoadOptions, LoadedImage, Problem, black, checked_size};
use crate::image::{MAX_SIZE, Raster, Window};

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
    checked_size(part.layer_size.width(), part.layer_size.height())?;
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

pub(super) fn read(file: BufReader<File>, options: &LoadOptions) -> Result<LoadedImage, Problem> {
    let file = ::exr::block::read(file, false)?;
    let (layer, other_layers) = layers::choose(file.headers(), options.layer.as_deref())?;
    let header = &file.headers()[layer.part];
    check_part(header)?;
    let Vec2(left, top) = header.own_attributes.layer_position;
    let display = header.shared_attributes.display_window;
    let mut image = black(header.layer_size.width(), header.layer_size.height())?;
    let chunks = file.filter_chunks(false, |_, tile, block| {
        block.layer == layer.part && tile.is_largest_resolution_level()
    })?;
    let parts = chunks.meta_data().clone();
    let mut opaque = true;
    for chunk in chunks {
        let chunk = chunk?;
        // Only this part has been checked.
        if chunk.layer_index != layer.part {
            return Err(wrong_block());
        }
        let block = UncompressedBlock::decompress_chunk(chunk, &parts, false)?;
        if block.index.level != Vec2(0, 0) {
            return Err(wrong_block());
        }
        opaque &= copy(&block, &parts.headers[layer.part], &layer, &mut image);
    }
    if !opaque && !options.ignore_alpha {
        return Err(Problem::Transparent);
    }
    Ok(LoadedImage {
        image,
        corner: [left, top],
        display_window: Window {
            corner: [display.position.x(), display.position.y()],
            size: [display.size.width(), display.size.height()]
                .map(|side| u32::try_from(side).unwrap_or(u32::MAX)),
        },
        largest: None,
        layer: layer.name,
        other_layers,
    })
}

fn wrong_block() -> Problem {
    Problem::Damaged("its table of blocks names one of another picture".to_owned())
}

/// Copies the layer's colours of a block to where they are in the picture; whether all of them are
/// opaque.
fn copy(block: &UncompressedBlock, header: &Header, layer: &Layer, image: &mut Raster) -> bool {
    let mut opaque = true;
    let (width, height) = (image.width() as usize, image.height() as usize);
    for line in block.lines(&header.channels) {
        let Some(role) = layer.role(line.location.channel) else {
            continue;
        };
        let kind = header.channels.list[line.location.channel].sample_type;
        let mut samples = samples(line.value, kind);
        match role {
            Role::Alpha => opaque &= samples.all(|alpha| alpha == 1.0),
            Role::Color(color) => {
                let Vec2(first, row_from_top) = line.location.position;
                let start = (height - 1 - row_from_top) * width + first;
                let pixels = image.samples_mut()[3 * start..].chunks_exact_mut(3);
                for (pixel, sample) in pixels.zip(samples) {
                    pixel[color] = sample;
                }
            }
        }
    }
    opaque
}

/// The numbers of a decompressed line, which are as this machine has them.
fn samples(line: &[u8], kind: SampleType) -> impl Iterator<Item = f32> {
    line.chunks_exact(kind.bytes_per_sample())
        .map(move |bytes| match (kind, bytes) {
            (SampleType::F16, &[a, b]) => f16::from_ne_bytes([a, b]).to_f32(),
            (SampleType::U32, &[a, b, c, d]) => u32::from_ne_bytes([a, b, c, d]) as f32,
            (_, &[a, b, c, d]) => f32::from_ne_bytes([a, b, c, d]),
            _ => f32::NAN,
        })
}
