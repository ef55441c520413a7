//! Low regions, of few rows: a small sphere, its mirror image, its shadow.
//!
//! Between two bands, half of them come and go, and what was known of the order of edges and of
//! gaps is of no use to the next row. So they are no part of the active edges. Their edges are
//! sorted band by band, and a row lays its own over the gaps of the active edges: a gap without low
//! regions shows what it showed without them, and the others are resolved in each row.

use fearless_simd::Level;

use crate::tracer::scanline::active::ActiveEdges;
use crate::tracer::scanline::edges::table::EdgeTable;
use crate::tracer::scanline::grid::{Grid, ROWS};
use crate::tracer::scanline::row_edges::{Added, RowEdges};
use crate::tracer::scanline::visibility::coverage::Coverage;
use crate::tracer::scanline::visibility::visible::{Packed, Visible};

/// The edges of low regions, and what is visible where they cross a row.
#[derive(Default)]
pub(crate) struct LowEdges {
    /// The first row of the band.
    first: Option<u32>,
    edges: RowEdges,
    /// All edges of the band.
    added: Added,
    /// Empty, except while a row is overlaid.
    coverage: Coverage,
    /// The column at which each span of the overlaid row ends, and what the span shows.
    spans: Vec<(u32, Packed)>,
}

impl LowEdges {
    /// Prepares for rows of a frame.
    pub(crate) fn begin(&mut self, table: &EdgeTable<'_>) {
        self.first = None;
        self.coverage.clear(&table.regions.kinds);
    }

    /// Goes to a row. Returns whether any low region reaches it. `fetch` asks for the memory of what
    /// regions show.
    pub(crate) fn enter(
        &mut self,
        row: u32,
        table: &EdgeTable<'_>,
        level: Level,
        grid: Grid,
        fetch: impl Fn(&[u32]),
    ) -> bool {
        let first = row - row % ROWS as u32;
        if self.first != Some(first) {
            self.first = Some(first);
            let low = table.low(first);
            fetch(low);
            self.edges.clear();
            self.added = self.edges.add(&table.regions, low, first, level, grid);
        }
        self.edge_count(row) > 0
    }

    /// The number of edges of low regions that cross the row.
    pub(crate) fn edge_count(&self, row: u32) -> usize {
        self.added.count(row)
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
        let kinds = &table.regions.kinds;
        self.spans.clear();
        let mut low = self.edges.sorted(&self.added, row).peekable();
        let (mut from, mut covering) = (0, 0);
        for (to, alone, edge) in active.gaps(row) {
            loop {
                let next = low.next_if(|next| next.column() < to);
                let end = next.map_or(to, |next| next.column());
                if from < end {
                    let visible = if covering == 0 {
                        alone
                    } else {
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
                self.coverage.cross(kinds, edge.region(), edge.cover());
                covering += edge.step();
            }
            if let Some(edge) = edge {
                self.coverage.cross(kinds, edge.region(), edge.cover());
            }
        }
        for edge in low.map(|next| next.edge()) {
            self.coverage.cross(kinds, edge.region(), edge.cover());
        }
    }

    /// The spans of the overlaid row: the column at which each ends, and what it shows.
    pub(crate) fn spans(&self) -> impl ExactSizeIterator<Item = (u32, Visible)> {
        let spans = self.spans.iter();
        spans.map(|(to, visible)| (*to, visible.visible()))
    }
}
