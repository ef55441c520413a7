//! Sine and cosine of an f64 taken exactly, the same on every platform.
//!
//! A frame asks for them once, so they must not cost more than a few rows of pixels: a series in
//! double-doubles, with a bound on its error, and arbitrary precision for the rest.

use std::sync::LazyLock;

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;

use super::Real;
use super::double_double::DoubleDouble;
use super::error_free::two_sum;

/// The sine and the cosine of the f64 `alpha` taken exactly, each rounded to nearest: the same bits
/// on every platform, which the system's library does not promise. An angle that is not finite has
/// neither: both are NaN.
///
/// ```
/// assert_eq!(firsthit::camera::sin_cos(1e22).0, -0.8522008497671888);
/// ```
pub fn sin_cos(alpha: f64) -> (f64, f64) {
    // α − α³/6 < sin α < α and 1 − α²/2 < cos α < 1: below 2^-27 both lie within a quarter of an
    // ulp of α and of 1, also where α is subnormal and a result of 53 bits would have to be
    // rounded a second time.
    if !alpha.is_finite() {
        return (f64::NAN, f64::NAN);
    }
    if alpha.abs() < f64::from_bits(0x3e40_0000_0000_0000) {
        return (alpha, 1.0);
    }
    let rounded = by_series(alpha).map(|whole| whole.map(DoubleDouble::to_nearest));
    if let Some([Some(sin), Some(cos)]) = rounded {
        return (sin, cos);
    }
    // No sine or cosine of a larger f64 is smaller than 2^-62: none is subnormal, and 53 bits are
    // an f64.
    let [sin, cos] = sin_cos_with(alpha, f64::MANTISSA_DIGITS as usize);
    (sin.to_f64().value(), cos.to_f64().value())
}

/// The sine and the cosine of the f64 `alpha` in double-doubles; of 0 for an angle that is not
/// finite.
pub(super) fn in_two(alpha: f64) -> [DoubleDouble; 2] {
    if alpha == 0.0 || !alpha.is_finite() {
        return [0.0, 1.0].map(DoubleDouble::exact);
    }
    by_series(alpha).unwrap_or_else(|| {
        // Half an ulp of the second part is at most 2^-106 of the first, and 120 bits add 2^-120.
        const ERROR: f64 = f64::EPSILON * f64::EPSILON / 2.0;
        sin_cos_with(alpha, 120).map(|whole| {
            let high = whole.to_f64().value();
            let rest = FBig::try_from(high);
            DoubleDouble {
                high,
                low: rest.map_or(f64::NAN, |high| (whole - high).to_f64().value()),
                // A second part below 2^-1074 is lost.
                error: high.abs() * ERROR + f64::from_bits(1),
            }
        })
    })
}

/// π/2 as a sum, the first two parts of 40 bits each, so that products with a whole number below
/// 2^13 are exact. The whole is off by less than 2^-188.
const HALF_PI: [f64; 4] = [
    f64::from_bits(0x3ff9_21fb_5444_2000),
    f64::from_bits(0x3d6a_308d_3131_8000),
    f64::from_bits(0x3ae8_a2e0_3707_344a),
    f64::from_bits(0x3780_24e0_88a6_7cc7),
];

/// The last power of the sine's series; that of the cosine ends one before.
const LAST: usize = 29;

/// 1/n!.
static RECIPROCALS: LazyLock<[DoubleDouble; LAST + 1]> = LazyLock::new(|| {
    let mut all = [DoubleDouble::exact(1.0); LAST + 1];
    for n in 1..=LAST {
        all[n] = all[n - 1] / DoubleDouble::exact(n as f64);
    }
    all
});

/// Sine and cosine of an angle of moderate size: reduced by multiples of π/2 to |r| < 0.79, and
/// Taylor's series in r.
fn by_series(alpha: f64) -> Option<[DoubleDouble; 2]> {
    // Below, numbers would underflow; above, the quadrant's number would have too many bits.
    if !(1e-8..4096.0).contains(&alpha.abs()) {
        return None;
    }
    let quadrant = (alpha / HALF_PI[0]).round();
    // The first difference is exact: both numbers are within a factor 2 of each other (Sterbenz),
    // or the second is 0.
    let (high, low) = two_sum(alpha - quadrant * HALF_PI[0], -(quadrant * HALF_PI[1]));
    let rest = DoubleDouble {
        high: HALF_PI[2],
        low: HALF_PI[3],
        error: f64::from_bits((1023 - 188) << 52),
    };
    let near = DoubleDouble {
        high,
        low,
        error: 0.0,
    };
    let r = near - DoubleDouble::exact(quadrant) * rest;
    let minus_square = -(r * r);
    // Every second term from the n-th on, divided by rⁿ. The sum begins with what is left out: it
    // alternates and falls, and so is less than 1/(last + 2)!.
    let series = |n: usize, last: usize| {
        let mut sum = DoubleDouble {
            error: RECIPROCALS[LAST].high / 15.0,
            ..DoubleDouble::exact(0.0)
        };
        for power in (n..=last).rev().step_by(2) {
            sum = sum * minus_square + RECIPROCALS[power];
        }
        sum
    };
    let (sin, cos) = (r * series(1, LAST), series(0, LAST - 1));
    // A whole number below 2^13, or 0 or more of four.
    Some(match (quadrant as i32).rem_euclid(4) {
        0 => [sin, cos],
        1 => [cos, -sin],
        2 => [-sin, -cos],
        _ => [-cos, sin],
    })
}

/// Sine and cosine rounded to `bits`; 0 for an angle that is not finite.
fn sin_cos_with(alpha: f64, bits: usize) -> [FBig<HalfEven>; 2] {
    let angle = FBig::<HalfEven>::try_from(alpha)
        .unwrap_or(FBig::ZERO)
        .with_precision(bits)
        .value();
    angle.sin_cos().into()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

    use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4, PI, TAU};

    use super::*;

    /// α, sin α and cos α from 1400 bits of another library (mpmath), rounded once.
    const ANGLES: &[(f64, f64, f64)] = &[
        (0.3, 0.29552020666133955, 0.955336489125606),
        (0.9, 0.7833269096274834, 0.6216099682706644),
        (-0.3, -0.29552020666133955, 0.955336489125606),
        (1.5, 0.9974949866040544, 0.0707372016677029),
        (3.0, 0.1411200080598672, -0.9899924966004454),
        (6.0, -0.27941549819892586, 0.960170286650366),
        (PI, 1.2246467991473532e-16, -1.0),
        (FRAC_PI_2, 1.0, 6.123233995736766e-17),
        (-PI, -1.2246467991473532e-16, -1.0),
        (TAU, -2.4492935982947064e-16, 1.0),
        (1e-08, 1e-08, 1.0),
        (
            1.4901161193847656e-08,
            1.4901161193847656e-08,
            0.9999999999999999,
        ),
        (
            1.1175870895385742e-08,
            1.1175870895385742e-08,
            0.9999999999999999,
        ),
        (7.450580596923827e-09, 7.450580596923827e-09, 1.0),
        (5e-324, 5e-324, 1.0),
        (-1e-300, -1e-300, 1.0),
        (1e22, -0.8522008497671888, 0.523214785395139),
        (-1.7e308, 0.5952560848632077, 0.803536056087918),
        (
            1.7976931348623157e308,
            0.004961954789184062,
            -0.9999876894265599,
        ),
        (5.319372648326541e255, 1.0, -4.687165924254628e-19),
        (FRAC_PI_4, FRAC_1_SQRT_2.next_down(), FRAC_1_SQRT_2),
        (4503599627370497.0, 0.06377812111975718, -0.9979641031953171),
        (907200.0, 0.7527106525580637, -0.6583514817524253),
        (100000.0, 0.03574879797201651, -0.9993608074382124),
    ];

    #[test]
    fn the_series_encloses_the_truth() {
        let angles = (0..2000).map(|i| f64::from(i) * f64::from(i) * 1e-3 + 1e-7);
        let frames = (1..21).map(crate::camera::frame_angle);
        for alpha in angles.chain(frames).chain([FRAC_PI_2, PI, 355.0, 710.0]) {
            let [sin, cos] = sin_cos_with(alpha, 200);
            let negative = [-sin.clone(), cos.clone()];
            for (alpha, truths) in [(alpha, [sin, cos]), (-alpha, negative)] {
                let Some(series) = by_series(alpha) else {
                    continue;
                };
                for (known, truth) in series.into_iter().zip(truths) {
                    let [high, low] = [known.high, known.low].map(|x| FBig::try_from(x).unwrap());
                    let off = (truth - high - low).to_f64().value().abs();
                    assert!(off <= known.error, "{alpha:e}: {off:e} {:e}", known.error);
                    // And it is known well: to 95 bits, or where α is near a multiple of π/2, to
                    // 2^-120.
                    let few = known.high.abs() * 2f64.powi(-95) + 2f64.powi(-120);
                    assert!(known.error < few, "{alpha:e}: {:e}", known.error);
                }
            }
        }
    }

    #[test]
    fn sine_and_cosine_are_correctly_rounded() {
        for &(alpha, sin, cos) in ANGLES {
            let got = sin_cos(alpha);
            assert_eq!(
                (got.0.to_bits(), got.1.to_bits()),
                (sin.to_bits(), cos.to_bits()),
                "{alpha:e}"
            );
            assert_eq!(sin_cos(-alpha), (-sin, cos), "{:e}", -alpha);
        }
        assert_eq!(sin_cos(-0.0).0.to_bits(), (-0.0f64).to_bits());
        assert!(sin_cos(f64::NAN).0.is_nan() && sin_cos(f64::INFINITY).1.is_nan());
    }
}
