//! Pixels within an ellipse: a sphere's outline, or the shadow of one.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch};

use crate::number::rounding::{INFLATION, U};
use crate::number::{Bounded, Real};
use crate::tracer::line::Direction;
use crate::tracer::scanline::edges::enclosure::{ColumnEnclosure, NOWHERE};
use crate::tracer::scanline::edges::pixel_plane::PixelPlane;
use crate::tracer::scanline::grid::{Grid, in_columns};
use crate::tracer::sphere::Sphere;
use crate::tracer::vector::Vector;
use crate::tracer::view_space::{EYE_SQUARED, EYE_Y, EYE_Z, number_at};

/// The pixels where (X − `middle`)² + m² ≤ `squared_radius`, with a middle and an m that are linear
/// functions of Y: an ellipse, with a horizontal chord in every row.
#[derive(Clone, Copy)]
pub(crate) struct Ellipse {
    /// The middle of the chord at Y = 0, and how it moves with Y.
    middle: (f64, f64),
    /// m of each row.
    pub(crate) m: RowOffset,
    /// The square of half the longest chord.
    pub(crate) squared_radius: f64,
    /// The largest |m| of a row that the ellipse may reach.
    max_m: f64,
    /// A bound on the error of m.
    pub(crate) m_error: f64,
    /// A bound on the error of the square of half a chord.
    pub(crate) chord_error: f64,
    /// A bound on the error of an end of a chord, in columns, without the part of `chord_error`.
    slack: f64,
    /// Whether all of these are finite; otherwise every column is in doubt.
    is_bounded: bool,
}

/// m as a function of Y: `slope` · (Y − `zero`).
#[derive(Clone, Copy)]
pub(crate) struct RowOffset {
    slope: f64,
    zero: f64,
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

/// Parallel lines through the points of a plane, one a pixel.
pub(crate) struct ParallelLines {
    /// The plane's origin.
    origin: Vector<Bounded>,
    /// The product of this vector with a sphere's centre, seen from the origin, is the middle of
    /// its chord at Y = 0.
    middle_axis: Vector<Bounded>,
    /// That with this vector is m at Y = 0.
    m_axis: Vector<Bounded>,
    /// The change of the chord's middle where Y grows by 1.
    middle_per_y: Bounded,
    /// The change of m where Y grows by 1.
    m_per_y: Bounded,
    /// The square of half the longest chord of a sphere of radius 1.
    squared_radius: Bounded,
    /// The product of this vector with a point, seen from the plane's origin, is Y of the pixel
    /// whose line passes through the point.
    row_axis: Vector<Bounded>,
}

impl ParallelLines {
    pub(crate) fn new(plane: &PixelPlane, direction: Direction<Bounded>) -> Self {
        let l = direction.vector;
        // The moment of a line about a centre c is (o − c) × l at X = Y = 0, and changes by these.
        let per_x = plane.per_x.cross(l);
        let per_y = plane.per_y.cross(l);
        let squared_per_x = per_x.squared_length();
        // The moment is shortest in the middle of a chord, and there perpendicular to both l and
        // `per_x`.
        let shortest = l.cross(per_x);
        let shortest = shortest.divided_by(shortest.length() * squared_per_x.sqrt());
        // −((o − c) × l)·v = (c − o)·(l × v).
        ParallelLines {
            origin: plane.origin,
            middle_axis: l.cross(per_x).divided_by(squared_per_x),
            m_axis: shortest.cross(l),
            squared_radius: direction.squared_length / squared_per_x,
            middle_per_y: -(per_y.dot(per_x) / squared_per_x),
            m_per_y: per_y.dot(shortest),
            row_axis: per_x.divided_by(plane.per_y.dot(per_x)),
        }
    }

    /// The rows of the pixels whose lines may meet the convex hull of some points.
    pub(crate) fn rows_through(&self, points: [Vector<Bounded>; 4], grid: Grid) -> (u32, u32) {
        let y = points.map(|point| (point - self.origin).dot(self.row_axis));
        let low = y.map(Bounded::at_least).into_iter();
        let high = y.map(Bounded::at_most).into_iter();
        grid.between(
            low.fold(f64::INFINITY, f64::min),
            high.fold(f64::NEG_INFINITY, f64::max),
        )
    }

    /// The pixels whose lines meet a sphere: |(p − c) × l|² ≤ |l|² R².
    pub(crate) fn meet(&self, sphere: &Sphere<Bounded>, grid: Grid) -> Ellipse {
        let center = sphere.center - self.origin;
        Ellipse::new(
            (center.dot(self.middle_axis), self.middle_per_y),
            (center.dot(self.m_axis), self.m_per_y),
            self.squared_radius * sphere.radius.squared(),
            grid,
        )
    }
}

impl Ellipse {
    // Inlined, so that it is written where it is kept: the processor would wait long before it
    // copies what was just written.
    #[inline(always)]
    fn new(
        middle: (Bounded, Bounded),
        m: (Bounded, Bounded),
        squared_radius: Bounded,
        grid: Grid,
    ) -> Ellipse {
        let max = grid.max;
        let (zero, slope) = (-(m.0 / m.1), m.1);
        // A linear function of Y in f64: its coefficients' errors, and two roundings.
        let error = |(a, b): (Bounded, Bounded)| {
            (a.error() + b.error() * max + 4.0 * U * (a.value().abs() + b.value().abs() * max))
                * INFLATION
        };
        let radius = squared_radius.at_most().max(0.0).sqrt() * INFLATION;
        // The error of Y − zero, where |m| is not much more than R: that of the zero, and one
        // rounding. The product rounds too.
        let away = 2.0 * radius / slope.value().abs() + 4.0 * zero.error();
        let shift = zero.error() + U * away;
        let m_error =
            (slope.value().abs() * (shift + U * away) + slope.error() * (away + shift)) * INFLATION;
        // A row with a computed |m| above R plus its error misses the ellipse: near the zero by the
        // bound on the error, and farther away because the slope is right to a quarter. If the
        // slope is not, every row is in doubt.
        let is_steep = slope.error() < slope.value().abs() / 4.0;
        let max_m = if is_steep {
            (radius + m_error) * INFLATION
        } else {
            f64::INFINITY
        };
        // |(m + ε)² − m²| ≤ 2|m|ε + ε², and squaring and subtracting round by u of what they give.
        let chord_error = (squared_radius.error()
            + (2.0 * max_m + m_error) * m_error
            + 2.0 * U * (max_m * max_m + squared_radius.value().abs()))
            * INFLATION;
        // The chord's half is at most the radius. Its root, the sum with the middle, a third of it
        // and the sum with N/2 round by less than u of |middle| + radius + N each.
        let largest = middle.0.value().abs() + middle.1.value().abs() * max;
        let slack = (error(middle) + 16.0 * U * (largest + radius + max)) * INFLATION;
        let all = [
            middle.0.value(),
            middle.1.value(),
            slope.value(),
            zero.value(),
            squared_radius.value(),
            max_m,
            chord_error,
            slack,
        ];
        Ellipse {
            is_bounded: all.iter().all(|x| x.is_finite()),
            middle: (middle.0.value(), middle.1.value()),
            m: RowOffset {
                slope: slope.value(),
                zero: zero.value(),
            },
            squared_radius: squared_radius.value(),
            max_m,
            m_error,
            chord_error,
            slack,
        }
    }

    /// The outline of a sphere on the screen. There the chord's middle is the sphere's, and m is
    /// the second coordinate in the axes of `shade/light.rs`: (10 (Y − c_y) − 3 (Z − c_z))/√109,
    /// divided once, because at α = 0 the numerator may be exact.
    pub(crate) fn outline(center: Vector<Bounded>, radius: Bounded, grid: Grid) -> Ellipse {
        let root = Bounded::exact(EYE_SQUARED).sqrt();
        let [three, ten] = [EYE_Y, EYE_Z].map(Bounded::exact);
        let z = Bounded::exact(grid.max) - center.z;
        Ellipse::new(
            (center.x, Bounded::exact(0.0)),
            ((-(ten * center.y) - three * z) / root, ten / root),
            radius.squared(),
            grid,
        )
    }

    /// The enclosures of as many rows as there are lanes.
    #[inline(always)]
    pub(crate) fn enclose<S: Simd>(
        &self,
        simd: S,
        y: S::f64s,
        grid: Grid,
    ) -> ColumnEnclosure<S::f64s> {
        let zero = S::f64s::splat(simd, 0.0);
        let none = S::f64s::splat(simd, NOWHERE);
        if !self.is_bounded {
            let all = S::f64s::splat(simd, f64::from(grid.size));
            return ColumnEnclosure {
                possible: [zero, all],
                certain: [zero, none],
            };
        }
        let m = self.m.of_rows::<S>(y);
        let squared = -(m * m) + self.squared_radius;
        let (upper, lower) = (squared + self.chord_error, squared - self.chord_error);
        let is_met = m.abs().simd_le(self.max_m) & upper.simd_ge(zero);
        let is_certain = is_met & lower.simd_gt(zero);
        let middle = y * self.middle.1 + self.middle.0;
        // m is no NaN here. Where it is infinite, the row misses the ellipse.
        let half = upper.max(zero).sqrt();
        let from = in_columns::<S>(grid, middle - half) - self.slack;
        let to = in_columns::<S>(grid, middle + half) + self.slack;
        let possible = [from, is_met.select(to, none)];
        let half = lower.max(zero).sqrt();
        let from = in_columns::<S>(grid, middle - half) + self.slack;
        let to = in_columns::<S>(grid, middle + half) - self.slack;
        let certain = [from, is_certain.select(to, none)];
        ColumnEnclosure { possible, certain }
    }

    /// The enclosure of the row at Y.
    #[inline(always)]
    pub(super) fn enclose_row<S: Simd>(&self, simd: S, y: f64, grid: Grid) -> ColumnEnclosure<f64> {
        let y = S::f64s::splat(simd, y);
        let ColumnEnclosure { possible, certain } = self.enclose(simd, y, grid);
        ColumnEnclosure {
            possible: possible.map(|end| end.as_slice()[0]),
            certain: certain.map(|end| end.as_slice()[0]),
        }
    }

    /// Whether the pixel at X, Y is in the ellipse; `None` where that is in doubt.
    pub(crate) fn decide(&self, x: f64, y: f64, grid: Grid) -> Option<bool> {
        let ColumnEnclosure { possible, certain } =
            dispatch!(Level::baseline(), simd => self.enclose_row(simd, y, grid));
        let column = number_at(x, grid.half);
        if column < possible[0] || column > possible[1] {
            return Some(false);
        }
        (certain[0] <= column && column <= certain[1]).then_some(true)
    }

    /// The half-open range of the rows that the ellipse may reach.
    pub(crate) fn rows(&self, grid: Grid) -> (u32, u32) {
        let ends = [-self.max_m, self.max_m].map(|m| self.m.zero + m / self.m.slope);
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        if low.is_finite() && high.is_finite() {
            grid.between(low, high)
        } else {
            (0, grid.size)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn lines_through_a_point_are_in_the_rows_through_it() {
        let mut random = Random::new();
        let grid = Grid::new(500);
        let mut narrow = 0;
        for _ in 0..1000 {
            let [column, row] = [(); 2].map(|()| random.below(500) as u32);
            let mut number = |max: f64| Bounded::exact(max * (2.0 * random.fraction() - 1.0));
            let mut vector = |max: f64| Vector::new(number(max), number(max), number(max));
            let plane = PixelPlane {
                origin: vector(750.0),
                per_x: vector(1.0),
                per_y: vector(1.0),
                support: None,
            };
            let direction = vector(1.0);
            let lines = ParallelLines::new(
                &plane,
                Direction {
                    vector: direction,
                    squared_length: direction.squared_length(),
                },
            );
            let [x, y] = [column, row].map(|number| Bounded::exact(grid.coordinate(number)));
            let on_plane = plane.origin + plane.per_x * x + plane.per_y * y;
            let point = on_plane + direction * number(500.0);
            let (from, to) = lines.rows_through([point; 4], grid);
            assert!(from <= row && row < to, "{row}: {from} to {to}");
            narrow += u32::from(to - from <= 4);
        }
        assert!(narrow > 950, "{narrow} of 1000");
    }
}
