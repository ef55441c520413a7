//! The picture: N × N pixels of three linear 32-bit floats.

mod animation;
mod error;
mod exr;
mod format;
mod load;
pub(crate) mod png;
mod save;
mod srgb;
mod stream;
mod unfinished;
pub(crate) mod whole_file;

use std::fmt;

use crate::memory;

pub use animation::{Animation, AnimationWriter};
pub use error::SaveError;
pub use format::Format;
pub use load::{InputFormat, LoadError, LoadOptions, LoadedImage};
pub use srgb::decode_srgb;
pub use unfinished::abandon_unfinished;

/// The largest number of pixels along a side.
pub const MAX_SIZE: u32 = 16384;

/// A square picture of N × N pixels, each red, green and blue as linear floats: not clamped, not
/// gamma-encoded.
///
/// Rows go from the **bottom** to the top, as `glDrawPixels` and `glTexSubImage2D` lay them out; a
/// row goes from left to right.
#[derive(Clone)]
pub struct Image {
    size: u32,
    samples: Vec<f32>,
    /// The number of the frame that a tracer has left here, to trace the next one over it; 0 after
    /// anyone else could write.
    frame: u64,
}

impl PartialEq for Image {
    fn eq(&self, other: &Image) -> bool {
        self.size == other.size && self.samples == other.samples
    }
}

/// An image that cannot be made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// N is not from 1 to [`MAX_SIZE`].
    #[error("a picture of {0} × {0} pixels cannot be made: choose a size from 1 to {MAX_SIZE}")]
    Size(u32),
    /// There is not enough memory for N × N × 3 floats.
    #[error("not enough memory for a picture of {0} × {0} pixels: choose a smaller size")]
    Memory(u32),
}

impl Image {
    /// A black picture of `size` × `size` pixels.
    ///
    /// # Errors
    /// [`ImageError::Size`] unless 1 ≤ `size` ≤ [`MAX_SIZE`], [`ImageError::Memory`] where the
    /// floats do not fit.
    pub fn new(size: u32) -> Result<Image, ImageError> {
        if !(1..=MAX_SIZE).contains(&size) {
            return Err(ImageError::Size(size));
        }
        let length = size as usize * size as usize * 3;
        let mut samples = Vec::new();
        memory::reserve(&mut samples, length).map_err(|_| ImageError::Memory(size))?;
        samples.resize(length, 0.0);
        Ok(Image {
            size,
            samples,
            frame: 0,
        })
    }

    /// N, the number of pixels along a side.
    pub fn size(&self) -> u32 {
        self.size
    }

    /// All 3 N² floats: red, green, blue of each pixel, rows from the bottom.
    pub fn samples(&self) -> &[f32] {
        &self.samples
    }

    /// The same floats, to be written.
    pub fn samples_mut(&mut self) -> &mut [f32] {
        self.frame = 0;
        &mut self.samples
    }

    /// The number of the frame that a tracer left here.
    pub(crate) fn frame(&self) -> u64 {
        self.frame
    }

    /// The samples, for a tracer that is to leave the frame of this number, and no other.
    pub(crate) fn samples_of_frame(&mut self, frame: u64) -> &mut [f32] {
        self.frame = frame;
        &mut self.samples
    }

    /// Red, green and blue at `column` from the left and `row` from the bottom; `None` outside the
    /// picture.
    pub fn pixel(&self, column: u32, row: u32) -> Option<[f32; 3]> {
        if column >= self.size || row >= self.size {
            return None;
        }
        let first = (row as usize * self.size as usize + column as usize) * 3;
        Some([
            self.samples[first],
            self.samples[first + 1],
            self.samples[first + 2],
        ])
    }

    /// The rows from the top of the picture to the bottom, as files store them: 3 N floats each.
    pub(crate) fn rows_from_top(&self) -> impl Iterator<Item = &[f32]> {
        self.samples.chunks_exact(3 * self.size as usize).rev()
    }
}

/// The byte that a display of 8 bits shows for `sample`: round(255 · clamp(sample, 0, 1)), computed
/// in f32, ties to even; 0 for a NaN.
///
/// It is what OpenGL writes into an RGBA8 framebuffer, and what a PNG holds.
///
/// ```
/// use firsthit::image::display_byte;
/// assert_eq!(display_byte(0.5), 128);
/// assert_eq!(display_byte(7.0), 255);
/// assert_eq!(display_byte(f32::NAN), 0);
/// ```
pub fn display_byte(sample: f32) -> u8 {
    (sample.clamp(0.0, 1.0) * 255.0).round_ties_even() as u8
}

impl fmt::Debug for Image {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Image({0} × {0})", self.size)
    }
}
