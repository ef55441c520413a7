//! Half-spaces, and which lines begin in them.

use fearless_simd::{Level, dispatch};

use super::line::Line;
use super::vector::Vector;
use crate::number::{Bounded, Real};
use crate::scene::Support;

/// The points x with normal · (x − at) ≥ 0, or > 0 where its border does not belong to it.
#[derive(Clone, Copy)]
pub(super) struct HalfSpace<R> {
    /// Inward, of any length.
    pub(super) normal: Vector<R>,
    /// A point of the border.
    pub(super) at: Vector<R>,
    /// Whether the border belongs to the half-space.
    pub(super) closed: bool,
    /// The plane of the border, if rays may leave it.
    pub(super) support: Option<Support>,
}

impl<R: Real> HalfSpace<R> {
    /// Whether the line's origin is in the half-space. An origin on the border is recognised by its
    /// support, without any arithmetic.
    pub(super) fn holds(&self, line: &Line<R>) -> Result<bool, R::Doubt> {
        if self.support.is_some() && self.support == line.origin_support {
            return Ok(self.closed);
        }
        let sign = self.normal.dot(line.origin - self.at).sign()?;
        Ok(sign.is_gt() || (self.closed && sign.is_eq()))
    }
}

impl HalfSpace<Bounded> {
    /// Whether all of these points certainly lie outside, and not on the border.
    pub(super) fn misses(&self, points: &[Vector<Bounded>; 4], level: Level) -> bool {
        dispatch!(level, simd => {
            let [normal, at] = [Vector::splat(simd, self.normal), Vector::splat(simd, self.at)];
            normal.dot(Vector::together(simd, *points) - at).all_negative()
        })
    }
}
