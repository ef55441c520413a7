//! A double-double, the unevaluated sum of two f64s, and a bound on how far it is from the truth.
//!
//! # Why the bounds hold
//!
//! With u = 2⁻⁵³ and no underflow, Joldes, Muller and Popescu ("Tight and rigorous error bounds for
//! basic building blocks of double-word arithmetic", ACM TOMS 44, 2017) prove for normalised
//! operands a relative error of at most 3u² + 13u³ for the accurate sum (their algorithm 6) and,
//! without a fused multiply-add, of at most 7u² for the product (algorithm 10 with
//! Dekker's product). [`SUM`] and [`PRODUCT`] are above that. Where both low parts are 0, the
//! error-free transformations give the sum and the product exactly, which is how a sign of exactly
//! 0 can be told.
//!
//! Quotient and root are checked instead of analysed: with r = a − q b computed with its own bound,
//! |a/b − q| ≤ |r|/|b|, and with r = a − q², |√a − q| ≤ |r|/q.
//!
//! How errors of operands carry over, and why the bounds may themselves be computed in f64: as in
//! `bounded.rs`.

mod real;

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Real;
use super::error_free::{quick_two_sum, two_product, two_sum};
use super::rounding::{ROUND_UP, U, UNDERFLOW};

/// Above 3u² + 13u³.
const SUM: f64 = 4.0 * U * U;

/// Above 7u².
const PRODUCT: f64 = 8.0 * U * U;

/// Products and their error terms that are at least this large have lost nothing to underflow.
const NO_UNDERFLOW: f64 = 1e-270;

/// The truth lies within `error` of `high` + `low`, where |`low`| is at most half an ulp of `high`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DoubleDouble {
    pub(super) high: f64,
    pub(super) low: f64,
    pub(super) error: f64,
}

impl DoubleDouble {
    #[inline]
    fn is_zero(self) -> bool {
        self.high == 0.0 && self.error == 0.0
    }

    /// A bound on the magnitude of the truth.
    #[inline]
    fn magnitude(self) -> f64 {
        (self.high.abs() + self.error) * ROUND_UP
    }

    /// The f64 nearest to the truth; `None` where it is not known.
    pub(super) fn to_nearest(self) -> Option<f64> {
        // Both ends of what the truth can be round to it, so the truth does.
        let slack = self.error * ROUND_UP;
        let nearest = |low: f64| self.high + low;
        let ends = [
            nearest((self.low - slack).next_down()),
            nearest((self.low + slack).next_up()),
        ];
        (ends[0] == ends[1]).then_some(ends[0])
    }

    /// The same number without what is unknown about it.
    #[inline]
    fn middle(self) -> DoubleDouble {
        DoubleDouble { error: 0.0, ..self }
    }

    /// Encloses all from `high` + `low` to `high` + `up_to`, each end widened by an ulp.
    pub(super) fn around(high: f64, low: f64, up_to: f64) -> DoubleDouble {
        let ulps = 4.0 * U * (low.abs() + up_to.abs());
        DoubleDouble {
            high,
            low,
            error: ((up_to - low).abs() + ulps) * ROUND_UP + UNDERFLOW,
        }
    }

    /// Whether it is known to about 100 bits.
    pub(super) fn is_known(&self) -> bool {
        self.error <= self.high.abs() * f64::EPSILON * f64::EPSILON * 64.0 + 2.0 * UNDERFLOW
    }

    pub(super) fn unknown() -> DoubleDouble {
        DoubleDouble {
            high: 0.0,
            low: 0.0,
            error: f64::INFINITY,
        }
    }
}

impl Add for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn add(self, other: DoubleDouble) -> DoubleDouble {
        let (high, high_error) = two_sum(self.high, other.high);
        let carried = self.error + other.error;
        if self.low == 0.0 && other.low == 0.0 {
            return DoubleDouble {
                high,
                low: high_error,
                error: carried * ROUND_UP,
            };
        }
        let (low, low_error) = two_sum(self.low, other.low);
        let (high, rest) = quick_two_sum(high, high_error + low);
        let (high, low) = quick_two_sum(high, low_error + rest);
        DoubleDouble {
            high,
            low,
            error: (carried + SUM * high.abs()) * ROUND_UP,
        }
    }
}

impl Neg for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn neg(self) -> DoubleDouble {
        DoubleDouble {
            high: -self.high,
            low: -self.low,
            error: self.error,
        }
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn sub(self, other: DoubleDouble) -> DoubleDouble {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn mul(self, other: DoubleDouble) -> DoubleDouble {
        if self.is_zero() || other.is_zero() {
            return DoubleDouble::exact(0.0);
        }
        let (product, product_error) = two_product(self.high, other.high);
        let carried = self.magnitude() * other.error + other.high.abs() * ROUND_UP * self.error;
        let carried = if product.abs() < NO_UNDERFLOW {
            carried + UNDERFLOW
        } else {
            carried
        };
        if self.low == 0.0 && other.low == 0.0 {
            return DoubleDouble {
                high: product,
                low: product_error,
                error: carried * ROUND_UP,
            };
        }
        let crossed = self.high * other.low + self.low * other.high;
        let (high, low) = quick_two_sum(product, product_error + crossed);
        DoubleDouble {
            high,
            low,
            error: (carried + PRODUCT * high.abs()) * ROUND_UP,
        }
    }
}

impl Div for DoubleDouble {
    type Output = DoubleDouble;
    fn div(self, other: DoubleDouble) -> DoubleDouble {
        // As for `Bounded`: a divisor that is hardly known tells nothing.
        let divisor = other.high.abs();
        let known = other.error < divisor * f64::EPSILON.sqrt();
        if !known {
            return DoubleDouble::unknown();
        }
        if self.is_zero() {
            return self;
        }
        let (a, b) = (self.middle(), other.middle());
        let first = a.high / b.high;
        let second = (a - b * DoubleDouble::exact(first)).high / b.high;
        let (high, low) = quick_two_sum(first, second);
        let quotient = DoubleDouble {
            high,
            low,
            error: 0.0,
        };
        let residual = (a - b * quotient).magnitude();
        // |B| ≥ |b| − E, and |b| ≥ |b.high|(1 − u).
        let least = (divisor - other.error) / ROUND_UP;
        let error = (residual + self.error + quotient.magnitude() * other.error) / least;
        DoubleDouble {
            error: error * ROUND_UP + UNDERFLOW,
            ..quotient
        }
    }
}
