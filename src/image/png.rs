//! PNG: 8 bits a sample, the bytes that the display shows.
//!
//! A chunk says that the bytes are sRGB, which is what a display takes them for. No date is stored.

use std::io::{self, Write};

use ::png::{BitDepth, ColorType, Encoder, EncodingError, SrgbRenderingIntent};

use super::Raster;

/// Bytes in an IDAT chunk: large enough that the 12 around each do not count.
pub(crate) const CHUNK: usize = 1 << 16;

/// An encoder of 8-bit RGB pictures.
pub(crate) fn encoder<W: Write>(output: W, width: u32, height: u32) -> Encoder<'static, W> {
    let mut encoder = Encoder::new(output, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    encoder
}

/// Writes the picture row by row: a second copy of a large one would not fit beside it.
pub(super) fn write(image: &Raster, output: &mut dyn Write) -> io::Result<()> {
    let mut writer = encoder(output, image.width(), image.height()).write_header()?;
    let mut stream = writer.stream_writer_with_size(CHUNK)?;
    image.write_rgb24(&mut stream)?;
    stream.finish()?;
    writer.finish().map_err(EncodingError::into)
}
