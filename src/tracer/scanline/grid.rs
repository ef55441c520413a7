//! Columns and rows of pixels, and their coordinates X and Y on the screen.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

use crate::image::MAX_SIZE;
use crate::tracer::view_space::{self, PIXEL, number_at};

/// Rows are crossed so many at a time.
pub(in crate::tracer) const ROWS: usize = 8;

/// A half-open range of columns: where it begins, and where it ends.
pub(crate) type Columns = (u32, u32);

/// The pixels of a picture: N columns and N rows.
#[derive(Clone, Copy)]
pub(crate) struct Grid {
    /// N.
    pub(crate) size: u32,
    /// N/2.
    pub(crate) half: f64,
    /// 3N/2, the largest |X| and |Y|.
    pub(crate) max: f64,
}

impl Grid {
    pub(crate) fn new(size: u32) -> Grid {
        let half = f64::from(size) / 2.0;
        Grid {
            size,
            half,
            max: PIXEL * half,
        }
    }

    /// X of a column, or Y of a row.
    #[inline]
    pub(crate) fn coordinate(&self, number: u32) -> f64 {
        view_space::coordinate(number, self.half)
    }

    /// Y of the rows of the band from `first` on.
    #[inline(always)]
    pub(crate) fn band<S: Simd>(&self, simd: S, first: u32) -> f32x8<S> {
        let mut offsets = [0.0; ROWS];
        for (offset, number) in offsets.iter_mut().zip(OFFSETS) {
            *offset = number as f32;
        }
        f32x8::from_slice(simd, &offsets) + self.coordinate(first) as f32
    }

    /// The first column at or after each position, given in columns: a whole number.
    #[inline(always)]
    pub(crate) fn ceil_all<S: Simd>(&self, positions: f32x8<S>) -> f32x8<S> {
        self.clamp_all(positions.ceil())
    }

    /// The number of columns at or before each position, given in columns.
    #[inline(always)]
    pub(crate) fn count_all<S: Simd>(&self, positions: f32x8<S>) -> f32x8<S> {
        self.clamp_all(positions.floor() + 1.0)
    }

    /// The nearest column, or N.
    #[inline(always)]
    fn clamp_all<S: Simd>(&self, columns: f32x8<S>) -> f32x8<S> {
        columns.max(0.0).min(self.size as f32)
    }

    /// The first column at or after a position given in columns.
    pub(crate) fn ceil(&self, position: f64) -> u32 {
        // Less than 0 converts to 0.
        let position = position.min(f64::from(self.size));
        let below = position as u32;
        if f64::from(below) < position {
            below + 1
        } else {
            below
        }
    }

    /// The columns or rows whose X or Y may lie between two bounds.
    pub(crate) fn between(&self, low: f64, high: f64) -> Columns {
        // One more on either side is far more than rounding takes.
        let [low, high] = [low, high].map(|coordinate| number_at(coordinate, self.half));
        (self.ceil(low - 1.0), self.count(high + 1.0))
    }

    /// The number of columns at or before a position given in columns.
    pub(crate) fn count(&self, position: f64) -> u32 {
        if position < 0.0 {
            return 0;
        }
        (position as u32).saturating_add(1).min(self.size)
    }
}

/// The coordinates of neighbouring rows or columns, relative to the first.
const OFFSETS: [f64; ROWS] = {
    let mut offsets = [0.0; ROWS];
    let mut number = 0;
    while number < ROWS {
        offsets[number] = PIXEL * number as f64;
        number += 1;
    }
    offsets
};

/// As many offsets as there are lanes, from that of number `first` on.
#[inline(always)]
pub(crate) fn offsets<S: Simd>(simd: S, first: usize) -> S::f64s {
    S::f64s::from_slice(simd, &OFFSETS[first..first + S::f64s::LEN])
}

// f32 holds all coordinates: they are multiples of one half below 2²³.
const _: () = assert!(6 * MAX_SIZE < 1 << 24);
