//! The ellipses of a frame, with bounds on their errors: outlines of spheres, and their shadows on
//! planes.

use std::cell::Cell;

use crate::number::rounding::{INFLATION, U};
use crate::number::{Bounded, Divisor, Real};
use crate::tracer::line::Direction;
use crate::tracer::scanline::edges::ellipse::{Chords, Ellipse, RowOffset};
use crate::tracer::scanline::edges::pixel_plane::PixelPlane;
use crate::tracer::scanline::grid::Grid;
use crate::tracer::sphere::Sphere;
use crate::tracer::vector::Vector;
use crate::tracer::view_space::{EYE_SQUARED, EYE_Y, EYE_Z};

/// Ellipses whose chords move alike from row to row: the outlines of spheres, or their shadows on a
/// plane.
struct Ellipses {
    grid: Grid,
    /// The change of the chord's middle where Y grows by 1.
    middle_per_y: Bounded,
    /// The change of m where Y grows by 1.
    m_per_y: Bounded,
    /// The bounds that were derived last, and the sizes that they hold for.
    derived: Cell<(Sizes, ErrorBounds)>,
}

/// What the bounds on the errors of an ellipse grow with: magnitudes and errors of these.
#[derive(Clone, Copy)]
struct Sizes {
    /// The middle of the chord at Y = 0.
    middle: Bounded,
    /// m at Y = 0.
    m: Bounded,
    /// The square of half the longest chord.
    squared_radius: Bounded,
}

impl Sizes {
    const NONE: Sizes = Sizes {
        middle: Bounded::ZERO,
        m: Bounded::ZERO,
        squared_radius: Bounded::ZERO,
    };

    fn is_within(self, larger: Sizes) -> bool {
        self.middle.is_no_larger(larger.middle)
            & self.m.is_no_larger(larger.m)
            & self.squared_radius.is_no_larger(larger.squared_radius)
    }

    /// Sizes that both are within.
    fn joined(self, other: Sizes) -> Sizes {
        Sizes {
            middle: self.middle.joined(other.middle),
            m: self.m.joined(other.m),
            squared_radius: self.squared_radius.joined(other.squared_radius),
        }
    }
}

/// The bounds of an [`Ellipse`].
#[derive(Clone, Copy)]
struct ErrorBounds {
    m_error: f64,
    chord_error: f64,
    slack: f64,
}

impl ErrorBounds {
    /// Of an ellipse of which nothing is derived.
    const UNKNOWN: ErrorBounds = ErrorBounds {
        m_error: f64::INFINITY,
        chord_error: f64::INFINITY,
        slack: f64::INFINITY,
    };

    /// Whether bounds for these sizes are nearly as good as its own for a smaller ellipse: they
    /// leave hardly a column in doubt, since an end of a chord moves by 2⁻³² of a column, and by
    /// 2⁻¹⁶ of the longest chord where the chord is shortest; and no radius is four times the
    /// other, so that the bounds of the shader, which grow with `chord_error` over R², do not
    /// become four times as wide.
    fn serve(&self, sizes: Sizes, squared_radius: Bounded) -> bool {
        const NARROW: f64 = 1.0 / (1_u64 << 32) as f64;
        sizes.squared_radius.value() <= 16.0 * squared_radius.value()
            && self.chord_error <= NARROW * squared_radius.value()
            && self.slack <= NARROW
    }
}

impl Ellipses {
    fn new((middle_per_y, m_per_y): (Bounded, Bounded), grid: Grid) -> Self {
        Ellipses {
            grid,
            middle_per_y,
            m_per_y,
            derived: Cell::new((Sizes::NONE, ErrorBounds::UNKNOWN)),
        }
    }

    /// The ellipse with this middle and this m at Y = 0.
    // Inlined, so that it is written where it is kept: a copy reads by wide loads what narrow
    // stores have just written, which the processor cannot forward, so that it waits.
    #[inline(always)]
    fn ellipse(&self, middle: Bounded, m: Bounded, squared_radius: Bounded) -> Ellipse {
        let ErrorBounds {
            m_error,
            chord_error,
            slack,
        } = self.bounds_of(Sizes {
            middle,
            m,
            squared_radius,
        });
        Ellipse {
            chords: Chords::IN_DOUBT,
            middle: (middle.value(), self.middle_per_y.value()),
            m: RowOffset {
                slope: self.m_per_y.value(),
                zero: -(m.value() / self.m_per_y.value()),
            },
            squared_radius: squared_radius.value(),
            max_m: self.max_m(squared_radius, m_error),
            m_error,
            chord_error,
            slack,
            // Bounds are finite only if all that they are derived from is.
            is_bounded: chord_error.is_finite() && slack.is_finite(),
        }
        .with_chords(self.grid)
    }

    /// Bounds for an ellipse of these sizes: mostly those that were derived for larger ones.
    #[inline(always)]
    fn bounds_of(&self, sizes: Sizes) -> ErrorBounds {
        let (held, bounds) = self.derived.get();
        if !(sizes.is_within(held) && bounds.serve(held, sizes.squared_radius)) {
            self.derive_bounds(sizes.middle, sizes.m, sizes.squared_radius);
        }
        self.derived.get().1
    }

    /// Derives bounds for these sizes, and for those before, too, unless these differ much.
    // The sizes come one by one, and no result goes: each would be copied, as above.
    #[inline(never)]
    fn derive_bounds(&self, middle: Bounded, m: Bounded, squared_radius: Bounded) {
        let sizes = Sizes {
            middle,
            m,
            squared_radius,
        };
        let joined = sizes.joined(self.derived.get().0);
        let mut derived = (joined, self.bounds(joined));
        if !derived.1.serve(joined, squared_radius) {
            derived = (sizes, self.bounds(sizes));
        }
        self.derived.set(derived);
    }

    /// The largest |m| of a row that an ellipse may reach.
    #[inline(always)]
    fn max_m(&self, squared_radius: Bounded, m_error: f64) -> f64 {
        // A row with a computed |m| above R plus its error misses the ellipse: near the zero by the
        // bound on the error, and farther away because the slope is right to a quarter. If the
        // slope is not, every row is in doubt.
        let is_steep = self.m_per_y.error() < self.m_per_y.value().abs() / 4.0;
        if is_steep {
            (radius(squared_radius) + m_error) * INFLATION
        } else {
            f64::INFINITY
        }
    }

    /// The bounds for an ellipse of these sizes, and for all smaller ones: they grow with each
    /// magnitude and with each error.
    fn bounds(&self, sizes: Sizes) -> ErrorBounds {
        let Sizes {
            middle,
            m,
            squared_radius,
        } = sizes;
        let (max, slope) = (self.grid.max, self.m_per_y);
        let zero = m / slope;
        // A linear function of Y in f64: its coefficients' errors, and two roundings.
        let error = |(a, b): (Bounded, Bounded)| {
            (a.error() + b.error() * max + 4.0 * U * (a.value().abs() + b.value().abs() * max))
                * INFLATION
        };
        let radius = radius(squared_radius);
        // The error of Y − zero, where |m| is not much more than R: that of the zero, and one
        // rounding. The product rounds too.
        let away = 2.0 * radius / slope.value().abs() + 4.0 * zero.error();
        let shift = zero.error() + U * away;
        let m_error =
            (slope.value().abs() * (shift + U * away) + slope.error() * (away + shift)) * INFLATION;
        let max_m = self.max_m(squared_radius, m_error);
        // |(m + ε)² − m²| ≤ 2|m|ε + ε², and squaring and subtracting round by u of what they give.
        let chord_error = (squared_radius.error()
            + (2.0 * max_m + m_error) * m_error
            + 2.0 * U * (max_m * max_m + squared_radius.value().abs()))
            * INFLATION;
        // The chord's half is at most the radius. Its root, the sum with the middle, a third of it
        // and the sum with N/2 round by less than u of |middle| + radius + N each.
        let largest = middle.value().abs() + self.middle_per_y.value().abs() * max;
        let slack =
            (error((middle, self.middle_per_y)) + 16.0 * U * (largest + radius + max)) * INFLATION;
        ErrorBounds {
            m_error,
            chord_error,
            slack,
        }
    }
}

/// A bound on half the longest chord.
#[inline(always)]
fn radius(squared_radius: Bounded) -> f64 {
    squared_radius.at_most().max(0.0).sqrt() * INFLATION
}

/// The outlines of spheres on the screen.
pub(crate) struct SphereOutlines {
    ellipses: Ellipses,
    /// √109.
    root: Divisor,
}

impl SphereOutlines {
    pub(crate) fn new(grid: Grid) -> Self {
        let root = Divisor::new(Bounded::exact(EYE_SQUARED).sqrt());
        let slope = root.divide(Bounded::exact(EYE_Z));
        SphereOutlines {
            ellipses: Ellipses::new((Bounded::exact(0.0), slope), grid),
            root,
        }
    }

    /// The outline of a sphere. There the chord's middle is the sphere's, and m is the second
    /// coordinate in the axes of `shade/light.rs`: (10 (Y − c_y) − 3 (Z − c_z))/√109, divided once,
    /// because at α = 0 the numerator may be exact.
    #[inline(always)]
    pub(crate) fn of(&self, center: Vector<Bounded>, radius: Bounded) -> Ellipse {
        let [three, ten] = [EYE_Y, EYE_Z].map(Bounded::exact);
        let z = Bounded::exact(self.ellipses.grid.max) - center.z;
        let m = self.root.divide(-(ten * center.y) - three * z);
        self.ellipses.ellipse(center.x, m, radius.squared())
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
    /// The square of half the longest chord of a sphere of radius 1.
    squared_radius: Bounded,
    /// The pixels whose lines meet spheres.
    ellipses: Ellipses,
    /// The product of this vector with a point, seen from the plane's origin, is Y of the pixel
    /// whose line passes through the point.
    row_axis: Vector<Bounded>,
}

impl ParallelLines {
    pub(crate) fn new(plane: &PixelPlane, direction: Direction<Bounded>, grid: Grid) -> Self {
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
            ellipses: Ellipses::new(
                (-(per_y.dot(per_x) / squared_per_x), per_y.dot(shortest)),
                grid,
            ),
            row_axis: per_x.divided_by(plane.per_y.dot(per_x)),
        }
    }

    /// The rows of the pixels whose lines may meet the convex hull of some points.
    pub(crate) fn rows_through(&self, points: [Vector<Bounded>; 4]) -> (u32, u32) {
        let y = points.map(|point| (point - self.origin).dot(self.row_axis));
        let low = y.map(Bounded::at_least).into_iter();
        let high = y.map(Bounded::at_most).into_iter();
        self.ellipses.grid.between(
            low.fold(f64::INFINITY, f64::min),
            high.fold(f64::NEG_INFINITY, f64::max),
        )
    }

    /// The pixels whose lines meet a sphere: |(p − c) × l|² ≤ |l|² R².
    #[inline(always)]
    pub(crate) fn meet(&self, sphere: &Sphere<Bounded>) -> Ellipse {
        let center = sphere.center - self.origin;
        self.ellipses.ellipse(
            center.dot(self.middle_axis),
            center.dot(self.m_axis),
            self.squared_radius * sphere.radius.squared(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn bounds_derived_for_other_spheres_are_no_less_than_own_ones() {
        let grid = Grid::new(500);
        let outlines = SphereOutlines::new(grid);
        let mut random = Random::new();
        let mut shared = 0;
        for number in 0..3000 {
            let scale = [1.0, 1.0, 1.0, 0.01, 100.0][random.below(5)];
            let mut length = |max: f64| Bounded::exact(scale * max * random.fraction());
            let third = Bounded::exact(1.0) / Bounded::exact(3.0);
            let center = Vector::new(length(750.0), -length(750.0) * third, length(750.0));
            let mut radius = length(30.0) * third;
            if number % 100 == 99 {
                radius = Bounded::UNKNOWN;
            }
            let own = SphereOutlines::new(grid).of(center, radius);
            let made = outlines.of(center, radius);
            let values = |e: &Ellipse| [e.middle.0, e.m.zero, e.squared_radius].map(f64::to_bits);
            assert_eq!(values(&made), values(&own));
            assert_eq!(made.is_bounded, own.is_bounded);
            if own.is_bounded {
                let bounds = |e: &Ellipse| [e.m_error, e.chord_error, e.slack, e.max_m];
                let (made, own) = (bounds(&made), bounds(&own));
                assert!(
                    own.iter().zip(made).all(|(own, made)| *own <= made),
                    "{made:?} {own:?}"
                );
                shared += u32::from(own[..3] != made[..3]);
            }
        }
        assert!(shared > 1000, "{shared}");
    }

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
                grid,
            );
            let [x, y] = [column, row].map(|number| Bounded::exact(grid.coordinate(number)));
            let on_plane = plane.origin + plane.per_x * x + plane.per_y * y;
            let point = on_plane + direction * number(500.0);
            let (from, to) = lines.rows_through([point; 4]);
            assert!(from <= row && row < to, "{row}: {from} to {to}");
            narrow += u32::from(to - from <= 4);
        }
        assert!(narrow > 950, "{narrow} of 1000");
    }
}
