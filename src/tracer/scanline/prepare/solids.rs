//! The solids as a frame's rows cross them: seen directly, or in the mirror.

use crate::scene::Side;
use crate::tracer::scanline::edges::table::Receiver;
use crate::tracer::scanline::prepare::depth::Depth;
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::visibility::separation::Separation;
use crate::tracer::scanline::write::paint::PaintNumber;

/// The solids of a view that are seen.
pub(crate) struct Solids<'f> {
    pub(crate) mirrored: bool,
    pub(crate) solids: &'f [Solid<'f>],
    /// Which is in front of which.
    pub(crate) separation: Separation<'f>,
}

/// One of them.
pub(crate) struct Solid<'f> {
    pub(crate) side: Side,
    pub(crate) depth: Depth<'f>,
    pub(crate) body: Body<'f>,
}

/// How its pixels are coloured.
pub(crate) enum Body<'f> {
    /// All alike.
    Flat(PaintNumber),
    Sphere(&'f ShadedSphere<'f>),
    Facets(&'f [Facet], &'f [Pair]),
}

/// A face that eye rays enter.
pub(crate) struct Facet {
    pub(crate) lit: PaintNumber,
    pub(crate) in_shadow: PaintNumber,
    /// Whether all of it is turned away from the light, and so in shadow.
    pub(crate) turned_away: bool,
    pub(crate) shadows: Receiver,
}

/// Two facets, the first of the lower number, and the edge of where eye rays enter that last.
pub(crate) struct Pair {
    pub(crate) facets: (usize, usize),
    pub(crate) first: usize,
}
