//! From the left end of a row to the right: which borders are crossed where, and on which side of each a column is.
//!
//! Rows are crossed [`ROWS`] at a time, and only by the borders that reach them. From one row to the next the crossings move
//! little, so they are kept in order rather than put in order.

use std::ops::Range;

use fearless_simd::{Level, Simd, dispatch};

use super::shape::{Screen, Shape};
use super::span::ROWS;

/// What a border is of.
#[derive(Clone, Copy)]
pub(super) enum Border {
    /// A solid, by its place among those seen directly, or in the mirror.
    Direct(usize),
    Mirrored(usize),
    Surface,
    ShadowOnSurface,
    /// Part of a solid: it is asked for where that is seen.
    Detail,
}

/// Every border of a frame. Each is known by its number.
#[derive(Default)]
pub(super) struct Borders {
    shapes: Vec<Shape>,
    /// The rows that each can cross.
    rows: Vec<(u32, u32)>,
    of: Vec<Border>,
}

impl Borders {
    pub(super) fn add(&mut self, shape: Shape, of: Border) -> usize {
        self.rows.push(shape.rows());
        self.shapes.push(shape);
        self.of.push(of);
        self.of.len() - 1
    }

    /// Details of a solid that is seen in these rows only. Returns their numbers.
    pub(super) fn add_details(
        &mut self,
        shapes: impl Iterator<Item = Shape>,
        rows: (u32, u32),
    ) -> Range<usize> {
        let first = self.of.len();
        for shape in shapes {
            self.add(shape.within(rows), Border::Detail);
        }
        first..self.of.len()
    }
}

/// How a border crosses rows: where its columns begin possibly and certainly, and where they end certainly and possibly.
struct Crossed {
    border: usize,
    places: [[u32; ROWS]; 4],
}

/// In what order a border's crossings of a row come, and what it is beyond each.
const KINDS: [Option<bool>; 4] = [None, Some(true), None, Some(false)];

/// Solids met in a column, in their order, and of how many it is not known.
#[derive(Default)]
pub(super) struct Met {
    pub(super) solids: Vec<usize>,
    unknown: usize,
}

impl Met {
    /// The solids, if they are known.
    pub(super) fn known(&self) -> Option<&[usize]> {
        (self.unknown == 0).then_some(&self.solids)
    }

    fn change(&mut self, solid: usize, before: Option<bool>, after: Option<bool>) {
        self.unknown += usize::from(after.is_none());
        self.unknown -= usize::from(before.is_none());
        let place = self.solids.partition_point(|&other| other < solid);
        if after == Some(true) {
            self.solids.insert(place, solid);
        } else if before == Some(true) {
            self.solids.remove(place);
        }
    }
}

/// What is known of a column.
#[derive(Default)]
pub(super) struct Column {
    pub(super) direct: Met,
    pub(super) mirrored: Met,
    surface: bool,
    surface_unknown: bool,
    shadows: usize,
    shadows_unknown: usize,
    /// Whether it belongs to each border's columns.
    held: Vec<Option<bool>>,
}

impl Column {
    /// Whether it meets the surface.
    pub(super) fn surface(&self) -> Option<bool> {
        (!self.surface_unknown).then_some(self.surface)
    }

    /// Whether the surface is in shadow there.
    pub(super) fn surface_in_shadow(&self) -> Option<bool> {
        match (self.shadows, self.shadows_unknown) {
            (0, 0) => Some(false),
            (0, _) => None,
            _ => Some(true),
        }
    }

    /// Whether it belongs to a border's columns.
    pub(super) fn holds(&self, border: usize) -> Option<bool> {
        self.held[border]
    }

    fn change(&mut self, border: usize, of: Border, after: Option<bool>) {
        let before = std::mem::replace(&mut self.held[border], after);
        match of {
            Border::Direct(solid) => self.direct.change(solid, before, after),
            Border::Mirrored(solid) => self.mirrored.change(solid, before, after),
            Border::Surface => {
                self.surface = after == Some(true);
                self.surface_unknown = after.is_none();
            }
            Border::ShadowOnSurface => {
                self.shadows += usize::from(after == Some(true));
                self.shadows -= usize::from(before == Some(true));
                self.shadows_unknown += usize::from(after.is_none());
                self.shadows_unknown -= usize::from(before.is_none());
            }
            Border::Detail => {}
        }
    }
}

/// The crossings of a row, and the column at which the sweep is.
#[derive(Default)]
pub(super) struct Sweep {
    pub(super) column: Column,
    /// The first of the rows that are crossed.
    first: Option<u32>,
    crossed: Vec<Crossed>,
    /// The crossings of a row, from the left: the column, which of `crossed` it is, and its kind, from the highest bits down.
    crossings: Vec<u64>,
}

impl Sweep {
    /// Prepares for rows of a frame.
    pub(super) fn begin(&mut self, borders: &Borders) {
        self.first = None;
        self.column.held.clear();
        self.column.held.resize(borders.of.len(), Some(false));
    }

    /// Goes to the left end of a row.
    pub(super) fn enter(&mut self, row: u32, borders: &Borders, level: Level, screen: Screen) {
        let first = row - row % ROWS as u32;
        if self.first != Some(first) {
            self.first = Some(first);
            dispatch!(level, simd => cross(simd, borders, first, screen, &mut self.crossed));
            self.crossings.clear();
            for (number, crossed) in self.crossed.iter().enumerate() {
                let [possible, certain, certain_end, possible_end] = &crossed.places;
                let is_certain = possible == certain && certain_end == possible_end;
                let kinds: &[u64] = if is_certain { &[1, 3] } else { &[0, 1, 2, 3] };
                let number = (number as u64) << 2;
                self.crossings
                    .extend(kinds.iter().map(|kind| number | kind));
            }
        }
        let row = (row - first) as usize;
        for crossing in &mut self.crossings {
            let at = *crossing & u64::from(u32::MAX);
            let place = self.crossed[(at >> 2) as usize].places[(at & 3) as usize][row];
            *crossing = u64::from(place) << 32 | at;
        }
        for i in 1..self.crossings.len() {
            let crossing = self.crossings[i];
            let mut to = i;
            while to > 0 && self.crossings[to - 1] > crossing {
                self.crossings[to] = self.crossings[to - 1];
                to -= 1;
            }
            self.crossings[to] = crossing;
        }
    }

    /// How many crossings the row has.
    pub(super) fn len(&self) -> usize {
        self.crossings.len()
    }

    /// The column of a crossing.
    pub(super) fn place(&self, crossing: usize) -> u32 {
        (self.crossings[crossing] >> 32) as u32
    }

    /// Goes over a crossing.
    pub(super) fn pass(&mut self, crossing: usize, borders: &Borders) {
        let at = self.crossings[crossing] as u32;
        let border = self.crossed[(at >> 2) as usize].border;
        let after = KINDS[(at & 3) as usize];
        self.column.change(border, borders.of[border], after);
    }
}

/// How the borders cross the rows from `first` on.
#[inline(always)]
fn cross<S: Simd>(
    simd: S,
    borders: &Borders,
    first: u32,
    screen: Screen,
    crossed: &mut Vec<Crossed>,
) {
    crossed.clear();
    for (border, &(from, to)) in borders.rows.iter().enumerate() {
        if from < first + ROWS as u32 && to > first {
            let spans = borders.shapes[border].cross(simd, first, screen);
            if !spans.is_none() {
                let ([a, d], [b, c]) = (spans.possible, spans.certain);
                crossed.push(Crossed {
                    border,
                    places: [a, b, c, d],
                });
            }
        }
    }
}
