//! The numbers m · 2^e: exact under +, − and ×, until something rounds them.
//!
//! A limit of bits, a sine, a quotient and a root round. A rounded number carries a bound on the
//! errors of all roundings before it, as a power of two: a few times 2^`error`. Below 2^(`error` +
//! `bits`/2) it counts as 0. A number that is not 0 would have to lose half of its bits by accident
//! to be taken for one, and half of twice as many in an evaluation of twice the bits: one that
//! agrees in both is 0, or smaller beyond what short scenes can bring about.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use dashu_base::{BitTest, FloatEncoding, SquareRoot};
use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use dashu_int::IBig;

/// The `bits` of a number that nothing rounds.
const UNLIMITED: usize = usize::MAX;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Binary {
    significand: IBig,
    exponent: isize,
    /// `None` while nothing was rounded.
    error: Option<isize>,
    /// Longer significands are cut to so many.
    bits: usize,
}

/// `significand` · 2^-`places`, rounded to nearest, ties to even.
fn nearest(significand: &IBig, places: isize) -> IBig {
    let Ok(places) = usize::try_from(places) else {
        return significand << places.unsigned_abs();
    };
    if places > significand.bit_len() {
        return IBig::ZERO;
    }
    let floor = significand >> places;
    let twice_the_rest = (significand - (&floor << places)) << 1;
    let up = match twice_the_rest.cmp(&(IBig::ONE << places)) {
        Ordering::Less => false,
        Ordering::Equal => floor.bit(0),
        Ordering::Greater => true,
    };
    if up { floor + IBig::ONE } else { floor }
}

impl Binary {
    pub(super) const ZERO: Binary = Binary {
        significand: IBig::ZERO,
        exponent: 0,
        error: None,
        bits: UNLIMITED,
    };

    /// An f64, taken exactly.
    pub(super) fn exact(value: f64) -> Binary {
        let (significand, exponent) = value.decode().unwrap();
        let zeros = significand.trailing_zeros() % i64::BITS;
        Binary {
            significand: (significand >> zeros).into(),
            exponent: isize::from(exponent) + zeros as isize,
            ..Binary::ZERO
        }
    }

    /// What is off by a few times 2^`error`, cut to `bits` bits.
    fn cut(significand: IBig, exponent: isize, error: Option<isize>, bits: usize) -> Binary {
        if bits == UNLIMITED || significand.bit_len() <= bits {
            return Binary {
                significand,
                exponent,
                error,
                bits,
            };
        }
        let excess = significand.bit_len() - bits;
        let exponent = exponent + excess as isize;
        let is_exact = significand.trailing_zeros() >= Some(excess);
        Binary {
            significand: significand >> excess,
            exponent,
            error: if is_exact {
                error
            } else {
                error.max(Some(exponent))
            },
            bits,
        }
    }

    /// For computing on in at most `bits` bits.
    pub(super) fn limited(&self, bits: usize) -> Binary {
        let bits = self.bits.min(bits);
        Binary::cut(self.significand.clone(), self.exponent, self.error, bits)
    }

    /// The sine and the cosine of an f64 in `bits` bits; those of 0 are exact.
    pub(super) fn sin_cos(angle: f64, bits: usize) -> [Binary; 2] {
        if angle == 0.0 {
            return [0.0, 1.0].map(Binary::exact);
        }
        let angle = FBig::<HalfEven, 2>::try_from(angle).unwrap();
        let turned = angle.with_precision(bits).value().sin_cos();
        <[FBig<HalfEven, 2>; 2]>::from(turned).map(|value| {
            let (significand, exponent) = value.into_repr().into_parts();
            let last = exponent + significand.bit_len() as isize - bits as isize;
            Binary::cut(significand, exponent, Some(last), bits)
        })
    }

    /// Whether a square root of it would be the first rounding.
    pub(super) fn is_exact(&self) -> bool {
        self.bits == UNLIMITED
    }

    fn is_zero(&self) -> bool {
        self.error.is_none() && self.significand.is_zero()
    }

    /// An e with |value| < 2^e, the smallest unless the value is 0.
    fn top(&self) -> isize {
        self.exponent + self.significand.bit_len() as isize
    }

    /// The same for the number that the value stands for.
    fn bound(&self) -> isize {
        self.error.map_or(self.top(), |error| self.top().max(error))
    }

    pub(super) fn sign(&self) -> Ordering {
        let half = (self.bits / 2) as isize;
        if self.error.is_some_and(|error| self.top() < error + half) {
            return Ordering::Equal;
        }
        self.significand.cmp(&IBig::ZERO)
    }

    /// The square root of a rounded number that is not negative.
    pub(super) fn root(&self) -> Binary {
        if self.sign().is_le() {
            return Binary::ZERO.limited(self.bits);
        }
        // A root has half as many bits.
        let longer = (2 * self.bits).saturating_sub(self.significand.bit_len());
        let places = longer + (self.exponent - longer as isize).rem_euclid(2) as usize;
        let exponent = (self.exponent - places as isize) / 2;
        let significand = IBig::from((&self.significand << places).sqrt());
        let carried = self.error.map(|error| error - self.top() / 2);
        Binary::cut(
            significand,
            exponent,
            carried.max(Some(exponent)),
            self.bits,
        )
    }

    /// max(0, self)^`power`.
    pub(super) fn clipped_power(&self, power: u32) -> Binary {
        if self.sign().is_le() {
            return Binary::ZERO.limited(self.bits);
        }
        let mut result = Binary::exact(1.0).limited(self.bits);
        for place in (0..u32::BITS - power.leading_zeros()).rev() {
            result = &result * &result;
            if power.bit(place as usize) {
                result = &result * self;
            }
        }
        // Relative errors are multiplied by the power, which is below 2^20.
        let relative = self.error.map_or(isize::MIN, |error| error - self.top());
        let relative = 20 + relative.max(-(self.bits as isize));
        let error = Some(result.top() + relative);
        Binary { error, ..result }
    }

    /// The nearest f32, ties to even. Half of the bits of a rounded number decide what is a tie, as
    /// they decide what is zero.
    pub(super) fn to_sample(&self) -> f32 {
        if self.sign().is_eq() {
            return 0.0;
        }
        let known = match self.error {
            None => self.clone(),
            Some(_) => {
                let exponent = self.top() - (self.bits / 2) as isize;
                let significand = nearest(&self.significand, exponent - self.exponent);
                Binary::cut(significand, exponent, None, self.bits)
            }
        };
        // The last digit of an f32 of that size, or of the smallest.
        let last = (known.top() - 24).max(-149);
        let digits = nearest(&known.significand, last - known.exponent);
        // At most 2^24 · 2^`last`: what is too large for an f32 is infinity as an f64 already, or
        // becomes it.
        (digits.to_f64().value() * (last as f64).exp2()) as f32
    }
}

impl Add for &Binary {
    type Output = Binary;
    fn add(self, other: &Binary) -> Binary {
        let (bits, error) = (self.bits.min(other.bits), self.error.max(other.error));
        for (small, large) in [(self, other), (other, self)] {
            if small.is_zero() {
                return large.limited(bits);
            }
            // Too small for any of the bits.
            let is_lost = bits != UNLIMITED && small.top() < large.top() - bits as isize - 1;
            if is_lost && !large.significand.is_zero() {
                let error = error.max(Some(small.bound()));
                return Binary::cut(large.significand.clone(), large.exponent, error, bits);
            }
        }
        let (fine, coarse) = if self.exponent <= other.exponent {
            (self, other)
        } else {
            (other, self)
        };
        let sum = match (coarse.exponent - fine.exponent) as usize {
            0 => &fine.significand + &coarse.significand,
            places => &fine.significand + (&coarse.significand << places),
        };
        Binary::cut(sum, fine.exponent, error, bits)
    }
}

impl Sub for &Binary {
    type Output = Binary;
    fn sub(self, other: &Binary) -> Binary {
        self + &-other
    }
}

impl Neg for &Binary {
    type Output = Binary;
    fn neg(self) -> Binary {
        Binary {
            significand: -&self.significand,
            ..*self
        }
    }
}

impl Mul for &Binary {
    type Output = Binary;
    fn mul(self, other: &Binary) -> Binary {
        let bits = self.bits.min(other.bits);
        if self.is_zero() || other.is_zero() {
            return Binary {
                bits,
                ..Binary::ZERO
            };
        }
        let carried = |a: &Binary, b: &Binary| a.error.map(|error| error + b.bound());
        Binary::cut(
            &self.significand * &other.significand,
            self.exponent + other.exponent,
            carried(self, other).max(carried(other, self)),
            bits,
        )
    }
}

/// Of numbers of which one is limited, the second not 0.
impl Div for &Binary {
    type Output = Binary;
    fn div(self, other: &Binary) -> Binary {
        let bits = self.bits.min(other.bits);
        let (length, divisor) = (self.significand.bit_len(), other.significand.bit_len());
        let places = (bits + divisor + 1).saturating_sub(length);
        let exponent = self.exponent - other.exponent - places as isize;
        let least = other.top() - 1;
        let error = self.error.map(|error| error - least);
        let by_divisor = other.error.map(|error| self.bound() + error - 2 * least);
        Binary::cut(
            (&self.significand << places) / &other.significand,
            exponent,
            error.max(by_divisor).max(Some(exponent)),
            bits,
        )
    }
}

/// The digits are mpmath's, which shares no code with what computes here and in the tracer.
#[test]
fn digits_are_those_of_another_library() {
    let whole = |significand: IBig| Binary {
        significand,
        ..Binary::ZERO
    };
    let ten = |power: isize| whole(IBig::from(10).pow(power.max(0) as usize));
    let lines = include_str!("digits.txt").lines();
    for line in lines.filter(|line| !line.starts_with('#')) {
        let words: Vec<&str> = line.split(' ').collect();
        let [what, operands @ .., digits] = &words[..] else {
            panic!("{line}");
        };
        let operand = |i: usize| Binary::exact(operands[i].parse().unwrap());
        let value = |bits: usize| match *what {
            "sin" => Binary::sin_cos(operands[0].parse().unwrap(), bits)[0].clone(),
            "cos" => Binary::sin_cos(operands[0].parse().unwrap(), bits)[1].clone(),
            "root" => operand(0).limited(bits).root(),
            "quotient" => &operand(0).limited(bits) / &operand(1),
            "power" => operand(0)
                .limited(bits)
                .clipped_power(operands[1].parse().unwrap()),
            _ => panic!("{line}"),
        };
        let (digits, power) = digits.split_once('e').unwrap_or((digits, "0"));
        let places = digits.split_once('.').unwrap().1.len() as isize;
        let places = places - power.parse::<isize>().unwrap();
        let truth = &whole(digits.replace('.', "").parse().unwrap()) * &ten(-places);
        for bits in [100, 400] {
            let value = value(bits);
            let claim = Binary {
                exponent: value.error.unwrap() + 2,
                ..whole(IBig::ONE)
            };
            let value = Binary {
                error: None,
                bits: UNLIMITED,
                ..value
            };
            // The last digit may be off by one.
            let (last, claim) = (ten(-places), &claim * &ten(places));
            let (off, bound) = (&(&value * &ten(places)) - &truth, &claim + &last);
            assert!(
                (&off - &bound).sign().is_le() && (&off + &bound).sign().is_ge(),
                "{line}"
            );
            assert!(bits == 100 || (&claim - &last).sign().is_lt(), "{line}");
        }
    }
}

#[test]
fn samples_are_rounded_to_nearest() {
    let sample = |values: &[f64]| {
        let sum = |sum, &value| &sum + &Binary::exact(value);
        values.iter().fold(Binary::ZERO, sum).to_sample()
    };
    let [ulp, half, tiny] = [-23.0, -24.0, -1000.0].map(f64::exp2);
    assert_eq!(sample(&[1.0, half]), 1.0);
    assert_eq!(sample(&[1.0, half, tiny]), f32::from_bits(0x3f80_0001));
    assert_eq!(sample(&[1.0, ulp, half]), f32::from_bits(0x3f80_0002));
    assert_eq!(
        sample(&[1.0, ulp, half, -tiny]),
        f32::from_bits(0x3f80_0001)
    );
    let least = (-149.0f64).exp2();
    assert_eq!(sample(&[least / 2.0]), 0.0);
    assert_eq!(sample(&[least / 2.0, tiny]), f32::from_bits(1));
    assert_eq!(sample(&[least, least / 2.0]), f32::from_bits(2));
    let largest = f64::from(f32::MAX);
    assert_eq!(sample(&[largest, largest * half / 2.0]), f32::MAX);
    assert_eq!(sample(&[largest, largest * half]), f32::INFINITY);
    // A third in 64 bits, three times, is below a tie of few bits, and taken for it.
    let third = &Binary::exact(1.0).limited(64) / &Binary::exact(3.0);
    let tie = &third * &Binary::exact(3.0 * (1.0 + ulp + half));
    assert_eq!(tie.to_sample(), f32::from_bits(0x3f80_0002));
}
