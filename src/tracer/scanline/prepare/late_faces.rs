//! Late faces: the front faces of a tetrahedron in a crowd, prepared when a row first shows the
//! solid.
//!
//! Each face receives the shadows of many solids, and few of a crowd's solids are seen. So the
//! creases and shadows of a solid are no edges of the frame: they are made for the rows that show
//! the solid, and divide what they show of it.

use std::sync::OnceLock;

use bumpalo_herd::Herd;
use fearless_simd::Level;

use crate::number::Bounded;
use crate::tracer::pixel::Picture;
use crate::tracer::scanline::edges::table::Regions;
use crate::tracer::scanline::grid::Grid;
use crate::tracer::scanline::prepare::front_faces::FrontFaces;
use crate::tracer::scanline::prepare::outline::OutlinedFaces;
use crate::tracer::scanline::write::paint::AllPaints;
use crate::tracer::view_tetrahedra::TetrahedronInView;

/// The front faces of a tetrahedron, made when they are first asked for.
pub(crate) struct LateFaces<'f> {
    /// The number among all late faces of the frame.
    pub(crate) number: usize,
    /// What they are made from.
    pub(crate) outlined: OutlinedFaces<'f>,
    pub(crate) tetrahedron: &'f TetrahedronInView<Bounded>,
    /// They themselves, once they are made.
    pub(crate) made: OnceLock<SplitFaces<'f>>,
}

/// Front faces with regions and paints of their own.
pub(crate) struct SplitFaces<'f> {
    /// The faces; receivers, creases and paints are numbers among those of this solid.
    pub(crate) front_faces: FrontFaces<'f>,
    /// The creases, and the shadows on the faces.
    pub(crate) regions: Regions<'f>,
    /// The paints of the faces.
    pub(crate) paints: AllPaints<'f>,
}

/// What late faces are made from.
pub(crate) struct LateSource<'f> {
    /// The frame as f64 with a bound knows it.
    pub(crate) picture: &'f Picture<'f, Bounded>,
    pub(crate) grid: Grid,
    pub(crate) level: Level,
    /// The memory for what threads make.
    pub(crate) threads: &'f Herd,
}

impl<'f> LateFaces<'f> {
    /// Nothing is made yet.
    pub(crate) fn new(
        number: usize,
        outlined: OutlinedFaces<'f>,
        tetrahedron: &'f TetrahedronInView<Bounded>,
    ) -> Self {
        LateFaces {
            number,
            outlined,
            tetrahedron,
            made: OnceLock::new(),
        }
    }
}
