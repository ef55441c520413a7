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

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch};

use super::span::{ROWS, Spans};
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

    /// The first column at or after each place, given in columns: a whole number.
    #[inline(always)]
    fn ceil_all<S: Simd>(&self, places: S::f64s) -> S::f64s {
        places.ceil().max(0.0).min(f64::from(self.size))
    }

    /// The number of columns up to each place, given in columns.
    #[inline(always)]
    fn count_all<S: Simd>(&self, places: S::f64s) -> S::f64s {
        (places.floor() + 1.0).max(0.0).min(f64::from(self.size))
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
    crossing: Crossing,
}

/// How rows cross a border.
enum Crossing {
    /// At `at` + `per_row` Y in columns, and at most `slack` columns beside that; the half-plane is to the right of it, or to the left.
    Right(Root),
    Left(Root),
    /// Not to be told from not at all. A bound on the error of the sum but for the part of Y.
    Never {
        error: f64,
    },
}

struct Root {
    at: f64,
    per_row: f64,
    slack: f64,
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
        // The errors of the coefficients.
        let carried = constant.error() + (column.error() + row.error()) * reach;
        let magnitude = constant.value().abs() + row.value().abs() * reach;
        let across = column.value().abs() * reach;
        // In columns the root is N/2 − (constant + row · Y)/(3 · column). The errors move it by that part of theirs. The inverse of
        // 3 · column rounds by 2u, `at` and `per_row` by 2u more, the product with Y and the sum with it by u each: less than 8u of the
        // terms' magnitudes, and of N/2 and the root, which is below 3N where it matters.
        let inverse = 1.0 / (3.0 * column.value());
        let root = Root {
            at: screen.half - constant.value() * inverse,
            per_row: -(row.value() * inverse),
            slack: ((carried + 8.0 * U * magnitude) * inverse.abs()
                + 16.0 * U * 3.0 * f64::from(screen.size))
                * MORE,
        };
        let is_known = root.at.is_finite() && root.per_row.is_finite() && root.slack.is_finite();
        // The sum rounds by less than 2u of its terms twice.
        let error = (carried + 4.0 * U * magnitude) * MORE;
        let crossing = match inverse > 0.0 {
            _ if !is_known || across <= error => Crossing::Never {
                error: (error + across) * MORE,
            },
            true => Crossing::Right(root),
            false => Crossing::Left(root),
        };
        HalfPlane {
            constant,
            column,
            row,
            closed,
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

    /// The same, asked only where its border may be.
    fn decide_near(&self, x: f64, y: f64, screen: Screen) -> Option<bool> {
        let (root, rightward) = match &self.crossing {
            Crossing::Right(root) => (root, true),
            Crossing::Left(root) => (root, false),
            Crossing::Never { .. } => return self.decide(x, y),
        };
        let beyond = screen.half + x / 3.0 - (y * root.per_row + root.at);
        if beyond.abs() > root.slack * MORE + U * (beyond.abs() + f64::from(screen.size)) {
            Some((beyond > 0.0) == rightward)
        } else {
            self.decide(x, y)
        }
    }

    /// Brings in what it has of as many rows as there are lanes.
    #[inline(always)]
    fn cut<S: Simd>(&self, simd: S, y: S::f64s, reaches: &mut Reaches<S::f64s>) {
        let Reaches { possible, certain } = reaches;
        match &self.crossing {
            Crossing::Right(root) => {
                let place = y * root.per_row + root.at;
                possible[0] = possible[0].max(place - root.slack);
                certain[0] = certain[0].max(place + root.slack);
            }
            Crossing::Left(root) => {
                let place = y * root.per_row + root.at;
                possible[1] = possible[1].min(place + root.slack);
                certain[1] = certain[1].min(place - root.slack);
            }
            Crossing::Never { error } => {
                let sum = y * self.row.value() + self.constant.value();
                let is_in = sum.simd_gt(*error);
                if !is_in.all_true() {
                    let mut is_in = is_in.to_bitmask();
                    let mut is_out = sum.simd_lt(-*error).to_bitmask();
                    if self.column.is_zero() {
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

/// Where columns begin and end in as many rows as there are lanes, given in columns: the first at or after a place, up to another place.
struct Reaches<V> {
    possible: [V; 2],
    certain: [V; 2],
}

/// No column lies up to this place.
const NOWHERE: f64 = -1.0;

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

    /// What it has of as many rows as there are lanes.
    #[inline(always)]
    fn reaches<S: Simd>(&self, simd: S, y: S::f64s, screen: Screen) -> Reaches<S::f64s> {
        let zero = S::f64s::splat(simd, 0.0);
        let none = S::f64s::splat(simd, NOWHERE);
        if !self.is_bounded {
            let all = S::f64s::splat(simd, f64::from(screen.size));
            return Reaches {
                possible: [zero, all],
                certain: [zero, none],
            };
        }
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
        let possible = [from, is_met.select(to, none)];
        let half = least.max(zero).sqrt();
        let from = in_columns::<S>(screen, middle - half) + self.slack;
        let to = in_columns::<S>(screen, middle + half) - self.slack;
        let certain = [from, is_certain.select(to, none)];
        Reaches { possible, certain }
    }

    /// Whether it is known to hold the pixel at X, Y, or known not to.
    fn decide(&self, x: f64, y: f64, screen: Screen) -> Option<bool> {
        let [possible, certain] = dispatch!(Level::baseline(), simd => {
            let y = splat(simd, y);
            let Reaches { possible, certain } = self.reaches(simd, y, screen);
            [possible, certain].map(|ends| ends.map(|end| end.as_slice()[0]))
        });
        let column = screen.half + x / 3.0;
        if column < possible[0] || column > possible[1] {
            return Some(false);
        }
        (certain[0] <= column && column <= certain[1]).then_some(true)
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

#[inline(always)]
fn splat<S: Simd>(simd: S, x: f64) -> S::f64s {
    S::f64s::splat(simd, x)
}

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

/// Whole numbers of columns, below 2³².
#[inline(always)]
pub(super) fn put_columns<S: Simd>(places: S::f64s, columns: &mut [u32]) {
    // With 2⁵² added, a whole number's bits are its own and the exponent's, which lies in the upper half.
    let shifted = places + f64::from_bits((1023 + 52) << 52);
    for (column, place) in columns.iter_mut().zip(shifted.as_slice()) {
        *column = place.to_bits() as u32;
    }
}
