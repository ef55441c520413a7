//! A double-double, the unevaluated sum of two f64s, and a bound on how far it is from the truth.
//!
//! # Why the bounds hold
//!
//! With u = 2⁻⁵³ and no underflow, Joldes, Muller and Popescu ("Tight and rigorous error bounds for basic building blocks of
//! double-word arithmetic", ACM TOMS 44, 2017) prove for normalised operands a relative error of at most 3u² + 13u³ for
//! the accurate sum (their algorithm 6) and, without a fused multiply-add, of at most 7u² for the product (algorithm 10 with
//! Dekker's product). [`SUM`] and [`PRODUCT`] are above that. Where both low parts are 0, the error-free transformations give
//! the sum and the product exactly, which is how a sign of exactly 0 can be told.
//!
//! Quotient and root are checked instead of analysed: with r = a − q b computed with its own bound, |a/b − q| ≤ |r|/|b|, and
//! with r = a − q², |√a − q| ≤ |r|/q.
//!
//! How errors of operands carry over, and why the bounds may themselves be computed in f64: as in `bounded.rs`.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::bounded::{Bounded, ROUND_UP, UNDERFLOW, UNIT_ROUNDOFF};
use super::{Doubt, Real, round_enclosure, round_sum, sine};

/// Above 3u² + 13u³.
const SUM: f64 = 4.0 * UNIT_ROUNDOFF * UNIT_ROUNDOFF;

/// Above 7u².
const PRODUCT: f64 = 8.0 * UNIT_ROUNDOFF * UNIT_ROUNDOFF;

/// Products and their error terms that are at least this large have lost nothing to underflow.
const NO_UNDERFLOW: f64 = 1e-270;

/// The truth lies within `error` of `high` + `low`, where |`low`| is at most half an ulp of `high`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DoubleDouble {
    pub(super) high: f64,
    pub(super) low: f64,
    pub(super) error: f64,
}

/// a + b as a rounded sum and its error, exactly (Knuth).
#[inline]
pub(super) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    let a_part = sum - b_part;
    (sum, (a - a_part) + (b - b_part))
}

/// The same where |a| ≥ |b| or a = 0 (Dekker).
#[inline]
fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// A number's upper 26 bits and the rest (Veltkamp). No operand comes near the 2⁹⁹⁶ where this would overflow.
#[inline]
fn split(a: f64) -> (f64, f64) {
    let scaled = a * 134_217_729.0;
    let upper = scaled - (scaled - a);
    (upper, a - upper)
}

/// a · b as a rounded product and its error, exactly where nothing underflows (Dekker). A fused multiply-add would do it in one
/// step, and would be a slow call on every machine that has none.
#[inline]
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((a_upper, a_lower), (b_upper, b_lower)) = (split(a), split(b));
    let error = a_lower * b_lower
        - (((product - a_upper * b_upper) - a_lower * b_upper) - a_upper * b_lower);
    (product, error)
}

impl DoubleDouble {
    fn is_zero(self) -> bool {
        self.high == 0.0 && self.error == 0.0
    }

    /// A bound on the magnitude of the truth.
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
    fn middle(self) -> DoubleDouble {
        DoubleDouble { error: 0.0, ..self }
    }

    /// A number from `high` + `low`, or less by an ulp of `low`, to `high` + `up_to`, or more by one.
    pub(super) fn around(high: f64, low: f64, up_to: f64) -> DoubleDouble {
        let ulps = 4.0 * UNIT_ROUNDOFF * (low.abs() + up_to.abs());
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

impl Add for DoubleDouble {
    type Output = DoubleDouble;
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
    fn sub(self, other: DoubleDouble) -> DoubleDouble {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = DoubleDouble;
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

impl Real for DoubleDouble {
    type Doubt = Doubt;

    fn exact(value: f64) -> DoubleDouble {
        DoubleDouble {
            high: value,
            low: 0.0,
            error: 0.0,
        }
    }

    fn sin_cos(alpha: f64) -> (DoubleDouble, DoubleDouble) {
        let [sin, cos] = sine::in_two(alpha);
        (sin, cos)
    }

    fn sqrt(self) -> DoubleDouble {
        if self.is_zero() {
            return self;
        }
        let positive = self.high > self.error * ROUND_UP;
        if !positive {
            let most = (self.high.max(0.0) + self.error) * ROUND_UP;
            return DoubleDouble {
                high: 0.0,
                low: 0.0,
                error: most.sqrt() * ROUND_UP,
            };
        }
        let first = self.high.sqrt();
        let square = DoubleDouble::exact(first) * DoubleDouble::exact(first);
        let second = (self.middle() - square).high / (2.0 * first);
        let (high, low) = quick_two_sum(first, second);
        let root = DoubleDouble {
            high,
            low,
            error: 0.0,
        };
        let residual = (self.middle() - root * root).magnitude();
        let error = (residual + self.error) / (high / ROUND_UP);
        DoubleDouble {
            error: error * ROUND_UP + UNDERFLOW,
            ..root
        }
    }

    fn one_minus_to_the(self, exponent: u32) -> DoubleDouble {
        let mut square = DoubleDouble::exact(1.0) - self;
        let positive = square.high > square.error * ROUND_UP;
        if !positive {
            // At most the base itself, and 0 where the base is not positive.
            let most = (square.high.max(0.0) + square.error) * ROUND_UP;
            let error = if square.high + square.error * ROUND_UP < 0.0 {
                0.0
            } else {
                most
            };
            return DoubleDouble {
                high: 0.0,
                low: 0.0,
                error,
            };
        }
        let mut power = DoubleDouble::exact(1.0);
        let mut bits = exponent;
        loop {
            if bits & 1 == 1 {
                power = power * square;
            }
            bits >>= 1;
            if bits == 0 {
                return power;
            }
            square = square * square;
            if square.magnitude() < NO_UNDERFLOW {
                // The power is a multiple of this square, and no factor is above 1 by more than rounding.
                return DoubleDouble {
                    high: 0.0,
                    low: 0.0,
                    error: 2.0 * NO_UNDERFLOW,
                };
            }
        }
    }

    fn or_better(self, known: DoubleDouble) -> DoubleDouble {
        known
    }

    fn sign(self) -> Result<Ordering, Doubt> {
        // |low| ≤ u|high|, so the truth has the sign of `high` where |high|(1 − u) exceeds the error.
        if self.high.abs() > self.error * ROUND_UP {
            Ok(if self.high > 0.0 {
                Ordering::Greater
            } else {
                Ordering::Less
            })
        } else if self.is_zero() {
            Ok(Ordering::Equal)
        } else {
            Err(Doubt)
        }
    }

    fn to_sample(self) -> Result<f32, Doubt> {
        // The f64 nearest to high + low ± error, rounded away from the middle by more than its own rounding.
        let ends = [-self.error, self.error].map(|error| {
            let end = self + DoubleDouble::exact(error);
            let slack = SUM * 2.0 * end.high.abs();
            let end = if self.error == 0.0 {
                self
            } else {
                end + DoubleDouble::exact(slack.copysign(error))
            };
            round_sum(end.high, end.low)
        });
        round_enclosure(ends[0], ends[1]).ok_or(Doubt)
    }

    fn to_f64(self) -> f64 {
        self.high
    }
}
