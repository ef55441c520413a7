//! Vectors of abstract numbers: points, directions and colours of the formulas.

use std::ops::{Add, Mul, Neg, Sub};

use fearless_simd::Simd;
use glam::DVec3;

use crate::number::{Bounded, FourBounded, Real, Ring};

/// Three numbers: a point, a direction or a colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector<R> {
    pub(crate) x: R,
    pub(crate) y: R,
    pub(crate) z: R,
}

impl<R: Ring> Vector<R> {
    #[inline(always)]
    pub(crate) fn new(x: R, y: R, z: R) -> Self {
        Vector { x, y, z }
    }

    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> R {
        R::sum_of_products([self.x, self.y, self.z], [other.x, other.y, other.z])
    }

    #[inline(always)]
    pub(crate) fn cross(self, other: Self) -> Self {
        let (a, b) = (self, other);
        Vector::new(
            R::sum_of_products([a.y, -a.z], [b.z, b.y]),
            R::sum_of_products([a.z, -a.x], [b.x, b.z]),
            R::sum_of_products([a.x, -a.y], [b.y, b.x]),
        )
    }

    #[inline]
    pub(crate) fn squared_length(self) -> R {
        self.dot(self)
    }
}

impl<R: Real> Vector<R> {
    /// A vector of the scene, each component taken exactly.
    pub(crate) fn exact(v: DVec3) -> Self {
        Vector::new(R::exact(v.x), R::exact(v.y), R::exact(v.z))
    }

    #[inline]
    pub(crate) fn length(self) -> R {
        self.squared_length().sqrt()
    }

    /// Component by component, as light and colour multiply.
    #[inline(always)]
    pub(crate) fn times(self, other: Self) -> Self {
        Vector::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }

    #[inline]
    pub(crate) fn divided_by(self, divisor: R) -> Self {
        Vector::new(self.x / divisor, self.y / divisor, self.z / divisor)
    }
}

impl<S: Simd> Vector<FourBounded<S>> {
    /// Four vectors as one.
    #[inline(always)]
    pub(crate) fn together(simd: S, [a, b, c, d]: [Vector<Bounded>; 4]) -> Self {
        Vector::new(
            FourBounded::new(simd, [a.x, b.x, c.x, d.x]),
            FourBounded::new(simd, [a.y, b.y, c.y, d.y]),
            FourBounded::new(simd, [a.z, b.z, c.z, d.z]),
        )
    }

    /// Four times the same vector.
    #[inline(always)]
    pub(crate) fn splat(simd: S, v: Vector<Bounded>) -> Self {
        Vector::new(
            FourBounded::splat(simd, v.x),
            FourBounded::splat(simd, v.y),
            FourBounded::splat(simd, v.z),
        )
    }

    /// The four vectors.
    #[inline(always)]
    pub(crate) fn apart(self) -> [Vector<Bounded>; 4] {
        let (x, y, z) = (self.x.to_array(), self.y.to_array(), self.z.to_array());
        [
            Vector::new(x[0], y[0], z[0]),
            Vector::new(x[1], y[1], z[1]),
            Vector::new(x[2], y[2], z[2]),
            Vector::new(x[3], y[3], z[3]),
        ]
    }
}

impl<R: Ring> Add for Vector<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Vector::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<R: Ring> Sub for Vector<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Vector::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<R: Ring> Neg for Vector<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Vector::new(-self.x, -self.y, -self.z)
    }
}

impl<R: Real> Mul<R> for Vector<R> {
    type Output = Self;
    #[inline]
    fn mul(self, factor: R) -> Self {
        Vector::new(self.x * factor, self.y * factor, self.z * factor)
    }
}
