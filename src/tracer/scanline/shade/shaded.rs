//! A sphere of a frame whose pixels are shaded.

use crate::tracer::decision::Decision;
use crate::tracer::scanline::shade::caster::Caster;
use crate::tracer::scanline::shade::sphere::SphereConstants;
use crate::tracer::scanline::write::paint::Paint;

/// A sphere that is shaded, with its casters and its colours.
pub(crate) struct ShadedSphere<'f> {
    /// Its number among the shaded spheres of the frame.
    pub(crate) number: usize,
    pub(crate) constants: SphereConstants<'f>,
    pub(crate) casters: &'f [Caster<'f>],
    /// The decision of its pixels in the light.
    pub(crate) in_light: Decision,
    /// The paint of its pixels in shadow.
    pub(crate) in_shadow: Paint,
}
