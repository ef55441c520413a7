//! What double-doubles answer, and their functions.

use std::cmp::Ordering;

use super::{DoubleDouble, NO_UNDERFLOW, SUM};
use crate::number::error_free::quick_two_sum;
use crate::number::rounding::{ROUND_UP, UNDERFLOW};
use crate::number::{Doubt, Real, Ring, products_summed, round_enclosure, round_sum, sine};

impl Ring for DoubleDouble {
    #[inline]
    fn sum_of_products<const N: usize>(a: [DoubleDouble; N], b: [DoubleDouble; N]) -> DoubleDouble {
        products_summed(a, b)
    }
}

impl Real for DoubleDouble {
    type Doubt = Doubt;

    #[inline]
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
                // The power is a multiple of this square, and no factor is above 1 by more than
                // rounding.
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

    #[inline]
    fn sign(self) -> Result<Ordering, Doubt> {
        // |low| ≤ u|high|, so the truth has the sign of `high` where |high|(1 − u) exceeds the
        // error.
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
        // The f64 nearest to high + low ± error, rounded away from the middle by more than its own
        // rounding.
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
