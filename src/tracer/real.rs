//! The abstract number that every formula is written over.

use std::cmp::Ordering;
use std::convert::Infallible;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number as a kernel holds it: exactly, roughly, or within known bounds.
///
/// A kernel is a choice of number and of what to do when that number cannot tell a sign or a rounding: its *doubt*.
pub(crate) trait Real:
    Copy
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// What is returned in place of an answer that this number cannot give; [`Infallible`] where it always answers.
    type Doubt;

    /// The value of an f64, taken exactly.
    fn exact(value: f64) -> Self;

    /// The square root of a number that is not negative.
    fn sqrt(self) -> Self;

    /// (1 − self)ⁿ, and 0 from self = 1 on.
    ///
    /// A highlight is (n·h)ⁿ with n near 1000, which would multiply the relative error of n·h by n. What a formula knows
    /// well is 1 − n·h, so that is what it hands over.
    fn one_minus_to_the(self, exponent: u32) -> Self;

    /// Less than, equal to or greater than 0.
    fn sign(self) -> Result<Ordering, Self::Doubt>;

    /// Rounded to the nearest f32, ties to even; a zero is +0.
    fn to_sample(self) -> Result<f32, Self::Doubt>;

    /// Its square.
    fn squared(self) -> Self {
        self * self
    }

    /// Its magnitude.
    fn abs(self) -> Result<Self, Self::Doubt> {
        Ok(if self.sign()?.is_lt() { -self } else { self })
    }
}

impl Real for f64 {
    type Doubt = Infallible;

    fn exact(value: f64) -> f64 {
        value
    }

    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }

    fn one_minus_to_the(self, exponent: u32) -> f64 {
        if self >= 1.0 {
            return 0.0;
        }
        // libm is Rust code throughout: the same bits on every platform, within an ulp of log1p and of exp.
        libm::exp(f64::from(exponent) * libm::log1p(-self))
    }

    fn sign(self) -> Result<Ordering, Infallible> {
        // A NaN cannot come up: a scene's numbers are finite and far from overflow, and nothing divides by 0.
        Ok(self.partial_cmp(&0.0).unwrap_or(Ordering::Equal))
    }

    fn to_sample(self) -> Result<f32, Infallible> {
        // + 0 turns −0 into +0 and changes nothing else.
        Ok(self as f32 + 0.0)
    }
}
