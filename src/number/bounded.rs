//! An f64 and a bound on how far it is from the truth.
//!
//! # Why the bounds hold
//!
//! Every operation of IEEE 754 returns fl(a ∘ b) = (a ∘ b)(1 + δ), |δ| ≤ u = 2⁻⁵³, where nothing
//! underflows; sums are exact where they would underflow. With a = A + α, |α| ≤ E_a for the true A,
//! and the same for b, the error of a result v is at most
//!
//! - sum: E_a + E_b + |a + b − v|, where a + b − v is an f64 that TwoSum gives exactly (Knuth),
//! - product: |a|E_b + |b|E_a + E_a E_b + u|v|, from AB = (a − α)(b − β); without u|v| where a and
//!   b have at most 53 bits together,
//! - sum of products, where any factor has an error: the errors of the products, and u|s| for each
//!   partial sum s,
//! - quotient: (E_a + |a/b|E_b)/|B| + u|v|, from A/B − a/b = ((A − a)b − a(B − b))/(Bb), with |B| ≥
//!   |b| − E_b,
//! - root: E_a/√a + u v, from |√A − √a| = |A − a|/(√A + √a), √A ≥ 0.
//!
//! These expressions are themselves computed in f64. No term passes through more than 12
//! operations, all on terms that are not negative (of sums of products, up to four products), so
//! that what is computed is at least (1 − u)¹² of the expression, and [`ROUND_UP`] more than makes
//! up for that, for u|v| in place of u|a ∘ b|, and for |v| in place of
//! |a/b|. What underflow can take away is less than [`UNDERFLOW`]: a scene's numbers have
//! magnitudes from 1e-30 to 1e6, no formula has a term of more than eight factors of them, and a
//! number as small as 1e-290 is in doubt.
//!
//! So whatever f64 computes exactly is known exactly: at α = 0, in a scene of short binary
//! fractions, a tie is seen to be one.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::double_double::DoubleDouble;
use super::error_free::two_sum;
use super::rounding::{ROUND_UP, U, UNDERFLOW};
use super::{Doubt, Real, Ring, products_summed, round_enclosure, sin_cos};

/// The truth lies within `error` of `value`; exactly there where `error` is 0. An error of infinity
/// or NaN says nothing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounded {
    pub(super) value: f64,
    pub(super) error: f64,
}

impl Bounded {
    /// A number of which nothing is known.
    pub(crate) const UNKNOWN: Bounded = Bounded {
        value: 0.0,
        error: f64::INFINITY,
    };

    /// 0, which has no error.
    pub(crate) const ZERO: Bounded = Bounded {
        value: 0.0,
        error: 0.0,
    };

    /// Whether neither its magnitude nor its error is larger than that of another number; never
    /// where one is a NaN.
    #[inline]
    pub(crate) fn is_no_larger(self, other: Bounded) -> bool {
        (self.value.abs() <= other.value.abs()) & (self.error <= other.error)
    }

    /// A number of the larger magnitude and the larger error of both; a NaN of this one is larger
    /// than all.
    pub(crate) fn joined(self, other: Bounded) -> Bounded {
        let larger = |a: f64, b: f64| if a < b { b } else { a };
        Bounded {
            value: larger(self.value.abs(), other.value.abs()),
            error: larger(self.error, other.error),
        }
    }

    /// A number that the truth is not below.
    #[inline]
    pub(crate) fn at_least(self) -> f64 {
        // A little more than the error takes care of the rounding here; NaN and infinities say
        // nothing.
        let low = self.value - (self.error + 2.0 * U * self.value.abs()) * ROUND_UP;
        if low.is_nan() { f64::NEG_INFINITY } else { low }
    }

    /// A number that the truth is not above.
    #[inline]
    pub(crate) fn at_most(self) -> f64 {
        -(-self).at_least()
    }

    /// The approximation.
    #[inline]
    pub(crate) fn value(self) -> f64 {
        self.value
    }

    /// How far the truth can be from the approximation.
    #[inline]
    pub(crate) fn error(self) -> f64 {
        self.error
    }

    /// Whether it is known to be 0.
    #[inline]
    pub(crate) fn is_zero(self) -> bool {
        self.value == 0.0 && self.error == 0.0
    }
}

/// Whether a · b is an f64: their significant bits together are no more than an f64 has, and
/// nothing underflows.
#[inline]
fn is_exact_product(a: f64, b: f64) -> bool {
    let zeros = |x: f64| (x.to_bits() | 1 << (f64::MANTISSA_DIGITS - 1)).trailing_zeros();
    (zeros(a) + zeros(b) >= f64::MANTISSA_DIGITS) & ((a * b).abs() > UNDERFLOW)
}

impl Add for Bounded {
    type Output = Bounded;
    #[inline]
    fn add(self, other: Bounded) -> Bounded {
        let (value, rounded_off) = two_sum(self.value, other.value);
        Bounded {
            value,
            error: (self.error + other.error + rounded_off.abs()) * ROUND_UP,
        }
    }
}

impl Neg for Bounded {
    type Output = Bounded;
    #[inline]
    fn neg(self) -> Bounded {
        Bounded {
            value: -self.value,
            error: self.error,
        }
    }
}

impl Sub for Bounded {
    type Output = Bounded;
    #[inline]
    fn sub(self, other: Bounded) -> Bounded {
        self + -other
    }
}

impl Mul for Bounded {
    type Output = Bounded;
    #[inline]
    fn mul(self, other: Bounded) -> Bounded {
        if self.is_zero() || other.is_zero() {
            return Bounded::exact(0.0);
        }
        let value = self.value * other.value;
        let exact = is_exact_product(self.value, other.value);
        let rounding = if exact { 0.0 } else { U * value.abs() };
        let known = exact && self.error == 0.0 && other.error == 0.0;
        let lost = if known { 0.0 } else { UNDERFLOW };
        let carried = self.value.abs() * other.error
            + other.value.abs() * self.error
            + self.error * other.error;
        Bounded {
            value,
            error: (carried + rounding) * ROUND_UP + lost,
        }
    }
}

impl Div for Bounded {
    type Output = Bounded;
    #[inline]
    fn div(self, other: Bounded) -> Bounded {
        Divisor::new(other).divide(self)
    }
}

/// What several numbers are divided by. The division that only their bounds need is done once.
#[derive(Clone, Copy)]
pub(crate) struct Divisor {
    number: Bounded,
    /// 1 over the least magnitude that it can have; infinite where it tells nothing.
    inverse: f64,
}

impl Divisor {
    #[inline]
    pub(crate) fn new(number: Bounded) -> Divisor {
        // A divisor known to fewer than 26 bits tells nothing worth knowing.
        let magnitude = number.value.abs();
        let known = number.error < magnitude * f64::EPSILON.sqrt();
        Divisor {
            number,
            inverse: if known {
                1.0 / (magnitude - number.error)
            } else {
                f64::INFINITY
            },
        }
    }

    /// The quotient of a number and this divisor.
    #[inline]
    pub(crate) fn divide(self, dividend: Bounded) -> Bounded {
        if self.inverse == f64::INFINITY {
            return Bounded::UNKNOWN;
        }
        let value = dividend.value / self.number.value;
        let carried = (dividend.error + value.abs() * self.number.error) * self.inverse;
        Bounded {
            value,
            error: (carried + U * value.abs()) * ROUND_UP + UNDERFLOW,
        }
    }
}

impl From<Bounded> for DoubleDouble {
    fn from(number: Bounded) -> DoubleDouble {
        DoubleDouble {
            high: number.value,
            low: 0.0,
            error: number.error,
        }
    }
}

impl From<DoubleDouble> for Bounded {
    fn from(number: DoubleDouble) -> Bounded {
        Bounded {
            value: number.high,
            error: (number.error + number.low.abs()) * ROUND_UP,
        }
    }
}

impl Ring for Bounded {
    #[inline]
    fn sum_of_products<const N: usize>(a: [Bounded; N], b: [Bounded; N]) -> Bounded {
        const { assert!(N <= 4, "the bound is derived for four products") };
        let errors = (0..N).fold(0.0, |sum, i| sum + (a[i].error + b[i].error));
        if errors == 0.0 {
            // Products and sums may be exact, too.
            return products_summed(a, b);
        }
        let product = |i: usize| {
            let (a, b): (Bounded, Bounded) = (a[i], b[i]);
            let value = a.value * b.value;
            let carried = (a.value.abs() + a.error) * b.error + b.value.abs() * a.error;
            (value, carried + U * value.abs())
        };
        let (mut value, mut error) = product(0);
        for i in 1..N {
            let (term, its_error) = product(i);
            value += term;
            error += its_error + U * value.abs();
        }
        // Without an error, each product has a factor that is known to be 0. A factor of which
        // nothing is known makes the sum unknown, even beside a 0.
        let lost = if error == 0.0 { 0.0 } else { UNDERFLOW };
        Bounded {
            value,
            error: error * ROUND_UP + lost,
        }
    }
}

impl Real for Bounded {
    type Doubt = Doubt;

    #[inline]
    fn exact(value: f64) -> Bounded {
        Bounded { value, error: 0.0 }
    }

    fn sin_cos(alpha: f64) -> (Bounded, Bounded) {
        let (sin, cos) = sin_cos(alpha);
        if alpha == 0.0 {
            return (Bounded::exact(sin), Bounded::exact(cos));
        }
        // Both are correctly rounded; where u|v| underflows, the smallest f64 is more than enough.
        let rounded = |value: f64| Bounded {
            value,
            error: value.abs() * U + f64::from_bits(1),
        };
        (rounded(sin), rounded(cos))
    }

    #[inline]
    fn sqrt(self) -> Bounded {
        if self.is_zero() {
            return self;
        }
        let positive = self.value > self.error;
        if !positive {
            // Between 0 and the root of the most that it can be.
            let most = (self.value + self.error).max(0.0) * ROUND_UP;
            return Bounded {
                value: 0.0,
                error: most.sqrt() * ROUND_UP,
            };
        }
        let value = self.value.sqrt();
        Bounded {
            value,
            error: (self.error / value + U * value) * ROUND_UP,
        }
    }

    fn one_minus_to_the(self, exponent: u32) -> Bounded {
        // (1 − x)ⁿ ≤ e⁻ⁿˣ: beside most highlights that is nothing.
        if f64::from(exponent) * self.at_least() > 200.0 {
            return Bounded {
                value: 0.0,
                error: 1e-86,
            };
        }
        DoubleDouble::from(self).one_minus_to_the(exponent).into()
    }

    fn or_better(self, known: DoubleDouble) -> Bounded {
        known.into()
    }

    #[inline]
    fn sign(self) -> Result<Ordering, Doubt> {
        if self.value > self.error {
            Ok(Ordering::Greater)
        } else if -self.value > self.error {
            Ok(Ordering::Less)
        } else if self.is_zero() {
            Ok(Ordering::Equal)
        } else {
            Err(Doubt)
        }
    }

    #[inline]
    fn to_sample(self) -> Result<f32, Doubt> {
        if self.error == 0.0 {
            return Ok(self.value as f32 + 0.0);
        }
        round_enclosure(self.at_least() as f32, self.at_most() as f32).ok_or(Doubt)
    }

    fn to_f64(self) -> f64 {
        self.value
    }
}
