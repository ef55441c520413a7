//! The columns of a sphere in a band of rows: those that f64 can shade, those that face the light,
//! and those that may have a highlight.
//!
//! Along a row s = √(R² − m² − q²) is concave in q. So a [`LinearForm`] is concave if its factor of
//! s is not negative; if the factor is not positive, the form's negative is concave. Three
//! properties of a concave function f are used, for columns i < j:
//!
//! - If f(i) > 0 and f(j) > 0, then f > 0 between them.
//! - If f(i) < 0 and f(j) > 0, then f < 0 in all columns to the left of i.
//! - If f(i) < f(j), then f < f(i) in all columns to the left of i.
//!
//! So the columns in which f changes sign are guessed, by the roots of a quadratic equation. f is
//! evaluated beside them, with its bound as in `shade/sphere.rs`. If the signs are certain there,
//! they are certain in the whole row; if not, the row is left in doubt.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch};

use crate::number::rounding::U;
use crate::tracer::scanline::grid::{Columns, Grid, ROWS, offsets};
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::shade::sphere::{LinearForm, SphereConstants, ZONES};
use crate::tracer::view_space::PIXEL;

/// If rounding moves a root by more columns than this, the guess is rejected.
const NUDGE: f64 = 1.0 / (1 << 20) as f64;

/// A half-open range of columns in each row of a band: where it begins, and where it ends.
type Intervals = [[u32; ROWS]; 2];

/// The columns of a sphere in a band of rows.
#[derive(Clone, Default)]
pub(crate) struct SphereBand {
    /// The columns in the zones: so far inside the outline that f64 shades them with bounds.
    shadeable: Intervals,
    /// The columns in each zone but the outermost, with all zones inside.
    zones: [Intervals; ZONES - 1],
    /// The columns that face the light.
    facing: Arcs,
    /// The columns that may have a highlight.
    bright: Intervals,
    /// The casters that may cast a shadow on a shadeable column, by [`bit_of`].
    casters: u64,
}

/// The bit of a caster's number. Casters may share a bit.
pub(crate) fn bit_of(caster: usize) -> u64 {
    1 << (caster % 64)
}

/// The sign of a form that is concave or convex.
#[derive(Clone, Default)]
struct Arcs {
    /// The columns in which a concave form is positive, or a convex one negative.
    inside: Intervals,
    is_concave: bool,
    /// A bit for each row: whether `inside` is certain.
    certain: u64,
}

/// The columns of a sphere in a row, as in [`SphereBand`].
#[derive(Clone, Copy)]
pub(crate) struct SphereColumns {
    pub(crate) shadeable: Columns,
    pub(crate) zones: [Columns; ZONES - 1],
    pub(crate) bright: Columns,
    pub(crate) casters: u64,
    /// Some columns, and whether they face the light; all others do the opposite. `None` where each
    /// column must be tested.
    pub(crate) facing: Option<(Columns, bool)>,
}

/// The columns of spheres in the band that is traced now, computed when first needed.
#[derive(Default)]
pub(crate) struct SphereCache {
    /// By the sphere's number among those that are shaded.
    cache: Vec<SphereBand>,
    /// For each, the first row of the band that it was computed for.
    first: Vec<Option<u32>>,
}

impl SphereCache {
    /// Prepares for so many spheres of a frame.
    pub(crate) fn begin(&mut self, count: usize) {
        self.first.clear();
        self.first.resize(count, None);
        if self.cache.len() < count {
            self.cache.resize(count, SphereBand::default());
        }
    }

    /// The columns of a sphere in a row.
    pub(crate) fn of(
        &mut self,
        shaded: &ShadedSphere<'_>,
        row: u32,
        level: Level,
        grid: Grid,
    ) -> SphereColumns {
        let (number, sphere) = (shaded.number, &shaded.constants);
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
    /// The columns in one of the rows.
    pub(crate) fn row(&self, row: usize) -> SphereColumns {
        let of = |intervals: &Intervals| (intervals[0][row], intervals[1][row]);
        let Arcs {
            inside,
            is_concave,
            certain,
        } = &self.facing;
        SphereColumns {
            shadeable: of(&self.shadeable),
            zones: [of(&self.zones[0]), of(&self.zones[1])],
            bright: of(&self.bright),
            casters: self.casters,
            facing: (certain >> row & 1 == 1).then(|| (of(inside), *is_concave)),
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
        let hits = shaded.constants.hit_box(columns, (row(low), row(high)));
        let casters = shaded.casters.iter().enumerate();
        let near = casters.filter(|(_, caster)| !caster.misses(shaded.constants.lighting, &hits));
        near.fold(0, |all, (number, _)| all | bit_of(number))
    }

    /// Computes all but the casters, for the rows from `first` on.
    #[inline(always)]
    pub(crate) fn find<S: Simd>(
        &mut self,
        simd: S,
        sphere: &SphereConstants<'_>,
        first: u32,
        grid: Grid,
    ) {
        self.facing.is_concave = sphere.n_dot_l.is_concave == Some(true);
        self.facing.certain = 0;
        self.bright = Intervals::default();
        for lane in (0..ROWS).step_by(S::f64s::LEN) {
            let y = offsets(simd, lane) + grid.coordinate(first);
            let m = sphere.m.of_rows::<S>(y);
            let rows = RowLanes {
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
            if sphere.has_shadows {
                let (inside, certain) = rows.arc(&sphere.n_dot_l, 0.0, shadeable);
                store::<S>(inside, &mut self.facing.inside, lane);
                self.facing.certain |= certain.to_bitmask() << lane;
            }
            if let Some(highlight) = &sphere.highlight {
                let threshold = sphere.lighting.highlight.threshold;
                // |n − h| is no less than its component along the axis of m.
                let is_near = (m * sphere.inverse_radius - sphere.lighting.highlight.halfway[1])
                    .abs()
                    .simd_le(highlight.max_distance);
                if is_near.any_true() {
                    let (inside, certain) = rows.arc(&highlight.form, threshold, shadeable);
                    let mut bright = shadeable;
                    if highlight.form.is_concave == Some(true) {
                        bright = select::<S>(certain, inside, shadeable);
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
struct RowLanes<'b, S: Simd> {
    simd: S,
    sphere: &'b SphereConstants<'b>,
    grid: Grid,
    /// m of each row.
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
    for (numbers, columns) in ends.iter().zip(intervals) {
        // With 2⁵² added, a whole number's bits are its own and the exponent's, which lies in the
        // upper half.
        let shifted = *numbers + f64::from_bits((1023 + 52) << 52);
        for (column, number) in columns[lane..].iter_mut().zip(shifted.as_slice()) {
            *column = number.to_bits() as u32;
        }
    }
}

/// X in columns.
#[inline(always)]
fn in_columns<S: Simd>(grid: Grid, x: S::f64s) -> S::f64s {
    x * (1.0 / PIXEL) + grid.half
}

// No vectors in closures below: see `shade/run.rs`.

impl<S: Simd> RowLanes<'_, S> {
    /// q in a column of each row.
    #[inline(always)]
    fn q(&self, column: S::f64s) -> S::f64s {
        (column - self.grid.half) * PIXEL - self.sphere.center_x
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
        // s² falls from the middle to both ends, also as f64 computes it: so what holds at both
        // ends holds between them.
        let (a, b) = (self.q(from), self.q(to - 1.0));
        let is_inside =
            (self.squared - a * a).simd_ge(min_square) & (self.squared - b * b).simd_ge(min_square);
        let is_chord = is_inside & from.simd_lt(to);
        [is_chord.select(from, zero), is_chord.select(to, zero)]
    }

    /// The form minus `level`, times `sign`, in a column of each row.
    #[inline(always)]
    fn above(&self, form: &LinearForm, level: f64, sign: f64, column: S::f64s) -> S::f64s {
        let q = self.q(column);
        let s = (self.squared - q * q).sqrt();
        (self.m * form.m + form.constant + q * form.q + s * form.s - level) * sign
    }

    /// The columns among `shadeable` in which a concave form is above `level`, or a convex one
    /// below; and the rows for which that is certain of these and of all other columns.
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
        // At a root with r + a q > 0, r + a q − o s is 0, and F is positive up to the chord's end.
        let from_end = !has_roots | (low * a + r).simd_gt(zero);
        let to_end = !has_roots | (high * a + r).simd_gt(zero);
        let (low, high) = (low + self.sphere.center_x, high + self.sphere.center_x);
        let from = in_columns::<S>(self.grid, low).ceil().max(first);
        let to = (in_columns::<S>(self.grid, high).floor() + one).min(end);
        let from = from_end.select(first, from);
        let to = to_end.select(end, to);
        let is_none = (!has_roots & r.simd_lt(zero)) | from.simd_ge(to);
        // F is largest at q/s = a/o.
        let top = (self.squared.max(zero) * inverse).sqrt() * a + self.sphere.center_x;
        let top = in_columns::<S>(self.grid, top).floor();
        let top = top.min(last - one).max(first);
        // The columns beside each end of the guess, on either side of it. If the guess is empty,
        // the four columns around the top.
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
        let certain = (is_none & none_in) | (!is_none & is_in & begins & ends) | first.simd_ge(end);
        let from = is_none.select(first, from);
        let to = is_none.select(first, to);
        ([from, to], certain)
    }
}
