//! Low regions, of few rows: a small sphere, its mirror image, its shadow.
//!
//! Between two bands, half of them come and go, and what was known of the order of edges and of
//! gaps is of no use to the next row. So they are no part of the active edges. A row sorts their
//! edges and lays them over the gaps of the active edges: a gap without low regions shows what it
//! showed without them, and the others are resolved in each row.

use fearless_simd::{Level, Simd, dispatch};

use crate::tracer::scanline::active::{ActiveEdges, Edge};
use crate::tracer::scanline::edges::table::EdgeTable;
use crate::tracer::scanline::grid::{Grid, ROWS};
use crate::tracer::scanline::visibility::coverage::Coverage;
use crate::tracer::scanline::visibility::visible::{Packed, Visible};

/// An edge of a region after its column in a row, in one word, which sorts faster than two.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct EdgeAt(u64);

impl EdgeAt {
    fn new(column: u32, edge: Edge) -> EdgeAt {
        EdgeAt(u64::from(column) << 32 | u64::from(edge.0))
    }

    fn column(self) -> u32 {
        (self.0 >> 32) as u32
    }

    fn edge(self) -> Edge {
        Edge(self.0 as u32)
    }
}

/// The edges of low regions, and what is visible where they cross a row.
#[derive(Default)]
pub(crate) struct LowEdges {
    /// The first row of the band.
    first: Option<u32>,
    /// A bit for each row of the band: whether a low region reaches it.
    reached: u64,
    /// The edges in each row of the band.
    edges: [Vec<EdgeAt>; ROWS],
    /// Empty, except while a row is overlaid.
    coverage: Coverage,
    /// The column at which each span of the overlaid row ends, and what the span shows.
    spans: Vec<(u32, Packed)>,
}

impl LowEdges {
    /// Prepares for rows of a frame.
    pub(crate) fn begin(&mut self, table: &EdgeTable<'_>) {
        self.first = None;
        self.coverage.clear(table);
    }

    /// Goes to a row. Returns whether any low region reaches it.
    pub(crate) fn enter(
        &mut self,
        row: u32,
        table: &EdgeTable<'_>,
        level: Level,
        grid: Grid,
    ) -> bool {
        let first = row - row % ROWS as u32;
        if self.first != Some(first) {
            self.first = Some(first);
            dispatch!(level, simd => self.cross_band(simd, table, first, grid));
        }
        self.reached >> (row - first) & 1 == 1
    }

    /// Crosses the low regions that reach the band of rows from `first` on.
    #[inline(always)]
    fn cross_band<S: Simd>(&mut self, simd: S, table: &EdgeTable<'_>, first: u32, grid: Grid) {
        self.edges.iter_mut().for_each(Vec::clear);
        self.reached = 0;
        for &region in table.low(first) {
            let band = table.regions[region as usize].cross(simd, first, grid);
            let ([a, d], [b, c]) = (band.possible, band.certain);
            let mut filled = band.filled;
            self.reached |= filled;
            while filled != 0 {
                let row = filled.trailing_zeros() as usize;
                filled &= filled - 1;
                let columns = [a[row], b[row], c[row], d[row]];
                let is_certain = (a[row], d[row]) == (b[row], c[row]);
                for edge in Edge::of(region as usize, is_certain) {
                    self.edges[row].push(EdgeAt::new(columns[edge.kind()], edge));
                }
            }
        }
    }

    /// The number of edges of low regions that cross the row.
    pub(crate) fn edge_count(&self, row: u32) -> usize {
        self.edges[row as usize % ROWS].len()
    }

    /// Lays the low regions over the gaps of a row that both have entered. `resolve` finds what is
    /// visible where these regions cover a column.
    pub(crate) fn overlay(
        &mut self,
        row: u32,
        table: &EdgeTable<'_>,
        active: &ActiveEdges,
        mut resolve: impl FnMut(&Coverage) -> Visible,
    ) {
        let edges = &mut self.edges[row as usize % ROWS];
        edges.sort_unstable();
        self.spans.clear();
        let mut low = edges.iter().peekable();
        let (mut from, mut covering) = (0, 0);
        for (to, alone, edge) in active.gaps(row) {
            loop {
                let next = low.next_if(|next| next.column() < to);
                let end = next.map_or(to, |next| next.column());
                if from < end {
                    let visible = if covering == 0 {
                        alone
                    } else {
                        self.coverage.look(table);
                        Packed::new(resolve(&self.coverage))
                    };
                    match self.spans.last_mut() {
                        Some((last, same)) if *same == visible => *last = end,
                        _ => self.spans.push((end, visible)),
                    }
                    from = end;
                }
                let Some(edge) = next.map(|next| next.edge()) else {
                    break;
                };
                self.coverage.cross(edge.region(), edge.cover());
                covering += edge.step();
            }
            if let Some(edge) = edge {
                self.coverage.cross(edge.region(), edge.cover());
            }
        }
        for edge in low.map(|next| next.edge()) {
            self.coverage.cross(edge.region(), edge.cover());
        }
    }

    /// The spans of the overlaid row: the column at which each ends, and what it shows.
    pub(crate) fn spans(&self) -> impl ExactSizeIterator<Item = (u32, Visible)> {
        let spans = self.spans.iter();
        spans.map(|(to, visible)| (*to, visible.visible()))
    }
}
