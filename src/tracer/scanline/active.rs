//! The active edges: the crossings of a row from the left to the right, and what is visible between
//! them.
//!
//! The edges that reach a band of [`ROWS`] rows are crossed with all of its rows at once. Crossings
//! move little from one row to the next, so their order is repaired instead of made anew.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, mask32x8, u32x8};

use crate::tracer::scanline::edges::table::EdgeTable;
use crate::tracer::scanline::grid::{Grid, ROWS};
use crate::tracer::scanline::visibility::coverage::{Cover, Coverage};
use crate::tracer::scanline::visibility::visible::{Packed, Visible};

/// After so many exchanges in one row the next rows are sorted without asking whether they must be.
const MANY: usize = 8;

/// How often an edge crosses a band of rows.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Crosses {
    No,
    /// Twice a row: its region's possible columns are certain in the whole band.
    Certainly,
    /// Four times a row: the region begins possibly, then certainly; it ends certainly, then
    /// possibly.
    Possibly,
}

/// One of the four crossings of an edge with a row, 4 · edge + kind: its region begins possibly (0),
/// begins certainly (1), ends certainly (2), ends possibly (3).
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Crossing(u32);

impl Crossing {
    /// Those of an edge, from the left.
    fn of(edge: usize, crosses: Crosses) -> impl Iterator<Item = Crossing> {
        let kinds: &[u32] = match crosses {
            Crosses::No => &[],
            Crosses::Certainly => &[1, 3],
            Crosses::Possibly => &[0, 1, 2, 3],
        };
        kinds
            .iter()
            .map(move |kind| Crossing(4 * edge as u32 + kind))
    }

    fn edge(self) -> usize {
        self.0 as usize / 4
    }

    /// How the region covers the columns after it.
    fn cover(self) -> Cover {
        match self.0 % 4 {
            0 | 2 => Cover::Unknown,
            1 => Cover::Certainly,
            _ => Cover::Not,
        }
    }

    /// 1 where columns begin, −1 where they end.
    fn step(self) -> i32 {
        if self.0 % 4 < 2 { 1 } else { -1 }
    }
}

/// A part of a row: before which of its crossings it ends, and what is visible there.
#[derive(Clone, Copy)]
struct Span {
    to: u32,
    visible: Packed,
}

/// The crossings of a row from the left to the right, and what is visible between them.
///
/// Visibility between two crossings depends on which edges were crossed before, and not on where.
/// So it is cached from row to row; where two crossings exchange places, only what lies between
/// these two is found out again.
#[derive(Default)]
pub(crate) struct ActiveEdges {
    coverage: Coverage,
    /// The first of the rows that are crossed.
    first: Option<u32>,
    /// The first column after a row.
    size: u32,
    /// How each edge crosses them.
    crosses: Vec<Crosses>,
    /// Bit by bit, 64 in a word, those that do.
    crossing: Vec<u64>,
    /// Where, row by row, for each of its four crossings.
    places: Vec<[u32; ROWS]>,
    /// In the order of the row that was entered last.
    crossings: Vec<Crossing>,
    /// The places of these, and the row's end: side by side, for those who go through all.
    at: Vec<[u32; ROWS]>,
    /// What is visible before each of them, and after the last.
    visible: Vec<Packed>,
    /// The columns of these in that row.
    here: Vec<u32>,
    /// Bit by bit, the rows in which they come in another order, and those that have columns of
    /// which it is not known what is visible.
    disordered: u64,
    wanting: u64,
    /// What the row that was entered last shows, if `has_spans`; neighbours that show the same
    /// are one. The first is none.
    spans: Vec<Span>,
    has_spans: bool,
    /// The places in `visible` where nobody has looked.
    open: Vec<usize>,
    /// Edges whose crossings are not, or no longer, those in `crossings`.
    changed: Vec<usize>,
    is_changed: Vec<bool>,
    /// Their new crossings, by their places in the first of the rows.
    arrivals: Vec<(u32, Crossing)>,
    /// Where `crossings` and `visible` are made anew.
    spare: Changed,
}

#[derive(Default)]
struct Changed {
    crossings: Vec<Crossing>,
    visible: Vec<Packed>,
}

impl ActiveEdges {
    /// Prepares for rows of a frame.
    pub(crate) fn begin(&mut self, edges: &EdgeTable<'_>, grid: Grid) {
        let count = edges.of.len();
        self.first = None;
        self.crosses.clear();
        self.crosses.resize(count, Crosses::No);
        self.crossing.clear();
        self.crossing.resize(edges.words(), 0);
        self.places.resize(4 * count, [0; ROWS]);
        self.size = grid.size;
        self.is_changed.clear();
        self.is_changed.resize(count, false);
        self.coverage.clear(edges);
        self.crossings.clear();
        self.forget();
    }

    /// Forgets what is visible.
    pub(crate) fn forget(&mut self) {
        self.visible.clear();
        self.visible.resize(self.crossings.len() + 1, Packed::OPEN);
        self.has_spans = false;
    }

    /// Goes to a row. `look` is asked what is visible in a column where that is not known.
    pub(crate) fn enter(
        &mut self,
        row: u32,
        edges: &EdgeTable<'_>,
        level: Level,
        grid: Grid,
        look: impl FnMut(&Coverage) -> Visible,
    ) {
        let first = row - row % ROWS as u32;
        if self.first != Some(first) {
            self.first = Some(first);
            dispatch!(level, simd => {
                self.cross(simd, edges, first, grid);
                self.find_disorder(simd);
            });
        }
        let row = (row - first) as usize;
        if self.disordered >> row & 1 == 1 {
            let changes = self.order(row);
            if changes > MANY {
                // So it will be in the next rows.
                self.disordered = u64::MAX;
            } else {
                dispatch!(level, simd => self.find_disorder(simd));
            }
        }
        if !self.has_spans || self.wanting >> row & 1 == 1 {
            self.look(row, edges, look);
            dispatch!(level, simd => self.merge_spans(simd));
        }
    }

    /// How many parts the row has.
    pub(crate) fn len(&self) -> usize {
        self.spans.len() - 1
    }

    /// Where a part of a row ends, and what is visible there.
    pub(crate) fn span(&self, number: usize, row: u32) -> (u32, Visible) {
        let Span { to, visible } = self.spans[number + 1];
        let to = self.at[to as usize][row as usize % ROWS];
        (to, visible.visible())
    }

    /// Sees to it that the crossings come in the order of a row. Returns how often two have changed
    /// places.
    fn order(&mut self, row: usize) -> usize {
        let places = &self.at[..self.crossings.len()];
        self.here.clear();
        self.here.extend(places.iter().map(|places| places[row]));
        let mut changes = 0;
        for i in 1..self.here.len() {
            let place = self.here[i];
            if self.here[i - 1] <= place {
                continue;
            }
            let (crossing, at) = (self.crossings[i], self.at[i]);
            let mut to = i;
            while to > 0 && self.here[to - 1] > place {
                self.here[to] = self.here[to - 1];
                self.crossings[to] = self.crossings[to - 1];
                self.at[to] = self.at[to - 1];
                // Between the two, one was crossed before, and now the other.
                self.visible[to] = Packed::OPEN;
                to -= 1;
                changes += 1;
            }
            self.here[to] = place;
            self.crossings[to] = crossing;
            self.at[to] = at;
        }
        self.has_spans &= changes == 0;
        changes
    }

    /// What rows show where the crossings are in this order, as far as it is known.
    #[inline(always)]
    fn merge_spans<S: Simd>(&mut self, simd: S) {
        // What comes next is not to be foreseen: every step does the same, and counts or does not
        // count.
        let nothing = Span {
            to: self.crossings.len() as u32,
            visible: Packed::OPEN,
        };
        self.spans.clear();
        self.spans.resize(self.visible.len() + 1, nothing);
        self.open.clear();
        self.open.resize(self.visible.len() + 1, 0);
        let (mut spans, mut open) = (0, 0);
        let mut last = nothing;
        for (gap, &visible) in self.visible.iter().enumerate() {
            let is_open = visible == Packed::OPEN;
            self.open[open] = gap;
            open += usize::from(is_open);
            let is_new = !is_open & (visible != last.visible);
            spans += usize::from(is_new);
            last = Span {
                to: if is_open { last.to } else { gap as u32 },
                visible: if is_open { last.visible } else { visible },
            };
            self.spans[spans] = last;
        }
        self.spans.truncate(spans + 1);
        self.open.truncate(open);
        self.has_spans = true;
        let mut wanting = mask32x8::splat(simd, false);
        for &gap in &self.open {
            let from = match gap.checked_sub(1) {
                Some(before) => &self.at[before],
                None => &[0; ROWS],
            };
            let to = &self.at[gap];
            let (from, to) = (u32x8::from_slice(simd, from), u32x8::from_slice(simd, to));
            wanting |= from.simd_lt(to);
        }
        self.wanting = wanting.to_bitmask();
    }

    /// Finds out what is visible in the gaps that have columns in this row, where it is not known.
    /// All regions end with the row: then the coverage is empty again.
    fn look(
        &mut self,
        row: usize,
        edges: &EdgeTable<'_>,
        mut look: impl FnMut(&Coverage) -> Visible,
    ) {
        let mut from = 0;
        for gap in 0..self.visible.len() {
            let to = self.at[gap][row];
            if self.visible[gap] == Packed::OPEN && from < to {
                self.visible[gap] = Packed::new(look(&self.coverage));
            }
            from = to;
            if let Some(crossing) = self.crossings.get(gap) {
                self.coverage
                    .cross(edges, crossing.edge(), crossing.cover());
            }
        }
    }

    /// How the edges cross the rows from `first` on.
    #[inline(always)]
    fn cross<S: Simd>(&mut self, simd: S, edges: &EdgeTable<'_>, first: u32, grid: Grid) {
        self.changed.clear();
        for word in 0..self.crossing.len() {
            let reaching = edges.reaching(simd, word, first);
            let mut asked = reaching | self.crossing[word];
            while asked != 0 {
                let bit = asked.trailing_zeros() as usize;
                asked &= asked - 1;
                let edge = 64 * word + bit;
                let crosses = match reaching >> bit & 1 {
                    1 => self.cross_by(simd, edge, edges, first, grid),
                    _ => Crosses::No,
                };
                if self.crosses[edge] != crosses {
                    self.crosses[edge] = crosses;
                    self.changed.push(edge);
                    let is_crossing = u64::from(crosses != Crosses::No);
                    self.crossing[word] = self.crossing[word] & !(1 << bit) | is_crossing << bit;
                }
            }
        }
        if !self.changed.is_empty() {
            self.change();
        }
        let places = self.crossings.iter();
        let places = places.map(|crossing| self.places[crossing.0 as usize]);
        self.at.clear();
        self.at.extend(places);
        self.at.push([self.size; ROWS]);
        // A gap that nobody has looked into, empty so far, may have columns now.
        self.has_spans &= self.open.is_empty();
    }

    /// How an edge crosses them.
    #[inline(always)]
    fn cross_by<S: Simd>(
        &mut self,
        simd: S,
        edge: usize,
        edges: &EdgeTable<'_>,
        first: u32,
        grid: Grid,
    ) -> Crosses {
        let shape = &edges.shapes[edge];
        let mut spans = shape.cross(simd, first, grid);
        if !spans.is_certain {
            shape.narrow(&mut spans, first, grid);
        }
        if spans.filled == 0 {
            return Crosses::No;
        }
        spans.put_empty_beside();
        let ([a, d], [b, c]) = (spans.possible, spans.certain);
        self.places[4 * edge..4 * edge + 4].copy_from_slice(&[a, b, c, d]);
        if spans.is_certain {
            Crosses::Certainly
        } else {
            Crosses::Possibly
        }
    }

    /// Takes out the crossings of edges that have changed, and brings in their new ones.
    fn change(&mut self) {
        self.has_spans = false;
        self.arrivals.clear();
        for edge in self.changed.drain(..) {
            self.is_changed[edge] = true;
            for crossing in Crossing::of(edge, self.crosses[edge]) {
                let place = self.places[crossing.0 as usize][0];
                self.arrivals.push((place, crossing));
            }
        }
        self.arrivals.sort_unstable();
        let Changed { crossings, visible } = &mut self.spare;
        crossings.clear();
        visible.clear();
        let mut arrivals = self.arrivals.iter().peekable();
        // `gone` counts the removed edges that hold the present place, `come` the added ones. Where
        // both are 0, no edge was added or removed, and the cached visibility holds.
        let (mut gone, mut come) = (0, 0);
        let mut before = self.visible[0];
        for i in 0..self.visible.len() {
            let crossing = self.crossings.get(i);
            if let Some(crossing) = crossing.filter(|crossing| self.is_changed[crossing.edge()]) {
                gone += crossing.step();
                if before == Packed::OPEN && gone == 0 {
                    before = self.visible[i + 1];
                }
                continue;
            }
            let place = crossing.map_or(u32::MAX, |crossing| self.places[crossing.0 as usize][0]);
            while let Some((_, arrival)) = arrivals.next_if(|(arrives, _)| *arrives < place) {
                visible.push(before.if_closed(come));
                crossings.push(*arrival);
                come += arrival.step();
            }
            visible.push(before.if_closed(come));
            if let Some(&crossing) = crossing {
                crossings.push(crossing);
                before = self.visible[i + 1].if_closed(gone);
            }
        }
        std::mem::swap(&mut self.crossings, crossings);
        std::mem::swap(&mut self.visible, visible);
        self.is_changed.fill(false);
    }

    /// Finds the rows in which the crossings are not in order.
    #[inline(always)]
    fn find_disorder<S: Simd>(&mut self, simd: S) {
        let mut disordered = mask32x8::splat(simd, false);
        let mut before = u32x8::splat(simd, 0);
        for place in &self.at {
            let place = u32x8::from_slice(simd, place);
            disordered |= before.simd_gt(place);
            before = place;
        }
        self.disordered = disordered.to_bitmask();
    }
}
