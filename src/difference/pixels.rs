//! The difference of two pictures by pixels: how many are how far off, and which one is worst.

use super::{SizesDiffer, check_sizes, worst};
use crate::image::{Raster, display_byte};

/// How far the pixels of one picture are from those of another, each judged by its worst sample. A
/// NaN against a number is further off than any number.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelDifference {
    /// All pixels.
    pub pixels: u64,
    /// How many are off by more f32 steps than 0, 1, 2, 4 … 2³¹.
    pub beyond_steps: [u64; 33],
    /// How many are off by more of 255 than 0, 1, 2, 4 … 128 on an 8-bit display.
    pub beyond_bytes: [u64; 9],
    /// The pixel that is off by the most f32 steps, of equals the first from the lower left, row by
    /// row; `None` where none is off.
    pub worst: Option<WorstPixel>,
}

/// A pixel in two pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstPixel {
    /// Its column from the left.
    pub column: u32,
    /// Its row from the bottom.
    pub row: u32,
    /// What it is in the one picture and in the other.
    pub colors: [[f32; 3]; 2],
    /// Its error in f32 steps; `None` where only one picture has a NaN.
    pub steps: Option<u32>,
}

/// The limit at `place` of [`PixelDifference::beyond_steps`] and
/// [`PixelDifference::beyond_bytes`]: 0, 1, 2, 4, 8 … 2³¹ for 0 to 32, and the largest u32 beyond.
pub fn limit(place: usize) -> u32 {
    match place {
        0 => 0,
        1..=32 => 1 << (place - 1),
        _ => u32::MAX,
    }
}

/// How many of the limits an error is beyond.
fn limits_below(error: u32) -> usize {
    match error {
        0 => 0,
        _ => 1 + (u32::BITS - (error - 1).leading_zeros()) as usize,
    }
}

impl PixelDifference {
    /// The difference of two pictures.
    ///
    /// # Errors
    /// [`SizesDiffer`] unless both have one size.
    pub fn of(image: &Raster, truth: &Raster) -> Result<PixelDifference, SizesDiffer> {
        check_sizes(image, truth)?;
        let mut difference = PixelDifference {
            pixels: u64::from(image.width()) * u64::from(image.height()),
            beyond_steps: [0; 33],
            beyond_bytes: [0; 9],
            worst: None,
        };
        let pixels =
            (0..image.height()).flat_map(|row| (0..image.width()).map(move |at| (at, row)));
        let (colors, _) = image.samples().as_chunks::<3>();
        let (true_colors, _) = truth.samples().as_chunks::<3>();
        for ((&color, &truth), (column, row)) in colors.iter().zip(true_colors).zip(pixels) {
            let steps = worst(&color, &truth);
            if steps == Some(0) {
                continue;
            }
            difference.add(WorstPixel {
                column,
                row,
                colors: [color, truth],
                steps,
            });
        }
        Ok(difference)
    }

    /// Adds a pixel that is off.
    fn add(&mut self, pixel: WorstPixel) {
        let [color, truth] = pixel.colors.map(|color| color.map(display_byte));
        let bytes = color.into_iter().zip(truth);
        let bytes = bytes.fold(0, |most, (byte, truth)| most.max(byte.abs_diff(truth)));
        let order = |steps: Option<u32>| steps.unwrap_or(u32::MAX);
        for count in &mut self.beyond_steps[..limits_below(order(pixel.steps))] {
            *count += 1;
        }
        for count in &mut self.beyond_bytes[..limits_below(bytes.into())] {
            *count += 1;
        }
        let is_worse = |than: WorstPixel| order(pixel.steps) > order(than.steps);
        if self.worst.is_none_or(is_worse) {
            self.worst = Some(pixel);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_beyond_the_limits_that_are_less() {
        let errors = (0..300).chain([1 << 31, (1 << 31) + 1, u32::MAX]);
        for error in errors {
            let less = (0..33).filter(|&place| limit(place) < error).count();
            assert_eq!(limits_below(error), less, "{error}");
        }
    }
}
