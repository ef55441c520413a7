//! The picture: pixels of three linear 32-bit floats, N × N where a tracer makes it.

mod animation;
mod error;
mod exr;
mod format;
mod load;
pub(crate) mod png;
mod raster;
mod save;
mod srgb;
mod stream;
mod unfinished;
pub(crate) mod whole_file;
mod window;

use std::fmt;
use std::ops::Deref;

pub use animation::{Animation, AnimationWriter};
pub use error::SaveError;
pub use format::Format;
pub use load::{InputFormat, LoadError, LoadOptions, LoadedImage};
pub use raster::Raster;
pub use srgb::decode_srgb;
pub(crate) use srgb::light;
pub use unfinished::abandon_unfinished;
pub use window::Window;

/// The largest number of pixels along a side.
pub const MAX_SIZE: u32 = 16384;

/// The square picture that a tracer writes to: a [`Raster`] of N × N pixels.
#[derive(Clone)]
pub struct Image {
    raster: Raster,
    /// The number of the frame that a tracer has left here, to trace the next one over it; 0 after
    /// anyone else could write.
    frame_number: u64,
}

/// Whatever a raster can be asked, an image can: its samples, its difference to another, a file.
impl Deref for Image {
    type Target = Raster;

    fn deref(&self) -> &Raster {
        &self.raster
    }
}

/// By the values of the floats: −0 equals 0, and a NaN equals nothing.
impl PartialEq for Image {
    fn eq(&self, other: &Image) -> bool {
        self.raster == other.raster
    }
}

/// A picture that cannot be made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// Its width or its height is not from 1 to [`MAX_SIZE`].
    #[error("a picture of {0} × {1} pixels cannot be made: choose a size from 1 to {MAX_SIZE}")]
    Size(u32, u32),
    /// There is not enough memory for three floats a pixel of this width and height.
    #[error("not enough memory for a picture of {0} × {1} pixels: choose a smaller size")]
    Memory(u32, u32),
}

impl Image {
    /// A black picture of `size` × `size` pixels.
    ///
    /// # Errors
    /// [`ImageError::Size`] unless 1 ≤ `size` ≤ [`MAX_SIZE`], [`ImageError::Memory`] where the
    /// floats do not fit.
    pub fn new(size: u32) -> Result<Image, ImageError> {
        let raster = Raster::new(size, size)?;
        Ok(Image {
            raster,
            frame_number: 0,
        })
    }

    /// N, the number of pixels along a side.
    pub fn size(&self) -> u32 {
        self.raster.width()
    }

    /// All 3 N² floats, to be written: red, green, blue of each pixel, rows from the bottom. The
    /// next [`Tracer::retrace`](crate::Tracer::retrace) into this picture writes all of it.
    pub fn samples_mut(&mut self) -> &mut [f32] {
        self.samples_of_frame(0)
    }

    /// The number of the frame that a tracer left here.
    pub(crate) fn frame_number(&self) -> u64 {
        self.frame_number
    }

    /// The samples, for a tracer that is to leave the frame of this number, and no other.
    pub(crate) fn samples_of_frame(&mut self, number: u64) -> &mut [f32] {
        self.frame_number = number;
        self.raster.samples_mut()
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
#[inline]
pub fn display_byte(sample: f32) -> u8 {
    // From here on an f32 has no fraction: adding it rounds to an integer, ties to even, where
    // `round_ties_even` is a call of a function.
    const WHOLE: f32 = 8_388_608.0;
    ((sample.clamp(0.0, 1.0) * 255.0 + WHOLE) - WHOLE) as u8
}

impl fmt::Debug for Image {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Image({0} × {0})", self.size())
    }
}
