//! View space, in which pixels are traced.
//!
//! The scene is turned by α instead of the eye, and measured in thirds of a pixel from the
//! picture's centre: x right, y up, z toward the eye, a scene's length 1 being 3N/2. There the
//! pixel (x, y) lies on the screen at e = 3 (x − N/2, y − N/2, N/2), the eye looks along
//! −(0, 3, 10), which is −10 w, and a ray reaches the surface at t = (y − N/2) − (N/2) · height.
//! Directions need no unit length. So pixels and eye rays are small whole or half numbers, which
//! nothing rounds, and at α = 0 a scene of short binary fractions is, too.

use super::line::Direction;
use super::vector::Vector;
use crate::number::Real;

/// The width and height of a pixel in view space.
pub(super) const PIXEL: f64 = 3.0;

/// Eye rays go along d = (0, −[`EYE_Y`], −[`EYE_Z`]) in view space.
pub(super) const EYE_Y: f64 = 3.0;
/// See [`EYE_Y`].
pub(super) const EYE_Z: f64 = 10.0;
/// |d|² = 109.
pub(super) const EYE_SQUARED: f64 = EYE_Y * EYE_Y + EYE_Z * EYE_Z;

/// How many pixels a column or row is from the picture's middle; `half` is N/2.
#[inline]
pub(super) fn from_middle(number: u32, half: f64) -> f64 {
    f64::from(number) - half
}

/// X of a column, or Y of a row: a whole or half number below 2¹⁶, exactly.
#[inline]
pub(super) fn coordinate(number: u32, half: f64) -> f64 {
    PIXEL * from_middle(number, half)
}

/// The number of the column at X, or of the row at Y, not rounded to a whole number.
#[inline]
pub(super) fn number_at(coordinate: f64, half: f64) -> f64 {
    coordinate / PIXEL + half
}

/// (p − o)·d for the eye ray of the pixel o at Y = 0: how far along its direction d the point lies.
/// Each unit of Y adds [`EYE_Y`].
pub(super) fn along_eye_ray<R: Real>(p: Vector<R>, half: f64) -> R {
    let [y, z, screen] = [EYE_Y, EYE_Z, PIXEL * half].map(R::exact);
    z * (screen - p.z) - y * p.y
}

/// The reflection in the horizontal plane of height `mirror_height`, if there is one.
pub(super) fn reflect<R: Real>(point: Vector<R>, mirror_height: Option<R>) -> Vector<R> {
    match mirror_height {
        Some(height) => Vector::new(point.x, height + height - point.y, point.z),
        None => point,
    }
}

/// The reflection of a direction in a horizontal plane, where it is `mirrored`.
pub(super) fn reflect_direction<R: Real>(direction: Vector<R>, mirrored: bool) -> Vector<R> {
    match mirrored {
        true => Vector::new(direction.x, -direction.y, direction.z),
        false => direction,
    }
}

/// The direction of every eye ray: −10 w, of length √109.
pub(super) fn eye_direction<R: Real>() -> Direction<R> {
    let vector = Vector::new(R::exact(0.0), R::exact(-EYE_Y), R::exact(-EYE_Z));
    Direction {
        vector,
        squared_length: R::exact(EYE_SQUARED),
    }
}

/// The x and z that a vector of view space has along the scene's axes, which are turned by α.
pub(super) fn turn_back<R: Real>(sin: R, cos: R, v: Vector<R>) -> [R; 2] {
    [v.x * cos + v.z * sin, v.z * cos - v.x * sin]
}
