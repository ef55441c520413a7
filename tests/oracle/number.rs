//! Numbers of a chosen number of bits that know when they are zero.
//!
//! Each carries a bound on the errors of all roundings before it, as a power of two: a few times
//! 2^(`error` − bits). What is not rounded has none, so that rational numbers that fit are exact. A
//! number below 2^(`error` − bits/2) counts as exactly 0. A number that is not 0 would have to lose
//! half of its bits by accident to be taken for one, and half of twice as many in an evaluation of
//! twice the bits: one that agrees in both is 0, or smaller beyond what short scenes can bring
//! about.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use dashu_base::Approximation::{Exact, Inexact};
use dashu_float::round::Rounded;
use dashu_float::round::mode::HalfEven;
use dashu_float::{Context, FBig};

type Float = FBig<HalfEven, 2>;

/// The logarithm of 0, far from where adding a few of them overflows.
const MINUS_INFINITY: isize = isize::MIN / 16;

#[derive(Clone, Debug)]
pub(crate) struct Number {
    value: Float,
    error: isize,
    bits: usize,
}

/// The exponent e of the smallest 2^e above |`value`|.
fn exponent(value: &Float) -> isize {
    let digits = value.repr().digits() as isize;
    if digits == 0 || value.repr().significand().is_zero() {
        MINUS_INFINITY
    } else {
        value.repr().exponent() + digits
    }
}

impl Number {
    /// An f64, taken exactly, for computing in `bits` bits.
    pub(crate) fn exact(value: f64, bits: usize) -> Number {
        let value = Float::try_from(value).unwrap();
        Number {
            value: value.with_precision(bits).value(),
            error: MINUS_INFINITY,
            bits,
        }
    }

    /// The result of an operation whose operands' errors make it wrong by 2^(`carried` − bits).
    fn new(result: Rounded<Float>, carried: isize, bits: usize) -> Number {
        let (value, own) = match result {
            Exact(value) => (value, MINUS_INFINITY),
            Inexact(value, _) => {
                let own = exponent(&value);
                (value, own)
            }
        };
        Number {
            value,
            error: carried.max(own).max(MINUS_INFINITY),
            bits,
        }
    }

    fn context(&self) -> Context<HalfEven> {
        Context::new(self.bits)
    }

    pub(crate) fn sin_cos(&self) -> (Number, Number) {
        let angle = &self.value;
        let turned = if self.sign().is_eq() {
            [0.0, 1.0].map(|value| Number::exact(value, self.bits))
        } else {
            <[Float; 2]>::from(angle.sin_cos()).map(|value| {
                let error = exponent(&value);
                Number {
                    value,
                    error,
                    bits: self.bits,
                }
            })
        };
        turned.into()
    }

    pub(crate) fn sign(&self) -> Ordering {
        let size = exponent(&self.value);
        if size == MINUS_INFINITY || size < self.error - self.bits as isize / 2 {
            Ordering::Equal
        } else {
            self.value.cmp(&Float::ZERO)
        }
    }

    /// Of a number that is not negative.
    pub(crate) fn root(&self) -> Number {
        if self.sign().is_le() {
            return Number::exact(0.0, self.bits);
        }
        let carried = self.error - exponent(&self.value) / 2;
        Number::new(
            self.context().sqrt(self.value.repr()).unwrap(),
            carried,
            self.bits,
        )
    }

    /// max(0, self)^`power`.
    pub(crate) fn clipped_power(&self, power: u32) -> Number {
        if self.sign().is_le() {
            return Number::exact(0.0, self.bits);
        }
        // Relative errors are multiplied by the power, which is below 2^20.
        let relative = 20 + self.error.max(exponent(&self.value)) - exponent(&self.value);
        let value = self.value.powi(power.into());
        let error = exponent(&value) + relative;
        Number {
            value,
            error,
            bits: self.bits,
        }
    }

    pub(crate) fn less(&self, other: &Number) -> bool {
        (self - other).sign().is_lt()
    }

    /// The nearest f32, ties to even. Half of the bits decide what is a tie, as they decide what is
    /// zero.
    pub(crate) fn to_sample(&self) -> f32 {
        if self.sign().is_eq() {
            return 0.0;
        }
        let value = self.value.clone().with_precision(self.bits / 2).value();
        // The library takes what is below the smallest f32 for 0, but above its half that is the
        // nearest.
        let [smallest, its_half] = [-149, -150].map(|e| Float::from_parts(1.into(), e));
        if value > its_half && value < smallest {
            return f32::from_bits(1);
        }
        value.to_f32().value() + 0.0
    }
}

impl Add for &Number {
    type Output = Number;
    fn add(self, other: &Number) -> Number {
        let sum = self.context().add(self.value.repr(), other.value.repr());
        Number::new(sum.unwrap(), self.error.max(other.error), self.bits)
    }
}

impl Sub for &Number {
    type Output = Number;
    fn sub(self, other: &Number) -> Number {
        let difference = self.context().sub(self.value.repr(), other.value.repr());
        Number::new(difference.unwrap(), self.error.max(other.error), self.bits)
    }
}

impl Neg for &Number {
    type Output = Number;
    fn neg(self) -> Number {
        Number {
            value: -&self.value,
            ..*self
        }
    }
}

impl Mul for &Number {
    type Output = Number;
    fn mul(self, other: &Number) -> Number {
        let product = self.context().mul(self.value.repr(), other.value.repr());
        let carried =
            (self.error + exponent(&other.value)).max(exponent(&self.value) + other.error);
        Number::new(product.unwrap(), carried, self.bits)
    }
}

impl Div for &Number {
    type Output = Number;
    fn div(self, other: &Number) -> Number {
        let quotient = self.context().div(self.value.repr(), other.value.repr());
        let divisor = exponent(&other.value);
        let carried = (self.error - divisor).max(exponent(&self.value) + other.error - 2 * divisor);
        Number::new(quotient.unwrap(), carried, self.bits)
    }
}
