//! Lines and rays.

use std::cmp::Ordering;

use super::vector::Vector;
use crate::number::Real;
use crate::scene::Support;

/// The points `origin` + t · `direction`; a ray where only t > 0 counts.
#[derive(Clone, Copy)]
pub(super) struct Line<R> {
    pub(super) origin: Vector<R>,
    pub(super) direction: Direction<R>,
    /// The sphere or plane that the origin lies on, for a ray that starts at one. It leaves it
    /// outward.
    pub(super) leaves: Option<Support>,
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
    /// The parameter t of the line there.
    pub(super) depth: R,
    /// The point itself.
    pub(super) point: Vector<R>,
    pub(super) normal: Normal<R>,
    /// The face it enters, for a tetrahedron.
    pub(super) face: Option<u8>,
    /// The sphere or plane that the point lies on.
    pub(super) support: Support,
}

/// The outward normal at a point of a solid: all that equation 4-1 asks about the point.
#[derive(Clone, Copy)]
pub(super) struct Normal<R> {
    pub(super) vector: Vector<R>,
    pub(super) length: R,
    /// The sign of n·l, for a face: decided where the scene was read.
    pub(super) facing_light: Option<Ordering>,
}
