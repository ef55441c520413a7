//! Which way round a tetrahedron's vertices go, exactly.

use std::cmp::Ordering;

use dashu_base::Sign;
use dashu_ratio::Relaxed;
use glam::DVec3;

/// The sign of six times the signed volume, (b − a) · ((c − a) × (d − a)), in exact rational arithmetic: equal where the
/// four points lie in one plane.
///
/// The points must be finite; one that is not counts as the origin.
pub(super) fn orientation([a, b, c, d]: [DVec3; 4]) -> Ordering {
    let [a, b, c, d] = [a, b, c, d].map(|p| {
        p.to_array()
            .map(|x| Relaxed::try_from(x).unwrap_or(Relaxed::ZERO))
    });
    let from_a = |p: &[Relaxed; 3]| [&p[0] - &a[0], &p[1] - &a[1], &p[2] - &a[2]];
    let [u, v, w] = [from_a(&b), from_a(&c), from_a(&d)];
    let volume = &u[0] * (&v[1] * &w[2] - &v[2] * &w[1])
        + &u[1] * (&v[2] * &w[0] - &v[0] * &w[2])
        + &u[2] * (&v[0] * &w[1] - &v[1] * &w[0]);
    match volume.sign() {
        _ if volume == Relaxed::ZERO => Ordering::Equal,
        Sign::Positive => Ordering::Greater,
        Sign::Negative => Ordering::Less,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ulp_decides() {
        let flat = [
            DVec3::ZERO,
            DVec3::new(1.0, 0.0, 1.0),
            DVec3::new(0.0, 1.0, 1.0),
            DVec3::new(1.0, 1.0, 2.0),
        ];
        assert_eq!(orientation(flat), Ordering::Equal);
        for (z, expected) in [
            (2f64.next_up(), Ordering::Greater),
            (2f64.next_down(), Ordering::Less),
        ] {
            let mut nearly = flat;
            nearly[3].z = z;
            assert_eq!(orientation(nearly), expected);
        }
    }

    #[test]
    fn no_size_is_too_small_or_too_far() {
        let tiny = [
            DVec3::ZERO,
            DVec3::X * 1e-30,
            DVec3::Y * 1e-30,
            DVec3::Z * 1e-30,
        ];
        assert_eq!(orientation(tiny), Ordering::Greater);
        // In f64, 1e6 + 1e-30 is 1e6; the tetrahedron is given by what its numbers are, which is flat.
        let far = tiny.map(|p| p + 1e6);
        assert_eq!(orientation(far), Ordering::Equal);
        // Coordinates of both magnitudes: a volume of 1e-30 · 1e6 · 1e6.
        let long = [
            DVec3::ZERO,
            DVec3::X * 1e-30,
            DVec3::Y * 1e6,
            DVec3::Z * -1e6,
        ];
        assert_eq!(orientation(long), Ordering::Less);
    }
}
