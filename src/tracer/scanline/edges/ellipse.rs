//! Pixels within an ellipse, and how rows cross it.

use fearless_simd::prelude::*;
#[cfg(test)]
use fearless_simd::{Level, dispatch};
use fearless_simd::{Simd, f32x8};

use crate::number::rounding::{INFLATION_F32, U_F32};
use crate::tracer::scanline::edges::enclosure::{ColumnEnclosure, NOWHERE};
use crate::tracer::scanline::fetch::fetch;
use crate::tracer::scanline::grid::Grid;
use crate::tracer::view_space::{PIXEL, number_at};

/// The pixels where (X − `middle`)² + m² ≤ `squared_radius`, with a middle and an m that are linear
/// functions of Y: an ellipse, with a horizontal chord in every row.
#[derive(Clone, Copy)]
pub(crate) struct Ellipse {
    /// Its chords, as rows cross it.
    pub(super) chords: Chords,
    /// The middle of the chord at Y = 0, and how it moves with Y.
    pub(super) middle: (f64, f64),
    /// m of each row.
    pub(crate) m: RowOffset,
    /// The square of half the longest chord.
    pub(crate) squared_radius: f64,
    /// The largest |m| of a row that the ellipse may reach.
    pub(super) max_m: f64,
    /// A bound on the error of m.
    pub(crate) m_error: f64,
    /// A bound on the error of the square of half a chord.
    pub(crate) chord_error: f64,
    /// A bound on the error of an end of a chord, in columns, without the part of `chord_error`.
    pub(super) slack: f64,
    /// Whether all of these are finite; otherwise every column is in doubt.
    pub(super) is_bounded: bool,
}

/// m as a function of Y: `slope` · (Y − `zero`).
#[derive(Clone, Copy)]
pub(crate) struct RowOffset {
    pub(super) slope: f64,
    pub(super) zero: f64,
}

impl RowOffset {
    /// m of the row at Y.
    pub(crate) fn at(self, y: f64) -> f64 {
        self.slope * (y - self.zero)
    }

    /// m of as many rows as there are lanes.
    #[inline(always)]
    pub(crate) fn of_rows<S: Simd>(self, y: S::f64s) -> S::f64s {
        (y - self.zero) * self.slope
    }
}

impl Ellipse {
    /// The same with its chords.
    #[inline(always)]
    pub(super) fn with_chords(mut self, grid: Grid) -> Ellipse {
        if self.is_bounded {
            self.chords = Chords::of(&self, grid);
        }
        self
    }

    /// Asks for the memory that crossing it takes.
    #[inline(always)]
    pub(crate) fn fetch(&self) {
        self.chords.fetch();
    }

    /// Its chords, as rows cross it.
    pub(crate) fn chords(&self) -> &Chords {
        &self.chords
    }

    /// The enclosure of the row at Y, closer than that of its chords: their formula in f64, in X.
    pub(super) fn enclose_row(&self, y: f64, grid: Grid) -> ColumnEnclosure<f64> {
        let none = f64::from(NOWHERE);
        if !self.is_bounded {
            return ColumnEnclosure {
                possible: [0.0, f64::from(grid.size)],
                certain: [0.0, none],
            };
        }
        let m = self.m.at(y);
        let squared = -(m * m) + self.squared_radius;
        let (upper, lower) = (squared + self.chord_error, squared - self.chord_error);
        let is_met = m.abs() <= self.max_m && upper >= 0.0;
        let middle = y * self.middle.1 + self.middle.0;
        let ends = |half: f64| [middle - half, middle + half].map(|x| number_at(x, grid.half));
        let slack = self.slack;
        // m is no NaN here. Where it is infinite, the row misses the ellipse.
        let [from, to] = ends(upper.max(0.0).sqrt());
        let possible = [from - slack, if is_met { to + slack } else { none }];
        let [from, to] = ends(lower.max(0.0).sqrt());
        let is_certain = is_met && lower > 0.0;
        let certain = [from + slack, if is_certain { to - slack } else { none }];
        ColumnEnclosure { possible, certain }
    }

    /// The half-open range of the rows that the ellipse may reach.
    pub(crate) fn rows(&self, grid: Grid) -> (u32, u32) {
        let reach = (self.max_m / self.m.slope).abs();
        let (low, high) = (self.m.zero - reach, self.m.zero + reach);
        if low.is_finite() && high.is_finite() {
            grid.between(low, high)
        } else {
            (0, grid.size)
        }
    }
}

/// The chords of an ellipse, as rows cross it: in f32, with bounds that cover that, in columns.
///
/// The middle of a chord is `middle` + `middle_per_y` · Y, and the square of its half is
/// `squared_radius` − k², with k = `slope` · (Y − `zero`), where the zero is a sum.
#[derive(Clone, Copy)]
pub(crate) struct Chords {
    middle: f32,
    middle_per_y: f32,
    zero: [f32; 2],
    slope: f32,
    squared_radius: f32,
    /// The largest |k| of a row that the ellipse may reach.
    max_k: f32,
    /// A bound on the error of the square of half a chord.
    chord_error: f32,
    /// A bound on the error of an end of a chord, without the part of `chord_error`.
    slack: f32,
}

impl Chords {
    /// Those of an ellipse of which every column is in doubt.
    pub(super) const IN_DOUBT: Chords = Chords {
        middle: 0.0,
        middle_per_y: 0.0,
        zero: [0.0; 2],
        slope: 0.0,
        squared_radius: 0.0,
        max_k: f32::INFINITY,
        chord_error: 0.0,
        slack: f32::INFINITY,
    };

    /// Those of a bounded ellipse, to which f64 is no more than its bounds off.
    #[inline(always)]
    fn of(ellipse: &Ellipse, grid: Grid) -> Chords {
        const V: f64 = U_F32;
        const COLUMNS: f64 = 1.0 / PIXEL;
        // More than what is rounded off numbers near 0 can change k by.
        const TINY: f64 = 1.0 / (1_u128 << 90) as f64;
        let (middle, middle_per_y) = ellipse.middle;
        let (middle, middle_per_y) = (middle * COLUMNS + grid.half, middle_per_y * COLUMNS);
        let RowOffset { slope, zero } = ellipse.m;
        let slope = slope * COLUMNS;
        let squared_radius = ellipse.squared_radius * (COLUMNS * COLUMNS);
        let [max_k, k_error] = [ellipse.max_m, ellipse.m_error].map(|length| length * COLUMNS);
        // The zero is the sum of its f32 and of what that rounds off, which is v of it and rounds
        // by v again. So Y − zero rounds by v of itself, by v² of the zero, and by v of what is
        // left; the slope and the product with it round by v.
        let near_zero = slope.abs() * zero.abs() * (4.0 * V * V) + TINY;
        let max_k = max_k * (1.0 + 8.0 * V) + near_zero;
        let rounded = 5.0 * V * max_k + near_zero;
        // As for f64: |(k + ε)² − k²| ≤ 2|k|ε + ε². `chord_error` has the part without `rounded`,
        // for the |k| that f64 allows. That of a row that passes is more by less than 3 of
        // `rounded`: 1.6 in `max_k`, and what f32 is off by; there `m_error` grows by a few v² at
        // most. The square, R² and their difference round by v of k² or R²; then the sum with this
        // bound does, and the bound itself.
        let chord_error = ellipse.chord_error * (COLUMNS * COLUMNS)
            + (2.0 * max_k + 6.0 * k_error + rounded) * rounded
            + 3.0 * V * (max_k * max_k + squared_radius.abs());
        let chord_error = chord_error * INFLATION_F32 + f64::from(f32::MIN_POSITIVE);
        // |k| is at most R, and so half a chord, but for its error: √(R² + E) ≤ R + 1 + E. Its root
        // rounds, the middle and what it is the sum of, and two sums with it.
        let half = max_k + 1.0 + chord_error;
        let largest = middle.abs() + middle_per_y.abs() * grid.max;
        let slack = (ellipse.slack + 5.0 * V * (largest + half)) * INFLATION_F32;
        // Then f32 holds all numbers and their squares.
        let is_small = |x: f64| x.abs() < 2.0_f64.powi(50);
        if ![slack, max_k, zero, slope].into_iter().all(is_small) {
            return Chords::IN_DOUBT;
        }
        let near = zero as f32;
        Chords {
            middle: middle as f32,
            middle_per_y: middle_per_y as f32,
            zero: [near, (zero - f64::from(near)) as f32],
            slope: slope as f32,
            squared_radius: squared_radius as f32,
            max_k: max_k as f32,
            chord_error: chord_error as f32,
            slack: slack as f32,
        }
    }

    /// Asks for their memory.
    #[inline(always)]
    fn fetch(&self) {
        fetch(&self.middle);
        fetch(&self.slack);
    }

    /// The enclosures of a band's rows, with these Y.
    #[inline(always)]
    pub(crate) fn enclose<S: Simd>(&self, simd: S, y: f32x8<S>) -> ColumnEnclosure<f32x8<S>> {
        let (zero, none) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, NOWHERE));
        let k = (y - self.zero[0] - self.zero[1]) * self.slope;
        let squared = -(k * k) + self.squared_radius;
        let (upper, lower) = (squared + self.chord_error, squared - self.chord_error);
        let is_met = k.abs().simd_le(self.max_k) & upper.simd_ge(zero);
        let is_certain = is_met & lower.simd_gt(zero);
        let middle = y * self.middle_per_y + self.middle;
        let half = upper.max(zero).sqrt() + self.slack;
        let possible = [middle - half, is_met.select(middle + half, none)];
        let half = lower.max(zero).sqrt() - self.slack;
        let certain = [middle - half, is_certain.select(middle + half, none)];
        ColumnEnclosure { possible, certain }
    }

    /// The enclosure of the row at Y alone.
    #[cfg(test)]
    pub(super) fn enclose_row(&self, y: f64) -> ColumnEnclosure<f64> {
        dispatch!(Level::baseline(), simd => {
            let y = f32x8::splat(simd, y as f32);
            let ColumnEnclosure { possible, certain } = self.enclose(simd, y);
            let first = |ends: [f32x8<_>; 2]| ends.map(|end| f64::from(end.as_slice()[0]));
            ColumnEnclosure {
                possible: first(possible),
                certain: first(certain),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::{Bounded, Real as _};
    use crate::random::Random;
    use crate::tracer::scanline::edges::ellipses::SphereOutlines;
    use crate::tracer::vector::Vector;

    #[test]
    fn rows_cross_outlines_where_whole_numbers_do() {
        // Coordinates in units of 1/1024.
        const ONE: i128 = 1024;
        let mut random = Random::new();
        let mut below = |most: i128| random.below(most as usize) as i128;
        let sizes = [1, 2, 3, 7, 8, 24, 501, 8191, 8192, 16383, 16384];
        let (mut certain, mut doubtful) = (0, 0);
        for _ in 0..20_000 {
            let size = sizes[below(sizes.len() as i128) as usize];
            let grid = Grid::new(size as u32);
            let coordinate = |number: i128| 3 * (2 * number - size) * (ONE / 2);
            let (column, row) = (below(size), below(size));
            let mut number = || {
                let most = 1 << below(31);
                below(2 * most + 1) - most
            };
            // The outline passes through the pixel, or close to it.
            let (x, y) = (coordinate(column) + number(), coordinate(row) + number());
            let z = 3 * size * (ONE / 2) + number();
            let squares = |column: i128, row: i128| {
                let q = coordinate(column) - x;
                let m = 10 * (coordinate(row) - y) - 3 * (3 * size * (ONE / 2) - z);
                109 * q * q + m * m
            };
            let radius = (squares(column, row) as f64 / 109.0).sqrt() as i128 + below(4);
            if radius == 0 {
                continue;
            }
            let [x, y, z, length] =
                [x, y, z, radius].map(|number| Bounded::exact(number as f64 / ONE as f64));
            let outline = SphereOutlines::new(grid).of(Vector::new(x, y, z), length);
            for row in (row - 1).max(0)..(row + 2).min(size) {
                let y = grid.coordinate(row as u32);
                let crossed = outline.chords().enclose_row(y);
                let near = (column - 2).max(0)..(column + 3).min(size);
                for column in near.chain([0, size - 1]) {
                    let is_in = squares(column, row) <= 109 * radius * radius;
                    for enclosure in [&crossed, &outline.enclose_row(y, grid)] {
                        let holds = enclosure.holds(column as f64);
                        assert!(
                            holds.is_none_or(|holds| holds == is_in),
                            "{x:?} {y} {z:?} {length:?}, N = {size}, ({column}, {row})"
                        );
                    }
                    match crossed.holds(column as f64) {
                        Some(_) => certain += 1,
                        None => doubtful += 1,
                    }
                }
            }
        }
        assert!(
            doubtful > 1000 && 4 * doubtful < certain,
            "{doubtful}, {certain}"
        );
    }
}
