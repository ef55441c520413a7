//! The parts of a frame while it is prepared.

use bumpalo::Bump;

use crate::tracer::scanline::edges::table::EdgeTableBuilder;
use crate::tracer::scanline::grid::Grid;
use crate::tracer::scanline::write::paint::Paints;

/// The parts of a frame that surface and solids add to.
pub(crate) struct Builder<'f, 'c> {
    pub(crate) grid: Grid,
    pub(crate) arena: &'f Bump,
    pub(crate) edge_table: EdgeTableBuilder<'f>,
    pub(crate) paints: Paints<'f, 'c>,
    /// How many spheres are shaded so far.
    pub(crate) shaded_spheres: usize,
}
