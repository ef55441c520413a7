//! From the left end of a row to the right: which borders are crossed where, and what is seen
//! between.
//!
//! Rows are crossed [`ROWS`] at a time, and only by the borders that reach them. From one row to
//! the next the crossings move little, so they are kept in order rather than put in order.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, mask32x8, u32x8};

use crate::tracer::scanline::edges::table::EdgeTable;
use crate::tracer::scanline::grid::{Grid, ROWS};
use crate::tracer::scanline::visibility::coverage::Coverage;
use crate::tracer::scanline::visibility::visible::{Packed, Visible};

/// Where so many crossings change places in a row, it is put in order without asking whether it is.
const MANY: usize = 8;

/// Whether a border crosses some rows, and how often.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Crosses {
    No,
    /// Twice: where its columns begin and end is certain in all of these rows.
    Certainly,
    /// Four times: where they begin possibly and certainly, and where they end certainly and
    /// possibly.
    Possibly,
}

/// A crossing: which of the four of which border.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Crossing(u32);

impl Crossing {
    /// Those of a border, from the left.
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

    /// Whether its border certainly holds the columns after it.
    fn is_held(self) -> bool {
        self.0 % 4 == 1
    }

    /// Whether it is unknown if it does.
    fn is_unknown(self) -> bool {
        self.0.is_multiple_of(2)
    }

    /// 1 where columns begin, −1 where they end.
    fn step(self) -> i32 {
        if self.0 % 4 < 2 { 1 } else { -1 }
    }
}

/// A part of a row: up to which crossing, and what is seen there.
#[derive(Clone, Copy)]
struct Piece {
    to: Crossing,
    seen: Packed,
}

/// The crossings of a row from the left, and what is seen between them.
///
/// That depends on which borders have been crossed, and not on where. So it is kept from row to
/// row, and where two crossings change places it is forgotten only between these two.
#[derive(Default)]
pub(crate) struct ActiveEdges {
    coverage: Coverage,
    /// The first of the rows that are crossed.
    first: Option<u32>,
    /// How each border crosses them.
    crosses: Vec<Crosses>,
    /// Bit by bit, 64 in a word, those that do.
    crossing: Vec<u64>,
    /// Where, row by row, for each of its four crossings.
    places: Vec<[u32; ROWS]>,
    /// In the order of the row that was entered last.
    crossings: Vec<Crossing>,
    /// What is seen before each of them, and after the last.
    seen: Vec<Packed>,
    /// The columns of these in that row.
    here: Vec<u32>,
    /// Bit by bit, the rows in which they come in another order, and those that have columns of
    /// which it is not known what is seen.
    disordered: u64,
    wanting: u64,
    /// What the row that was entered last shows, if `is_planned`; neighbours that show the same
    /// are one. The first is none.
    pieces: Vec<Piece>,
    is_planned: bool,
    /// The places in `seen` where nobody has looked.
    open: Vec<usize>,
    end: Crossing,
    /// Borders whose crossings are not, or no longer, those in `crossings`.
    changed: Vec<usize>,
    is_changed: Vec<bool>,
    /// Their new crossings, by their places in the first of the rows.
    arrivals: Vec<(u32, Crossing)>,
    /// Where `crossings` and `seen` are made anew.
    spare: Changed,
}

#[derive(Default)]
struct Changed {
    crossings: Vec<Crossing>,
    seen: Vec<Packed>,
}

impl ActiveEdges {
    /// Prepares for rows of a frame.
    pub(crate) fn begin(&mut self, edges: &EdgeTable<'_>, grid: Grid) {
        let count = edges.of.len();
        self.first = None;
        self.crosses.clear();
        self.crosses.resize(count, Crosses::No);
        self.crossing.clear();
        self.crossing.resize(edges.kinds.len(), 0);
        self.places.resize(4 * count + 4, [0; ROWS]);
        // The end of every row is a crossing of no border.
        self.end = Crossing(4 * count as u32);
        self.places[4 * count] = [grid.size; ROWS];
        self.is_changed.clear();
        self.is_changed.resize(count, false);
        self.coverage.clear(edges);
        self.crossings.clear();
        self.forget();
    }

    /// Forgets what is seen.
    pub(crate) fn forget(&mut self) {
        self.seen.clear();
        self.seen.resize(self.crossings.len() + 1, Packed::OPEN);
        self.is_planned = false;
    }

    /// Goes to a row. `look` is asked what is seen in a column where that is not known.
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
        if !self.is_planned || self.wanting >> row & 1 == 1 {
            self.look(row, edges, look);
            dispatch!(level, simd => self.plan(simd));
        }
    }

    /// How many parts the row has.
    pub(crate) fn len(&self) -> usize {
        self.pieces.len() - 1
    }

    /// Where a part of a row ends, and what is seen there.
    pub(crate) fn part(&self, number: usize, row: u32) -> (u32, Visible) {
        let Piece { to, seen } = self.pieces[number + 1];
        (self.places[to.0 as usize][row as usize % ROWS], seen.seen())
    }

    /// The crossing after as many others, or the row's end.
    fn crossing(&self, number: usize) -> Crossing {
        self.crossings.get(number).copied().unwrap_or(self.end)
    }

    /// Sees to it that the crossings come in the order of a row. Returns how often two have changed
    /// places.
    fn order(&mut self, row: usize) -> usize {
        let place = |crossing: &Crossing| self.places[crossing.0 as usize][row];
        self.here.clear();
        self.here.extend(self.crossings.iter().map(place));
        let mut changes = 0;
        for i in 1..self.here.len() {
            let place = self.here[i];
            if self.here[i - 1] <= place {
                continue;
            }
            let crossing = self.crossings[i];
            let mut to = i;
            while to > 0 && self.here[to - 1] > place {
                self.here[to] = self.here[to - 1];
                self.crossings[to] = self.crossings[to - 1];
                // Between the two, one was crossed before, and now the other.
                self.seen[to] = Packed::OPEN;
                to -= 1;
                changes += 1;
            }
            self.here[to] = place;
            self.crossings[to] = crossing;
        }
        self.is_planned &= changes == 0;
        changes
    }

    /// What rows show where the crossings are in this order, as far as it is known.
    #[inline(always)]
    fn plan<S: Simd>(&mut self, simd: S) {
        // What comes next is not to be foreseen: every step does the same, and counts or does not
        // count.
        let nothing = Piece {
            to: self.end,
            seen: Packed::OPEN,
        };
        self.pieces.clear();
        self.pieces.resize(self.seen.len() + 1, nothing);
        self.open.clear();
        self.open.resize(self.seen.len() + 1, 0);
        let (mut pieces, mut open) = (0, 0);
        let mut last = nothing;
        for (gap, &seen) in self.seen.iter().enumerate() {
            let is_open = seen == Packed::OPEN;
            self.open[open] = gap;
            open += usize::from(is_open);
            let (to, now) = (self.crossings.get(gap).copied().unwrap_or(self.end), seen);
            let is_new = !is_open & (now != last.seen);
            pieces += usize::from(is_new);
            last = Piece {
                to: if is_open { last.to } else { to },
                seen: if is_open { last.seen } else { now },
            };
            self.pieces[pieces] = last;
        }
        self.pieces.truncate(pieces + 1);
        self.open.truncate(open);
        self.is_planned = true;
        let mut wanting = mask32x8::splat(simd, false);
        for &gap in &self.open {
            let from = match gap.checked_sub(1) {
                Some(before) => &self.places[self.crossings[before].0 as usize],
                None => &[0; ROWS],
            };
            let to = &self.places[self.crossing(gap).0 as usize];
            let (from, to) = (u32x8::from_slice(simd, from), u32x8::from_slice(simd, to));
            wanting |= from.simd_lt(to);
        }
        self.wanting = wanting.to_bitmask();
    }

    /// Finds out what is seen where the row has columns of which that is not known.
    fn look(
        &mut self,
        row: usize,
        edges: &EdgeTable<'_>,
        mut look: impl FnMut(&Coverage) -> Visible,
    ) {
        let mut from = 0;
        for gap in 0..self.seen.len() {
            let to = self.places[self.crossing(gap).0 as usize][row];
            if self.seen[gap] == Packed::OPEN && from < to {
                self.coverage.look(edges);
                self.seen[gap] = Packed::new(look(&self.coverage));
            }
            from = to;
            if let Some(crossing) = self.crossings.get(gap) {
                let (held, unknown) = (crossing.is_held(), crossing.is_unknown());
                self.coverage.cross(crossing.edge(), held, unknown);
            }
        }
    }

    /// How the borders cross the rows from `first` on.
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
        // Columns may have come between other crossings.
        self.is_planned &= self.open.is_empty();
    }

    /// How a border crosses them.
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

    /// Takes out the crossings of borders that have changed, and brings in their new ones.
    fn change(&mut self) {
        self.is_planned = false;
        self.arrivals.clear();
        for edge in self.changed.drain(..) {
            self.is_changed[edge] = true;
            for crossing in Crossing::of(edge, self.crosses[edge]) {
                let place = self.places[crossing.0 as usize][0];
                self.arrivals.push((place, crossing));
            }
        }
        self.arrivals.sort_unstable();
        let Changed { crossings, seen } = &mut self.spare;
        crossings.clear();
        seen.clear();
        let mut arrivals = self.arrivals.iter().peekable();
        // How many columns of crossings that are gone, or that have come, begin before here and
        // have not ended. What was seen where there were none still is where there are
        // none.
        let (mut gone, mut come) = (0, 0);
        let mut before = self.seen[0];
        for i in 0..self.seen.len() {
            let crossing = self.crossings.get(i);
            if let Some(crossing) = crossing.filter(|crossing| self.is_changed[crossing.edge()]) {
                gone += crossing.step();
                if before == Packed::OPEN && gone == 0 {
                    before = self.seen[i + 1];
                }
                continue;
            }
            let place = crossing.map_or(u32::MAX, |crossing| self.places[crossing.0 as usize][0]);
            while let Some((_, arrival)) = arrivals.next_if(|(arrives, _)| *arrives < place) {
                seen.push(before.if_closed(come));
                crossings.push(*arrival);
                come += arrival.step();
            }
            seen.push(before.if_closed(come));
            if let Some(&crossing) = crossing {
                crossings.push(crossing);
                before = self.seen[i + 1].if_closed(gone);
            }
        }
        std::mem::swap(&mut self.crossings, crossings);
        std::mem::swap(&mut self.seen, seen);
        self.is_changed.fill(false);
    }

    /// Finds the rows in which the crossings are not in order.
    #[inline(always)]
    fn find_disorder<S: Simd>(&mut self, simd: S) {
        let mut disordered = mask32x8::splat(simd, false);
        let mut before = u32x8::splat(simd, 0);
        for crossing in &self.crossings {
            let place = u32x8::from_slice(simd, &self.places[crossing.0 as usize]);
            disordered |= before.simd_gt(place);
            before = place;
        }
        self.disordered = disordered.to_bitmask();
    }
}
