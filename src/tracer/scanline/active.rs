//! The active edges: the edges of regions that cross a row, from the left to the right, and what is
//! visible between them.
//!
//! The regions that reach a band of [`ROWS`] rows are crossed with all of its rows at once. Edges
//! move little from one row to the next, so their order is repaired instead of made anew.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, mask32x8, u32x8};

use crate::tracer::scanline::edges::band_columns::BandColumns;
use crate::tracer::scanline::edges::table::EdgeTable;
use crate::tracer::scanline::grid::{Grid, ROWS};
use crate::tracer::scanline::visibility::coverage::{Cover, Coverage};
use crate::tracer::scanline::visibility::visible::{Packed, Visible};

/// After so many exchanges in one row, the remaining rows of the band are sorted without a test.
const MANY: usize = 8;

/// The edges of a region in a band of rows.
#[derive(Clone, Copy, PartialEq, Eq)]
enum BandEdges {
    /// The region has no pixels in the band.
    None,
    /// Two edges a row: all possible columns of the region are certain.
    Two,
    /// Four edges a row: some columns of the region are only possible.
    Four,
}

/// An edge of a region, 4 · region + kind: the region begins possibly (0), begins certainly (1),
/// ends certainly (2), ends possibly (3).
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Edge(pub(crate) u32);

impl Edge {
    /// The edges of a region whose possible columns are all certain, or not, from the left.
    pub(crate) fn of(region: usize, is_certain: bool) -> impl Iterator<Item = Edge> {
        let kinds: &[u32] = if is_certain { &[1, 3] } else { &[0, 1, 2, 3] };
        kinds.iter().map(move |kind| Edge(4 * region as u32 + kind))
    }

    pub(crate) fn region(self) -> usize {
        self.0 as usize / 4
    }

    /// Which of the region's four edges it is.
    pub(crate) fn kind(self) -> usize {
        self.0 as usize % 4
    }

    /// How the region covers the columns to the right of the edge.
    pub(crate) fn cover(self) -> Cover {
        match self.kind() {
            0 | 2 => Cover::Possibly,
            1 => Cover::Certainly,
            _ => Cover::Not,
        }
    }

    /// 1 where columns begin, −1 where they end.
    pub(crate) fn step(self) -> i32 {
        if self.kind() < 2 { 1 } else { -1 }
    }
}

/// Neighbouring gaps that show the same.
#[derive(Clone, Copy)]
struct Span {
    /// The index of the edge at which the last gap ends.
    to: u32,
    visible: Packed,
}

/// The edges that cross a row from the left to the right, and what is visible in the gaps between
/// them.
///
/// Which edges lie to the left of a gap determines what the gap shows; their columns do not matter.
/// So what gaps show is kept from row to row. Where two edges exchange places, the gap between them
/// is resolved again.
#[derive(Default)]
pub(crate) struct ActiveEdges {
    /// Empty, except while gaps are resolved.
    coverage: Coverage,
    /// The first row of the band.
    first: Option<u32>,
    /// N, the column at which every row ends.
    size: u32,
    /// By the number of the region.
    band_edges: Vec<BandEdges>,
    /// A bit for each region, 64 in a word: whether it has edges in the band.
    is_active: Vec<u64>,
    /// For each of the four edges of each region, its column in each row of the band.
    columns: Vec<[u32; ROWS]>,
    /// The edges in the order of the row that was entered last.
    edges: Vec<Edge>,
    /// The columns of `edges`, and N at the end: side by side, for loops over all of them.
    sorted_columns: Vec<[u32; ROWS]>,
    /// What each gap shows: gap i lies to the left of `edges[i]`, and the last gap to the right of
    /// all edges.
    gaps: Vec<Packed>,
    /// The columns of `edges` in the row that is being sorted.
    row_columns: Vec<u32>,
    /// A bit for each row of the band: whether `edges` are out of order there.
    unsorted: u64,
    /// A bit for each row of the band: whether an unresolved gap has columns there.
    unresolved: u64,
    /// The spans of the row that was entered last, if `has_spans`. The first is a placeholder.
    spans: Vec<Span>,
    has_spans: bool,
    /// The indices of the unresolved `gaps`.
    unresolved_gaps: Vec<usize>,
    /// The regions of which other edges than before cross the band.
    changed: Vec<usize>,
    /// Whether each region is in `changed`.
    is_changed: Vec<bool>,
    /// The new edges of changed regions, by their columns in the first row of the band.
    arrivals: Vec<(u32, Edge)>,
    /// The memory in which `edges` and `gaps` are made anew.
    spare: (Vec<Edge>, Vec<Packed>),
}

impl ActiveEdges {
    /// Prepares for rows of a frame.
    pub(crate) fn begin(&mut self, table: &EdgeTable<'_>, grid: Grid) {
        let count = table.regions.kinds.all.len();
        self.first = None;
        self.band_edges.clear();
        self.band_edges.resize(count, BandEdges::None);
        self.is_active.clear();
        self.is_active.resize(table.words(), 0);
        self.columns.resize(4 * count, [0; ROWS]);
        self.size = grid.size;
        self.is_changed.clear();
        self.is_changed.resize(count, false);
        self.coverage.clear(&table.regions.kinds);
        self.edges.clear();
        self.forget();
    }

    /// Forgets what all gaps show.
    pub(crate) fn forget(&mut self) {
        self.gaps.clear();
        self.gaps.resize(self.edges.len() + 1, Packed::UNRESOLVED);
        self.has_spans = false;
    }

    /// Goes to a row. `resolve` finds what is visible where these regions cover a column.
    #[inline]
    pub(crate) fn enter(
        &mut self,
        row: u32,
        table: &EdgeTable<'_>,
        level: Level,
        grid: Grid,
        resolve: impl FnMut(&Coverage) -> Visible,
    ) {
        let first = row - row % ROWS as u32;
        if self.first != Some(first) {
            self.first = Some(first);
            dispatch!(level, simd => {
                self.cross_band(simd, table, first, grid);
                self.find_unsorted_rows(simd);
            });
        }
        let row = (row - first) as usize;
        if self.unsorted >> row & 1 == 1 {
            let exchanges = self.sort(row);
            if exchanges > MANY {
                // The next rows will need as many.
                self.unsorted = u64::MAX;
            } else {
                dispatch!(level, simd => self.find_unsorted_rows(simd));
            }
        }
        if !self.has_spans || self.unresolved >> row & 1 == 1 {
            self.resolve_gaps(row, table, resolve);
            dispatch!(level, simd => self.merge_spans(simd));
        }
    }

    /// The number of edges that are kept for the row: those of the regions that have pixels in the
    /// row's band.
    pub(crate) fn edge_count(&self) -> usize {
        self.edges.len()
    }

    /// The spans of the row, from the left: the column at which each ends, and what it shows.
    pub(crate) fn spans(&self, row: u32) -> impl ExactSizeIterator<Item = (u32, Visible)> {
        let column = move |edge: u32| self.sorted_columns[edge as usize][row as usize % ROWS];
        let spans = self.spans[1..].iter();
        spans.map(move |span| (column(span.to), span.visible.visible()))
    }

    /// The gaps of the row, from the left: the column at which each ends, what it shows if it has
    /// columns, and the edge at its end.
    pub(crate) fn gaps(&self, row: u32) -> impl Iterator<Item = (u32, Packed, Option<Edge>)> {
        let edges = self.edges.iter().copied().map(Some).chain([None]);
        let ends = self.sorted_columns.iter().zip(&self.gaps).zip(edges);
        ends.map(move |((columns, visible), edge)| (columns[row as usize % ROWS], *visible, edge))
    }

    /// Sorts the edges by their columns in a row. Returns how often two were exchanged.
    fn sort(&mut self, row: usize) -> usize {
        let columns = &self.sorted_columns[..self.edges.len()];
        self.row_columns.clear();
        self.row_columns
            .extend(columns.iter().map(|columns| columns[row]));
        let mut exchanges = 0;
        for i in 1..self.row_columns.len() {
            let column = self.row_columns[i];
            if self.row_columns[i - 1] <= column {
                continue;
            }
            let (edge, columns) = (self.edges[i], self.sorted_columns[i]);
            let mut to = i;
            while to > 0 && self.row_columns[to - 1] > column {
                self.row_columns[to] = self.row_columns[to - 1];
                self.edges[to] = self.edges[to - 1];
                self.sorted_columns[to] = self.sorted_columns[to - 1];
                // The gap between the two lay behind one of them, and now lies behind the other.
                self.gaps[to] = Packed::UNRESOLVED;
                to -= 1;
                exchanges += 1;
            }
            self.row_columns[to] = column;
            self.edges[to] = edge;
            self.sorted_columns[to] = columns;
        }
        self.has_spans &= exchanges == 0;
        exchanges
    }

    /// Merges neighbouring gaps that show the same into spans, and collects unresolved gaps.
    #[inline(always)]
    fn merge_spans<S: Simd>(&mut self, simd: S) {
        // No processor predicts the order of what gaps show: so the loop has no branches, and each
        // turn writes to both lists, whose lengths tell whether the entry counts.
        let nothing = Span {
            to: self.edges.len() as u32,
            visible: Packed::UNRESOLVED,
        };
        self.spans.clear();
        self.spans.resize(self.gaps.len() + 1, nothing);
        self.unresolved_gaps.clear();
        self.unresolved_gaps.resize(self.gaps.len() + 1, 0);
        let (mut spans, mut unresolved) = (0, 0);
        let mut last = nothing;
        for (gap, &visible) in self.gaps.iter().enumerate() {
            let is_unresolved = visible == Packed::UNRESOLVED;
            self.unresolved_gaps[unresolved] = gap;
            unresolved += usize::from(is_unresolved);
            let is_new = !is_unresolved & (visible != last.visible);
            spans += usize::from(is_new);
            last = Span {
                to: if is_unresolved { last.to } else { gap as u32 },
                visible: if is_unresolved { last.visible } else { visible },
            };
            self.spans[spans] = last;
        }
        self.spans.truncate(spans + 1);
        self.unresolved_gaps.truncate(unresolved);
        self.has_spans = true;
        let mut unresolved = mask32x8::splat(simd, false);
        for &gap in &self.unresolved_gaps {
            let from = match gap.checked_sub(1) {
                Some(before) => &self.sorted_columns[before],
                None => &[0; ROWS],
            };
            let to = &self.sorted_columns[gap];
            let (from, to) = (u32x8::from_slice(simd, from), u32x8::from_slice(simd, to));
            unresolved |= from.simd_lt(to);
        }
        self.unresolved = unresolved.to_bitmask();
    }

    /// Resolves the gaps that have columns in this row. Every region ends with its row, so the
    /// coverage is empty again afterwards.
    fn resolve_gaps(
        &mut self,
        row: usize,
        table: &EdgeTable<'_>,
        mut resolve: impl FnMut(&Coverage) -> Visible,
    ) {
        let mut from = 0;
        for gap in 0..self.gaps.len() {
            let to = self.sorted_columns[gap][row];
            if self.gaps[gap] == Packed::UNRESOLVED && from < to {
                self.gaps[gap] = Packed::new(resolve(&self.coverage));
            }
            from = to;
            if let Some(edge) = self.edges.get(gap) {
                let kinds = &table.regions.kinds;
                self.coverage.cross(kinds, edge.region(), edge.cover());
            }
        }
    }

    /// Crosses all regions with the band of rows from `first` on.
    #[inline(always)]
    fn cross_band<S: Simd>(&mut self, simd: S, table: &EdgeTable<'_>, first: u32, grid: Grid) {
        self.changed.clear();
        for word in 0..self.is_active.len() {
            let reaching = table.reaching(simd, word, first);
            let mut candidates = reaching | self.is_active[word];
            while candidates != 0 {
                let bit = candidates.trailing_zeros() as usize;
                candidates &= candidates - 1;
                let region = 64 * word + bit;
                let band_edges = match reaching >> bit & 1 {
                    1 => self.cross_region(simd, region, table, first, grid),
                    _ => BandEdges::None,
                };
                if self.band_edges[region] != band_edges {
                    self.band_edges[region] = band_edges;
                    self.changed.push(region);
                    let is_active = u64::from(band_edges != BandEdges::None);
                    self.is_active[word] = self.is_active[word] & !(1 << bit) | is_active << bit;
                }
            }
        }
        if !self.changed.is_empty() {
            self.replace_changed();
        }
        let columns = self.edges.iter();
        let columns = columns.map(|edge| self.columns[edge.0 as usize]);
        self.sorted_columns.clear();
        self.sorted_columns.extend(columns);
        self.sorted_columns.push([self.size; ROWS]);
        // An unresolved gap that had no columns in the band before may have columns in this one.
        self.has_spans &= self.unresolved_gaps.is_empty();
    }

    /// Crosses one region with the band.
    #[inline(always)]
    fn cross_region<S: Simd>(
        &mut self,
        simd: S,
        region: usize,
        table: &EdgeTable<'_>,
        first: u32,
        grid: Grid,
    ) -> BandEdges {
        let mut band = BandColumns::NONE;
        table.regions.all[region].cross(simd, first, grid, &mut band);
        if band.filled == 0 {
            return BandEdges::None;
        }
        band.place_empty_rows();
        let ([a, d], [b, c]) = (band.possible, band.certain);
        self.columns[4 * region..4 * region + 4].copy_from_slice(&[a, b, c, d]);
        if band.is_certain {
            BandEdges::Two
        } else {
            BandEdges::Four
        }
    }

    /// Removes the old edges of changed regions, and inserts the new ones.
    fn replace_changed(&mut self) {
        self.has_spans = false;
        self.arrivals.clear();
        for region in self.changed.drain(..) {
            self.is_changed[region] = true;
            let band_edges = self.band_edges[region];
            if band_edges != BandEdges::None {
                for edge in Edge::of(region, band_edges == BandEdges::Two) {
                    self.arrivals.push((self.columns[edge.0 as usize][0], edge));
                }
            }
        }
        self.arrivals.sort_unstable();
        let (edges, gaps) = &mut self.spare;
        edges.clear();
        gaps.clear();
        let mut arrivals = self.arrivals.iter().peekable();
        // `removed` and `added` count the removed and the added edges that are open at the present
        // gap: a region with two left edges counts twice.
        // Where both are 0, the same regions cover the gap as before, and what it shows holds.
        let (mut removed, mut added) = (0, 0);
        let mut before = self.gaps[0];
        for i in 0..self.gaps.len() {
            let edge = self.edges.get(i);
            if let Some(edge) = edge.filter(|edge| self.is_changed[edge.region()]) {
                removed += edge.step();
                if before == Packed::UNRESOLVED && removed == 0 {
                    before = self.gaps[i + 1];
                }
                continue;
            }
            let column = edge.map_or(u32::MAX, |edge| self.columns[edge.0 as usize][0]);
            while let Some((_, arrival)) = arrivals.next_if(|(arrives, _)| *arrives < column) {
                gaps.push(before.unless_changed(added));
                edges.push(*arrival);
                added += arrival.step();
            }
            gaps.push(before.unless_changed(added));
            if let Some(&edge) = edge {
                edges.push(edge);
                before = self.gaps[i + 1].unless_changed(removed);
            }
        }
        std::mem::swap(&mut self.edges, edges);
        std::mem::swap(&mut self.gaps, gaps);
        self.is_changed.fill(false);
    }

    /// Finds the rows in which the edges are out of order.
    #[inline(always)]
    fn find_unsorted_rows<S: Simd>(&mut self, simd: S) {
        let mut unsorted = mask32x8::splat(simd, false);
        let mut before = u32x8::splat(simd, 0);
        for columns in &self.sorted_columns {
            let columns = u32x8::from_slice(simd, columns);
            unsorted |= before.simd_gt(columns);
            before = columns;
        }
        self.unsorted = unsorted.to_bitmask();
    }
}
