//! PNG: 8 bits a sample, the bytes that the display shows.
//!
//! No gamma, colour space or date is stored: as on the screen, the bytes are what they are.

use std::io::{self, Write};

use ::png::{BitDepth, ColorType, Encoder, EncodingError};

use super::whole_file::Output;
use super::{Image, display_byte};

/// Bytes in an IDAT chunk: large enough that the 12 around each do not count.
pub(crate) const CHUNK: usize = 1 << 16;

/// An encoder of 8-bit RGB pictures.
pub(crate) fn encoder<W: Write>(output: W, width: u32, height: u32) -> Encoder<'static, W> {
    let mut encoder = Encoder::new(output, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder
}

/// Writes the picture row by row: a second copy of a large one would not fit beside it.
pub(super) fn write(image: &Image, output: &mut Output) -> io::Result<()> {
    let mut writer = encoder(output, image.size(), image.size()).write_header()?;
    let mut stream = writer.stream_writer_with_size(CHUNK)?;
    let mut bytes = Vec::new();
    for row in image.rows_from_top() {
        bytes.clear();
        bytes.extend(row.iter().copied().map(display_byte));
        stream.write_all(&bytes)?;
    }
    stream.finish()?;
    writer.finish().map_err(EncodingError::into)
}
