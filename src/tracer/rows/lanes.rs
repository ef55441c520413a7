//! Many pixels of a row at a time.

use std::ops::Range;

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use super::ball::{Ball, Form, Halfway, Stretch};
use super::paint::{Paint, fill};
use super::shape::{MORE, Screen, U, places};
use super::solids::ShadedBall;
use crate::number::Bounded;
use crate::tracer::decision::Decision;

/// What may stand between a pixel of a sphere and the light.
pub(super) enum Caster<'f> {
    /// Any point within all of these half-spaces is in its shadow.
    Cell(&'f [Form]),
    /// Any point that is before it, and from which the way to the light passes its centre near enough.
    Ball(&'f Passing),
}

/// Points in the shadow of a ball.
pub(super) struct Passing {
    pub(super) before: Form,
    /// The components of a vector, of which the squared length is at most `reach`; a bound on the error of the difference.
    pub(super) moment: [Form; 3],
    pub(super) reach: f64,
    error: f64,
}

/// What the shading of a run needs, kept for the next.
#[derive(Default)]
pub(super) struct Shading {
    /// Which casters can throw a shadow on any pixel of the run.
    pub(super) in_reach: Vec<usize>,
    /// The columns left in doubt.
    pub(super) doubts: Vec<u32>,
}

/// The pixels of a run: where they are, and where they go.
pub(super) struct Run<'r> {
    pub(super) screen: Screen,
    /// Y.
    pub(super) y: f64,
    /// The first column.
    pub(super) from: u32,
    pub(super) samples: &'r mut [f32],
    pub(super) decisions: Option<&'r mut [Decision]>,
    /// What pixels in shadow show.
    pub(super) in_shadow: &'r Paint,
    pub(super) shading: &'r mut Shading,
}

// No closures below: the instructions of a level are only there for what is inlined into its dispatch, which closures
// given to other functions are not.

impl Run<'_> {
    /// Writes the decisions of some pixels, bit by bit in shadow or not.
    #[inline(always)]
    pub(super) fn decide(&mut self, shaded: &ShadedBall<'_>, pixels: Range<usize>, in_shadow: u64) {
        if let Some(decisions) = &mut self.decisions {
            for (i, decision) in decisions[pixels].iter_mut().enumerate() {
                *decision = if in_shadow >> i & 1 == 1 {
                    self.in_shadow.decision
                } else {
                    shaded.lit
                };
            }
        }
    }
}

/// As many pixels as f64 lanes: where they are hit, and bit by bit which are turned away from the light, and of which all this is known.
pub(super) struct Hits<V, M> {
    pub(super) q: V,
    pub(super) s: V,
    /// n·l.
    pub(super) light: V,
    /// Which are in the innermost zone.
    deep: M,
    turned_away: u64,
    pub(super) known: u64,
}

/// A linear form along a row.
#[derive(Clone, Copy)]
pub(super) struct Along<V> {
    row: V,
    across: V,
    out: V,
}

/// Shades a run of pixels that see a sphere.
#[inline(always)]
pub(super) fn shade<S: Simd>(simd: S, shaded: &ShadedBall<'_>, run: &mut Run<'_>) {
    let ball = &shaded.ball;
    let width = S::f32s::LEN;
    let half = S::f64s::LEN;
    let m = ball.off.at(run.y);
    let light = along(simd, &ball.light, m);
    let count = run.samples.len() / 3;
    let zero = S::f32s::splat(simd, 0.0);
    let mut first = 0;
    while first < count {
        let x = run.screen.place(run.from + first as u32);
        let low = hits(simd, ball, &light, m, x);
        let high = hits(simd, ball, &light, m, x + 3.0 * half as f64);
        let mut in_shadow = low.turned_away | high.turned_away << half;
        let mut known = low.known | high.known << half;
        let here = width.min(count - first);
        let all = u64::MAX >> (64 - here);
        if ball.shadows && in_shadow & all != all {
            let casters = &shaded.casters;
            let (low_dark, low_known) = shadowed(simd, ball, casters, run.shading, m, &low);
            let (high_dark, high_known) = shadowed(simd, ball, casters, run.shading, m, &high);
            in_shadow |= low_dark | high_dark << half;
            known &= low_known | high_known << half;
        }
        let samples = &mut run.samples[3 * first..3 * (first + here)];
        if in_shadow & all == all {
            fill(simd, samples, run.in_shadow);
        } else {
            let (low_lower, low_upper) = lit(simd, ball, m, &low);
            let (high_lower, high_upper) = lit(simd, ball, m, &high);
            let dark = S::mask32s::from_bitmask(simd, in_shadow);
            let mut channels = [zero; 3];
            for i in 0..3 {
                let lower = low_lower[i].narrow(high_lower[i]);
                let upper = low_upper[i].narrow(high_upper[i]);
                known &= lower.simd_eq(upper).to_bitmask() | in_shadow;
                // + 0 turns −0 into +0.
                let shadow = S::f32s::splat(simd, run.in_shadow.color()[i]);
                channels[i] = dark.select(shadow, upper + zero);
            }
            let [red, green, blue] = &channels;
            interleave(samples, red.as_slice(), green.as_slice(), blue.as_slice());
        }
        run.decide(shaded, first..first + here, in_shadow);
        let mut doubts = !known & all;
        while doubts != 0 {
            run.shading
                .doubts
                .push(run.from + first as u32 + doubts.trailing_zeros());
            doubts &= doubts - 1;
        }
        first += here;
    }
}

/// Red, green and blue, pixel by pixel.
#[inline(always)]
pub(super) fn interleave(samples: &mut [f32], red: &[f32], green: &[f32], blue: &[f32]) {
    let channels = red.iter().zip(green).zip(blue);
    for (pixel, ((&red, &green), &blue)) in samples.chunks_exact_mut(3).zip(channels) {
        pixel[0] = red;
        pixel[1] = green;
        pixel[2] = blue;
    }
}

#[inline(always)]
pub(super) fn along<S: Simd>(simd: S, form: &Form, m: f64) -> Along<S::f64s> {
    Along {
        row: S::f64s::splat(simd, form.of_row(m)),
        across: S::f64s::splat(simd, form.across),
        out: S::f64s::splat(simd, form.out),
    }
}

/// The value of a form at some pixels.
#[inline(always)]
pub(super) fn value<S: Simd>(form: &Along<S::f64s>, q: S::f64s, s: S::f64s) -> S::f64s {
    form.row + q * form.across + s * form.out
}

#[inline(always)]
pub(super) fn hits<S: Simd>(
    simd: S,
    ball: &Ball,
    light: &Along<S::f64s>,
    m: f64,
    x: f64,
) -> Hits<S::f64s, S::mask64s> {
    let q = places::<S>(simd, 0) + x - ball.center;
    let squared = S::f64s::splat(simd, ball.squared_radius - m * m) - q * q;
    let deep = squared.simd_ge(ball.least[0]);
    let known = squared.simd_ge(ball.least[1]);
    let s = squared.sqrt();
    let light = value::<S>(light, q, s);
    let turned_away = if ball.shadows {
        light.simd_lt(-ball.light.error).to_bitmask()
    } else {
        0
    };
    Hits {
        q,
        s,
        light,
        deep,
        turned_away,
        known: known.to_bitmask(),
    }
}

/// Which pixels are in shadow, and of which it is known.
#[inline(always)]
fn shadowed<S: Simd>(
    simd: S,
    ball: &Ball,
    casters: &[Caster<'_>],
    shading: &Shading,
    m: f64,
    hits: &Hits<S::f64s, S::mask64s>,
) -> (u64, u64) {
    let mut in_shadow = S::mask64s::from_bitmask(simd, hits.turned_away);
    let mut settled = in_shadow | hits.light.simd_gt(ball.light.error);
    for &caster in &shading.in_reach {
        let (inside, outside) = behind(simd, &casters[caster], m, hits);
        in_shadow |= inside;
        settled &= inside | outside;
    }
    (in_shadow.to_bitmask(), (in_shadow | settled).to_bitmask())
}

/// Bounds on the samples of pixels in the light.
#[inline(always)]
pub(super) fn lit<S: Simd>(
    simd: S,
    ball: &Ball,
    m: f64,
    hits: &Hits<S::f64s, S::mask64s>,
) -> ([S::f64s; 3], [S::f64s; 3]) {
    let zero = S::f64s::splat(simd, 0.0);
    let light = hits.light.max(zero);
    let mut samples = [zero; 3];
    for (sample, channel) in samples.iter_mut().zip(&ball.channels) {
        *sample = light * channel.diffuse + channel.ambient;
    }
    let [deep, shallow] = ball.errors;
    let error = S::f64s::splat(simd, shallow);
    let error = hits.deep.select(S::f64s::splat(simd, deep), error);
    let mut errors = [error; 3];
    if let Some(halfway) = &ball.halfway {
        let x = value::<S>(&along(simd, &halfway.form, m), hits.q, hits.s);
        if x.simd_gt(ball.highlight).any_true() {
            let (power, power_error) = highlight(simd, ball, halfway, m, hits);
            for i in 0..3 {
                let specular = ball.channels[i].specular;
                samples[i] += power * specular;
                errors[i] += power_error * specular.abs();
            }
        }
    }
    let (mut lower, mut upper) = (samples, samples);
    for i in 0..3 {
        lower[i] -= errors[i];
        upper[i] += errors[i];
    }
    (lower, upper)
}

/// (n·h)ⁿ, and a bound on its error.
#[inline(always)]
fn highlight<S: Simd>(
    simd: S,
    ball: &Ball,
    halfway: &Halfway,
    m: f64,
    hits: &Hits<S::f64s, S::mask64s>,
) -> (S::f64s, S::f64s) {
    let [across, off, out] = halfway.at;
    let (across, off, out) = (hits.q - across, m - off, hits.s - out);
    let squared = across * across + out * out + off * off;
    // 1 − n·h = |n − h|²/2 is small, and known to a small relative error, where the highlight is bright.
    let scale = 0.5 * ball.inverse_radius * ball.inverse_radius;
    let missing = (squared * scale).min(1.0 - ball.highlight);
    let power = power(simd, -missing + 1.0, ball.exponent);
    let [constant, slope] = halfway.errors;
    // With `missing` up to 1/2, xⁿ⁻¹ is at most 2xⁿ, and beyond 1/2 at most 2¹⁻ⁿ; the 1.06 is for max(X, x) instead of x.
    let steep = power * (2.0 * 1.06) + 1.06 * halfway.least;
    (power, (missing * slope + constant) * steep)
}

/// xⁿ, by squaring.
#[inline(always)]
fn power<S: Simd>(simd: S, x: S::f64s, exponent: u32) -> S::f64s {
    let mut power = S::f64s::splat(simd, 1.0);
    let (mut square, mut bits) = (x, exponent);
    loop {
        if bits & 1 == 1 {
            power *= square;
        }
        bits >>= 1;
        if bits == 0 {
            return power;
        }
        square *= square;
    }
}

/// Which pixels are certainly in a caster's shadow, and which certainly are not.
#[inline(always)]
fn behind<S: Simd>(
    simd: S,
    caster: &Caster<'_>,
    m: f64,
    hits: &Hits<S::f64s, S::mask64s>,
) -> (S::mask64s, S::mask64s) {
    let &Hits { q, s, .. } = hits;
    match caster {
        Caster::Cell(forms) => {
            let mut inside = S::mask64s::splat(simd, true);
            let mut outside = S::mask64s::splat(simd, false);
            for form in *forms {
                let depth = value::<S>(&along(simd, form, m), q, s);
                inside &= depth.simd_gt(form.error);
                outside |= depth.simd_lt(-form.error);
            }
            (inside, outside)
        }
        Caster::Ball(passing) => {
            let Passing {
                before,
                moment,
                reach,
                error,
            } = *passing;
            let ahead = value::<S>(&along(simd, before, m), q, s);
            let x = value::<S>(&along(simd, &moment[0], m), q, s);
            let y = value::<S>(&along(simd, &moment[1], m), q, s);
            let z = value::<S>(&along(simd, &moment[2], m), q, s);
            let depth = S::f64s::splat(simd, *reach) - (x * x + y * y + z * z);
            (
                ahead.simd_gt(before.error) & depth.simd_gt(*error),
                ahead.simd_lt(-before.error) | depth.simd_lt(-*error),
            )
        }
    }
}

impl Caster<'_> {
    /// Whether it certainly throws no shadow on a stretch.
    pub(super) fn misses(&self, stretch: &Stretch) -> bool {
        match self {
            Caster::Cell(forms) => forms.iter().any(|form| form.is_negative_along(stretch)),
            Caster::Ball(passing) => {
                let least_square = |form: &Form| {
                    let (low, high) = form.along(stretch);
                    if low <= 0.0 && high >= 0.0 {
                        0.0
                    } else {
                        (low * low).min(high * high)
                    }
                };
                let [x, y, z] = &passing.moment;
                let most = passing.reach - (least_square(x) + least_square(y) + least_square(z));
                most < -passing.error || passing.before.is_negative_along(stretch)
            }
        }
    }
}

impl Passing {
    /// `reach` is |l|² R² of a sphere.
    pub(super) fn new(before: Form, moment: [Form; 3], reach: Bounded) -> Passing {
        let magnitudes: f64 = moment
            .iter()
            .map(|form| form.magnitude * form.magnitude)
            .sum();
        // |(a + ε)² − a²| ≤ 2|a|ε + ε²; six operations round, each by less than u of all magnitudes.
        let carried: f64 = moment
            .iter()
            .map(|form| (2.0 * form.magnitude + form.error) * form.error)
            .sum();
        let error = (reach.error() + carried + 8.0 * U * (magnitudes + reach.value())) * MORE;
        Passing {
            before,
            moment,
            reach: reach.value(),
            error,
        }
    }
}
