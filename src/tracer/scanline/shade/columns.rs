//! A sphere in neighbouring rows: which of its pixels can be shaded at once, and which need not be
//! asked where they face.
//!
//! Along a row s = √(R² − m² − q²) is concave in q. So a [`LinearForm`] is concave where s is
//! multiplied with what is not negative, and convex where it is multiplied with what is not
//! positive; its negative is concave then. A concave function is positive between any two columns
//! in which it is positive. Where it is negative in one column and positive in one to the right of
//! it, it is negative in all columns to the left of the first: were it not in one of them, it would
//! be no less than the least of that and the second, between them. And where it is less in a column
//! than in the next, it is less still in all columns before.
//!
//! So the columns where it changes sign may be guessed, by the roots of a quadratic equation. The
//! form is asked in few columns beside these, with its bound as in `shade/sphere.rs`, and what they
//! tell of all others is certain. Where they do not, the row is left unsettled.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch};

use crate::tracer::scanline::grid::{Columns, Grid, ROWS, in_columns, offsets, store_columns};
use crate::tracer::scanline::rounding::U;
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::shade::sphere::{LinearForm, RowSphere, ZONES};

/// Rounding moves a place by less than so many columns; where that is not so, what is guessed with
/// it is found to be wrong.
const NUDGE: f64 = 1.0 / (1 << 20) as f64;

/// A half-open range of columns in each row of a band: where it begins, and where it ends.
type Intervals = [[u32; ROWS]; 2];

/// What is known of a sphere's pixels in a band of rows.
#[derive(Clone)]
pub(crate) struct SphereBand {
    /// Those that are hit deep enough inside the outline for f64 to say anything.
    shadeable: Intervals,
    /// Those in each zone but the outermost.
    zones: [Intervals; ZONES - 1],
    facing: Arcs,
    /// Those outside of which there is certainly no highlight.
    bright: Intervals,
    /// The casters that may cast a shadow on any of them, by [`bit_of`].
    casters: u64,
}

/// The bit of a caster by its number, which it may have in common with others.
pub(crate) fn bit_of(caster: usize) -> u64 {
    1 << (caster % 64)
}

/// The columns in which a form that is concave or convex is positive.
#[derive(Clone)]
struct Arcs {
    /// Where it is positive, if it is concave; where it is negative, if it is convex.
    inside: Intervals,
    is_concave: bool,
    /// Bit by bit, the rows of which this is certain.
    settled: u64,
}

/// What is known of a sphere's pixels in a row.
#[derive(Clone, Copy)]
pub(crate) struct SphereColumns {
    pub(crate) shadeable: Columns,
    pub(crate) zones: [Columns; ZONES - 1],
    pub(crate) bright: Columns,
    /// The casters that may cast a shadow on them, by [`bit_of`].
    pub(crate) casters: u64,
    /// The columns in which it faces the light, or those in which it does not; `None` where each
    /// is to be asked.
    pub(crate) facing: Option<(Columns, bool)>,
}

/// What is known of spheres in the rows that are traced now, found when it is first asked for.
#[derive(Default)]
pub(crate) struct SphereCache {
    cache: Vec<SphereBand>,
    /// For each, the first of the rows that it is of.
    first: Vec<Option<u32>>,
}

impl SphereCache {
    /// Prepares for so many spheres of a frame.
    pub(crate) fn begin(&mut self, count: usize) {
        self.first.clear();
        self.first.resize(count, None);
        if self.cache.len() < count {
            self.cache.resize(count, SphereBand::NONE);
        }
    }

    /// A sphere in a row.
    pub(crate) fn of(
        &mut self,
        shaded: &ShadedSphere<'_>,
        row: u32,
        level: Level,
        grid: Grid,
    ) -> SphereColumns {
        let (number, sphere) = (shaded.number, &shaded.sphere);
        let within = row % ROWS as u32;
        let first = row - within;
        if self.first[number] != Some(first) {
            self.first[number] = Some(first);
            let cache = &mut self.cache[number];
            dispatch!(level, simd => cache.find(simd, sphere, first, grid));
            cache.casters = cache.casters_near(shaded, first, grid);
        }
        self.cache[number].row(within as usize)
    }
}

impl SphereBand {
    pub(crate) const NONE: SphereBand = SphereBand {
        shadeable: [[0; ROWS]; 2],
        zones: [[[0; ROWS]; 2]; ZONES - 1],
        facing: Arcs {
            inside: [[0; ROWS]; 2],
            is_concave: true,
            settled: 0,
        },
        bright: [[0; ROWS]; 2],
        casters: 0,
    };

    /// In one of the rows.
    pub(crate) fn row(&self, row: usize) -> SphereColumns {
        let of = |intervals: &Intervals| (intervals[0][row], intervals[1][row]);
        let Arcs {
            inside,
            is_concave,
            settled,
        } = &self.facing;
        SphereColumns {
            shadeable: of(&self.shadeable),
            zones: [of(&self.zones[0]), of(&self.zones[1])],
            bright: of(&self.bright),
            casters: self.casters,
            facing: (settled >> row & 1 == 1).then(|| (of(inside), *is_concave)),
        }
    }

    /// The casters that may cast a shadow on any of the shadeable pixels.
    fn casters_near(&self, shaded: &ShadedSphere<'_>, first: u32, grid: Grid) -> u64 {
        if shaded.casters.is_empty() {
            return 0;
        }
        let [from, to] = &self.shadeable;
        let is_met = |row: &usize| from[*row] < to[*row];
        let (Some(low), Some(high)) = ((0..ROWS).find(is_met), (0..ROWS).rfind(is_met)) else {
            return 0;
        };
        let rows = low..high + 1;
        let begin = from[rows.clone()].iter().fold(u32::MAX, |a, &b| a.min(b));
        let end = to[rows].iter().fold(0, |a, &b| a.max(b));
        let columns = (grid.coordinate(begin), grid.coordinate(end - 1));
        let row = |row: usize| grid.coordinate(first + row as u32);
        let hits = shaded.sphere.hit_box(columns, (row(low), row(high)));
        let casters = shaded.casters.iter().enumerate();
        let near = casters.filter(|(_, caster)| !caster.misses(&hits));
        near.fold(0, |all, (number, _)| all | bit_of(number))
    }

    /// Finds all but the casters, of the rows from `first` on.
    #[inline(always)]
    pub(crate) fn find<S: Simd>(&mut self, simd: S, sphere: &RowSphere, first: u32, grid: Grid) {
        self.facing.is_concave = sphere.light.is_concave == Some(true);
        self.facing.settled = 0;
        self.bright = SphereBand::NONE.bright;
        for lane in (0..ROWS).step_by(S::f64s::LEN) {
            let y = offsets::<S>(simd, lane) + grid.coordinate(first);
            let m = sphere.m.of_rows::<S>(y);
            let rows = InRows {
                simd,
                sphere,
                grid,
                m,
                squared: -(m * m) + sphere.squared_radius,
            };
            let [innermost, inner, outermost] = sphere.min_squares;
            let shadeable = rows.chord(outermost);
            store::<S>(shadeable, &mut self.shadeable, lane);
            store::<S>(rows.chord(innermost), &mut self.zones[0], lane);
            store::<S>(rows.chord(inner), &mut self.zones[1], lane);
            if sphere.shadows {
                let (inside, settled) = rows.arc(&sphere.light, 0.0, shadeable);
                store::<S>(inside, &mut self.facing.inside, lane);
                self.facing.settled |= settled.to_bitmask() << lane;
            }
            if let Some(highlight) = &sphere.highlight {
                // |n − h| is no less than its component along the axis of m.
                let is_near = (m * sphere.inverse_radius - highlight.halfway[1])
                    .abs()
                    .simd_le(highlight.max_distance);
                if is_near.any_true() {
                    let (inside, settled) = rows.arc(&highlight.form, sphere.threshold, shadeable);
                    let mut bright = shadeable;
                    if highlight.form.is_concave == Some(true) {
                        bright = select::<S>(settled, inside, shadeable);
                    }
                    let none = [S::f64s::splat(simd, 0.0); 2];
                    let bright = select::<S>(is_near, bright, none);
                    store::<S>(bright, &mut self.bright, lane);
                }
            }
        }
    }
}

/// A sphere in as many rows as there are lanes.
struct InRows<'b, S: Simd> {
    simd: S,
    sphere: &'b RowSphere,
    grid: Grid,
    m: S::f64s,
    /// R² − m².
    squared: S::f64s,
}

/// Where an interval begins and ends in as many rows as there are lanes: whole numbers of columns.
type Ends<V> = [V; 2];

#[inline(always)]
fn select<S: Simd>(mask: S::mask64s, yes: Ends<S::f64s>, no: Ends<S::f64s>) -> Ends<S::f64s> {
    [mask.select(yes[0], no[0]), mask.select(yes[1], no[1])]
}

#[inline(always)]
fn store<S: Simd>(ends: Ends<S::f64s>, intervals: &mut Intervals, lane: usize) {
    store_columns::<S>(ends[0], &mut intervals[0][lane..]);
    store_columns::<S>(ends[1], &mut intervals[1][lane..]);
}

// No closures below: see `shade/run.rs`.

impl<S: Simd> InRows<'_, S> {
    /// q in a column of each row.
    #[inline(always)]
    fn q(&self, column: S::f64s) -> S::f64s {
        (column - self.grid.half) * 3.0 - self.sphere.center_x
    }

    /// The columns in which s² is at least `min_square`. Columns at the ends may be missing.
    #[inline(always)]
    fn chord(&self, min_square: f64) -> Ends<S::f64s> {
        let (zero, size) = (S::f64s::splat(self.simd, 0.0), f64::from(self.grid.size));
        let half = (self.squared - min_square).max(zero).sqrt();
        let middle = S::f64s::splat(self.simd, self.sphere.center_x);
        let from = (in_columns::<S>(self.grid, middle - half) + NUDGE).ceil();
        let to = (in_columns::<S>(self.grid, middle + half) - NUDGE).floor() + 1.0;
        let (from, to) = (from.max(zero).min(size), to.max(zero).min(size));
        // s² falls from the middle to both ends, also as f64 computes it: so what holds at both ends
        // holds between them.
        let (a, b) = (self.q(from), self.q(to - 1.0));
        let is_inside =
            (self.squared - a * a).simd_ge(min_square) & (self.squared - b * b).simd_ge(min_square);
        let is_chord = is_inside & from.simd_lt(to);
        [is_chord.select(from, zero), is_chord.select(to, zero)]
    }

    /// How much a form is more than `level` in a column of each row, or less if it is convex.
    #[inline(always)]
    fn above(&self, form: &LinearForm, level: f64, sign: f64, column: S::f64s) -> S::f64s {
        let q = self.q(column);
        let s = (self.squared - q * q).sqrt();
        (self.m * form.m + form.constant + q * form.q + s * form.s - level) * sign
    }

    /// Of the columns `shadeable` those in which a form is above `level`, if it is concave, or below,
    /// if it is convex; and in which rows it certainly is there, and not in the others.
    #[inline(always)]
    fn arc(
        &self,
        form: &LinearForm,
        level: f64,
        shadeable: Ends<S::f64s>,
    ) -> (Ends<S::f64s>, S::mask64s) {
        let none = S::mask64s::splat(self.simd, false);
        let sign = match form.is_concave {
            Some(true) => 1.0,
            Some(false) => -1.0,
            None => return (shadeable, none),
        };
        // The form is F = r + a q + o s, with o ≥ 0, and 0 at (r + a q)² = o² s².
        let (a, o) = (form.q * sign, form.s * sign);
        let norm = a * a + o * o;
        let inverse = 1.0 / norm;
        if !inverse.is_finite() {
            return (shadeable, none);
        }
        let zero = S::f64s::splat(self.simd, 0.0);
        let one = S::f64s::splat(self.simd, 1.0);
        let [first, end] = shadeable;
        let last = end - one;
        let r = (self.m * form.m + form.constant - level) * sign;
        let discriminant = self.squared * norm - r * r;
        let has_roots = discriminant.simd_ge(zero);
        let root = discriminant.max(zero).sqrt() * o;
        let middle = -(r * a);
        let (low, high) = ((middle - root) * inverse, (middle + root) * inverse);
        // Where r + a q > 0, F is 0 with the other sign of s, and positive at the end of the chord.
        let from_end = !has_roots | (low * a + r).simd_gt(zero);
        let to_end = !has_roots | (high * a + r).simd_gt(zero);
        let (low, high) = (low + self.sphere.center_x, high + self.sphere.center_x);
        let from = in_columns::<S>(self.grid, low).ceil().max(first);
        let to = (in_columns::<S>(self.grid, high).floor() + one).min(end);
        let from = from_end.select(first, from);
        let to = to_end.select(end, to);
        let is_none = (!has_roots & r.simd_lt(zero)) | from.simd_ge(to);
        // It is most at q/s = a/o.
        let top = (self.squared.max(zero) * inverse).sqrt() * a + self.sphere.center_x;
        let top = in_columns::<S>(self.grid, top).floor();
        let top = top.min(last - one).max(first);
        // The last column before those, the first and the last of them, and the next; or of none,
        // two columns on either side of the top.
        let columns = [
            is_none.select(top - one, from - one),
            is_none.select(top, from),
            is_none.select(top + one, to - one),
            is_none.select(top + one + one, to),
        ];
        let mut values = [zero; 4];
        for (value, column) in values.iter_mut().zip(columns) {
            let column = column.max(first).min(last);
            *value = self.above(form, level, sign, column);
        }
        let [before, begin, finish, after] = values;
        let error = form.error + 4.0 * U * level.abs();
        let is_out = before.simd_lt(-error) & after.simd_lt(-error);
        let is_in = begin.simd_gt(error) & finish.simd_gt(error);
        let begins = from.simd_le(first) | before.simd_lt(-error);
        let ends = to.simd_ge(end) | after.simd_lt(-error);
        let rises = (top - one).simd_le(first) | (begin - before).simd_gt(4.0 * error);
        let falls = (top + one + one).simd_ge(last) | (finish - after).simd_gt(4.0 * error);
        let none_in = is_out & begin.simd_lt(-error) & finish.simd_lt(-error) & rises & falls;
        let settled = (is_none & none_in) | (!is_none & is_in & begins & ends) | first.simd_ge(end);
        let from = is_none.select(first, from);
        let to = is_none.select(first, to);
        ([from, to], settled)
    }
}
