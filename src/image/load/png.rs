//! PNG, read.

use std::fs::File;
use std::io::{self, BufReader};

use ::png::{ColorType, Decoder, DecodingError, Transformations};

use super::{LoadOptions, LoadedImage, Problem, black};
use crate::memory;

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

pub(super) fn read(file: BufReader<File>, options: &LoadOptions) -> Result<LoadedImage, Problem> {
    let mut decoder = Decoder::new(file);
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let (width, height) = reader.info().size();
    let mut image = black(width as usize, height as usize)?;
    // The decoder takes a palette apart by threes, and would panic at what is left.
    let palette = reader.info().palette.as_deref().unwrap_or_default();
    if !palette.len().is_multiple_of(3) {
        let reason = format!(
            "its palette has {} bytes, not 3 for each colour",
            palette.len()
        );
        return Err(Problem::Damaged(reason));
    }
    let too_large = || Problem::Memory(width, height);
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
    for (row, samples) in rows.zip(image.rows_from_top_mut()) {
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
            if !opaque && !options.ignore_alpha {
                return Err(Problem::Transparent);
            }
            sample.copy_from_slice(&color.map(value));
        }
    }
    let largest = if wide { u16::MAX } else { u16::from(u8::MAX) };
    Ok(LoadedImage::of_whole_numbers(image, largest))
}
