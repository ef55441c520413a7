//! Vectors and planes in exact rational arithmetic.

use std::cmp::Ordering;

use dashu_base::Sign;
use dashu_ratio::{RBig, Relaxed};
use glam::DVec3;

use super::FACES;

pub(super) type RationalVector = [Relaxed; 3];

/// The vector of these f64s, taken exactly; one that is not finite counts as 0.
pub(super) fn exact(v: DVec3) -> RationalVector {
    v.to_array()
        .map(|x| Relaxed::try_from(x).unwrap_or(Relaxed::ZERO))
}

pub(super) fn minus(a: &RationalVector, b: &RationalVector) -> RationalVector {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

pub(super) fn cross(a: &RationalVector, b: &RationalVector) -> RationalVector {
    [
        &a[1] * &b[2] - &a[2] * &b[1],
        &a[2] * &b[0] - &a[0] * &b[2],
        &a[0] * &b[1] - &a[1] * &b[0],
    ]
}

pub(super) fn dot(a: &RationalVector, b: &RationalVector) -> Relaxed {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(super) fn sign(x: &Relaxed) -> Ordering {
    match x.sign() {
        _ if *x == Relaxed::ZERO => Ordering::Equal,
        Sign::Positive => Ordering::Greater,
        Sign::Negative => Ordering::Less,
    }
}

/// The points x with normal · x = offset.
pub(super) struct Plane {
    pub(super) normal: RationalVector,
    pub(super) offset: Relaxed,
}

impl Plane {
    /// The plane of face `k`, its normal outward.
    pub(super) fn of_face(vertices: &[RationalVector; 4], k: usize) -> Plane {
        let [a, b, c] = FACES[k].map(|vertex| &vertices[vertex]);
        let normal = cross(&minus(b, a), &minus(c, a));
        let outward = sign(&dot(&normal, &minus(&vertices[k], a))).is_lt();
        let normal = if outward { normal } else { normal.map(|x| -x) };
        Plane {
            offset: dot(&normal, a),
            normal,
        }
    }

    /// The coefficients, scaled so that the first that is not 0 is 1: equal for equal planes.
    pub(super) fn coefficients(self) -> [RBig; 4] {
        let [x, y, z] = self.normal.map(Relaxed::canonicalize);
        let all = [x, y, z, self.offset.canonicalize()];
        match all
            .iter()
            .find(|coefficient| **coefficient != RBig::ZERO)
            .cloned()
        {
            Some(first) => all.map(|coefficient| coefficient / &first),
            None => all,
        }
    }
}
