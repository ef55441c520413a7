//! The pixels of a loaded picture, by where they lie.

use super::LoadedImage;
use crate::image::{ImageError, Raster, Window};

impl LoadedImage {
    /// Where the picture's pixels lie: the data window of an EXR.
    pub fn data_window(&self) -> Window {
        Window {
            corner: self.corner,
            size: [self.image.width(), self.image.height()],
        }
    }

    /// The pixels of `window`, black where the picture has none.
    ///
    /// # Errors
    /// [`ImageError`] where there can be no picture of that size.
    pub fn pixels_of(&self, window: Window) -> Result<Raster, ImageError> {
        let mut pixels = Raster::new(window.size[0], window.size[1])?;
        let Some(both) = self.data_window().intersection(window) else {
            return Ok(pixels);
        };
        let skipped = |axis: usize, corner: [i32; 2]| both.corner[axis].abs_diff(corner[axis]);
        let rows_above = |corner| skipped(1, corner) as usize;
        let samples = |corner| {
            let first = 3 * skipped(0, corner) as usize;
            first..first + 3 * both.size[0] as usize
        };
        let from = self.image.rows_from_top().skip(rows_above(self.corner));
        let to = pixels.rows_from_top_mut().skip(rows_above(window.corner));
        for (to, from) in to.zip(from).take(both.size[1] as usize) {
            to[samples(window.corner)].copy_from_slice(&from[samples(self.corner)]);
        }
        Ok(pixels)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;

    fn window(corner: [i32; 2], size: [u32; 2]) -> Window {
        Window { corner, size }
    }

    #[test]
    fn pixels_stay_where_they_are_in_the_scene() {
        let mut image = Raster::new(3, 2).unwrap();
        for (i, sample) in image.samples_mut().iter_mut().enumerate() {
            *sample = 1.0 + i as f32;
        }
        let data = window([4, -7], [3, 2]);
        let loaded = LoadedImage {
            corner: data.corner,
            ..LoadedImage::of_floats(image)
        };
        let windows = [
            data,
            window([0, -10], [9, 9]),
            window([5, -7], [1, 1]),
            window([6, -6], [4, 3]),
            window([0, 0], [2, 5]),
        ];
        for window in windows {
            let pixels = loaded.pixels_of(window).unwrap();
            let [width, height] = window.size;
            assert_eq!((pixels.width(), pixels.height()), (width, height));
            for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
                // Rows of a picture count up.
                let column = window.corner[0] + x as i32 - data.corner[0];
                let row = 1 - (window.corner[1] + (height - 1 - y) as i32 - data.corner[1]);
                let held = match (column.try_into(), row.try_into()) {
                    (Ok(column), Ok(row)) => loaded.image.pixel(column, row),
                    _ => None,
                };
                let expected = held.unwrap_or_default();
                assert_eq!(pixels.pixel(x, y), Some(expected), "{window} {x} {y}");
            }
        }
    }
}
