//! The solids of a frame, prepared for its rows: seen directly, or in the mirror.

use crate::scene::Side;
use crate::tracer::scanline::edges::table::{Receiver, SolidIndex};
use crate::tracer::scanline::prepare::depth::Depth;
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::visibility::separation::Separation;
use crate::tracer::scanline::write::paint::PaintNumber;

/// The solids of a view that may be seen.
pub(crate) struct PreparedSolids<'f> {
    pub(crate) mirrored: bool,
    pub(crate) solids: &'f [PreparedSolid<'f>],
    /// The order of the solids that a plane separates.
    pub(crate) separation: Separation<'f>,
}

impl<'f> PreparedSolids<'f> {
    pub(crate) fn solid(&self, SolidIndex(index): SolidIndex) -> &PreparedSolid<'f> {
        &self.solids[index as usize]
    }
}

/// A solid that may be seen.
pub(crate) struct PreparedSolid<'f> {
    /// The side of the surface that the solid is on.
    pub(crate) side: Side,
    pub(crate) depth: Depth<'f>,
    pub(crate) appearance: Appearance<'f>,
}

/// How the pixels of a solid are coloured.
pub(crate) enum Appearance<'f> {
    /// All pixels show one paint.
    Flat(PaintNumber),
    /// The pixels of a sphere are shaded.
    Sphere(&'f ShadedSphere<'f>),
    /// Each front face of a tetrahedron has its paints. The pairs tell which one is seen.
    FrontFaces(&'f [FrontFace], &'f [Pair]),
}

/// A face of a tetrahedron that eye rays enter.
pub(crate) struct FrontFace {
    /// The paint in the light.
    pub(crate) lit: PaintNumber,
    /// The paint in shadow.
    pub(crate) in_shadow: PaintNumber,
    /// Whether all of it is turned away from the light, and so in shadow.
    pub(crate) turned_away: bool,
    /// The receiver of the shadows on the face.
    pub(crate) shadows: Receiver,
}

/// Two front faces that share an edge.
pub(crate) struct Pair {
    /// Their indices; the first has the lower face number.
    pub(crate) front_faces: (usize, usize),
    /// The number of the region in which eye rays enter the first one last.
    pub(crate) crease: usize,
}
