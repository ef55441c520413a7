//! The parts of a frame while it is prepared.

use bumpalo::Bump;
use fearless_simd::Level;

use crate::tracer::decision::Decision;
use crate::tracer::scanline::edges::table::EdgeTableBuilder;
use crate::tracer::scanline::grid::Grid;
use crate::tracer::scanline::write::paint::Paints;

/// The parts of a frame that surface and solids add to.
pub(crate) struct Builder<'f, 'c> {
    pub(crate) grid: Grid,
    pub(crate) level: Level,
    pub(crate) arena: &'f Bump,
    pub(crate) edge_table: EdgeTableBuilder<'f>,
    pub(crate) paints: Paints<'f, 'c>,
    /// How many spheres are shaded so far.
    pub(crate) shaded_spheres: usize,
    /// The mean number of shadows on front faces in a row from which on faces are late.
    pub(crate) late_from: u64,
    /// How many solids have late faces so far.
    pub(crate) late_faces: usize,
}

impl<'f, 'c> Builder<'f, 'c> {
    /// No parts yet, and room for so many regions. `color` tells the colour of a decision.
    pub(crate) fn new(
        (grid, level): (Grid, Level),
        color: &'c dyn Fn(Decision) -> [f32; 3],
        late_from: u64,
        regions: usize,
        arena: &'f Bump,
    ) -> Self {
        Builder {
            grid,
            level,
            arena,
            edge_table: EdgeTableBuilder::new(regions, arena),
            paints: Paints::new(color, arena),
            shaded_spheres: 0,
            late_from,
            late_faces: 0,
        }
    }
}
