//! The false-colour picture of a difference, with its scale below.

use std::io::{self, Write};
use std::path::Path;

use glam::IVec2;

use super::scale::{OCTAVES, color_at};
use super::{SizesDiffer, check_sizes, error_color, worst};
use crate::image::whole_file::{Output, WholeFile};
use crate::image::{Raster, SaveError, png};
use crate::text::Font;

/// The narrowest picture that the scale fits under.
const MIN_WIDTH: usize = 560;

/// Small pictures are magnified up to about this many pixels along their longer side.
const MAGNIFIED: usize = 512;

/// The width of a character, in pixels.
const CHARACTER: u32 = 8;

const PAPER: [u8; 3] = [255, 255, 255];

/// A picture that shows how far `image` is from `truth`, each pixel coloured by [`error_color`] of
/// its worst sample, above a scale with numbers; as a PNG, whatever the extension of `path`.
/// Pictures of less than 257 pixels along their longer side are magnified by whole numbers. The
/// file appears whole or not at all.
///
/// # Errors
/// [`HeatError`] unless both have one size, and where the file cannot be written.
pub fn save_heat(image: &Raster, truth: &Raster, path: impl AsRef<Path>) -> Result<(), HeatError> {
    check_sizes(image, truth)?;
    WholeFile::write(path.as_ref(), |output| write(image, truth, output))?;
    Ok(())
}

/// A false-colour picture that cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HeatError {
    /// The two pictures are not of one size.
    #[error(transparent)]
    Sizes(#[from] SizesDiffer),
    /// It cannot be written.
    #[error(transparent)]
    Save(#[from] SaveError),
}

fn write(image: &Raster, truth: &Raster, output: &mut Output) -> io::Result<()> {
    let size = [image.width(), image.height()].map(|side| side as usize);
    let magnification = (MAGNIFIED / size[0].max(size[1])).max(1);
    let [magnified_width, magnified_height] = size.map(|side| side * magnification);
    let width = magnified_width.max(MIN_WIDTH);
    let legend = legend(width);
    let height = magnified_height + legend.rows();
    let mut writer = png::encoder(output, width as u32, height as u32).write_header()?;
    let mut stream = writer.stream_writer_with_size(png::CHUNK)?;
    let margin = (width - magnified_width) / 2;
    let rows = image.rows_from_top().zip(truth.rows_from_top());
    for (row, true_row) in rows {
        let mut line = Strip::new(width, 1);
        let pixels = row.chunks_exact(3).zip(true_row.chunks_exact(3));
        for (column, (pixel, truth)) in pixels.enumerate() {
            let color = error_color(worst(pixel, truth));
            line.fill(margin + column * magnification, 0, magnification, 1, color);
        }
        for _ in 0..magnification {
            stream.write_all(&line.bytes)?;
        }
    }
    stream.write_all(&legend.bytes)?;
    stream.finish()?;
    writer.finish().map_err(::png::EncodingError::into)
}

/// The scale: a box for no error, the ramp with its numbers, a box for NaN.
fn legend(width: usize) -> Strip {
    let mut strip = Strip::new(width, 76);
    let (top, height, side) = (28, 18, 24);
    let left = (width - MIN_WIDTH) / 2 + 12;
    let mut font = Font::new(CHARACTER);
    let title = "largest error of a pixel's samples, in f32 steps";
    strip.text(&mut font, width / 2, 6, title);

    let mut swatch = |strip: &mut Strip, at: usize, color, label| {
        strip.fill(at, top, side, height, color);
        strip.text(&mut font, at + side / 2, top + height + 6, label);
    };
    swatch(&mut strip, left, error_color(Some(0)), "0");
    let (start, length) = (left + side + 24, MIN_WIDTH - 3 * (12 + side) - 48);
    for x in 0..length {
        let color = color_at(x as f32 / (length - 1) as f32);
        strip.fill(start + x, top, 1, height, color);
    }
    let labels = ["1", "16", "256", "4096", "65536", "2²⁰", "2²⁴…"];
    let octaves = (0..=OCTAVES).step_by(4);
    swatch(&mut strip, start + length + 36, error_color(None), "NaN");
    for (octave, label) in octaves.zip(labels) {
        let x = start + (length - 1) * octave as usize / OCTAVES as usize;
        strip.fill(x, top + height, 1, 4, [0; 3]);
        strip.text(&mut font, x, top + height + 6, label);
    }
    strip
}

/// Some rows of bytes, from the top.
struct Strip {
    width: usize,
    bytes: Vec<u8>,
}

impl Strip {
    fn new(width: usize, rows: usize) -> Strip {
        let bytes = PAPER.repeat(width * rows);
        Strip { width, bytes }
    }

    fn rows(&self) -> usize {
        self.bytes.len() / (3 * self.width)
    }

    fn fill(&mut self, left: usize, top: usize, width: usize, height: usize, color: [u8; 3]) {
        for row in top..top + height {
            for column in left..left + width {
                self.set(column, row, color);
            }
        }
    }

    /// Where the strip ends nothing is drawn.
    fn set(&mut self, column: usize, row: usize, color: [u8; 3]) {
        let first = 3 * (row * self.width + column);
        if column < self.width
            && let Some(pixel) = self.bytes.get_mut(first..first + 3)
        {
            pixel.copy_from_slice(&color);
        }
    }

    /// A line of text in black, its middle at the column `middle`.
    fn text(&mut self, font: &mut Font, middle: usize, top: usize, text: &str) {
        let width = text.chars().count() * font.cell().x as usize;
        let left = middle.saturating_sub(width / 2);
        font.write(text, IVec2::new(left as i32, top as i32), |pixel, ink| {
            if let (Ok(column), Ok(row)) = (pixel.x.try_into(), pixel.y.try_into()) {
                self.set(column, row, [255 - ink; 3]);
            }
        });
    }
}
