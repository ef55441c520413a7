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
//!
//! u is 2⁻⁵³, the largest relative error of an f64 operation. Bounds are sums of terms that are not negative; computing them rounds
//! too, each by less than 2⁻⁴⁰, for which [`MORE`] makes up.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use super::span::{HalfLines, ROWS, Spans};
use crate::number::{Bounded, Real};
use crate::scene::Support;
use crate::tracer::tetrahedron::HalfSpace;
use crate::tracer::vector::Vector;

/// u, the largest relative error of one rounding to f64.
pub(super) const U: f64 = f64::EPSILON / 2.0;

/// 1 + 2⁻³⁹.
pub(super) const MORE: f64 = 1.0 + 8192.0 * f64::EPSILON;

/// Columns and rows of pixels, and their places.
#[derive(Clone, Copy)]
pub(super) struct Screen {
    pub(super) size: u32,
    /// N/2.
    pub(super) half: f64,
    /// 3N/2, the largest |X| and |Y|.
    pub(super) reach: f64,
}

impl Screen {
    pub(super) fn new(size: u32) -> Screen {
        let half = f64::from(size) / 2.0;
        Screen {
            size,
            half,
            reach: 3.0 * half,
        }
    }

    /// X or Y of a column or row: a whole or half number below 2¹⁶, exactly.
    pub(super) fn place(&self, number: u32) -> f64 {
        3.0 * (f64::from(number) - self.half)
    }

    /// The first column at or after a place given in columns.
    fn ceil(&self, place: f64) -> u32 {
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
    fn count(&self, place: f64) -> u32 {
        if place < 0.0 {
            return 0;
        }
        (place as u32).saturating_add(1).min(self.size)
    }
}

/// Points that the pixels' rays reach on a plane: `origin` + X · `per_column` + Y · `per_row`.
pub(super) struct Sheet {
    pub(super) origin: Vector<Bounded>,
    pub(super) per_column: Vector<Bounded>,
    pub(super) per_row: Vector<Bounded>,
    /// The plane, if rays leave it.
    pub(super) plane: Option<Support>,
}

/// The pixels where constant + `column` X + `row` Y ≥ 0, or > 0.
pub(super) struct HalfPlane {
    constant: Bounded,
    column: Bounded,
    row: Bounded,
    closed: bool,
    /// A bound on the error of the sum, where it does not depend on the column, or is not computed from it.
    error: f64,
    crossing: Crossing,
}

/// How rows cross a border.
enum Crossing {
    /// Not to be told from not at all.
    Never,
    /// At (constant + row · Y) · −`inverse` columns from the middle, and at most `slack` columns beside that.
    Once { inverse: f64, slack: f64 },
}

impl HalfPlane {
    pub(super) fn new(
        constant: Bounded,
        column: Bounded,
        row: Bounded,
        closed: bool,
        screen: Screen,
    ) -> Self {
        let reach = screen.reach;
        // The errors of the coefficients, and of g = constant + row · Y: the product and the sum round, by less than
        // 2u (|constant| + |row · Y|) each.
        let error = (constant.error()
            + (column.error() + row.error()) * reach
            + 4.0 * U * (constant.value().abs() + row.value().abs() * reach))
            * MORE;
        let across = column.value().abs() * reach;
        let crossing = if across > error {
            // The root in columns, N/2 − g/(3 · column), rounds four times, by less than 4u of a number below 3N where it matters,
            // and E/(3 |column|) is what the error moves it by.
            let inverse = 1.0 / (3.0 * column.value());
            Crossing::Once {
                inverse,
                slack: (error * inverse.abs() + 16.0 * U * 3.0 * f64::from(screen.size)) * MORE,
            }
        } else {
            Crossing::Never
        };
        HalfPlane {
            constant,
            column,
            row,
            closed,
            error: match crossing {
                Crossing::Never => (error + across) * MORE,
                Crossing::Once { .. } => error,
            },
            crossing,
        }
    }

    /// The pixels whose points on the sheet lie in a half-space.
    pub(super) fn of(half_space: &HalfSpace<Bounded>, sheet: &Sheet, screen: Screen) -> HalfPlane {
        let n = half_space.normal;
        if half_space.border.is_some() && half_space.border == sheet.plane {
            // All of them lie on its border.
            let zero = Bounded::exact(0.0);
            return HalfPlane::new(zero, zero, zero, half_space.closed, screen);
        }
        HalfPlane::new(
            n.dot(sheet.origin - half_space.at),
            n.dot(sheet.per_column),
            n.dot(sheet.per_row),
            half_space.closed,
            screen,
        )
    }

    /// Whether the sum is known to be in it at X, Y; `None` where it is not known.
    fn decide(&self, x: f64, y: f64) -> Option<bool> {
        let sum = self.constant + self.row * Bounded::exact(y) + self.column * Bounded::exact(x);
        let sign = sum.sign().ok()?;
        Some(sign.is_gt() || (self.closed && sign.is_eq()))
    }

    /// Its columns of the rows from Y = `y` on.
    #[inline(always)]
    fn cross<S: Simd>(&self, simd: S, y: f64, screen: Screen) -> HalfLines {
        let (inverse, slack) = match self.crossing {
            Crossing::Never => return self.cross_never(y, screen),
            Crossing::Once { inverse, slack } => (inverse, slack),
        };
        let rightward = inverse > 0.0;
        let mut lines = HalfLines {
            rightward,
            possible: [0; ROWS],
            certain: [0; ROWS],
        };
        for first in (0..ROWS).step_by(S::f64s::LEN) {
            let y = places::<S>(simd, first) + y;
            let g = y * self.row.value() + self.constant.value();
            let root = -(g * inverse) + screen.half;
            let (low, high) = (root - slack, root + slack);
            if rightward {
                put_ceil::<S>(screen, low, &mut lines.possible[first..]);
                put_ceil::<S>(screen, high, &mut lines.certain[first..]);
            } else {
                put_count::<S>(screen, high, &mut lines.possible[first..]);
                put_count::<S>(screen, low, &mut lines.certain[first..]);
            }
        }
        if lines.possible != lines.certain {
            self.narrow(&mut lines, y, screen);
        }
        lines
    }

    /// The same where no row is known to cross its border.
    fn cross_never(&self, y: f64, screen: Screen) -> HalfLines {
        let mut lines = HalfLines {
            rightward: true,
            possible: [0; ROWS],
            certain: [0; ROWS],
        };
        for (row, place) in PLACES.iter().enumerate() {
            let y = y + place;
            let g = self.constant.value() + self.row.value() * y;
            let known = if g > self.error {
                Some(true)
            } else if g < -self.error {
                Some(false)
            } else if self.column.is_zero() {
                self.decide(0.0, y)
            } else {
                None
            };
            let border = |all: bool| if all { 0 } else { screen.size };
            lines.possible[row] = border(known != Some(false));
            lines.certain[row] = border(known == Some(true));
        }
        lines
    }

    /// Asks the columns in doubt, from the outside in.
    fn narrow(&self, lines: &mut HalfLines, y: f64, screen: Screen) {
        for (row, place) in PLACES.iter().enumerate() {
            let y = y + place;
            let (possible, certain) = (&mut lines.possible[row], &mut lines.certain[row]);
            while *possible != *certain {
                let column = if lines.rightward {
                    *possible
                } else {
                    *possible - 1
                };
                match self.decide(screen.place(column), y) {
                    Some(true) => *certain = *possible,
                    Some(false) if lines.rightward => *possible += 1,
                    Some(false) => *possible -= 1,
                    None => break,
                }
            }
        }
    }
}

/// The pixels where (X − `center`)² + m² ≤ `squared_radius`, with a center and an m that go linearly with Y: an ellipse with a horizontal
/// chord in every row.
pub(super) struct Ellipse {
    /// The middle of the chord at Y = 0, and how it moves with Y.
    center: (f64, f64),
    pub(super) off: Off,
    pub(super) squared_radius: f64,
    /// Beyond this |m| no row is crossed.
    limit: f64,
    /// A bound on the error of m, and of half the chord, squared.
    pub(super) off_error: f64,
    pub(super) chord_error: f64,
    /// A bound on the error of an end of the chord in columns, apart from that.
    slack: f64,
    /// Whether all of these are finite; otherwise nothing is known.
    is_bounded: bool,
}

/// m as a function of Y: `slope` · (Y − `zero`).
#[derive(Clone, Copy)]
pub(super) struct Off {
    slope: f64,
    zero: f64,
}

impl Off {
    /// m of the row at Y.
    pub(super) fn at(self, y: f64) -> f64 {
        self.slope * (y - self.zero)
    }

    /// The same of as many rows as there are lanes.
    #[inline(always)]
    pub(super) fn of_rows<S: Simd>(self, y: S::f64s) -> S::f64s {
        (y - self.zero) * self.slope
    }
}

impl Ellipse {
    fn new(
        center: (Bounded, Bounded),
        off: (Bounded, Bounded),
        squared_radius: Bounded,
        screen: Screen,
    ) -> Ellipse {
        let reach = screen.reach;
        let (zero, slope) = (-(off.0 / off.1), off.1);
        // A linear function of Y in f64: its coefficients' errors, and two roundings.
        let error = |(a, b): (Bounded, Bounded)| {
            (a.error() + b.error() * reach + 4.0 * U * (a.value().abs() + b.value().abs() * reach))
                * MORE
        };
        let radius = squared_radius.at_most().max(0.0).sqrt() * MORE;
        // What Y − zero is off by, where |m| is not much more than R: the zero's own error, and one rounding. The product rounds too.
        let away = 2.0 * radius / slope.value().abs() + 4.0 * zero.error();
        let shift = zero.error() + U * away;
        let off_error =
            (slope.value().abs() * (shift + U * away) + slope.error() * (away + shift)) * MORE;
        // Rows at which |m| seems to be more than R and the error do miss it, near the zero as the error says, and farther away
        // because the slope is known to a quarter. Otherwise nothing is known.
        let known = slope.error() < slope.value().abs() / 4.0;
        let limit = if known {
            (radius + off_error) * MORE
        } else {
            f64::INFINITY
        };
        // |(m + ε)² − m²| ≤ 2|m|ε + ε², and squaring and subtracting round by u of what they give.
        let chord_error = (squared_radius.error()
            + (2.0 * limit + off_error) * off_error
            + 2.0 * U * (limit * limit + squared_radius.value().abs()))
            * MORE;
        // The chord's half is at most the radius. Its root, the sum with the middle, a third of it and the sum with N/2 round
        // by less than u of |middle| + radius + N each.
        let middle = center.0.value().abs() + center.1.value().abs() * reach;
        let slack = (error(center) + 16.0 * U * (middle + radius + reach)) * MORE;
        let all = [
            center.0.value(),
            center.1.value(),
            slope.value(),
            zero.value(),
            squared_radius.value(),
            limit,
            chord_error,
            slack,
        ];
        Ellipse {
            is_bounded: all.iter().all(|x| x.is_finite()),
            center: (center.0.value(), center.1.value()),
            off: Off {
                slope: slope.value(),
                zero: zero.value(),
            },
            squared_radius: squared_radius.value(),
            limit,
            off_error,
            chord_error,
            slack,
        }
    }

    /// The pixels from whose points on the sheet lines along `direction` meet a sphere: |(p − c) × l|² ≤ |l|² R².
    pub(super) fn of(
        (center, radius): (Vector<Bounded>, Bounded),
        direction: (Vector<Bounded>, Bounded),
        sheet: &Sheet,
        screen: Screen,
    ) -> Ellipse {
        let (l, squared_length) = direction;
        let moment = (sheet.origin - center).cross(l);
        let per_column = sheet.per_column.cross(l);
        let per_row = sheet.per_row.cross(l);
        let speed = per_column.squared_length();
        // The chord's middle is where the moment is shortest. There it points across both l and what a column adds to it.
        let across = l.cross(per_column);
        let across = across.divided_by(across.length() * speed.sqrt());
        let middle = |moment: Vector<Bounded>| -(moment.dot(per_column) / speed);
        Ellipse::new(
            (middle(moment), middle(per_row)),
            (moment.dot(across), per_row.dot(across)),
            squared_length * radius.squared() / speed,
            screen,
        )
    }

    /// The outline of a sphere on the screen: there the chord's middle is the sphere's, and m = (10 (Y − c_y) − 3 (Z − c_z))/√109.
    pub(super) fn outline(center: Vector<Bounded>, radius: Bounded, screen: Screen) -> Ellipse {
        let root = Bounded::exact(109.0).sqrt();
        let [three, ten] = [3.0, 10.0].map(Bounded::exact);
        let z = Bounded::exact(screen.reach) - center.z;
        Ellipse::new(
            (center.x, Bounded::exact(0.0)),
            ((-(ten * center.y) - three * z) / root, ten / root),
            radius.squared(),
            screen,
        )
    }

    /// Its columns of the rows from Y = `y` on.
    #[inline(always)]
    fn cross<S: Simd>(&self, simd: S, y: f64, screen: Screen) -> Spans {
        if !self.is_bounded {
            return Spans::unknown(screen.size);
        }
        let mut spans = Spans::NONE;
        for first in (0..ROWS).step_by(S::f64s::LEN) {
            let y = places::<S>(simd, first) + y;
            let zero = S::f64s::splat(simd, 0.0);
            let m = self.off.of_rows::<S>(y);
            let squared = -(m * m) + self.squared_radius;
            let (most, least) = (squared + self.chord_error, squared - self.chord_error);
            let is_met = m.abs().simd_le(self.limit) & most.simd_ge(zero);
            let is_certain = is_met & least.simd_gt(zero);
            let middle = y * self.center.1 + self.center.0;
            // No NaN comes here: m is infinite at worst, and then the row is beyond.
            let half = most.max(zero).sqrt();
            let from = in_columns::<S>(screen, middle - half) - self.slack;
            let to = in_columns::<S>(screen, middle + half) + self.slack;
            // Where nothing is met, no column is before the row's first.
            let none = S::f64s::splat(simd, -1.0);
            put_ceil::<S>(
                screen,
                is_met.select(from, none),
                &mut spans.possible[0][first..],
            );
            put_count::<S>(
                screen,
                is_met.select(to, none),
                &mut spans.possible[1][first..],
            );
            let half = least.max(zero).sqrt();
            let from = in_columns::<S>(screen, middle - half) + self.slack;
            let to = in_columns::<S>(screen, middle + half) - self.slack;
            put_ceil::<S>(
                screen,
                is_certain.select(from, none),
                &mut spans.certain[0][first..],
            );
            put_count::<S>(
                screen,
                is_certain.select(to, none),
                &mut spans.certain[1][first..],
            );
        }
        spans
    }

    /// The rows that it can cross.
    fn rows(&self, screen: Screen) -> (u32, u32) {
        let ends = [-self.limit, self.limit].map(|m| self.off.zero + m / self.off.slope);
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        // A row more on either side is far more than rounding takes.
        let place = |y: f64| screen.half + y / 3.0;
        let rows = (
            screen.ceil(place(low) - 1.0),
            screen.count(place(high) + 1.0),
        );
        if low.is_finite() && high.is_finite() {
            rows
        } else {
            (0, screen.size)
        }
    }
}

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
        let y = screen.place(row);
        let mut spans = match &self.ellipse {
            Some(ellipse) => ellipse.cross(simd, y, screen),
            None => Spans::whole(screen.size),
        };
        for half_plane in self.half_planes {
            spans.and(&half_plane.cross(simd, y, screen).spans(screen.size));
        }
        let within = |limit: u32| limit.saturating_sub(row);
        spans.tidy((within(self.rows.0), within(self.rows.1)));
        spans
    }
}

/// Y of neighbouring rows and X of neighbouring columns, from the first.
const PLACES: [f64; ROWS] = [0.0, 3.0, 6.0, 9.0, 12.0, 15.0, 18.0, 21.0];

/// As many of them as there are lanes, from one on.
#[inline(always)]
pub(super) fn places<S: Simd>(simd: S, first: usize) -> S::f64s {
    S::f64s::from_slice(simd, &PLACES[first..first + S::f64s::LEN])
}

/// Places on the screen, in columns.
#[inline(always)]
pub(super) fn in_columns<S: Simd>(screen: Screen, x: S::f64s) -> S::f64s {
    x * (1.0 / 3.0) + screen.half
}

/// The first column at or after each place, given in columns.
#[inline(always)]
fn put_ceil<S: Simd>(screen: Screen, places: S::f64s, columns: &mut [u32]) {
    put_columns::<S>(screen, places.ceil(), columns);
}

/// The number of columns up to each place, given in columns.
#[inline(always)]
fn put_count<S: Simd>(screen: Screen, places: S::f64s, columns: &mut [u32]) {
    put_columns::<S>(screen, places.floor() + 1.0, columns);
}

/// Whole numbers, brought into the row.
#[inline(always)]
pub(super) fn put_columns<S: Simd>(screen: Screen, places: S::f64s, columns: &mut [u32]) {
    let columns_of_row = places.max(0.0).min(f64::from(screen.size));
    // With 2⁵² added, a whole number's bits are its own and the exponent's, which lies in the upper half.
    let shifted = columns_of_row + f64::from_bits((1023 + 52) << 52);
    for (column, place) in columns.iter_mut().zip(shifted.as_slice()) {
        *column = place.to_bits() as u32;
    }
}
