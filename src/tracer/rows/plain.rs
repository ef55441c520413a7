//! Many pixels of a sphere at a time, in f32 or f64, right or not.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, SimdElement};

use super::ball::Form;
use super::lanes::{Caster, Run, interleave};
use super::solids::ShadedBall;

/// A float of a kernel.
pub(super) trait Lane: SimdElement {
    fn of(value: f64) -> Self;
}

impl Lane for f32 {
    fn of(value: f64) -> f32 {
        value as f32
    }
}

impl Lane for f64 {
    fn of(value: f64) -> f64 {
        value
    }
}

// No closures below: see `lanes.rs`.

/// Shades a run of pixels that see a sphere, in f32.
#[inline(always)]
pub(super) fn shade_in_single<S: Simd>(simd: S, shaded: &ShadedBall<'_>, run: &mut Run<'_>) {
    let m = shaded.ball.off.at(run.y);
    let count = run.samples.len() / 3;
    let mut first = 0;
    while first < count {
        let x = run.screen.place(run.from + first as u32);
        let (channels, in_shadow) = lit::<S, S::f32s>(simd, shaded, &run.shading.in_reach, m, x);
        put(
            simd,
            shaded,
            run,
            &mut first,
            channels,
            in_shadow.to_bitmask(),
        );
    }
}

/// The same in f64, rounded once at the end.
#[inline(always)]
pub(super) fn shade_in_double<S: Simd>(simd: S, shaded: &ShadedBall<'_>, run: &mut Run<'_>) {
    let half = S::f64s::LEN;
    let m = shaded.ball.off.at(run.y);
    let count = run.samples.len() / 3;
    let mut first = 0;
    while first < count {
        let x = run.screen.place(run.from + first as u32);
        let (low, low_shadow) = lit::<S, S::f64s>(simd, shaded, &run.shading.in_reach, m, x);
        let (high, high_shadow) = lit::<S, S::f64s>(
            simd,
            shaded,
            &run.shading.in_reach,
            m,
            x + 3.0 * half as f64,
        );
        let channels = [
            low[0].narrow(high[0]),
            low[1].narrow(high[1]),
            low[2].narrow(high[2]),
        ];
        let in_shadow = low_shadow.to_bitmask() | high_shadow.to_bitmask() << half;
        put(simd, shaded, run, &mut first, channels, in_shadow);
    }
}

/// Writes one vector of pixels.
#[inline(always)]
fn put<S: Simd>(
    simd: S,
    shaded: &ShadedBall<'_>,
    run: &mut Run<'_>,
    first: &mut usize,
    mut channels: [S::f32s; 3],
    in_shadow: u64,
) {
    let here = S::f32s::LEN.min(run.samples.len() / 3 - *first);
    let dark = S::mask32s::from_bitmask(simd, in_shadow);
    for (channel, &shadow) in channels.iter_mut().zip(&run.in_shadow.color()) {
        *channel = dark.select(S::f32s::splat(simd, shadow), *channel + 0.0);
    }
    let samples = &mut run.samples[3 * *first..3 * (*first + here)];
    let [red, green, blue] = &channels;
    interleave(samples, red.as_slice(), green.as_slice(), blue.as_slice());
    run.decide(shaded, *first..*first + here, in_shadow);
    *first += here;
}

/// The samples of neighbouring pixels, and who is in shadow.
#[inline(always)]
fn lit<S: Simd, V: SimdFloat<S, Element: Lane>>(
    simd: S,
    shaded: &ShadedBall<'_>,
    in_reach: &[usize],
    m: f64,
    x: f64,
) -> ([V; 3], V::Mask) {
    let ball = &shaded.ball;
    let zero = V::splat(simd, V::Element::of(0.0));
    let one = V::splat(simd, V::Element::of(1.0));
    // X − c_x as f64 has it: it must not depend on where a vector begins.
    let mut q = zero;
    for (i, q) in q.as_mut_slice().iter_mut().enumerate() {
        *q = V::Element::of(x + 3.0 * i as f64 - ball.center);
    }
    let squared = V::splat(simd, V::Element::of(ball.squared_radius - m * m)) - q * q;
    let s = squared.max(zero).sqrt();
    let mut light = value::<S, V>(simd, &ball.light, m, q, s);
    let mut in_shadow = V::Mask::splat(simd, false);
    if ball.shadows {
        in_shadow = light.simd_le(zero);
        for &caster in in_reach {
            in_shadow |= shadowed::<S, V>(simd, &shaded.casters[caster], m, q, s);
        }
    }
    light = light.max(zero);
    let mut samples = [zero; 3];
    for (sample, channel) in samples.iter_mut().zip(&ball.channels) {
        *sample = light * V::Element::of(channel.diffuse) + V::Element::of(channel.ambient);
    }
    if let Some(halfway) = &ball.halfway {
        let h = &halfway.form;
        let x = value::<S, V>(simd, h, m, q, s);
        let bright = x.simd_gt(V::splat(simd, V::Element::of(ball.highlight)));
        if bright.any_true() {
            // |n − h|²/2 = 1 − n·h, in the axes of q, m and s, which are of length 1.
            let inverse = ball.inverse_radius;
            let [h_across, h_off, h_out] = h.vector();
            let across = q * V::Element::of(inverse) - V::Element::of(h_across / inverse);
            let off = m * inverse - h_off / inverse;
            let out = s * V::Element::of(inverse) - V::Element::of(h_out / inverse);
            let squared = across * across + out * out + V::Element::of(off * off);
            let power = one_minus_to_the(one, squared * V::Element::of(0.5), ball.exponent);
            let power = bright.select(power, zero);
            for (sample, channel) in samples.iter_mut().zip(&ball.channels) {
                *sample += power * V::Element::of(channel.specular);
            }
        }
    }
    (samples, in_shadow)
}

/// (1 − x)ⁿ for x from 0 on, and 0 from 1 on: by squaring 1 − x as 1 − x (2 − x), which keeps what is known of a small x.
#[inline(always)]
fn one_minus_to_the<S: Simd, V: SimdFloat<S, Element: Lane>>(one: V, x: V, exponent: u32) -> V {
    let mut square = x.min(one);
    // 1 − the power of the bits so far.
    let mut missing = None;
    let mut bits = exponent;
    loop {
        if bits & 1 == 1 {
            missing = Some(match missing {
                Some(missing) => missing + square - missing * square,
                None => square,
            });
        }
        bits >>= 1;
        if bits == 0 {
            return one - missing.unwrap_or(one).min(one);
        }
        square = square * (one + one - square);
    }
}

/// A linear form along a row.
#[inline(always)]
fn value<S: Simd, V: SimdFloat<S, Element: Lane>>(simd: S, form: &Form, m: f64, q: V, s: V) -> V {
    V::splat(simd, V::Element::of(form.of_row(m)))
        + q * V::Element::of(form.across)
        + s * V::Element::of(form.out)
}

/// Which pixels are in a caster's shadow.
#[inline(always)]
fn shadowed<S: Simd, V: SimdFloat<S, Element: Lane>>(
    simd: S,
    caster: &Caster<'_>,
    m: f64,
    q: V,
    s: V,
) -> V::Mask {
    let zero = V::splat(simd, V::Element::of(0.0));
    let mut inside = V::Mask::splat(simd, true);
    match caster {
        Caster::Cell(forms) => {
            for form in *forms {
                inside &= value::<S, V>(simd, form, m, q, s).simd_ge(zero);
            }
        }
        Caster::Ball(passing) => {
            let x = value::<S, V>(simd, &passing.moment[0], m, q, s);
            let y = value::<S, V>(simd, &passing.moment[1], m, q, s);
            let z = value::<S, V>(simd, &passing.moment[2], m, q, s);
            let reach = V::splat(simd, V::Element::of(passing.reach));
            inside &= value::<S, V>(simd, &passing.before, m, q, s).simd_gt(zero);
            inside &= (reach - (x * x + y * y + z * z)).simd_ge(zero);
        }
    }
    inside
}
