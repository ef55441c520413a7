//! Where edges cross a row.
//!
//! # Why rows
//!
//! Eye rays are parallel, and so are those to the light. So every edge in the picture that does
//! not lie on a sphere is a straight line or an ellipse on the screen: a silhouette, an edge
//! between faces, the surface's sides, the outline of a mirror image, a shadow on the surface or on
//! a face. Each is known as a polynomial in X and Y, the place on the screen in thirds of
//! a pixel from its centre, and a row of pixels, on which Y is fixed, crosses it at a root.
//!
//! A root is computed in f64 with a bound on its error, derived where it is used. The columns
//! beyond the bound are decided; those within it, rarely one, are asked one by one.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::tracer::scanline::edges::ellipse::Ellipse;
use crate::tracer::scanline::edges::enclosure::RunEnclosure;
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::grid::{Grid, ROWS, places};
use crate::tracer::scanline::span::Spans;

/// A convex part of the picture: what half-planes and an ellipse have in common.
pub(crate) struct Region<'f> {
    half_planes: &'f [HalfPlane],
    ellipse: Option<Ellipse>,
    /// The rows that it can cross.
    rows: (u32, u32),
}

impl<'f> Region<'f> {
    pub(crate) fn new(half_planes: &'f [HalfPlane], ellipse: Option<Ellipse>, grid: Grid) -> Self {
        let rows = ellipse
            .as_ref()
            .map_or((0, grid.size), |ellipse| ellipse.rows(grid));
        Region {
            half_planes,
            ellipse,
            rows,
        }
    }

    /// The same where it is known to cross no other than these rows.
    pub(crate) fn within(mut self, rows: (u32, u32)) -> Self {
        self.rows = (self.rows.0.max(rows.0), self.rows.1.min(rows.1));
        self
    }

    /// The rows that it can cross.
    pub(crate) fn rows(&self) -> (u32, u32) {
        self.rows
    }

    /// Its columns of the rows from `row` on.
    #[inline(always)]
    pub(crate) fn cross<S: Simd>(&self, simd: S, row: u32, grid: Grid) -> Spans {
        let mut spans = Spans::NONE;
        for first in (0..ROWS).step_by(S::f64s::LEN) {
            let y = places::<S>(simd, first) + grid.place(row);
            let mut reaches = match &self.ellipse {
                Some(ellipse) => ellipse.enclose(simd, y, grid),
                None => {
                    let zero = S::f64s::splat(simd, 0.0);
                    let all = [zero, zero + f64::from(grid.size)];
                    RunEnclosure {
                        possible: all,
                        certain: all,
                    }
                }
            };
            for half_plane in self.half_planes {
                half_plane.cut(simd, y, &mut reaches);
            }
            let is_crossed =
                y.simd_ge(grid.place(self.rows.0)) & y.simd_lt(grid.place(self.rows.1));
            let RunEnclosure { possible, certain } = reaches;
            let possible = [
                grid.ceil_all::<S>(possible[0]),
                grid.count_all::<S>(possible[1]),
            ];
            let certain = [
                grid.ceil_all::<S>(certain[0]),
                grid.count_all::<S>(certain[1]),
            ];
            spans.put(simd, first, is_crossed, possible, certain);
        }
        spans
    }

    /// Asks the columns in doubt, from the outside in.
    pub(crate) fn narrow(&self, spans: &mut Spans, row: u32, grid: Grid) {
        spans.is_certain = true;
        for i in 0..ROWS {
            let (mut from, mut to) = (spans.possible[0][i], spans.possible[1][i]);
            let certain = (spans.certain[0][i], spans.certain[1][i]);
            if (from, to) == certain {
                continue;
            }
            let y = grid.place(row + i as u32);
            let is_certain = |column: u32| certain.0 <= column && column < certain.1;
            let holds = |column: u32| match is_certain(column) {
                true => Some(true),
                false => self.decide(grid.place(column), y, grid),
            };
            let (mut first, mut last) = (None, None);
            while from < to && first.is_none() {
                match holds(from) {
                    Some(false) => from += 1,
                    Some(true) => first = Some(from),
                    None => break,
                }
            }
            while from < to && last.is_none() {
                match holds(to - 1) {
                    Some(false) => to -= 1,
                    Some(true) => last = Some(to - 1),
                    None => break,
                }
            }
            // What lies between columns of a convex part of the picture is in it.
            let known = [first, last].into_iter().flatten();
            let known = known.flat_map(|column| [column, column + 1]);
            let certain = [certain.0, certain.1]
                .into_iter()
                .filter(|_| certain.0 < certain.1);
            let ends = known.chain(certain);
            let (begin, end) = ends.fold((u32::MAX, 0), |(begin, end), column| {
                (begin.min(column), end.max(column))
            });
            let certain = if begin < end {
                (begin, end)
            } else {
                (from, from)
            };
            (spans.possible[0][i], spans.possible[1][i]) = (from, to);
            (spans.certain[0][i], spans.certain[1][i]) = certain;
            spans.is_certain &= (from, to) == certain;
            if from == to {
                spans.filled &= !(1 << i);
            }
        }
    }

    /// Whether it is known to hold the pixel at X, Y, or known not to.
    fn decide(&self, x: f64, y: f64, grid: Grid) -> Option<bool> {
        let mut all = match &self.ellipse {
            Some(ellipse) => ellipse.decide(x, y, grid),
            None => Some(true),
        };
        for half_plane in self.half_planes {
            match half_plane.decide_near(x, y, grid) {
                Some(false) => return Some(false),
                Some(true) => {}
                None => all = None,
            }
        }
        all
    }
}
