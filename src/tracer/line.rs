//! Lines and rays.

use std::cmp::Ordering;

use super::vector::Vector;
use crate::number::Real;
use crate::scene::Support;

/// The points `origin` + t · `direction`. If only t > 0 counts, it is a ray.
#[derive(Clone, Copy)]
pub(super) struct Line<R> {
    pub(super) origin: Vector<R>,
    pub(super) direction: Direction<R>,
    /// The sphere or plane on which a ray begins; the ray leaves it outward.
    pub(super) origin_support: Option<Support>,
}

/// The direction of a line, of any length but 0, with its squared length.
#[derive(Clone, Copy)]
pub(super) struct Direction<R> {
    pub(super) vector: Vector<R>,
    pub(super) squared_length: R,
}

impl<R: Real> Line<R> {
    /// The point at parameter `t`.
    pub(super) fn at(&self, t: R) -> Vector<R> {
        self.origin + self.direction.vector * t
    }
}

/// Where a line first meets a solid.
#[derive(Clone, Copy)]
pub(super) struct Hit<R> {
    /// The parameter t of the point.
    pub(super) depth: R,
    /// The point itself.
    pub(super) point: Vector<R>,
    pub(super) normal: Normal<R>,
    /// The face that the line enters, if the solid is a tetrahedron.
    pub(super) face: Option<u8>,
    /// The sphere or plane that the point lies on.
    pub(super) support: Support,
}

/// The outward normal at a point of a solid, from which equation 4-1 follows.
#[derive(Clone, Copy)]
pub(super) struct Normal<R> {
    pub(super) vector: Vector<R>,
    pub(super) length: R,
    /// The sign of n·l, if the point is on a face: exact arithmetic has decided it.
    pub(super) facing_light: Option<Ordering>,
}
