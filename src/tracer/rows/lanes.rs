//! Many pixels of a row at a time.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use super::ball::{Ball, Form};
use super::shape::{MORE, Screen, U};
use crate::tracer::decision::Decision;

/// What may stand between a pixel of a sphere and the light.
pub(super) enum Caster {
    /// Any point within all of these half-spaces is in its shadow.
    Cell(Vec<Form>),
    /// Any point that is before it, and from which the way to the light passes its centre near enough.
    Ball {
        before: Form,
        /// The components of a vector, of which the squared length is at most `reach`, give or take `error`.
        moment: [Form; 3],
        reach: f64,
        error: f64,
    },
}

/// A sphere to be shaded in a row.
pub(super) struct Shade<'a> {
    pub(super) ball: &'a Ball,
    pub(super) casters: &'a [Caster],
    /// Whether points turned away from the light are in shadow, and not just without its diffuse part.
    pub(super) shadows: bool,
    pub(super) color_in_shadow: [f32; 3],
}

/// The pixels of a run: where they are, and where they go.
pub(super) struct Run<'r> {
    pub(super) screen: Screen,
    /// Y.
    pub(super) y: f64,
    /// The first column.
    pub(super) from: u32,
    pub(super) samples: &'r mut [f32],
    /// Where decisions go, and the two that there are: in the light, and in shadow.
    pub(super) decisions: Option<(&'r mut [Decision], [Decision; 2])>,
    /// The columns left in doubt.
    pub(super) doubts: &'r mut Vec<u32>,
}

/// As many pixels as f64 lanes: their samples' bounds, and bit by bit who is in shadow and who is known.
struct Lit<V> {
    lower: [V; 3],
    upper: [V; 3],
    in_shadow: u64,
    known: u64,
}

/// Shades a run of pixels that see a sphere.
#[inline(always)]
pub(super) fn shade<S: Simd>(simd: S, shade: &Shade<'_>, run: &mut Run<'_>) {
    let width = S::f32s::LEN;
    let half = S::f64s::LEN;
    let m = shade.ball.off(run.y);
    let count = run.samples.len() / 3;
    let mut first = 0;
    while first < count {
        let x = run.screen.place(run.from + first as u32);
        let low = lit(simd, shade, m, x);
        let high = lit(simd, shade, m, x + 3.0 * half as f64);
        let in_shadow = low.in_shadow | high.in_shadow << half;
        let dark = S::mask32s::from_bitmask(simd, in_shadow);
        let mut known = low.known | high.known << half;
        let channels: [S::f32s; 3] = std::array::from_fn(|i| {
            let lower = low.lower[i].narrow(high.lower[i]);
            let upper = low.upper[i].narrow(high.upper[i]);
            known &= lower.simd_eq(upper).to_bitmask() | in_shadow;
            // + 0 turns −0 into +0.
            dark.select(
                S::f32s::splat(simd, shade.color_in_shadow[i]),
                upper + S::f32s::splat(simd, 0.0),
            )
        });
        let here = width.min(count - first);
        let samples = &mut run.samples[3 * first..3 * (first + here)];
        let [red, green, blue] = channels.each_ref().map(|channel| channel.as_slice());
        for (i, pixel) in samples.chunks_exact_mut(3).enumerate() {
            pixel[0] = red[i];
            pixel[1] = green[i];
            pixel[2] = blue[i];
        }
        if let Some((decisions, [light, shadow])) = &mut run.decisions {
            for (i, decision) in decisions[first..first + here].iter_mut().enumerate() {
                *decision = if in_shadow >> i & 1 == 1 {
                    *shadow
                } else {
                    *light
                };
            }
        }
        let mut doubts = !known & (u64::MAX >> (64 - here));
        while doubts != 0 {
            run.doubts
                .push(run.from + first as u32 + doubts.trailing_zeros());
            doubts &= doubts - 1;
        }
        first += here;
    }
}

/// A linear form along a row.
#[inline(always)]
fn value<S: Simd>(simd: S, form: &Form, m: f64, q: S::f64s, s: S::f64s) -> S::f64s {
    let constant = S::f64s::splat(simd, form.of_row(m));
    constant + q * form.across + s * form.out
}

#[inline(always)]
fn lit<S: Simd>(simd: S, shade: &Shade<'_>, m: f64, x: f64) -> Lit<S::f64s> {
    let splat = |value: f64| S::f64s::splat(simd, value);
    let ball: &Ball = shade.ball;
    let q = S::f64s::from_fn(simd, |i| 3.0 * i as f64) + splat(x) - splat(ball.center);
    let squared = splat(ball.squared_radius - m * m) - q * q;
    let mut known = squared.simd_ge(splat(ball.least));
    let s = squared.sqrt();
    let light = value(simd, &ball.light, m, q, s);
    let error = ball.light.error;
    let mut in_shadow = light.simd_lt(splat(-error));
    if shade.shadows {
        let mut open = !(in_shadow | light.simd_gt(splat(error)));
        for caster in shade.casters {
            let (inside, outside) = shadowed(simd, caster, m, q, s);
            in_shadow |= inside;
            open |= !(inside | outside);
        }
        known &= in_shadow | !open;
    } else {
        in_shadow = S::mask64s::splat(simd, false);
    }
    let light = light.max(splat(0.0));
    let power = ball.halfway.as_ref().and_then(|form| {
        let x = value(simd, form, m, q, s);
        let threshold = splat(ball.highlight);
        x.simd_gt(threshold)
            .any_true()
            .then(|| power(simd, x.max(threshold), ball.exponent))
    });
    let samples = ball.channels.map(|channel| {
        let sum = splat(channel.ambient) + light * channel.diffuse;
        match power {
            Some(power) => sum + power * channel.specular,
            None => sum,
        }
    });
    let errors = ball.channels.map(|channel| splat(channel.error));
    Lit {
        lower: std::array::from_fn(|i| samples[i] - errors[i]),
        upper: std::array::from_fn(|i| samples[i] + errors[i]),
        in_shadow: in_shadow.to_bitmask(),
        known: known.to_bitmask(),
    }
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
        square = square * square;
    }
}

/// Which pixels are certainly in a caster's shadow, and which certainly are not.
#[inline(always)]
fn shadowed<S: Simd>(
    simd: S,
    caster: &Caster,
    m: f64,
    q: S::f64s,
    s: S::f64s,
) -> (S::mask64s, S::mask64s) {
    let splat = |value: f64| S::f64s::splat(simd, value);
    let mut inside = S::mask64s::splat(simd, true);
    let mut outside = S::mask64s::splat(simd, false);
    let mut within = |depth: S::f64s, error: f64| {
        inside &= depth.simd_gt(splat(error));
        outside |= depth.simd_lt(splat(-error));
    };
    match caster {
        Caster::Cell(forms) => {
            for form in forms {
                within(value(simd, form, m, q, s), form.error);
            }
        }
        Caster::Ball {
            before,
            moment,
            reach,
            error,
        } => {
            within(value(simd, before, m, q, s), before.error);
            let [x, y, z] = moment.each_ref().map(|form| value(simd, form, m, q, s));
            within(splat(*reach) - (x * x + y * y + z * z), *error);
        }
    }
    (inside, outside)
}

impl Caster {
    /// A sphere, `reach` being |l|² R².
    pub(super) fn ball(before: Form, moment: [Form; 3], reach: (f64, f64)) -> Caster {
        // |(a + ε)² − a²| ≤ 2|a|ε + ε²; six roundings, each less than u of all magnitudes.
        let carried: f64 = moment
            .iter()
            .map(|form| (2.0 * form.magnitude + form.error) * form.error)
            .sum();
        let magnitudes: f64 = moment
            .iter()
            .map(|form| form.magnitude * form.magnitude)
            .sum();
        Caster::Ball {
            before,
            moment,
            reach: reach.0,
            error: (reach.1 + carried + 8.0 * U * (magnitudes + reach.0)) * MORE,
        }
    }
}

/// The same pixel again and again.
pub(super) fn fill(samples: &mut [f32], [red, green, blue]: [f32; 3]) {
    /// A whole number of vectors of any width.
    const PIXELS: usize = 16;
    let mut pattern = [0.0; 3 * PIXELS];
    for pixel in pattern.chunks_exact_mut(3) {
        pixel.copy_from_slice(&[red, green, blue]);
    }
    let mut blocks = samples.chunks_exact_mut(3 * PIXELS);
    for block in &mut blocks {
        block.copy_from_slice(&pattern);
    }
    let rest = blocks.into_remainder();
    let length = rest.len();
    rest.copy_from_slice(&pattern[..length]);
}
