//! Vectors of abstract numbers: points, directions and colours of the formulas.

use std::ops::{Add, Mul, Neg, Sub};

use glam::DVec3;

use crate::number::Real;

/// Three numbers: a point, a direction or a colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector<R> {
    pub(crate) x: R,
    pub(crate) y: R,
    pub(crate) z: R,
}

impl<R: Real> Vector<R> {
    #[inline]
    pub(crate) fn new(x: R, y: R, z: R) -> Self {
        Vector { x, y, z }
    }

    /// A vector of the scene, each component taken exactly.
    pub(crate) fn exact(v: DVec3) -> Self {
        Vector::new(R::exact(v.x), R::exact(v.y), R::exact(v.z))
    }

    #[inline]
    pub(crate) fn dot(self, other: Self) -> R {
        R::sum_of_products([self.x, self.y, self.z], [other.x, other.y, other.z])
    }

    #[inline]
    pub(crate) fn cross(self, other: Self) -> Self {
        let component = |a: [R; 2], b: [R; 2]| R::sum_of_products([a[0], -a[1]], [b[1], b[0]]);
        Vector::new(
            component([self.y, self.z], [other.y, other.z]),
            component([self.z, self.x], [other.z, other.x]),
            component([self.x, self.y], [other.x, other.y]),
        )
    }

    #[inline]
    pub(crate) fn squared_length(self) -> R {
        self.dot(self)
    }

    #[inline]
    pub(crate) fn length(self) -> R {
        self.squared_length().sqrt()
    }

    /// Component by component, as light and colour multiply.
    #[inline]
    pub(crate) fn times(self, other: Self) -> Self {
        Vector::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }

    #[inline]
    pub(crate) fn divided_by(self, divisor: R) -> Self {
        Vector::new(self.x / divisor, self.y / divisor, self.z / divisor)
    }
}

impl<R: Real> Add for Vector<R> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Vector::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<R: Real> Sub for Vector<R> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Vector::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<R: Real> Neg for Vector<R> {
    type Output = Self;
    #[inline]
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
