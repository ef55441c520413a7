//! The columns of a region in a band of rows, as far as they are known.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, mask32x8};

use crate::tracer::scanline::grid::ROWS;

/// A bit for each row of a band.
const ALL: u64 = (1 << ROWS) - 1;

/// The columns of a region in each row of a band: where they begin, and where they end. `certain`
/// lies within `possible`.
#[cfg_attr(test, derive(Clone))]
pub(crate) struct BandColumns {
    /// The columns outside of which the region has none.
    pub(crate) possible: [[u32; ROWS]; 2],
    /// Columns that the region has.
    pub(crate) certain: [[u32; ROWS]; 2],
    /// A bit for each row: whether it has possible columns.
    pub(crate) filled: u64,
    /// Whether all possible columns are certain.
    pub(crate) is_certain: bool,
}

impl Default for BandColumns {
    fn default() -> Self {
        BandColumns::NONE
    }
}

impl BandColumns {
    pub(crate) const NONE: BandColumns = BandColumns {
        possible: [[0; ROWS]; 2],
        certain: [[0; ROWS]; 2],
        filled: 0,
        is_certain: true,
    };

    /// Stores the columns of all rows. Those that are not `is_crossed` have none.
    #[inline(always)]
    pub(crate) fn store<S: Simd>(
        &mut self,
        simd: S,
        is_crossed: mask32x8<S>,
        possible: [f32x8<S>; 2],
        certain: [f32x8<S>; 2],
    ) {
        let [from, to] = possible;
        let is_filled = is_crossed & from.simd_lt(to);
        let from = is_filled.select(from, f32x8::splat(simd, 0.0));
        let to = is_filled.select(to, from);
        self.possible = [whole(from), whole(to)];
        let [begin, end] = certain;
        let is_some = is_filled & begin.simd_lt(end);
        let begin = is_some.select(begin, from);
        let end = is_some.select(end, from);
        self.certain = [whole(begin), whole(end)];
        self.filled = is_filled.to_bitmask();
        self.is_certain = (from.simd_eq(begin) & to.simd_eq(end)).all_true();
    }

    /// Lets each row without columns begin and end where the nearest row with columns begins, below
    /// or else above: there the row's edges are mostly in order among the other edges.
    pub(crate) fn place_empty_rows(&mut self) {
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
            let column = self.possible[0][next as usize];
            for ends in [&mut self.possible, &mut self.certain] {
                (ends[0][row as usize], ends[1][row as usize]) = (column, column);
            }
            empty &= empty - 1;
        }
    }
}

/// Whole numbers of columns.
#[inline(always)]
fn whole<S: Simd>(numbers: f32x8<S>) -> [u32; ROWS] {
    // With 2²³ added, a whole number's bits stand behind the exponent's.
    const SHIFT: f32 = (1 << 23) as f32;
    let shifted = numbers + SHIFT;
    let mut columns = [0; ROWS];
    for (column, number) in columns.iter_mut().zip(shifted.as_slice()) {
        *column = number.to_bits() ^ SHIFT.to_bits();
    }
    columns
}
