//! Parts of neighbouring rows of pixels, as far as they are known.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::tracer::scanline::grid::{ROWS, put_columns};

/// One bit for each of them.
const ALL: u64 = (1 << ROWS) - 1;

/// In each of some rows, a run of columns of which some are certain and, at both ends, some only
/// possible: `possible` holds `certain`. Every run goes from its first column to before its last;
/// one without columns begins and ends in the same place.
pub(crate) struct Spans {
    pub(crate) possible: [[u32; ROWS]; 2],
    pub(crate) certain: [[u32; ROWS]; 2],
    /// Bit by bit, the rows that have columns.
    pub(crate) filled: u64,
    /// Whether all columns are certain.
    pub(crate) is_certain: bool,
}

impl Spans {
    pub(crate) const NONE: Spans = Spans {
        possible: [[0; ROWS]; 2],
        certain: [[0; ROWS]; 2],
        filled: 0,
        is_certain: true,
    };

    /// The columns of as many rows as there are lanes, from one on: whole numbers, of rows that
    /// have any at all.
    #[inline(always)]
    pub(crate) fn put<S: Simd>(
        &mut self,
        simd: S,
        first: usize,
        is_crossed: S::mask64s,
        possible: [S::f64s; 2],
        certain: [S::f64s; 2],
    ) {
        let [from, to] = possible;
        let is_filled = is_crossed & from.simd_lt(to);
        let from = is_filled.select(from, S::f64s::splat(simd, 0.0));
        let to = is_filled.select(to, from);
        put_columns::<S>(from, &mut self.possible[0][first..]);
        put_columns::<S>(to, &mut self.possible[1][first..]);
        let [begin, end] = certain;
        let is_known = is_filled & begin.simd_lt(end);
        let begin = is_known.select(begin, from);
        let end = is_known.select(end, from);
        put_columns::<S>(begin, &mut self.certain[0][first..]);
        put_columns::<S>(end, &mut self.certain[1][first..]);
        self.filled |= is_filled.to_bitmask() << first;
        self.is_certain &= (from.simd_eq(begin) & to.simd_eq(end)).all_true();
    }

    /// Puts a run without columns where that of the nearest row begins that has some, below or else
    /// above: there it is in order among the other crossings of its row, mostly.
    pub(crate) fn put_empty_beside(&mut self) {
        let mut empty = !self.filled & ALL;
        if empty == ALL {
            return;
        }
        while empty != 0 {
            let row = empty.trailing_zeros();
            let (below, above) = (self.filled & ((1 << row) - 1), self.filled >> row);
            let next = if below == 0 {
                row + above.trailing_zeros()
            } else {
                below.ilog2()
            };
            let place = self.possible[0][next as usize];
            for ends in [&mut self.possible, &mut self.certain] {
                (ends[0][row as usize], ends[1][row as usize]) = (place, place);
            }
            empty &= empty - 1;
        }
    }
}
