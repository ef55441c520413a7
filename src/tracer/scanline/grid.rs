//! Columns and rows of pixels, and their places on the screen.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

/// Rows are crossed so many at a time.
pub(in crate::tracer) const ROWS: usize = 8;

/// A half-open range of columns: where it begins, and where it ends.
pub(crate) type Columns = (u32, u32);

/// Columns and rows of pixels, and their places.
#[derive(Clone, Copy)]
pub(crate) struct Grid {
    pub(crate) size: u32,
    /// N/2.
    pub(crate) half: f64,
    /// 3N/2, the largest |X| and |Y|.
    pub(crate) reach: f64,
}

impl Grid {
    pub(crate) fn new(size: u32) -> Grid {
        let half = f64::from(size) / 2.0;
        Grid {
            size,
            half,
            reach: 3.0 * half,
        }
    }

    /// X or Y of a column or row: a whole or half number below 2¹⁶, exactly.
    #[inline]
    pub(crate) fn place(&self, number: u32) -> f64 {
        3.0 * (f64::from(number) - self.half)
    }

    /// The first column at or after each place, given in columns: a whole number.
    #[inline(always)]
    pub(crate) fn ceil_all<S: Simd>(&self, places: S::f64s) -> S::f64s {
        places.ceil().max(0.0).min(f64::from(self.size))
    }

    /// The number of columns up to each place, given in columns.
    #[inline(always)]
    pub(crate) fn count_all<S: Simd>(&self, places: S::f64s) -> S::f64s {
        (places.floor() + 1.0).max(0.0).min(f64::from(self.size))
    }

    /// The first column at or after a place given in columns.
    pub(crate) fn ceil(&self, place: f64) -> u32 {
        // Less than 0 converts to 0.
        let place = place.min(f64::from(self.size));
        let below = place as u32;
        if f64::from(below) < place {
            below + 1
        } else {
            below
        }
    }

    /// The number of columns up to a place given in columns.
    pub(crate) fn count(&self, place: f64) -> u32 {
        if place < 0.0 {
            return 0;
        }
        (place as u32).saturating_add(1).min(self.size)
    }
}

/// Y of neighbouring rows and X of neighbouring columns, from the first.
const PLACES: [f64; ROWS] = {
    let mut places = [0.0; ROWS];
    let mut number = 0;
    while number < ROWS {
        places[number] = 3.0 * number as f64;
        number += 1;
    }
    places
};

/// As many of them as there are lanes, from one on.
#[inline(always)]
pub(crate) fn places<S: Simd>(simd: S, first: usize) -> S::f64s {
    S::f64s::from_slice(simd, &PLACES[first..first + S::f64s::LEN])
}

/// Places on the screen, in columns.
#[inline(always)]
pub(crate) fn in_columns<S: Simd>(grid: Grid, x: S::f64s) -> S::f64s {
    x * (1.0 / 3.0) + grid.half
}

/// Whole numbers of columns, below 2³².
#[inline(always)]
pub(crate) fn store_columns<S: Simd>(places: S::f64s, columns: &mut [u32]) {
    // With 2⁵² added, a whole number's bits are its own and the exponent's, which lies in the upper
    // half.
    let shifted = places + f64::from_bits((1023 + 52) << 52);
    for (column, place) in columns.iter_mut().zip(shifted.as_slice()) {
        *column = place.to_bits() as u32;
    }
}
