//! Pixels on one side of a straight line.

use bumpalo::Bump;
use bumpalo::collections::Vec as Growing;
use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f64x4};

use crate::number::rounding::{INFLATION, U};
use crate::number::{Bounded, FourBounded, Real, Ring};
use crate::tracer::half_space::HalfSpace;
use crate::tracer::scanline::edges::enclosure::{ColumnEnclosure, Cut, NOWHERE};
use crate::tracer::scanline::edges::pixel_plane::{PixelPlane, screen_origin};
use crate::tracer::scanline::grid::Grid;
use crate::tracer::tetrahedron::{Tetrahedron, Wall};
use crate::tracer::vector::Vector;
use crate::tracer::view_space::{PIXEL, number_at};

/// The pixels where constant + `per_x` X + `per_y` Y ≥ 0, or > 0.
#[derive(Clone, Copy)]
pub(crate) struct HalfPlane {
    constant: Bounded,
    per_x: Bounded,
    per_y: Bounded,
    /// Whether pixels with a sum of 0 belong to it.
    closed: bool,
    border: Border,
}

/// The border of a half-plane, as rows cross it.
#[derive(Clone, Copy)]
enum Border {
    /// A row crosses it at a root.
    Sloping(Root),
    /// The border is level, or f64 does not tell that it is not.
    Horizontal {
        /// A bound on the error of constant + per_y · Y as a stand-in for the whole sum.
        error: f64,
    },
}

/// Where the border crosses a row, in columns: at + per_y · Y.
#[derive(Clone, Copy)]
pub(super) struct Root {
    pub(super) at: f64,
    pub(super) per_y: f64,
    /// A bound on the error in columns.
    pub(super) slack: f64,
    /// Whether the half-plane lies to the right of the root, and not to the left.
    pub(super) rightward: bool,
}

impl Root {
    /// Intersects enclosures of as many rows as there are lanes with the half-plane.
    #[inline(always)]
    pub(super) fn cut<S: Simd>(&self, y: S::f64s, enclosure: &mut ColumnEnclosure<S::f64s>) {
        let ColumnEnclosure { possible, certain } = enclosure;
        let root_column = y * self.per_y + self.at;
        // No processor can predict on which side a half-plane lies: each bounds both ends, one of
        // them at infinity. The root is finite, as `HalfPlane` made sure when it called the border
        // sloping, so that no sum with infinity is a NaN.
        const BEYOND: [[f64; 2]; 2] = [[f64::INFINITY, 0.0], [0.0, f64::INFINITY]];
        let [left, right] = BEYOND[usize::from(self.rightward)];
        possible[0] = possible[0].max(root_column - (self.slack + left));
        certain[0] = certain[0].max(root_column + (self.slack - left));
        possible[1] = possible[1].min(root_column + (self.slack + right));
        certain[1] = certain[1].min(root_column - (self.slack - right));
    }
}

impl HalfPlane {
    /// A half-plane of which every pixel is in doubt.
    pub(crate) const IN_DOUBT: HalfPlane = HalfPlane {
        constant: Bounded::UNKNOWN,
        per_x: Bounded::UNKNOWN,
        per_y: Bounded::UNKNOWN,
        closed: false,
        border: Border::Horizontal {
            error: f64::INFINITY,
        },
    };

    pub(crate) fn new(
        constant: Bounded,
        per_x: Bounded,
        per_y: Bounded,
        closed: bool,
        grid: Grid,
    ) -> Self {
        dispatch!(Level::baseline(), simd => {
            let height = [constant, per_x, per_y].map(|term| FourBounded::splat(simd, term));
            let [half_plane, ..] = HalfPlane::four(simd, height, grid);
            HalfPlane { closed, ..half_plane }
        })
    }

    /// Four closed half-planes.
    #[inline(always)]
    fn four<S: Simd>(
        simd: S,
        [constant, per_x, per_y]: Height<FourBounded<S>>,
        grid: Grid,
    ) -> [HalfPlane; 4] {
        let max = grid.max;
        // The part of the sum's error that comes from the coefficients.
        let carried = constant.error() + (per_x.error() + per_y.error()) * max;
        let magnitude = constant.value().abs() + per_y.value().abs() * max;
        let magnitude_of_x = per_x.value().abs() * max;
        // In columns the root is N/2 − (constant + per_y · Y)/(3 · per_x), and moves by the same
        // part of the sum's error. The inverse of 3 · per_x rounds by 2u, the root's two numbers by
        // 2u more, the product with Y and the sum with it by u each: less than 8u of the terms'
        // magnitudes, and of N/2 and the root, which is below 3N where it matters.
        let inverse = f64x4::splat(simd, 1.0) / (per_x.value() * PIXEL);
        let at = -(constant.value() * inverse) + grid.half;
        let root_per_y = -(per_y.value() * inverse);
        let slack = ((carried + magnitude * (8.0 * U)) * inverse.abs()
            + 16.0 * U * 3.0 * f64::from(grid.size))
            * INFLATION;
        let is_finite = at.abs().simd_lt(f64::INFINITY)
            & root_per_y.abs().simd_lt(f64::INFINITY)
            & slack.simd_lt(f64::INFINITY);
        // The sum rounds by less than 2u of its terms twice.
        let error = (carried + magnitude * (4.0 * U)) * INFLATION;
        let is_sloping = (is_finite & !magnitude_of_x.simd_le(error)).to_bitmask();
        let is_rightward = inverse.simd_gt(0.0).to_bitmask();
        let level_error = (error + magnitude_of_x) * INFLATION;
        let terms = [constant.to_array(), per_x.to_array(), per_y.to_array()];
        let mut half_planes = [HalfPlane::IN_DOUBT; 4];
        for (i, half_plane) in half_planes.iter_mut().enumerate() {
            let root = Root {
                at: at.as_slice()[i],
                per_y: root_per_y.as_slice()[i],
                slack: slack.as_slice()[i],
                rightward: is_rightward >> i & 1 == 1,
            };
            let border = if is_sloping >> i & 1 == 1 {
                Border::Sloping(root)
            } else {
                Border::Horizontal {
                    error: level_error.as_slice()[i],
                }
            };
            *half_plane = HalfPlane {
                constant: terms[0][i],
                per_x: terms[1][i],
                per_y: terms[2][i],
                closed: true,
                border,
            };
        }
        half_planes
    }

    /// The pixels whose points on the plane, or on the screen, lie in a half-space.
    pub(crate) fn of(
        half_space: &HalfSpace<Bounded>,
        plane: Option<&PixelPlane>,
        grid: Grid,
    ) -> HalfPlane {
        let closed = half_space.closed;
        if is_border(half_space, plane) {
            let zero = Bounded::exact(0.0);
            return HalfPlane::new(zero, zero, zero, closed, grid);
        }
        let changes = plane.map(|plane| [plane.per_x, plane.per_y]);
        let origin = origin(plane, grid) - half_space.at;
        let [constant, per_x, per_y] = height(half_space.normal, origin, changes);
        HalfPlane::new(constant, per_x, per_y, closed, grid)
    }

    /// The same for the half-spaces with these walls, four at once: for lines of one direction
    /// and the tetrahedron.
    pub(crate) fn all_of<'f>(
        (tetrahedron, direction): (&Tetrahedron<Bounded>, Vector<Bounded>),
        walls: impl Iterator<Item = Wall>,
        plane: Option<&PixelPlane>,
        (grid, level): (Grid, Level),
        arena: &'f Bump,
    ) -> &'f [HalfPlane] {
        let mut all = Growing::new_in(arena);
        let may_be_exact = tetrahedron.may_be_exact();
        let half_space = |wall: Wall| tetrahedron.half_space(wall, direction);
        let mut add = |four: &[Wall; 4], count: usize| {
            let is_special = |wall: &Wall| {
                matches!(wall, Wall::Face { .. }) && is_border(&half_space(*wall), plane)
            };
            if may_be_exact || four.iter().any(is_special) {
                let each = four[..count].iter().map(|wall| half_space(*wall));
                all.extend(each.map(|half_space| HalfPlane::of(&half_space, plane, grid)));
            } else {
                let lines = (tetrahedron, direction);
                let four =
                    dispatch!(level, simd => HalfPlane::four_of(simd, lines, four, plane, grid));
                all.extend_from_slice_copy(&four[..count]);
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

    /// The same for four walls that do not hold the plane, of a tetrahedron without numbers that
    /// may be exact.
    #[inline(always)]
    fn four_of<S: Simd>(
        simd: S,
        (tetrahedron, direction): (&Tetrahedron<Bounded>, Vector<Bounded>),
        walls: &[Wall; 4],
        plane: Option<&PixelPlane>,
        grid: Grid,
    ) -> [HalfPlane; 4] {
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
        let mut half_planes = HalfPlane::four(simd, height(n, origin, changes), grid);
        for (half_plane, wall) in half_planes.iter_mut().zip(walls) {
            half_plane.closed = wall.is_closed();
        }
        half_planes
    }

    /// Whether the pixel at X, Y is in the half-plane; `None` where that is in doubt.
    fn decide(&self, x: f64, y: f64) -> Option<bool> {
        let sum = self.constant + self.per_y * Bounded::exact(y) + self.per_x * Bounded::exact(x);
        let sign = sum.sign().ok()?;
        Some(sign.is_gt() || (self.closed && sign.is_eq()))
    }

    /// The same, with the sum computed only near the border.
    pub(crate) fn decide_near(&self, x: f64, y: f64, grid: Grid) -> Option<bool> {
        let Some(root) = self.root() else {
            return self.decide(x, y);
        };
        let beyond = number_at(x, grid.half) - (y * root.per_y + root.at);
        if beyond.abs() > root.slack * INFLATION + U * (beyond.abs() + f64::from(grid.size)) {
            Some((beyond > 0.0) == root.rightward)
        } else {
            self.decide(x, y)
        }
    }

    /// The border's root, if the border is not level.
    #[inline]
    pub(super) fn root(&self) -> Option<&Root> {
        match &self.border {
            Border::Sloping(root) => Some(root),
            Border::Horizontal { .. } => None,
        }
    }

    /// Intersects enclosures of the row at Y with the half-plane.
    #[cfg(test)]
    #[inline(always)]
    pub(super) fn cut_row<S: Simd>(&self, simd: S, y: f64, enclosure: &mut ColumnEnclosure<f64>) {
        let all = |ends: [f64; 2]| ends.map(|end| S::f64s::splat(simd, end));
        let mut lanes = ColumnEnclosure {
            possible: all(enclosure.possible),
            certain: all(enclosure.certain),
        };
        self.cut(simd, S::f64s::splat(simd, y), &mut lanes);
        let first = |ends: [S::f64s; 2]| ends.map(|end| end.as_slice()[0]);
        enclosure.possible = first(lanes.possible);
        enclosure.certain = first(lanes.certain);
    }
}

impl Cut for HalfPlane {
    #[inline(always)]
    fn cut<S: Simd>(&self, simd: S, y: S::f64s, enclosure: &mut ColumnEnclosure<S::f64s>) {
        match &self.border {
            Border::Sloping(root) => root.cut::<S>(y, enclosure),
            Border::Horizontal { error } => {
                let ColumnEnclosure { possible, certain } = enclosure;
                let sum = y * self.per_y.value() + self.constant.value();
                let is_in = sum.simd_gt(*error);
                if !is_in.all_true() {
                    let mut is_in = is_in.to_bitmask();
                    let mut is_out = sum.simd_lt(-*error).to_bitmask();
                    if self.per_x.is_zero() {
                        for (lane, &y) in y.as_slice().iter().enumerate() {
                            match self.decide(0.0, y) {
                                Some(true) => is_in |= 1 << lane,
                                Some(false) => is_out |= 1 << lane,
                                None => {}
                            }
                        }
                    }
                    let none = S::f64s::splat(simd, NOWHERE);
                    let is_in = S::mask64s::from_bitmask(simd, is_in);
                    let is_out = S::mask64s::from_bitmask(simd, is_out);
                    possible[1] = is_out.select(none, possible[1]);
                    certain[1] = is_in.select(certain[1], none);
                }
            }
        }
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
