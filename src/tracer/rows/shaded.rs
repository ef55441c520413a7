//! A sphere of a frame whose pixels are shaded.

use super::ball::Ball;
use super::caster::Caster;
use super::paint::PaintNumber;
use crate::tracer::decision::Decision;

/// A sphere that is shaded.
pub(super) struct ShadedBall<'f> {
    /// Its number among those of the frame.
    pub(super) number: usize,
    pub(super) ball: Ball,
    /// What may throw a shadow on it.
    pub(super) casters: &'f [Caster<'f>],
    /// Its decision in the light.
    pub(super) lit: Decision,
    pub(super) in_shadow: PaintNumber,
}
