//! The abstract number that every formula is written over, and the numbers that kernels are made
//! of.

#[cfg(test)]
mod agreement_tests;
mod bounded;
mod double_double;
mod error_free;
mod expression;
mod four;
pub(crate) mod rounding;
mod sine;

use std::cmp::Ordering;
use std::convert::Infallible;
use std::ops::{Add, Div, Mul, Neg, Sub};

pub(crate) use bounded::{Bounded, Divisor};
pub(crate) use double_double::DoubleDouble;
pub(crate) use expression::{Expression, Session};
pub(crate) use four::FourBounded;
pub use sine::sin_cos;

/// The bound on a number's error does not determine the sign or the rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Doubt;

/// What vectors are made of: a real number, or several at once.
pub(crate) trait Ring:
    Copy + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self>
{
    /// a₀b₀ + a₁b₁ + …, from the left to the right.
    fn sum_of_products<const N: usize>(a: [Self; N], b: [Self; N]) -> Self;
}

/// A real number as a kernel holds it: exactly, roughly, or within known bounds.
///
/// A kernel is a choice of number and of what to do when that number cannot tell a sign or a
/// rounding: its *doubt*.
pub(crate) trait Real: Ring + Mul<Output = Self> + Div<Output = Self> {
    /// What is returned in place of an answer that this number cannot give; [`Infallible`] where it
    /// always answers.
    type Doubt;

    /// The number of this value: exactly that, except that f32 rounds it.
    fn exact(value: f64) -> Self;

    /// The sine and the cosine of an angle, its f64 taken exactly.
    fn sin_cos(alpha: f64) -> (Self, Self);

    /// The square root of a number that is not negative.
    fn sqrt(self) -> Self;

    /// (1 − self)ⁿ, and 0 from self = 1 on.
    ///
    /// A highlight is (n·h)ⁿ with n near 1000, which would multiply the relative error of n·h by n.
    /// What a formula knows well is 1 − n·h, so that is what it hands over.
    fn one_minus_to_the(self, exponent: u32) -> Self;

    /// Less than, equal to or greater than 0.
    fn sign(self) -> Result<Ordering, Self::Doubt>;

    /// Rounded to the nearest f32, ties to even; a zero is +0.
    fn to_sample(self) -> Result<f32, Self::Doubt>;

    /// The same number, given what else is known about it: for a kind of number that can make use
    /// of that.
    fn or_better(self, _known: DoubleDouble) -> Self {
        self
    }

    /// About its value, for a person to read.
    fn to_f64(self) -> f64;

    /// Its square.
    fn squared(self) -> Self {
        self * self
    }
}

/// a₀b₀ + a₁b₁ + …, one operation after the other.
#[inline]
fn products_summed<R: Real, const N: usize>(a: [R; N], b: [R; N]) -> R {
    let mut sum = a[0] * b[0];
    for i in 1..N {
        sum = sum + a[i] * b[i];
    }
    sum
}

impl Ring for f64 {
    #[inline]
    fn sum_of_products<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
        products_summed(a, b)
    }
}

impl Real for f64 {
    type Doubt = Infallible;

    #[inline]
    fn exact(value: f64) -> f64 {
        value
    }

    fn sin_cos(alpha: f64) -> (f64, f64) {
        sin_cos(alpha)
    }

    #[inline]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }

    fn one_minus_to_the(self, exponent: u32) -> f64 {
        if self >= 1.0 {
            return 0.0;
        }
        // libm is Rust code throughout: the same bits on every platform, within an ulp of log1p and
        // of exp.
        libm::exp(f64::from(exponent) * libm::log1p(-self))
    }

    #[inline]
    fn sign(self) -> Result<Ordering, Infallible> {
        // A NaN cannot come up: a scene's numbers are finite and far from overflow, and nothing
        // divides by 0.
        Ok(self.partial_cmp(&0.0).unwrap_or(Ordering::Equal))
    }

    #[inline]
    fn to_sample(self) -> Result<f32, Infallible> {
        // + 0 turns −0 into +0 and changes nothing else.
        Ok(self as f32 + 0.0)
    }

    fn to_f64(self) -> f64 {
        self
    }
}

impl Ring for f32 {
    #[inline]
    fn sum_of_products<const N: usize>(a: [f32; N], b: [f32; N]) -> f32 {
        products_summed(a, b)
    }
}

impl Real for f32 {
    type Doubt = Infallible;

    #[inline]
    fn exact(value: f64) -> f32 {
        value as f32
    }

    fn sin_cos(alpha: f64) -> (f32, f32) {
        let (sin, cos) = sin_cos(alpha);
        (sin as f32, cos as f32)
    }

    #[inline]
    fn sqrt(self) -> f32 {
        f32::sqrt(self)
    }

    fn one_minus_to_the(self, exponent: u32) -> f32 {
        if self >= 1.0 {
            return 0.0;
        }
        libm::expf(exponent as f32 * libm::log1pf(-self))
    }

    #[inline]
    fn sign(self) -> Result<Ordering, Infallible> {
        // A NaN, which a scene of extreme numbers can produce in 24 bits, counts as 0.
        Ok(self.partial_cmp(&0.0).unwrap_or(Ordering::Equal))
    }

    #[inline]
    fn to_sample(self) -> Result<f32, Infallible> {
        // A NaN or an infinity from numbers that 24 bits or their exponents cannot hold is no
        // sample, and a zero is +0.
        Ok(if self > 0.0 { self.min(f32::MAX) } else { 0.0 })
    }

    fn to_f64(self) -> f64 {
        self.into()
    }
}

/// The sample that both ends of an enclosure round to; `None` where they differ.
fn round_enclosure(lower: f32, upper: f32) -> Option<f32> {
    (lower == upper).then_some(lower + 0.0)
}

/// high + low, where high is the f64 nearest to it, rounded to the nearest f32, ties to even.
fn round_sum(high: f64, low: f64) -> f32 {
    let rounded = high as f32;
    let between = high - f64::from(rounded);
    // Only where high is halfway between two f32s does low have a say: it breaks the tie.
    let neighbour = if between > 0.0 {
        rounded.next_up()
    } else {
        rounded.next_down()
    };
    let halfway = between != 0.0 && between.abs() == (f64::from(neighbour) - high).abs();
    if !halfway || low == 0.0 {
        return rounded;
    }
    let (lower, upper) = if rounded < neighbour {
        (rounded, neighbour)
    } else {
        (neighbour, rounded)
    };
    if low > 0.0 { upper } else { lower }
}

/// Whether all of these hold. One that certainly does not decides, whatever else is in doubt.
pub(crate) fn all<D>(decisions: impl IntoIterator<Item = Result<bool, D>>) -> Result<bool, D> {
    let mut doubt = None;
    for decision in decisions {
        match decision {
            Ok(true) => {}
            Ok(false) => return Ok(false),
            Err(open) => doubt = Some(open),
        }
    }
    doubt.map_or(Ok(true), Err)
}

/// Whether any of these holds. One that certainly does decides, whatever else is in doubt.
pub(crate) fn any<D>(decisions: impl IntoIterator<Item = Result<bool, D>>) -> Result<bool, D> {
    Ok(!all(decisions
        .into_iter()
        .map(|decision| decision.map(|holds| !holds)))?)
}
