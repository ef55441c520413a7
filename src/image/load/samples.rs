//! The samples of a picture, one after the other.

use super::{Problem, checked_size};
use crate::image::Raster;
use crate::memory;

/// How many samples there is room for at first.
const FIRST: usize = 1 << 16;

/// Samples in the order of a file. They take memory as they come: what a file says of its size may
/// be wrong.
pub(super) struct Samples {
    width: u32,
    height: u32,
    samples: Vec<f32>,
}

impl Samples {
    /// None yet, of a picture of this size.
    pub(super) fn new(width: usize, height: usize) -> Result<Samples, Problem> {
        let [width, height] = checked_size(width, height)?;
        Ok(Samples {
            width,
            height,
            samples: Vec::new(),
        })
    }

    /// How many pixels the picture has.
    pub(super) fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Adds a pixel.
    pub(super) fn push(&mut self, pixel: [f32; 3]) -> Result<(), Problem> {
        let (length, room) = (self.samples.len(), self.samples.capacity());
        if length + 3 > room {
            let more = length.clamp(FIRST, (3 * self.pixels()).max(FIRST));
            memory::reserve(&mut self.samples, more).map_err(|_| self.too_large())?;
        }
        self.samples.extend(pixel);
        Ok(())
    }

    /// The picture, whose rows came from the bottom.
    pub(super) fn image_from_bottom(self) -> Result<Raster, Problem> {
        let mut image = Raster::new(self.width, self.height).map_err(|_| self.too_large())?;
        image.samples_mut().copy_from_slice(&self.samples);
        Ok(image)
    }

    /// The picture, whose rows came from the top.
    pub(super) fn image_from_top(self) -> Result<Raster, Problem> {
        let mut image = Raster::new(self.width, self.height).map_err(|_| self.too_large())?;
        let rows = self.samples.chunks_exact(3 * self.width as usize);
        for (to, from) in image.rows_from_top_mut().zip(rows) {
            to.copy_from_slice(from);
        }
        Ok(image)
    }

    fn too_large(&self) -> Problem {
        Problem::Memory(self.width, self.height)
    }
}
