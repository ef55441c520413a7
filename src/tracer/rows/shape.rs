//! Where borders cross a row.
//!
//! # Why rows
//!
//! Eye rays are parallel, and so are those to the light. So every border in the picture that does not lie on a sphere is a
//! straight line or an ellipse on the screen: a silhouette, an edge between faces, the surface's sides, the outline of a mirror
//! image, a shadow on the surface or on a face. Each is known as a polynomial in X and Y, the place on the screen in thirds of
//! a pixel from its centre, and a row of pixels, on which Y is fixed, crosses it at a root.
//!
//! A root is computed in f64 with a bound on its error, derived where it is used. The columns beyond the bound are decided;
//! those within it, rarely one, are asked one by one.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use super::ellipse::Ellipse;
use super::half_plane::HalfPlane;
use super::place::{ROWS, Screen, places};
use super::reaches::Reaches;
use super::span::Spans;

/// A convex part of the picture: what half-planes and an ellipse have in common.
pub(super) struct Shape<'f> {
    half_planes: &'f [HalfPlane],
    ellipse: Option<Ellipse>,
    /// The rows that it can cross.
    rows: (u32, u32),
}

impl<'f> Shape<'f> {
    pub(super) fn new(
        half_planes: &'f [HalfPlane],
        ellipse: Option<Ellipse>,
        screen: Screen,
    ) -> Self {
        let rows = ellipse
            .as_ref()
            .map_or((0, screen.size), |ellipse| ellipse.rows(screen));
        Shape {
            half_planes,
            ellipse,
            rows,
        }
    }

    /// The same where it is known to cross no other than these rows.
    pub(super) fn within(mut self, rows: (u32, u32)) -> Self {
        self.rows = (self.rows.0.max(rows.0), self.rows.1.min(rows.1));
        self
    }

    /// The rows that it can cross.
    pub(super) fn rows(&self) -> (u32, u32) {
        self.rows
    }

    /// Its columns of the rows from `row` on.
    #[inline(always)]
    pub(super) fn cross<S: Simd>(&self, simd: S, row: u32, screen: Screen) -> Spans {
        let mut spans = Spans::NONE;
        for first in (0..ROWS).step_by(S::f64s::LEN) {
            let y = places::<S>(simd, first) + screen.place(row);
            let mut reaches = match &self.ellipse {
                Some(ellipse) => ellipse.reaches(simd, y, screen),
                None => {
                    let zero = S::f64s::splat(simd, 0.0);
                    let all = [zero, zero + f64::from(screen.size)];
                    Reaches {
                        possible: all,
                        certain: all,
                    }
                }
            };
            for half_plane in self.half_planes {
                half_plane.cut(simd, y, &mut reaches);
            }
            let is_crossed =
                y.simd_ge(screen.place(self.rows.0)) & y.simd_lt(screen.place(self.rows.1));
            let Reaches { possible, certain } = reaches;
            let possible = [
                screen.ceil_all::<S>(possible[0]),
                screen.count_all::<S>(possible[1]),
            ];
            let certain = [
                screen.ceil_all::<S>(certain[0]),
                screen.count_all::<S>(certain[1]),
            ];
            spans.put(simd, first, is_crossed, possible, certain);
        }
        spans
    }

    /// Asks the columns in doubt, from the outside in.
    pub(super) fn narrow(&self, spans: &mut Spans, row: u32, screen: Screen) {
        spans.is_certain = true;
        for i in 0..ROWS {
            let (mut from, mut to) = (spans.possible[0][i], spans.possible[1][i]);
            let certain = (spans.certain[0][i], spans.certain[1][i]);
            if (from, to) == certain {
                continue;
            }
            let y = screen.place(row + i as u32);
            let is_certain = |column: u32| certain.0 <= column && column < certain.1;
            let holds = |column: u32| match is_certain(column) {
                true => Some(true),
                false => self.decide(screen.place(column), y, screen),
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
    fn decide(&self, x: f64, y: f64, screen: Screen) -> Option<bool> {
        let mut all = match &self.ellipse {
            Some(ellipse) => ellipse.decide(x, y, screen),
            None => Some(true),
        };
        for half_plane in self.half_planes {
            match half_plane.decide_near(x, y, screen) {
                Some(false) => return Some(false),
                Some(true) => {}
                None => all = None,
            }
        }
        all
    }
}
