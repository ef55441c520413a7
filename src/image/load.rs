//! A picture out of a file: an EXR as it is, a PNG as the fractions that its whole numbers stand
//! for.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};

use ::exr::compression::Compression;
use ::exr::error::Error;
use ::exr::image::read::image::ReadLayers;
use ::exr::image::read::layers::ReadChannels;
use ::exr::math::Vec2;
use ::exr::meta::BlockDescription;
use ::exr::meta::header::Header;
use ::png::{ColorType, Decoder, DecodingError, Transformations};

use super::{Format, Image, ImageError, MAX_SIZE};
use crate::memory;

/// A file that no picture can be read from. Each message is one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The extension names no format that can be read.
    #[error("{}: this extension names no picture that can be read: choose an .exr or a .png", .0.display())]
    Extension(PathBuf),
    /// The system does not let it be read.
    #[error("{}: cannot be read: {reason}: give the path of an .exr or a .png", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// It is not what its extension says, or a part of it is missing.
    #[error("{}: is not a whole {} file of red, green and blue: {reason}", path.display(), format.extension())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What its extension says.
        format: Format,
        /// What is wrong with it.
        reason: String,
    },
    /// It is an EXR whose compression is not read here: of a damaged file, its decoder could
    /// overflow or take all memory.
    #[error("{}: {compression} is not read: convert it to zip compression", path.display())]
    Compression {
        /// The file.
        path: PathBuf,
        /// Which one it is.
        compression: String,
    },
    /// It is not as wide as high.
    #[error("{}: is {width} × {height} pixels: give a picture that is as wide as high", path.display())]
    NotSquare {
        /// The file.
        path: PathBuf,
        /// Its pixels in a row.
        width: usize,
        /// Its rows.
        height: usize,
    },
    /// Some of its pixels are not opaque, so that their colours depend on what is behind.
    #[error("{}: some pixels are transparent: give an opaque picture", .0.display())]
    Transparent(PathBuf),
    /// It is larger than any picture here, or than the memory.
    #[error("{}: {reason}", path.display())]
    Image {
        /// The file.
        path: PathBuf,
        /// Why there can be no such picture.
        reason: ImageError,
    },
}

impl Image {
    /// Reads `path`: the channels R, G and B of an `.exr`, every 32-bit float bit for bit; or a
    /// `.png`, where a sample is the byte / 255 (of a PNG of 16 bits: the number / 65535),
    /// rounded to f32.
    ///
    /// # Errors
    /// [`LoadError`] where the extension is neither of the two, or the file is not a whole picture
    /// that is as wide as high and opaque, or it is an EXR compressed by B44 or DWA.
    pub fn load(path: impl AsRef<Path>) -> Result<Image, LoadError> {
        let path = path.as_ref();
        let format = Format::of(path).map_err(|_| LoadError::Extension(path.to_owned()))?;
        let read = match format {
            Format::Exr => read_exr,
            Format::Png => read_png,
            Format::Apng => return Err(LoadError::Extension(path.to_owned())),
        };
        let unreadable = |reason| LoadError::Unreadable {
            path: path.to_owned(),
            reason,
        };
        let file = BufReader::new(File::open(path).map_err(unreadable)?);
        read(file).map_err(|problem| match problem {
            Problem::Io(reason) => unreadable(reason),
            Problem::Damaged(reason) => LoadError::Damaged {
                path: path.to_owned(),
                format,
                reason,
            },
            Problem::Compression(compression) => LoadError::Compression {
                path: path.to_owned(),
                compression: compression.to_string(),
            },
            Problem::NotSquare(width, height) => LoadError::NotSquare {
                path: path.to_owned(),
                width,
                height,
            },
            Problem::Transparent => LoadError::Transparent(path.to_owned()),
            Problem::Image(reason) => LoadError::Image {
                path: path.to_owned(),
                reason,
            },
        })
    }
}

/// A [`LoadError`] that does not know its file.
enum Problem {
    Io(io::Error),
    Damaged(String),
    Compression(Compression),
    NotSquare(usize, usize),
    Transparent,
    Image(ImageError),
}

impl From<Error> for Problem {
    fn from(error: Error) -> Problem {
        match error {
            Error::Io(error) => Problem::Io(error),
            other => Problem::Damaged(other.to_string()),
        }
    }
}

impl From<DecodingError> for Problem {
    fn from(error: DecodingError) -> Problem {
        match error {
            DecodingError::IoError(error) if error.kind() != io::ErrorKind::UnexpectedEof => {
                Problem::Io(error)
            }
            other => Problem::Damaged(other.to_string()),
        }
    }
}

/// N of the size that a file says it has: checked before anything of that size is allocated.
fn side(width: usize, height: usize) -> Result<u32, Problem> {
    if width != height {
        return Err(Problem::NotSquare(width, height));
    }
    match u32::try_from(width).unwrap_or(u32::MAX) {
        side @ 1..=MAX_SIZE => Ok(side),
        other => Err(Problem::Image(ImageError::Size(other))),
    }
}

/// A black picture of that size.
fn square(width: usize, height: usize) -> Result<Image, Problem> {
    Image::new(side(width, height)?).map_err(Problem::Image)
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

fn read_exr(file: BufReader<File>) -> Result<Image, Problem> {
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

fn read_png(file: BufReader<File>) -> Result<Image, Problem> {
    let mut decoder = Decoder::new(file);
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let (width, height) = reader.info().size();
    let mut image = square(width as usize, height as usize)?;
    // The decoder takes a palette apart by threes, and would panic at what is left.
    let palette = reader.info().palette.as_deref().unwrap_or_default();
    if !palette.len().is_multiple_of(3) {
        let reason = format!(
            "its palette has {} bytes, not 3 for each colour",
            palette.len()
        );
        return Err(Problem::Damaged(reason));
    }
    let too_large = || Problem::Image(ImageError::Memory(width));
    let mut bytes = Vec::new();
    let length = reader.output_buffer_size().ok_or_else(too_large)?;
    memory::reserve(&mut bytes, length).map_err(|_| too_large())?;
    bytes.resize(length, 0);
    let info = reader.next_frame(&mut bytes)?;
    // The checksum of the last chunk, and that there is a last one.
    reader.finish()?;
    let wide = info.bit_depth == ::png::BitDepth::Sixteen;
    let channels = info.color_type.samples();
    let rows = bytes.chunks_exact(info.line_size);
    let rows_from_top = image
        .samples_mut()
        .chunks_exact_mut(3 * width as usize)
        .rev();
    for (row, samples) in rows.zip(rows_from_top) {
        let pixels = row.chunks_exact(channels * if wide { 2 } else { 1 });
        for (pixel, sample) in pixels.zip(samples.chunks_exact_mut(3)) {
            let value = |channel: usize| match wide {
                true => {
                    f32::from(u16::from_be_bytes([
                        pixel[2 * channel],
                        pixel[2 * channel + 1],
                    ])) / 65535.0
                }
                false => f32::from(pixel[channel]) / 255.0,
            };
            let (color, opaque) = match info.color_type {
                ColorType::Grayscale => ([0, 0, 0], true),
                ColorType::GrayscaleAlpha => ([0, 0, 0], value(1) == 1.0),
                ColorType::Rgba => ([0, 1, 2], value(3) == 1.0),
                // A palette has been expanded.
                ColorType::Rgb | ColorType::Indexed => ([0, 1, 2], true),
            };
            if !opaque {
                return Err(Problem::Transparent);
            }
            sample.copy_from_slice(&color.map(value));
        }
    }
    Ok(image)
}
