//! The solids of a frame, prepared for its rows: seen directly, or in the mirror.

use crate::scene::Side;
use crate::tracer::scanline::edges::table::SolidIndex;
use crate::tracer::scanline::fetch::fetch;
use crate::tracer::scanline::prepare::depth::Depth;
use crate::tracer::scanline::prepare::front_faces::FrontFaces;
use crate::tracer::scanline::prepare::late_faces::LateFaces;
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::visibility::separation::Separation;
use crate::tracer::scanline::write::paint::PaintNumber;

/// The solids of a view that may be seen. What is asked of many lies apart from what is asked of
/// few, so that it stays in the cache.
pub(crate) struct PreparedSolids<'f> {
    pub(crate) mirrored: bool,
    /// The number of each solid in the scene.
    pub(crate) numbers: &'f [usize],
    /// The side of the surface that each solid is on.
    pub(crate) sides: &'f [Side],
    pub(crate) appearance: &'f [Appearance<'f>],
    pub(crate) depths: &'f [Depth<'f>],
    /// The order of the solids that a plane separates.
    pub(crate) separation: Separation<'f>,
}

impl<'f> PreparedSolids<'f> {
    /// The number of a solid in the scene.
    pub(crate) fn number(&self, SolidIndex(index): SolidIndex) -> usize {
        self.numbers[index as usize]
    }

    /// The side of the surface that a solid is on.
    pub(crate) fn side(&self, SolidIndex(index): SolidIndex) -> Side {
        self.sides[index as usize]
    }

    pub(crate) fn appearance(&self, SolidIndex(index): SolidIndex) -> &Appearance<'f> {
        &self.appearance[index as usize]
    }

    /// Asks for the memory of what tells what is seen of a solid.
    pub(crate) fn fetch(&self, SolidIndex(index): SolidIndex) {
        fetch(&std::mem::discriminant(&self.appearance[index as usize]));
        self.separation.fetch(index as usize);
    }

    pub(crate) fn depth(&self, SolidIndex(index): SolidIndex) -> &Depth<'f> {
        &self.depths[index as usize]
    }
}

/// How the pixels of a solid are coloured.
pub(crate) enum Appearance<'f> {
    /// All pixels show one paint.
    Flat(PaintNumber),
    /// The pixels of a sphere are shaded.
    Sphere(&'f ShadedSphere<'f>),
    /// Each front face of a tetrahedron has its paints.
    FrontFaces(&'f FrontFaces),
    /// The same, but prepared when the solid is first seen.
    LateFaces(&'f LateFaces<'f>),
}
