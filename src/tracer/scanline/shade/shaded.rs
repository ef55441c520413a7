//! A sphere of a frame whose pixels are shaded.

use crate::tracer::decision::Decision;
use crate::tracer::scanline::shade::caster::Caster;
use crate::tracer::scanline::shade::sphere::RowSphere;
use crate::tracer::scanline::write::paint::PaintNumber;

/// A sphere that is shaded.
pub(crate) struct ShadedSphere<'f> {
    /// Its number among those of the frame.
    pub(crate) number: usize,
    pub(crate) sphere: RowSphere,
    /// What may cast a shadow on it.
    pub(crate) casters: &'f [Caster<'f>],
    /// Its decision in the light.
    pub(crate) lit: Decision,
    pub(crate) in_shadow: PaintNumber,
}
