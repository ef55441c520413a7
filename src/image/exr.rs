//! OpenEXR: three channels of 32-bit floats, every sample bit for bit.

use std::io::{self, Seek, Write};

use ::exr::error::Error;
use ::exr::image::write::WritableImage;
use ::exr::image::{Encoding, Image as Part, SpecificChannels};
use ::exr::math::Vec2;

use super::Raster;

/// Where an EXR can be written: its table of blocks, at the beginning, is written last.
pub(super) trait WriteSeek: Write + Seek {}

impl<T: Write + Seek> WriteSeek for T {}

/// One part of scan lines with the channels B, G and R, in blocks of 16 rows compressed by zlib,
/// rows in order. The encoder is compiled once, for whatever it writes to.
pub(super) fn write(image: &Raster, output: &mut dyn WriteSeek) -> io::Result<()> {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let samples = image.samples();
    let channels = SpecificChannels::rgb(|Vec2(column, row_from_top): Vec2<usize>| {
        let first = ((height - 1 - row_from_top) * width + column) * 3;
        (samples[first], samples[first + 1], samples[first + 2])
    });
    Part::from_encoded_channels((width, height), Encoding::SMALL_LOSSLESS, channels)
        .write()
        .to_buffered(output)
        .map_err(|error| match error {
            Error::Io(error) => error,
            other => io::Error::other(other),
        })
}
