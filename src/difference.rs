//! How far one picture is from another: in floats, in absolute value, in bytes of a display.
//!
//! An error in **f32 steps** is the number of floats from one sample to the other: 0 for equal
//! samples, 1 for neighbours. It is the error in ulp wherever both samples have the same exponent,
//! it is a whole number, and it can be counted without knowing more of the truth than its nearest
//! f32.

mod flip;
#[cfg(feature = "program")]
mod heat;
mod pixels;
mod scale;

use crate::image::{Raster, display_byte};
pub use flip::{FlipError, PIXELS_PER_DEGREE, PIXELS_PER_DEGREE_RANGE, flip};
#[cfg(feature = "program")]
pub use heat::{HeatError, save_heat};
pub use pixels::{PixelDifference, WorstPixel, limit};
pub use scale::error_color;

/// Two pictures that cannot be compared: the width and the height of each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "{} × {} and {} × {} pixels cannot be compared: give two pictures of one size",
    .0[0], .0[1], .1[0], .1[1]
)]
pub struct SizesDiffer(pub [u32; 2], pub [u32; 2]);

/// Refuses pictures of different sizes.
fn check_sizes(image: &Raster, truth: &Raster) -> Result<(), SizesDiffer> {
    let [size, true_size] = [image, truth].map(|raster| [raster.width(), raster.height()]);
    match size == true_size {
        true => Ok(()),
        false => Err(SizesDiffer(size, true_size)),
    }
}

/// How many floats `a` is from `b`: both zeros are one, an infinity is the one after the largest
/// float, and all NaNs are one. `None` where only one of the two is a NaN: nothing tells how far
/// that is.
///
/// ```
/// use firsthit::difference::steps;
/// assert_eq!(steps(1.0, 1.0 + f32::EPSILON), Some(1));
/// assert_eq!(steps(-0.0, f32::from_bits(3)), Some(3));
/// assert_eq!(steps(f32::NAN, 1.0), None);
/// ```
pub fn steps(a: f32, b: f32) -> Option<u32> {
    match (a.is_nan(), b.is_nan()) {
        (false, false) => Some(place(a).abs_diff(place(b))),
        (true, true) => Some(0),
        _ => None,
    }
}

/// Where a float stands in the order of all floats, counted from 0.
fn place(sample: f32) -> i32 {
    let magnitude = (sample.to_bits() & i32::MAX.unsigned_abs()) as i32;
    if sample.is_sign_negative() {
        -magnitude
    } else {
        magnitude
    }
}

/// The worst error of a pixel's samples; a NaN against a number is worse than any.
pub(crate) fn worst(pixel: &[f32], truth: &[f32]) -> Option<u32> {
    pixel
        .iter()
        .zip(truth)
        .try_fold(0, |worst, (&sample, &truth)| {
            steps(sample, truth).map(|steps| steps.max(worst))
        })
}

/// What there is to say about any number of samples, each compared with its true value.
///
/// A pair with one NaN counts among [`wrong`](Difference::wrong),
/// [`nan_against_number`](Difference::nan_against_number) and, where the bytes differ,
/// [`eight_bit`](Difference::eight_bit); no other number here knows of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Difference {
    /// Pairs of samples.
    pub samples: u64,
    /// Pairs that are not the same bit for bit.
    pub wrong: u64,
    /// NaNs among the samples, and among the true values.
    pub nans: [u64; 2],
    /// Pairs of a NaN and a number.
    pub nan_against_number: u64,
    /// The largest error in f32 steps.
    pub max_steps: u32,
    /// The largest absolute error; infinite where one sample is.
    pub max_abs: f64,
    /// The largest absolute error by the magnitude of its true value; infinite where that is 0 or
    /// infinite.
    pub max_relative: f64,
    /// Pairs that an 8-bit display shows differently.
    pub eight_bit: u64,
    sum_of_steps: u128,
    sum_of_abs: f64,
    sum_of_squares: f64,
}

impl Difference {
    /// The difference of two pictures.
    ///
    /// # Errors
    /// [`SizesDiffer`] unless both have one size.
    pub fn of(image: &Raster, truth: &Raster) -> Result<Difference, SizesDiffer> {
        check_sizes(image, truth)?;
        let mut difference = Difference::default();
        for (&sample, &truth) in image.samples().iter().zip(truth.samples()) {
            difference.add(sample, truth);
        }
        Ok(difference)
    }

    /// Adds a sample and its true value.
    pub fn add(&mut self, sample: f32, truth: f32) {
        self.samples += 1;
        self.nans[0] += u64::from(sample.is_nan());
        self.nans[1] += u64::from(truth.is_nan());
        if sample.to_bits() == truth.to_bits() {
            return;
        }
        self.wrong += 1;
        self.eight_bit += u64::from(display_byte(sample) != display_byte(truth));
        match steps(sample, truth) {
            // The same number or no number, in other bits.
            Some(0) => {}
            Some(steps) => {
                self.max_steps = self.max_steps.max(steps);
                self.sum_of_steps += u128::from(steps);
                let error = (f64::from(sample) - f64::from(truth)).abs();
                self.max_abs = self.max_abs.max(error);
                let magnitude = f64::from(truth).abs();
                // An infinite error is not a number by an infinity.
                let relative = match magnitude {
                    f64::INFINITY => magnitude,
                    _ => error / magnitude,
                };
                self.max_relative = self.max_relative.max(relative);
                self.sum_of_abs += error;
                self.sum_of_squares += error * error;
            }
            None => self.nan_against_number += 1,
        }
    }

    /// The mean error in f32 steps; 0 of no samples.
    pub fn mean_steps(&self) -> f64 {
        self.mean(self.sum_of_steps as f64)
    }

    /// The mean absolute error; 0 of no samples.
    pub fn mean_abs(&self) -> f64 {
        self.mean(self.sum_of_abs)
    }

    /// The peak signal-to-noise ratio in dB, the peak being 1, a display's white; infinite where
    /// there is no error.
    pub fn psnr(&self) -> f64 {
        -10.0 * libm::log10(self.mean(self.sum_of_squares))
    }

    fn mean(&self, sum: f64) -> f64 {
        match self.samples - self.nan_against_number {
            0 => 0.0,
            pairs => sum / pairs as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_count_floats_across_zero_and_up_to_infinity() {
        assert_eq!(steps(0.0, -0.0), Some(0));
        assert_eq!(steps(f32::from_bits(2), -f32::from_bits(3)), Some(5));
        assert_eq!(steps(f32::MAX, f32::INFINITY), Some(1));
        assert_eq!(
            steps(f32::NEG_INFINITY, f32::INFINITY),
            Some(2 * 0x7f80_0000)
        );
        assert_eq!(steps(f32::NAN, -f32::NAN), Some(0));
        assert_eq!(steps(0.0, f32::NAN), None);
    }

    #[test]
    fn nothing_is_far_from_nothing() {
        let nothing = Difference::default();
        assert_eq!((nothing.mean_steps(), nothing.mean_abs()), (0.0, 0.0));
        assert_eq!(nothing.psnr(), f64::INFINITY);
    }
}
