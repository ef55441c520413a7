//! Pixels in rows: what is read from a file, compared, and written to a file.

use std::fmt;

use super::{ImageError, MAX_SIZE};
use crate::memory;

/// A picture of any width and height, each pixel red, green and blue as linear floats: not clamped,
/// not gamma-encoded.
///
/// Rows go from the **bottom** to the top, as `glDrawPixels` and `glTexSubImage2D` lay them out; a
/// row goes from left to right. The square one that a tracer writes to is an
/// [`Image`](super::Image).
#[derive(Clone, PartialEq)]
pub struct Raster {
    width: u32,
    height: u32,
    samples: Vec<f32>,
}

impl Raster {
    /// A black picture of `width` × `height` pixels.
    ///
    /// # Errors
    /// [`ImageError::Size`] unless both are from 1 to [`MAX_SIZE`], [`ImageError::Memory`] where
    /// the floats do not fit.
    pub fn new(width: u32, height: u32) -> Result<Raster, ImageError> {
        if ![width, height]
            .iter()
            .all(|side| (1..=MAX_SIZE).contains(side))
        {
            return Err(ImageError::Size(width, height));
        }
        let length = width as usize * height as usize * 3;
        let mut samples = Vec::new();
        memory::reserve(&mut samples, length).map_err(|_| ImageError::Memory(width, height))?;
        samples.resize(length, 0.0);
        Ok(Raster {
            width,
            height,
            samples,
        })
    }

    /// The number of pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// The number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All floats: red, green, blue of each pixel, rows from the bottom.
    pub fn samples(&self) -> &[f32] {
        &self.samples
    }

    /// The same floats, to be written.
    pub fn samples_mut(&mut self) -> &mut [f32] {
        &mut self.samples
    }

    /// Red, green and blue at `column` from the left and `row` from the bottom; `None` outside the
    /// picture.
    pub fn pixel(&self, column: u32, row: u32) -> Option<[f32; 3]> {
        if column >= self.width || row >= self.height {
            return None;
        }
        let first = (row as usize * self.width as usize + column as usize) * 3;
        Some([
            self.samples[first],
            self.samples[first + 1],
            self.samples[first + 2],
        ])
    }

    /// The rows from the top of the picture to the bottom, as files store them: three floats a
    /// pixel.
    pub(crate) fn rows_from_top(&self) -> impl Iterator<Item = &[f32]> {
        self.samples.chunks_exact(3 * self.width as usize).rev()
    }

    /// The same rows, to be written.
    pub(super) fn rows_from_top_mut(&mut self) -> impl Iterator<Item = &mut [f32]> {
        self.samples.chunks_exact_mut(3 * self.width as usize).rev()
    }
}

impl fmt::Debug for Raster {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Raster({} × {})", self.width, self.height)
    }
}
