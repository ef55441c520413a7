//! A line and a sphere: equation 3-1 in its perpendicular form.

use std::cmp::Ordering;
use std::iter;

use super::half_space::HalfSpace;
use super::line::{Direction, Hit, Line, Normal};
use super::vector::Vector;
use crate::number::{Real, all};
use crate::scene::Support;

/// A sphere in view space.
pub(super) struct Sphere<R> {
    pub(super) center: Vector<R>,
    pub(super) radius: R,
    /// Equal for spheres that are listed twice.
    pub(super) support: Support,
}

impl<R: Real> Sphere<R> {
    /// The moment (o − c) × d of a line about the centre: its length is |d| times the line's
    /// distance from the centre.
    pub(super) fn moment(&self, line: &Line<R>) -> Vector<R> {
        (line.origin - self.center).cross(line.direction.vector)
    }

    /// |d|²R² − |(o − c) × d|², which is the discriminant of equation 3-1 by Lagrange's identity.
    /// Here nothing large cancels: the textbook's (d·(o − c))² − |d|²(|o − c|² − R²) loses every
    /// digit for a small sphere far away.
    fn discriminant(&self, line: &Line<R>, moment: Vector<R>) -> R {
        line.direction.squared_length * self.radius.squared() - moment.squared_length()
    }

    /// The first point of the whole line in the sphere; touching counts.
    pub(super) fn first_hit(&self, line: &Line<R>) -> Result<Option<Hit<R>>, R::Doubt> {
        let moment = self.moment(line);
        let discriminant = self.discriminant(line, moment);
        if discriminant.sign()?.is_lt() {
            return Ok(None);
        }
        let root = discriminant.sqrt();
        let d = line.direction;
        let depth = ((self.center - line.origin).dot(d.vector) - root) / d.squared_length;
        // The normal is d × ((o − c) × d)/|d|² − √D d/|d|², its parts perpendicular and parallel to
        // the line: no difference of points far away.
        let normal = (d.vector.cross(moment) - d.vector * root).divided_by(d.squared_length);
        Ok(Some(Hit {
            depth,
            point: self.center + normal,
            normal: Normal {
                vector: normal,
                length: self.radius,
                facing_light: None,
            },
            face: None,
            support: self.support,
        }))
    }

    /// How the depths of this sphere and another one compare, for a line that meets both; `None`
    /// unless their centres lie abreast of the line. If they do, the depths compare as the
    /// discriminants do, and no root is needed to see that they are equal.
    pub(super) fn compare_abreast(
        &self,
        other: &Sphere<R>,
        line: &Line<R>,
    ) -> Result<Option<Ordering>, R::Doubt> {
        let ahead = (other.center - self.center).dot(line.direction.vector);
        if !ahead.sign()?.is_eq() {
            return Ok(None);
        }
        let discriminant = |sphere: &Sphere<R>| sphere.discriminant(line, sphere.moment(line));
        let order = (discriminant(self) - discriminant(other)).sign()?;
        Ok(Some(order.reverse()))
    }

    /// The points from which rays of this direction move toward the centre.
    pub(super) fn before(&self, direction: &Direction<R>) -> HalfSpace<R> {
        HalfSpace {
            normal: -direction.vector,
            at: self.center,
            closed: false,
            support: None,
        }
    }

    /// Whether the ray from a point that is not inside the sphere meets it at some t > 0: the line
    /// meets it, and the ray moves toward the centre.
    pub(super) fn is_ahead(&self, ray: &Line<R>) -> Result<bool, R::Doubt> {
        if ray.origin_support == Some(self.support) {
            return Ok(false);
        }
        let approaches = || self.before(&ray.direction).holds(ray);
        let touches = || {
            self.discriminant(ray, self.moment(ray))
                .sign()
                .map(Ordering::is_ge)
        };
        all(iter::once_with(approaches).chain(iter::once_with(touches)))
    }
}
