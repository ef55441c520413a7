//! The angle α: its frames, its sine and its cosine.

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;

/// The frames of a round of the animation: the document adds 0.3 until α > 6.28.
pub const ROUND: u64 = 21;

/// α_k = 3k/10 rounded once to f64, the angle in radians of animation frame `k`, which counts modulo [`ROUND`].
///
/// ```
/// use firsthit::camera::frame_angle;
/// assert_eq!(frame_angle(3), 0.9);
/// assert_eq!(frame_angle(21), 0.0);
/// ```
pub fn frame_angle(k: u64) -> f64 {
    (3 * (k % ROUND)) as f64 / 10.0
}

/// The sine and the cosine of the f64 `alpha` taken exactly, each rounded to nearest: the same bits on every platform,
/// which the system's library does not promise. An angle that is not finite has neither: both are NaN.
///
/// ```
/// assert_eq!(firsthit::camera::sin_cos(1e22).0, -0.8522008497671888);
/// ```
pub fn sin_cos(alpha: f64) -> (f64, f64) {
    // α − α³/6 < sin α < α and 1 − α²/2 < cos α < 1: below 2^-27 both lie within a quarter of an ulp of α and of 1, also
    // where α is subnormal and a result of 53 bits would have to be rounded a second time.
    if !alpha.is_finite() {
        return (f64::NAN, f64::NAN);
    }
    if alpha.abs() < f64::from_bits(0x3e40_0000_0000_0000) {
        return (alpha, 1.0);
    }
    // No sine or cosine of a larger f64 is smaller than 2^-62: none is subnormal, and 53 bits are an f64.
    let [sin, cos] = sin_cos_with(alpha, f64::MANTISSA_DIGITS as usize);
    (sin.to_f64().value(), cos.to_f64().value())
}

/// How far the sums of [`sin_cos_in_two`] can be from the truth, relative to their first parts: half an ulp of the second part is
/// at most 2^-106 of the first, and 120 bits add 2^-120.
pub(crate) const IN_TWO_ERROR: f64 = f64::EPSILON * f64::EPSILON / 2.0;

/// The sine and the cosine of the f64 `alpha`, each as a sum of two f64s, the first the nearest to the whole; of 0 for an angle
/// that is not finite. A second part below 2^-1074 is lost.
pub(crate) fn sin_cos_in_two(alpha: f64) -> [(f64, f64); 2] {
    sin_cos_with(alpha, 120).map(|whole| {
        let high = whole.to_f64().value();
        let rest = FBig::try_from(high).map_or(f64::NAN, |high| (whole - high).to_f64().value());
        (high, rest)
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
