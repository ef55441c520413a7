//! The edges of regions in the rows of a band, each row by itself: nothing is kept of their order
//! from one row to the next.

use std::ops::Range;

use fearless_simd::{Level, Simd, dispatch};

use crate::tracer::scanline::active::Edge;
use crate::tracer::scanline::edges::band_columns::BandColumns;
use crate::tracer::scanline::edges::table::Regions;
use crate::tracer::scanline::grid::{Grid, ROWS};

/// An edge of a region after its column in a row, in one word, which sorts faster than two.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct EdgeAt(u64);

impl EdgeAt {
    fn new(column: u32, edge: Edge) -> EdgeAt {
        EdgeAt(u64::from(column) << 32 | u64::from(edge.0))
    }

    /// The column at which it is.
    pub(crate) fn column(self) -> u32 {
        (self.0 >> 32) as u32
    }

    /// The edge itself.
    pub(crate) fn edge(self) -> Edge {
        Edge(self.0 as u32)
    }
}

/// Regions that bands can cross.
pub(crate) trait BandRegions {
    /// The columns of the region of this number in the band of rows from `first` on.
    fn cross<S: Simd>(&self, simd: S, number: usize, first: u32, grid: Grid) -> BandColumns;
}

impl BandRegions for Regions<'_> {
    #[inline(always)]
    fn cross<S: Simd>(&self, simd: S, number: usize, first: u32, grid: Grid) -> BandColumns {
        self.all[number].cross(simd, first, grid)
    }
}

/// The edges of some regions in each row of a band.
#[derive(Default)]
pub(crate) struct RowEdges {
    /// A bit for each row: whether any of the regions reaches it.
    reached: u64,
    rows: [Vec<EdgeAt>; ROWS],
}

impl RowEdges {
    /// Removes all edges.
    pub(crate) fn clear(&mut self) {
        self.rows.iter_mut().for_each(Vec::clear);
        self.reached = 0;
    }

    /// Adds the edges of the regions of these numbers in the band of rows from `first` on.
    pub(crate) fn add(
        &mut self,
        regions: &impl BandRegions,
        numbers: &[u32],
        first: u32,
        level: Level,
        grid: Grid,
    ) {
        dispatch!(level, simd => self.add_all(simd, regions, numbers, first, grid));
    }

    #[inline(always)]
    fn add_all<S: Simd>(
        &mut self,
        simd: S,
        regions: &impl BandRegions,
        numbers: &[u32],
        first: u32,
        grid: Grid,
    ) {
        for &region in numbers {
            let region = region as usize;
            let band = regions.cross(simd, region, first, grid);
            let ([a, d], [b, c]) = (band.possible, band.certain);
            let mut filled = band.filled;
            self.reached |= filled;
            while filled != 0 {
                let row = filled.trailing_zeros() as usize;
                filled &= filled - 1;
                let columns = [a[row], b[row], c[row], d[row]];
                let is_certain = (a[row], d[row]) == (b[row], c[row]);
                for edge in Edge::of(region, is_certain) {
                    self.rows[row].push(EdgeAt::new(columns[edge.kind()], edge));
                }
            }
        }
    }

    /// Whether any of the regions reaches a row of the band.
    pub(crate) fn reach(&self, row: u32) -> bool {
        self.reached >> (row as usize % ROWS) & 1 == 1
    }

    /// The number of edges in a row of the band.
    pub(crate) fn count(&self, row: u32) -> usize {
        self.rows[row as usize % ROWS].len()
    }

    /// The numbers of edges in each row of the band.
    pub(crate) fn counts(&self) -> [usize; ROWS] {
        std::array::from_fn(|row| self.rows[row].len())
    }

    /// The edges in a row of the band, from the left.
    pub(crate) fn sorted(&mut self, row: u32) -> &[EdgeAt] {
        self.sorted_among(row, 0..self.count(row))
    }

    /// The same of those edges that were added as this range of the row's.
    pub(crate) fn sorted_among(&mut self, row: u32, range: Range<usize>) -> &[EdgeAt] {
        let edges = &mut self.rows[row as usize % ROWS][range];
        edges.sort_unstable();
        edges
    }
}
