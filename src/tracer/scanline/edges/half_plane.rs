//! Pixels on one side of a straight line.

use bumpalo::Bump;
use bumpalo::collections::Vec as Growing;
use bumpalo_herd::Member;
#[cfg(test)]
use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f64x4};

use crate::number::rounding::{INFLATION, INFLATION_F32, U, U_F32};
use crate::number::{Bounded, FourBounded, Real, Ring};
use crate::tracer::half_space::HalfSpace;
use crate::tracer::scanline::edges::enclosure::{ColumnEnclosure, Cut, NOWHERE};
use crate::tracer::scanline::edges::pixel_plane::{PixelPlane, screen_origin};
use crate::tracer::scanline::grid::{Grid, Position};
use crate::tracer::tetrahedron::{Tetrahedron, Wall};
use crate::tracer::vector::Vector;
use crate::tracer::view_space::{PIXEL, number_at};

/// The pixels where constant + `per_x` X + `per_y` Y ≥ 0, or > 0.
#[derive(Clone, Copy)]
pub(crate) struct HalfPlane<'f> {
    border: Border,
    /// Kept apart, since few pixels need them: so the borders of many half-planes are at hand.
    terms: &'f Terms,
}

/// What decides on which side a pixel is.
#[derive(Clone, Copy)]
struct Terms {
    constant: Bounded,
    per_x: Bounded,
    per_y: Bounded,
    /// Whether pixels with a sum of 0 belong to the half-plane.
    closed: bool,
}

/// The border of a half-plane, as rows cross it: in f32, with bounds that cover that.
///
/// A row crosses a *sloping* border at its root, at least `low` + `per_y` · Y and at most `high` +
/// `per_y` · Y, in columns. On the side on which the half-plane does not end, the bound is infinite;
/// `doubt` is how far the finite bound can be from one on the root's other side.
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
    const IN_DOUBT: Border = Border {
        per_y: 0.0,
        low: 0.0,
        high: f32::INFINITY,
        doubt: LEVEL,
    };

    /// The borders of four half-planes.
    #[inline(always)]
    fn four<S: Simd>(
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
        // product with Y; the bound at Y = 0 rounds by v of itself. The sum rounds by v of N between 0
        // and N. Below 0 and beyond N are no columns, and rounding is monotone: there it stays.
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

impl Terms {
    const IN_DOUBT: Terms = Terms {
        constant: Bounded::UNKNOWN,
        per_x: Bounded::UNKNOWN,
        per_y: Bounded::UNKNOWN,
        closed: false,
    };
}

impl<'f> HalfPlane<'f> {
    /// A half-plane of which every pixel is in doubt.
    pub(crate) const IN_DOUBT: HalfPlane<'static> = HalfPlane {
        border: Border::IN_DOUBT,
        terms: &Terms::IN_DOUBT,
    };

    pub(crate) fn new(
        constant: Bounded,
        per_x: Bounded,
        per_y: Bounded,
        closed: bool,
        (grid, arena): (Grid, &'f Bump),
    ) -> Self {
        let [border, ..] = dispatch!(Level::baseline(), simd => {
            let height = [constant, per_x, per_y].map(|term| FourBounded::splat(simd, term));
            Border::four(simd, &height, grid)
        });
        let terms = arena.alloc(Terms {
            constant,
            per_x,
            per_y,
            closed,
        });
        HalfPlane { border, terms }
    }

    /// Copies in other memory.
    pub(crate) fn kept_in<'k>(all: &[HalfPlane<'_>], memory: &Member<'k>) -> &'k [HalfPlane<'k>] {
        let copy = |half_plane: &HalfPlane<'_>| HalfPlane {
            border: half_plane.border,
            terms: memory.alloc(*half_plane.terms),
        };
        memory.alloc_slice_fill_iter(all.iter().map(copy))
    }

    /// How many bytes [`HalfPlane::kept_in`] takes.
    pub(crate) fn kept_size(all: &[HalfPlane<'_>]) -> usize {
        all.len() * (size_of::<HalfPlane<'_>>() + size_of::<Terms>())
    }

    /// The pixels whose points on the plane, or on the screen, lie in a half-space.
    pub(crate) fn of(
        half_space: &HalfSpace<Bounded>,
        plane: Option<&PixelPlane>,
        (grid, arena): (Grid, &'f Bump),
    ) -> HalfPlane<'f> {
        let closed = half_space.closed;
        if is_border(half_space, plane) {
            let zero = Bounded::exact(0.0);
            return HalfPlane::new(zero, zero, zero, closed, (grid, arena));
        }
        let changes = plane.map(|plane| [plane.per_x, plane.per_y]);
        let origin = origin(plane, grid) - half_space.at;
        let [constant, per_x, per_y] = height(half_space.normal, origin, changes);
        HalfPlane::new(constant, per_x, per_y, closed, (grid, arena))
    }

    /// The same for the half-spaces with these walls, four at once: for lines of one direction
    /// and the tetrahedron.
    pub(crate) fn all_of(
        (tetrahedron, direction): (&Tetrahedron<Bounded>, Vector<Bounded>),
        walls: impl Iterator<Item = Wall>,
        plane: Option<&PixelPlane>,
        (grid, level): (Grid, Level),
        arena: &'f Bump,
    ) -> &'f [HalfPlane<'f>] {
        let mut all = Growing::new_in(arena);
        let may_be_exact = tetrahedron.may_be_exact();
        let half_space = |wall: Wall| tetrahedron.half_space(wall, direction);
        let mut add = |four: &[Wall; 4], count: usize| {
            let is_special = |wall: &Wall| {
                matches!(wall, Wall::Face { .. }) && is_border(&half_space(*wall), plane)
            };
            if may_be_exact || four.iter().any(is_special) {
                let each = four[..count].iter().map(|wall| half_space(*wall));
                all.extend(each.map(|half_space| HalfPlane::of(&half_space, plane, (grid, arena))));
            } else {
                let lines = (tetrahedron, direction);
                let walls = (four, count);
                dispatch!(level, simd => {
                    HalfPlane::add_four(simd, lines, walls, plane, (grid, arena), &mut all);
                });
            }
        };
        let mut waiting = None;
        walls.for_each(|wall| {
            let (four, count) = waiting.get_or_insert(([wall; 4], 0));
            four[*count] = wall;
            *count += 1;
            if *count == 4 {
                add(four, 4);
                waiting = None;
            }
        });
        if let Some((four, count)) = waiting {
            add(&four, count);
        }
        all.into_bump_slice()
    }

    /// Adds those of the first `count` of four walls that do not hold the plane, of a tetrahedron
    /// without numbers that may be exact.
    #[inline(always)]
    fn add_four<S: Simd>(
        simd: S,
        (tetrahedron, direction): (&Tetrahedron<Bounded>, Vector<Bounded>),
        (walls, count): (&[Wall; 4], usize),
        plane: Option<&PixelPlane>,
        (grid, arena): (Grid, &'f Bump),
        all: &mut Growing<'f, HalfPlane<'f>>,
    ) {
        let [n, at] = tetrahedron.half_spaces_at_once(simd, walls, direction);
        #[allow(
            clippy::manual_map,
            reason = "a closure is compiled without vector instructions"
        )]
        let changes = match plane {
            Some(plane) => Some([
                Vector::splat(simd, plane.per_x),
                Vector::splat(simd, plane.per_y),
            ]),
            None => None,
        };
        let origin = Vector::splat(simd, origin(plane, grid)) - at;
        let height = height(n, origin, changes);
        let borders = Border::four(simd, &height, grid);
        let [constant, per_x, per_y] = height.map(FourBounded::to_array);
        let terms = arena.alloc_slice_fill_with(count, |i| Terms {
            constant: constant[i],
            per_x: per_x[i],
            per_y: per_y[i],
            closed: walls[i].is_closed(),
        });
        let each = borders.into_iter().zip(&*terms);
        all.extend(each.map(|(border, terms)| HalfPlane { border, terms }));
    }

    /// Whether the pixel at X, Y is in the half-plane; `None` where that is in doubt.
    fn decide(&self, x: f64, y: f64) -> Option<bool> {
        let Terms {
            constant,
            per_x,
            per_y,
            closed,
        } = *self.terms;
        let sum = constant + per_y * Bounded::exact(y) + per_x * Bounded::exact(x);
        let sign = sum.sign().ok()?;
        Some(sign.is_gt() || (closed && sign.is_eq()))
    }

    /// The same, with the sum computed only near the border.
    pub(crate) fn decide_near(&self, x: f64, y: f64, grid: Grid) -> Option<bool> {
        let Some(root) = self.root() else {
            return self.decide(x, y);
        };
        // Bounds that cover roundings to f32 cover those to f64.
        let column = number_at(x, grid.half);
        let [low, high] = root.ends.map(|end| y * root.per_y + end);
        if column < low || high < column {
            Some((high < column) == root.rightward)
        } else {
            self.decide(x, y)
        }
    }

    pub(crate) fn border(&self) -> &Border {
        &self.border
    }

    /// The border's root, if the border is not level.
    pub(super) fn root(&self) -> Option<Root> {
        self.border.root()
    }

    /// Intersects enclosures of the row at Y with the half-plane.
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

impl Cut for Border {
    #[inline(always)]
    fn cut<S: Simd, V>(&self, simd: S, y: V, enclosure: &mut ColumnEnclosure<V>)
    where
        V: SimdFloat<S, Element: Position>,
    {
        let ColumnEnclosure { possible, certain } = enclosure;
        let [per_y, low, high, doubt] =
            [self.per_y, self.low, self.high, self.doubt].map(V::Element::of);
        let moved = y * per_y;
        if self.is_level() {
            let sum = moved + low;
            let none = V::splat(simd, V::Element::of(NOWHERE));
            possible[1] = sum.simd_lt(-high).select(none, possible[1]);
            certain[1] = sum.simd_gt(high).select(certain[1], none);
            return;
        }
        // No processor can predict on which side a half-plane lies: each bounds both ends, one of
        // them at infinity.
        let (low, high) = (moved + low, moved + high);
        possible[0] = possible[0].max(low);
        certain[0] = certain[0].max(low + doubt);
        possible[1] = possible[1].min(high);
        certain[1] = certain[1].min(high - doubt);
    }
}

impl Cut for HalfPlane<'_> {
    #[inline(always)]
    fn cut<S: Simd, V>(&self, simd: S, y: V, enclosure: &mut ColumnEnclosure<V>)
    where
        V: SimdFloat<S, Element: Position>,
    {
        self.border.cut(simd, y, enclosure);
    }
}

/// Whether all points of a plane lie on the border of a half-space.
fn is_border(half_space: &HalfSpace<Bounded>, plane: Option<&PixelPlane>) -> bool {
    let support = plane.and_then(|plane| plane.support);
    support.is_some() && half_space.support == support
}

/// The point of a plane, or of the screen, at X = Y = 0.
fn origin(plane: Option<&PixelPlane>, grid: Grid) -> Vector<Bounded> {
    plane.map_or_else(|| screen_origin(grid), |plane| plane.origin)
}

/// The height of points over the border of a half-space with this normal: at X = Y = 0, and its
/// change per X and per Y.
type Height<R> = [R; 3];

/// `origin` is the point at X = Y = 0, seen from the border. `changes` are those of the points per
/// X and per Y; `None` on the screen.
#[inline(always)]
fn height<R: Ring>(n: Vector<R>, origin: Vector<R>, changes: Option<[Vector<R>; 2]>) -> Height<R> {
    let constant = n.dot(origin);
    match changes {
        Some([per_x, per_y]) => [constant, n.dot(per_x), n.dot(per_y)],
        None => [constant, n.x, n.y],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

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
            dispatch!(level, simd => half_plane.cut_row(simd, y, &mut enclosure));
            let is_in = match (enclosure.certain[1] > 0.0, enclosure.possible[1] > 0.0) {
                (true, _) => Some(true),
                (_, false) => Some(false),
                _ => None,
            };
            match is_in {
                None => doubtful += 1,
                Some(_) => {
                    assert_eq!(half_plane.decide(0.0, y), is_in, "Y = {y}");
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
        dispatch!(Level::baseline(), simd => half_plane.cut_row(simd, y, &mut enclosure));
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
