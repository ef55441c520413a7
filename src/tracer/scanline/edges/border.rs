//! The border of a half-plane, as rows cross it.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, f64x4};

use crate::number::FourBounded;
use crate::number::rounding::{INFLATION, INFLATION_F32, U, U_F32};
use crate::tracer::scanline::edges::enclosure::{ColumnEnclosure, Cut, NOWHERE};
use crate::tracer::scanline::grid::Grid;
use crate::tracer::view_space::PIXEL;

/// The height of points over the border of a half-space: at X = Y = 0, and its change per X and per
/// Y.
pub(super) type Height<R> = [R; 3];

/// The border of a half-plane, as rows cross it: in f32, with bounds that cover that.
///
/// A row crosses a *sloping* border at its root, at least `low` + `per_y` · Y and at most `high` +
/// `per_y` · Y, in columns. On the side on which the half-plane does not end, the bound is
/// infinite; `doubt` is how far the finite bound can be from one on the root's other side.
///
/// Of a *level* border, and of one of which f64 does not tell that it slopes, `low` + `per_y` · Y
/// stands in for the sum of the half-plane, and `high` bounds the error of that. `doubt` is
/// [`LEVEL`].
#[derive(Clone, Copy)]
pub(crate) struct Border {
    per_y: f32,
    low: f32,
    high: f32,
    doubt: f32,
}

/// No doubt is negative.
const LEVEL: f32 = -1.0;

impl Border {
    /// The border of a half-plane of which every pixel is in doubt.
    pub(super) const IN_DOUBT: Border = Border {
        per_y: 0.0,
        low: 0.0,
        high: f32::INFINITY,
        doubt: LEVEL,
    };

    /// The borders of four half-planes.
    #[inline(always)]
    pub(super) fn four<S: Simd>(
        simd: S,
        [constant, per_x, per_y]: &Height<FourBounded<S>>,
        grid: Grid,
    ) -> [Border; 4] {
        let (max, size) = (grid.max, f64::from(grid.size));
        // The part of the sum's error that comes from the coefficients.
        let carried = constant.error() + (per_x.error() + per_y.error()) * max;
        let magnitude = constant.value().abs() + per_y.value().abs() * max;
        let magnitude_of_x = per_x.value().abs() * max;
        // In columns the root is N/2 − (constant + per_y · Y)/(3 · per_x), and moves by the same
        // part of the sum's error. The inverse of 3 · per_x rounds by 2u, the root's two numbers by
        // 2u more: less than 8u of the terms' magnitudes, and of N/2.
        let inverse = f64x4::splat(simd, 1.0) / (per_x.value() * PIXEL);
        let at = -(constant.value() * inverse) + grid.half;
        let root_per_y = -(per_y.value() * inverse);
        let slack =
            ((carried + magnitude * (8.0 * U)) * inverse.abs() + 16.0 * U * size) * INFLATION;
        // In f32, per_y rounds by v, which moves the root by v of |per_y · Y|, and so does the
        // product with Y; the bound at Y = 0 rounds by v of itself. The sum rounds by v of N
        // between 0 and N. Below 0 and beyond N are no columns, and rounding is monotone: there it
        // stays.
        let slack =
            (slack + (at.abs() + root_per_y.abs() * (2.0 * max) + size) * U_F32) * INFLATION_F32;
        // A bound lies within twice the slack from the root, and this one on its other side after
        // one more rounding.
        let doubt = (slack * 2.0 + size * U_F32) * INFLATION_F32;
        // Then f32 holds all bounds.
        let is_small = slack.simd_lt(2.0_f64.powi(90));
        // The sum rounds by less than 2u of its terms twice.
        let error = (carried + magnitude * (4.0 * U)) * INFLATION;
        let is_sloping = is_small & !magnitude_of_x.simd_le(error);
        let is_rightward = inverse.simd_gt(0.0);
        // In f32 the terms round by v of themselves, the product by v, and the sum by v of its
        // terms; where they are tiny, by less than the smallest normal number.
        let level_error = (error + magnitude_of_x + magnitude * (3.0 * U_F32)) * INFLATION_F32
            + f64::from(f32::MIN_POSITIVE);
        let infinity = f64x4::splat(simd, f64::INFINITY);
        // Where f32 may not hold the sum, every row is in doubt.
        let is_held = magnitude.simd_lt(2.0_f64.powi(120));
        let level_error = is_held.select(level_error, infinity);
        let low = is_rightward.select(at - slack, -infinity);
        let high = is_rightward.select(infinity, at + slack);
        let per_y = is_sloping.select(root_per_y, per_y.value());
        let low = is_sloping.select(low, constant.value());
        let high = is_sloping.select(high, level_error);
        let doubt = is_sloping.select(doubt, f64x4::splat(simd, f64::from(LEVEL)));
        let mut borders = [Border::IN_DOUBT; 4];
        for (i, border) in borders.iter_mut().enumerate() {
            *border = Border {
                per_y: per_y.as_slice()[i] as f32,
                low: low.as_slice()[i] as f32,
                high: high.as_slice()[i] as f32,
                doubt: doubt.as_slice()[i] as f32,
            };
        }
        borders
    }

    /// Whether the border is level, as far as f64 tells.
    fn is_level(&self) -> bool {
        self.doubt < 0.0
    }

    /// Whether the half-plane lies to the right of the root of a sloping border.
    fn is_rightward(&self) -> bool {
        self.low > f32::NEG_INFINITY
    }

    /// The two bounds on the root of a sloping border at Y = 0, and the change per Y, in columns.
    pub(super) fn root(&self) -> Option<Root> {
        let [per_y, low, high, doubt] =
            [self.per_y, self.low, self.high, self.doubt].map(f64::from);
        let rightward = self.is_rightward();
        let ends = if rightward {
            [low, low + doubt]
        } else {
            [high - doubt, high]
        };
        let root = Root {
            ends,
            per_y,
            rightward,
        };
        (!self.is_level()).then_some(root)
    }

    /// Intersects enclosures of the row at Y with it.
    #[cfg(test)]
    #[inline(always)]
    pub(super) fn cut_row<S: Simd>(&self, simd: S, y: f64, enclosure: &mut ColumnEnclosure<f64>) {
        let all = |ends: [f64; 2]| ends.map(|end| f32x8::splat(simd, end as f32));
        let mut lanes = ColumnEnclosure {
            possible: all(enclosure.possible),
            certain: all(enclosure.certain),
        };
        self.cut(simd, f32x8::splat(simd, y as f32), &mut lanes);
        let first = |ends: [f32x8<S>; 2]| ends.map(|end| f64::from(end.as_slice()[0]));
        enclosure.possible = first(lanes.possible);
        enclosure.certain = first(lanes.certain);
    }
}

/// Where the border crosses a row, in columns.
#[derive(Clone, Copy)]
pub(super) struct Root {
    /// Bounds at Y = 0.
    pub(super) ends: [f64; 2],
    pub(super) per_y: f64,
    /// Whether the half-plane lies to the right of the root, and not to the left.
    pub(super) rightward: bool,
}

impl Cut for Border {
    #[inline(always)]
    fn cut<S: Simd>(&self, simd: S, y: f32x8<S>, enclosure: &mut ColumnEnclosure<f32x8<S>>) {
        let ColumnEnclosure { possible, certain } = enclosure;
        let moved = y * self.per_y;
        if self.is_level() {
            let sum = moved + self.low;
            let none = f32x8::splat(simd, NOWHERE);
            possible[1] = sum.simd_lt(-self.high).select(none, possible[1]);
            certain[1] = sum.simd_gt(self.high).select(certain[1], none);
            return;
        }
        // No processor can predict on which side a half-plane lies: each bounds both ends, one of
        // them at infinity.
        let (low, high) = (moved + self.low, moved + self.high);
        possible[0] = possible[0].max(low);
        certain[0] = certain[0].max(low + self.doubt);
        possible[1] = possible[1].min(high);
        certain[1] = certain[1].min(high - self.doubt);
    }
}

#[cfg(test)]
mod tests {
    use bumpalo::Bump;
    use fearless_simd::{Level, dispatch};

    use super::*;
    use crate::number::{Bounded, Real as _};
    use crate::random::Random;
    use crate::tracer::scanline::edges::half_plane::HalfPlane;

    #[test]
    fn rows_near_a_level_border_stay_in_doubt() {
        let mut random = Random::new();
        let (grid, arena) = (Grid::new(500), Bump::new());
        let (mut decided, mut doubtful) = (0, 0);
        for _ in 0..2000 {
            let y = grid.coordinate(random.below(500) as u32);
            let per_y = 2.0 * random.fraction() - 1.0;
            // The row lies about as far from the border as f32 can tell.
            let away = 32.0 * U_F32 * (2.0 * random.fraction() - 1.0);
            let constant = -per_y * y * (1.0 + away);
            let [constant, per_x, per_y] = [constant, 0.0, per_y].map(Bounded::exact);
            let half_plane = HalfPlane::new(constant, per_x, per_y, true, (grid, &arena));
            let mut enclosure = ColumnEnclosure {
                possible: [0.0, 500.0],
                certain: [0.0, 500.0],
            };
            let level = Level::baseline();
            dispatch!(level, simd => half_plane.border().cut_row(simd, y, &mut enclosure));
            let is_in = match (enclosure.certain[1] > 0.0, enclosure.possible[1] > 0.0) {
                (true, _) => Some(true),
                (_, false) => Some(false),
                _ => None,
            };
            match is_in {
                None => doubtful += 1,
                Some(_) => {
                    assert_eq!(half_plane.decide_near(0.0, y, grid), is_in, "Y = {y}");
                    decided += 1;
                }
            }
        }
        assert!(decided > 500 && doubtful > 100, "{decided}, {doubtful}");
    }

    /// What rows know of a half-plane with these terms: the columns outside of which it has none,
    /// and columns that it has.
    fn crossed(terms: [f64; 3], y: f64, grid: Grid) -> ColumnEnclosure<f64> {
        let arena = Bump::new();
        let [constant, per_x, per_y] = terms.map(Bounded::exact);
        let half_plane = HalfPlane::new(constant, per_x, per_y, true, (grid, &arena));
        let all = [0.0, f64::from(grid.size)];
        let mut enclosure = ColumnEnclosure {
            possible: all,
            certain: all,
        };
        dispatch!(Level::baseline(), simd => half_plane.border().cut_row(simd, y, &mut enclosure));
        enclosure
    }

    #[test]
    fn rows_cross_half_planes_where_whole_numbers_do() {
        let mut random = Random::new();
        let mut below = |most: i128| random.below(most as usize) as i128;
        let sizes = [1, 2, 3, 7, 8, 24, 501, 8191, 8192, 16383, 16384];
        let (mut certain, mut doubtful) = (0, 0);
        for _ in 0..40_000 {
            let size = sizes[below(sizes.len() as i128) as usize];
            // Twice a coordinate.
            let twice = |number: i128| 3 * (2 * number - size);
            let mut number = || {
                let most = 1 << below(34);
                below(2 * most + 1) - most
            };
            let (per_x, per_y, beside) = (number(), number(), number());
            let (column, row) = (below(size), below(size));
            // The border passes through the pixel, or close to it.
            let beside = beside / (1 + below(1 << 30));
            let constant = beside - per_x * twice(column) - per_y * twice(row);
            let scale = 2.0_f64.powi(below(200) as i32 - 140);
            let terms = [constant as f64 / 2.0, per_x as f64, per_y as f64];
            let grid = Grid::new(size as u32);
            for row in (row - 1).max(0)..(row + 2).min(size) {
                let y = grid.coordinate(row as u32);
                let ColumnEnclosure {
                    possible,
                    certain: sure,
                } = crossed(terms.map(|term| term * scale), y, grid);
                let near = (column - 2).max(0)..(column + 3).min(size);
                for column in near.chain([0, size - 1]) {
                    let sum = constant + per_x * twice(column) + per_y * twice(row);
                    let holds = |[from, to]: [f64; 2]| (from..=to).contains(&(column as f64));
                    let (is_possible, is_certain) = (holds(possible), holds(sure));
                    assert!(
                        (sum < 0 || is_possible) && (sum >= 0 || !is_certain),
                        "{terms:?} · {scale}, N = {size}, ({column}, {row}): {possible:?} {sure:?}"
                    );
                    certain += u32::from(is_possible == is_certain);
                    doubtful += u32::from(is_possible != is_certain);
                }
            }
        }
        assert!(
            doubtful > 1000 && 4 * doubtful < certain,
            "{doubtful}, {certain}"
        );
    }

    #[test]
    fn sums_beyond_f32_are_in_doubt() {
        let grid = Grid::new(4);
        for scale in [2.0_f64.powi(118), 2.0_f64.powi(127), 2.0_f64.powi(200)] {
            let [constant, per_y] = [scale, -scale / 3.0];
            let enclosure = crossed([constant, 0.0, per_y], 3.0, grid);
            let in_doubt =
                (enclosure.certain[1], enclosure.possible[1]) == (f64::from(NOWHERE), 4.0);
            assert!(in_doubt, "{scale}");
            let enclosure = crossed([constant, 0.0, 0.0], 3.0, grid);
            assert_eq!(
                enclosure.certain[1] == 4.0,
                scale < 2.0_f64.powi(120),
                "{scale}"
            );
        }
    }
}
