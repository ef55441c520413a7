//! Four numbers with bounds at once.

use std::ops::{Add, Neg, Sub};

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};

use super::rounding::{ROUND_UP, U, UNDERFLOW};
use super::{Bounded, Ring};

/// Four [`Bounded`] numbers.
///
/// Operations give the same bits as on each number by itself, except that sums of products are
/// taken to round: of numbers without any error, [`Bounded`] knows sums that are exact.
#[derive(Clone, Copy)]
pub(crate) struct FourBounded<S: Simd> {
    simd: S,
    value: f64x4<S>,
    error: f64x4<S>,
}

impl<S: Simd> FourBounded<S> {
    /// These four.
    #[inline(always)]
    pub(crate) fn new(simd: S, [a, b, c, d]: [Bounded; 4]) -> Self {
        FourBounded {
            simd,
            value: f64x4::from_slice(simd, &[a.value, b.value, c.value, d.value]),
            error: f64x4::from_slice(simd, &[a.error, b.error, c.error, d.error]),
        }
    }

    /// Four times the same number.
    #[inline(always)]
    pub(crate) fn splat(simd: S, number: Bounded) -> Self {
        FourBounded {
            simd,
            value: f64x4::splat(simd, number.value),
            error: f64x4::splat(simd, number.error),
        }
    }

    /// The approximations.
    #[inline(always)]
    pub(crate) fn value(self) -> f64x4<S> {
        self.value
    }

    /// How far the truths can be from the approximations.
    #[inline(always)]
    pub(crate) fn error(self) -> f64x4<S> {
        self.error
    }

    /// Whether all of them are certainly below 0.
    #[inline(always)]
    pub(crate) fn all_negative(self) -> bool {
        self.value.simd_lt(-self.error).all_true()
    }

    /// The four numbers.
    #[inline(always)]
    pub(crate) fn to_array(self) -> [Bounded; 4] {
        let (value, error) = (self.value.as_slice(), self.error.as_slice());
        let mut numbers = [Bounded::UNKNOWN; 4];
        for i in 0..4 {
            numbers[i] = Bounded {
                value: value[i],
                error: error[i],
            };
        }
        numbers
    }
}

impl<S: Simd> Add for FourBounded<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // `two_sum`.
        let value = self.value + other.value;
        let b_part = value - self.value;
        let a_part = value - b_part;
        let rounded_off = (self.value - a_part) + (other.value - b_part);
        FourBounded {
            value,
            error: (self.error + other.error + rounded_off.abs()) * ROUND_UP,
            ..self
        }
    }
}

impl<S: Simd> Neg for FourBounded<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        FourBounded {
            value: -self.value,
            ..self
        }
    }
}

impl<S: Simd> Sub for FourBounded<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<S: Simd> Ring for FourBounded<S> {
    #[inline(always)]
    fn sum_of_products<const N: usize>(a: [Self; N], b: [Self; N]) -> Self {
        const { assert!(N <= 4, "the bound is derived for four products") };
        let simd = a[0].simd;
        let zero = f64x4::splat(simd, 0.0);
        let (mut value, mut error) = (zero, zero);
        for i in 0..N {
            let term = a[i].value * b[i].value;
            let carried =
                (a[i].value.abs() + a[i].error) * b[i].error + b[i].value.abs() * a[i].error;
            let its_error = carried + term.abs() * U;
            (value, error) = if i == 0 {
                (term, its_error)
            } else {
                let sum = value + term;
                (sum, error + (its_error + sum.abs() * U))
            };
        }
        let lost = error.simd_eq(0.0).select(zero, zero + UNDERFLOW);
        FourBounded {
            simd,
            value,
            error: error * ROUND_UP + lost,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cmp::Ordering;

    use fearless_simd::{Level, dispatch};

    use super::*;
    use crate::number::Real as _;
    use crate::random::Random;

    /// A number with an error, of any magnitude that a frame has.
    fn number(random: &mut Random) -> Bounded {
        let mut signed = |digits: i32| {
            let scale = 10_f64.powi(random.below(digits as usize) as i32 - digits / 2);
            scale * (2.0 * random.fraction() - 1.0)
        };
        Bounded {
            value: signed(8),
            error: (signed(8) * 1e-12).abs(),
        }
    }

    fn bits(numbers: [Bounded; 4]) -> [(u64, u64); 4] {
        numbers.map(|number| (number.value.to_bits(), number.error.to_bits()))
    }

    #[test]
    fn four_numbers_at_once_have_the_bits_of_each_by_itself() {
        let mut random = Random::new();
        for level in [Level::new(), Level::baseline(), Level::fallback()] {
            for _ in 0..2000 {
                let mut four = || [(); 4].map(|()| number(&mut random));
                let (a, b) = ([four(), four(), four()], [four(), four(), four()]);
                let each = |of: &dyn Fn([Bounded; 3], [Bounded; 3]) -> Bounded| {
                    let lane = |lane: usize| of(a.map(|a| a[lane]), b.map(|b| b[lane]));
                    bits([0, 1, 2, 3].map(lane))
                };
                dispatch!(level, simd => {
                    let (p, q) = (
                        a.map(|a| FourBounded::new(simd, a)),
                        b.map(|b| FourBounded::new(simd, b)),
                    );
                    let sum = FourBounded::sum_of_products(p, q);
                    assert_eq!(bits(sum.to_array()), each(&Bounded::sum_of_products));
                    assert_eq!(bits((p[0] + q[0]).to_array()), each(&|a, b| a[0] + b[0]));
                    assert_eq!(bits((p[0] - q[0]).to_array()), each(&|a, b| a[0] - b[0]));
                    assert_eq!(bits((-p[0]).to_array()), each(&|a, _| -a[0]));
                    let same = FourBounded::splat(simd, a[0][0]);
                    assert_eq!(bits(same.to_array()), bits([a[0][0]; 4]));
                });
            }
        }
    }

    #[test]
    fn four_numbers_are_negative_where_each_certainly_is() {
        let number = |value, error| Bounded { value, error };
        let certain = number(-1.0, 0.5);
        let others = [
            (-1.0, 0.9),
            (-1.0, 1.0),
            (-1.0, 2.0),
            (0.0, 0.0),
            (1.0, 0.5),
        ];
        for level in [Level::new(), Level::baseline(), Level::fallback()] {
            for (lane, (value, error)) in (0..4).flat_map(|lane| others.map(|other| (lane, other)))
            {
                let mut four = [certain; 4];
                four[lane] = number(value, error);
                let expected = four[lane].sign() == Ok(Ordering::Less);
                dispatch!(level, simd => {
                    assert_eq!(FourBounded::new(simd, four).all_negative(), expected);
                });
            }
        }
    }
}
