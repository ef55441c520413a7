//! The curve of sRGB, from an encoded sample to the light that it stands for, rounded correctly.
//!
//! With t = (x + 0.055) / 1.055 = (200 x + 11) / 211 the curve is t^2.4 above 0.04045, so that its
//! fifth power is t¹², a rational number. Whether the curve lies above a number m is whether t¹² is
//! greater than m⁵: f64s with a bound on their error mostly tell, else rational numbers do. Which
//! f32 is tried first decides nothing but the time.
//!
//! The curve meets no midpoint between two f32s. Where t^2.4 is a binary fraction, t is the fifth
//! power of one, n/2ᵏ with an odd n, and the curve is n¹²/2¹²ᵏ. A midpoint has an odd numerator of
//! 25 bits, and no n¹² has 25 bits: 3¹² has 20, 5¹² has 28.

use dashu_ratio::Relaxed;

use super::Image;

/// The largest sample on the line: no f32 lies between 0.04045 and the f64 nearest to it.
const LINE: f64 = 0.04045;

impl Image {
    /// Takes each sample for one that sRGB encodes, and puts the light that it stands for in its
    /// place, as [`decode_srgb`] does.
    ///
    /// A display takes the bytes of a picture for sRGB; a viewer of EXR files takes its floats for
    /// light. There the decoded picture looks as this one does on a display.
    pub fn decode_srgb(&mut self) {
        for sample in self.samples_mut() {
            *sample = decode_srgb(*sample);
        }
    }
}

/// The light that `sample` stands for by the curve of sRGB: sample / 12.92 up to 0.04045, else
/// ((sample + 0.055) / 1.055)^2.4. The curve goes on below 0 and above 1. The result is the true
/// value rounded to the nearest f32, ties to even; a NaN stays a NaN.
///
/// ```
/// use firsthit::image::decode_srgb;
/// assert_eq!(decode_srgb(0.5), 0.21404114);
/// assert_eq!(decode_srgb(1.0), 1.0);
/// ```
pub fn decode_srgb(sample: f32) -> f32 {
    if sample.is_nan() {
        return sample;
    }
    let light = light(sample);
    if f64::from(sample) <= LINE {
        // The product is exact. A quotient that is not on a midpoint between two f32s is at least
        // 1/646 of the f32s' distance off it, so that rounding to f64 first changes nothing.
        return light as f32;
    }
    // No f32 is beyond 2^128.
    if light > 2_f64.powi(144) {
        return f32::INFINITY;
    }
    let mut rounded = light as f32;
    while is_above(sample, midpoint(rounded)) {
        rounded = rounded.next_up();
    }
    while !is_above(sample, midpoint(rounded.next_down())) {
        rounded = rounded.next_down();
    }
    rounded
}

/// The same in f64, a few units in the last place off above the line.
pub(crate) fn light(sample: f32) -> f64 {
    let x = f64::from(sample);
    match x <= LINE {
        true => x * 25.0 / 323.0,
        false => libm::pow((x * 200.0 + 11.0) / 211.0, 2.4),
    }
}

/// The number halfway from a positive `lower` to the next f32, where 2¹²⁸ follows the largest.
fn midpoint(lower: f32) -> f64 {
    let next = match lower.next_up() {
        f32::INFINITY => 2_f64.powi(128),
        next => f64::from(next),
    };
    (f64::from(lower) + next) / 2.0
}

/// Whether the curve at `sample`, which lies above the line, is above `m`.
fn is_above(sample: f32, m: f64) -> bool {
    is_clearly_above(sample, m).unwrap_or_else(|| is_truly_above(sample, m))
}

/// The same where f64s can tell.
fn is_clearly_above(sample: f32, m: f64) -> Option<bool> {
    // t has 2 roundings, t¹² 12 times their errors and 11 more, m⁵ of an exact m 4: in all fewer
    // than 64 relative errors of 2⁻⁵³, half of the doubt. Nothing underflows: the curve is above
    // 0.003 here.
    let t = (f64::from(sample) * 200.0 + 11.0) / 211.0;
    let (t3, m2) = (t * t * t, m * m);
    let (power, other) = (t3 * t3 * (t3 * t3), m2 * m2 * m);
    let doubt = 64.0 * f64::EPSILON * power;
    ((power - other).abs() > doubt).then_some(power > other)
}

/// The same in rational numbers.
fn is_truly_above(sample: f32, m: f64) -> bool {
    let exact = |x: f64| Relaxed::try_from(x).unwrap_or(Relaxed::ZERO);
    let t = (exact(sample.into()) * exact(200.0) + exact(11.0)) / exact(211.0);
    t.pow(12) > exact(m).pow(5)
}

#[cfg(test)]
mod tests {
    use dashu_float::FBig;
    use dashu_float::round::mode::HalfEven;

    use super::*;
    use crate::random::Random;

    /// The curve above the line in 120 bits, by exponential and logarithm.
    fn computed(sample: f32) -> f32 {
        let exact = |x: f64| FBig::<HalfEven>::try_from(x).unwrap_or(FBig::ZERO);
        let wide = |x: f64| exact(x).with_precision(120).value();
        let t = (wide(sample.into()) * wide(200.0) + wide(11.0)) / wide(211.0);
        (t.ln() * wide(12.0) / wide(5.0)).exp().to_f32().value()
    }

    /// Samples whose curve is so close to a midpoint between two f32s that f64s cannot tell.
    const HARD: [f32; 4] = [0.11598065, 0.24348919, 0.69389224, 3.0947974];

    #[test]
    fn the_curve_is_rounded_correctly() {
        let mut random = Random::new();
        let mut samples = vec![0.04045, 0.5, 1.0, 1.0_f32.next_up(), 2.0, 255.0, 1e10, 1e16];
        samples.extend((0..700).map(|_| 0.04045 + 0.96 * random.fraction() as f32));
        samples.extend(HARD);
        samples.retain(|&sample| f64::from(sample) > LINE);
        for sample in samples {
            assert_eq!(decode_srgb(sample), computed(sample), "{sample}");
        }
        for sample in [f32::MAX, f32::INFINITY, 2e16] {
            assert_eq!(decode_srgb(sample), f32::INFINITY);
        }
    }

    #[test]
    fn what_f64s_cannot_tell_rational_numbers_do() {
        for sample in HARD {
            let rounded = decode_srgb(sample);
            let midpoints = [rounded.next_down(), rounded].map(midpoint);
            assert_eq!(midpoints.map(|m| is_truly_above(sample, m)), [true, false]);
            let told = midpoints.map(|m| is_clearly_above(sample, m));
            assert!(told.contains(&None), "{sample}");
        }
    }

    #[test]
    fn the_line_is_rounded_correctly() {
        let mut random = Random::new();
        let mut samples = vec![0.04045, -0.04045, -1.0, -f32::MAX, 1e-38];
        samples.extend((0..100).map(f32::from_bits));
        samples.extend((0..2000).map(|_| 0.04045 * random.fraction() as f32));
        samples.retain(|&sample| f64::from(sample) <= LINE);
        for sample in samples {
            let exact = |x: f64| Relaxed::try_from(x).unwrap_or(Relaxed::ZERO);
            let truth = exact(sample.into()) * exact(25.0) / exact(323.0);
            let decoded = decode_srgb(sample);
            let off = |other: f32| {
                let difference = exact(other.into()) - truth.clone();
                difference.clone() * difference
            };
            for neighbour in [decoded.next_up(), decoded.next_down()] {
                assert!(off(decoded) <= off(neighbour), "{sample}");
            }
        }
        for special in [0.0, -0.0, f32::NEG_INFINITY, f32::NAN, -f32::NAN] {
            assert_eq!(decode_srgb(special).to_bits(), special.to_bits());
        }
    }
}
