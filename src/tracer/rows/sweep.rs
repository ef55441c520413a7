//! From the left end of a row to the right: which borders are crossed where, and on which side of each a column is.
//!
//! Rows are crossed [`ROWS`] at a time, and only by the borders that reach them. From one row to the next the crossings move
//! little, so they are kept in order rather than put in order.

use std::ops::Range;

use bumpalo::Bump;
use bumpalo::collections::Vec as Growing;
use fearless_simd::{Level, Simd, dispatch};

use super::shape::{Screen, Shape};
use super::span::ROWS;

/// What a border is of.
#[derive(Clone, Copy)]
pub(super) enum Border {
    Surface,
    ShadowOnSurface,
    /// Part of a solid: it is asked for where that is seen.
    Detail,
    /// A solid, by its place among those seen directly, or in the mirror.
    Direct(usize),
    Mirrored(usize),
}

/// All borders of a frame, as they are found. Each is known by its number.
pub(super) struct Borders<'f> {
    shapes: Growing<'f, Shape<'f>>,
    rows: Growing<'f, (u32, u32)>,
    of: Growing<'f, Border>,
}

/// The borders of a frame.
pub(super) struct AllBorders<'f> {
    shapes: &'f [Shape<'f>],
    /// The rows that each can cross.
    rows: &'f [(u32, u32)],
    of: &'f [Border],
}

impl<'f> Borders<'f> {
    pub(super) fn new(arena: &'f Bump) -> Self {
        Borders {
            shapes: Growing::new_in(arena),
            rows: Growing::new_in(arena),
            of: Growing::new_in(arena),
        }
    }

    pub(super) fn add(&mut self, shape: Shape<'f>, of: Border) -> usize {
        self.rows.push(shape.rows());
        self.shapes.push(shape);
        self.of.push(of);
        self.of.len() - 1
    }

    /// Details of a solid that is seen in these rows only. Returns their numbers.
    pub(super) fn add_details(
        &mut self,
        shapes: impl IntoIterator<Item = Shape<'f>>,
        rows: (u32, u32),
    ) -> Range<usize> {
        let first = self.of.len();
        for shape in shapes {
            self.add(shape.within(rows), Border::Detail);
        }
        first..self.of.len()
    }

    pub(super) fn all(self) -> AllBorders<'f> {
        AllBorders {
            shapes: self.shapes.into_bump_slice(),
            rows: self.rows.into_bump_slice(),
            of: self.of.into_bump_slice(),
        }
    }
}

/// Whether a column is one of a border's.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Held {
    No,
    Unknown,
    Yes,
}

/// In what order a border's crossings of a row come, and what is beyond each.
const KINDS: [Held; 4] = [Held::Unknown, Held::Yes, Held::Unknown, Held::No];

/// How many borders hold a column, and of how many it is not known.
#[derive(Default)]
struct Count([usize; 3]);

impl Count {
    fn change(&mut self, before: Held, after: Held) {
        // Those that hold it not are counted from the first change on, which matters to nobody.
        self.0[before as usize] = self.0[before as usize].wrapping_sub(1);
        self.0[after as usize] = self.0[after as usize].wrapping_add(1);
    }

    /// Whether any does.
    fn any(&self) -> Option<bool> {
        let [_, unknown, yes] = self.0;
        (yes > 0 || unknown == 0).then_some(yes > 0)
    }
}

/// Solids met in a column, in their order.
#[derive(Default)]
pub(super) struct Met {
    solids: Vec<usize>,
    count: Count,
}

impl Met {
    /// The solids, if they are known.
    pub(super) fn known(&self) -> Option<&[usize]> {
        (self.count.0[Held::Unknown as usize] == 0).then_some(&self.solids)
    }

    fn change(&mut self, solid: usize, before: Held, after: Held) {
        self.count.change(before, after);
        let place = self.solids.partition_point(|&other| other < solid);
        if after == Held::Yes {
            self.solids.insert(place, solid);
        } else if before == Held::Yes {
            self.solids.remove(place);
        }
    }
}

/// What is known of a column.
#[derive(Default)]
pub(super) struct Column {
    pub(super) direct: Met,
    pub(super) mirrored: Met,
    surface: Count,
    shadows: Count,
    /// Whether it is one of each border's.
    held: Vec<Held>,
}

impl Column {
    /// Whether it meets the surface.
    pub(super) fn surface(&self) -> Option<bool> {
        self.surface.any()
    }

    /// Whether the surface is in shadow there.
    pub(super) fn surface_in_shadow(&self) -> Option<bool> {
        self.shadows.any()
    }

    /// Whether it is one of a border's.
    pub(super) fn holds(&self, border: usize) -> Option<bool> {
        match self.held[border] {
            Held::No => Some(false),
            Held::Unknown => None,
            Held::Yes => Some(true),
        }
    }

    fn change(&mut self, border: usize, of: Border, after: Held) {
        let before = std::mem::replace(&mut self.held[border], after);
        match of {
            Border::Surface => self.surface.change(before, after),
            Border::ShadowOnSurface => self.shadows.change(before, after),
            Border::Detail => {}
            Border::Direct(solid) => self.direct.change(solid, before, after),
            Border::Mirrored(solid) => self.mirrored.change(solid, before, after),
        }
    }
}

/// The crossings of a row, and the column at which the sweep is.
#[derive(Default)]
pub(super) struct Sweep {
    pub(super) column: Column,
    /// The first of the rows that are crossed.
    first: Option<u32>,
    /// The borders that cross them, and whether it is certain where in all of them.
    crossed: Vec<(usize, bool)>,
    /// The same of the rows that were crossed before.
    crossed_before: Vec<(usize, bool)>,
    /// Four times for each of these: where its columns begin possibly and certainly, and where they end certainly and possibly.
    places: Vec<[u32; ROWS]>,
    /// The crossings of a row, from the left: the column in the upper half, and in the lower which of `places` it is.
    crossings: Vec<u64>,
    /// Whether there are columns before each crossing, and after the last.
    gaps: Vec<bool>,
}

impl Sweep {
    /// Prepares for rows of a frame.
    pub(super) fn begin(&mut self, borders: &AllBorders<'_>) {
        self.first = None;
        self.crossed.clear();
        self.crossings.clear();
        self.gaps.clear();
        self.gaps.push(false);
        self.column.held.clear();
        self.column.held.resize(borders.of.len(), Held::No);
    }

    /// Goes to the left end of a row. Returns whether other borders are crossed than in the row that was entered last, or in another
    /// order, or with columns between others of them.
    pub(super) fn enter(
        &mut self,
        row: u32,
        borders: &AllBorders<'_>,
        level: Level,
        screen: Screen,
    ) -> bool {
        let first = row - row % ROWS as u32;
        let mut is_new = self.first.is_none();
        if self.first != Some(first) {
            self.first = Some(first);
            std::mem::swap(&mut self.crossed, &mut self.crossed_before);
            self.crossed.clear();
            self.places.clear();
            dispatch!(level, simd => self.cross(simd, borders, first, screen));
            // The same borders mostly cross in the same order as in the rows before.
            if self.crossed != self.crossed_before {
                is_new = true;
                self.crossings.clear();
                for (number, &(_, is_certain)) in self.crossed.iter().enumerate() {
                    let kinds: &[u64] = if is_certain { &[1, 3] } else { &[0, 1, 2, 3] };
                    let number = 4 * number as u64;
                    self.crossings
                        .extend(kinds.iter().map(|kind| number + kind));
                }
                self.gaps.clear();
                self.gaps.resize(self.crossings.len() + 1, false);
            }
        }
        let row = (row - first) as usize;
        for i in 0..self.crossings.len() {
            let at = self.crossings[i] & u64::from(u32::MAX);
            let place = self.places[at as usize][row];
            let crossing = u64::from(place) << 32 | at;
            let mut to = i;
            while to > 0 && self.crossings[to - 1] > crossing {
                self.crossings[to] = self.crossings[to - 1];
                to -= 1;
                is_new = true;
            }
            self.crossings[to] = crossing;
        }
        let mut from = 0;
        for (i, gap) in self.gaps.iter_mut().enumerate() {
            let to = match self.crossings.get(i) {
                Some(crossing) => (crossing >> 32) as u32,
                None => screen.size,
            };
            is_new |= *gap != (from < to);
            *gap = from < to;
            from = to;
        }
        is_new
    }

    /// Whether there are columns before a crossing, or after the last.
    pub(super) fn has_columns_before(&self, crossing: usize) -> bool {
        self.gaps[crossing]
    }

    /// How many crossings the row has.
    pub(super) fn len(&self) -> usize {
        self.crossings.len()
    }

    /// The column of a crossing; none after the last.
    pub(super) fn place(&self, crossing: usize) -> Option<u32> {
        let crossing = self.crossings.get(crossing)?;
        Some((crossing >> 32) as u32)
    }

    /// Goes over a crossing.
    pub(super) fn pass(&mut self, crossing: usize, borders: &AllBorders<'_>) {
        let at = self.crossings[crossing] as u32;
        let (border, _) = self.crossed[(at >> 2) as usize];
        let after = KINDS[(at & 3) as usize];
        self.column.change(border, borders.of[border], after);
    }

    /// How the borders cross the rows from `first` on.
    #[inline(always)]
    fn cross<S: Simd>(&mut self, simd: S, borders: &AllBorders<'_>, first: u32, screen: Screen) {
        for (border, &(from, to)) in borders.rows.iter().enumerate() {
            if from < first + ROWS as u32 && to > first {
                let spans = borders.shapes[border].cross(simd, first, screen);
                if !spans.is_none() {
                    let ([a, d], [b, c]) = (spans.possible, spans.certain);
                    self.crossed.push((border, a == b && c == d));
                    self.places.extend([a, b, c, d]);
                }
            }
        }
    }
}
