//! A frame as it is prepared.

use bumpalo::Bump;

use crate::tracer::scanline::edges::table::Edges;
use crate::tracer::scanline::grid::Grid;
use crate::tracer::scanline::write::paint::Paints;

/// What a frame's rows are made of, as they are prepared.
pub(crate) struct Builder<'f, 'c> {
    pub(crate) grid: Grid,
    pub(crate) arena: &'f Bump,
    pub(crate) edges: Edges<'f>,
    pub(crate) paints: Paints<'f, 'c>,
    pub(crate) shaded_spheres: usize,
}
