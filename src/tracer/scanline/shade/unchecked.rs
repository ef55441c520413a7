//! Many pixels of a sphere at a time, in f32 or f64, right or not.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, SimdElement};

use crate::tracer::scanline::shade::caster::Caster;
use crate::tracer::scanline::shade::certified::{Run, narrow, put, spread};
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::shade::sphere::{Coefficients, Cycle, LinearForm, RowSphere};

/// A float of a kernel.
pub(crate) trait Lane: SimdElement {
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

// No closures below: see `shade/certified.rs`.

/// Shades a run of pixels that see a sphere, in f32.
#[inline(always)]
pub(crate) fn shade_in_single<S: Simd>(simd: S, shaded: &ShadedSphere<'_>, run: &mut Run<'_>) {
    let color = color::<S, S::f32s>(simd, &shaded.sphere);
    let m = shaded.sphere.off.at(run.y);
    let count = run.samples.len() / 3;
    let mut first = 0;
    while first < count {
        let x = run.grid.place(run.from + first as u32);
        let (samples, in_shadow) = lit::<S, S::f32s>(simd, shaded, run, &color, m, x);
        write::<S>(shaded, run, &mut first, samples, in_shadow.to_bitmask());
    }
}

/// The same in f64, rounded once at the end.
#[inline(always)]
pub(crate) fn shade_in_double<S: Simd>(simd: S, shaded: &ShadedSphere<'_>, run: &mut Run<'_>) {
    let color = color::<S, S::f64s>(simd, &shaded.sphere);
    let half = S::f64s::LEN;
    let m = shaded.sphere.off.at(run.y);
    let count = run.samples.len() / 3;
    let mut first = 0;
    while first < count {
        let x = run.grid.place(run.from + first as u32);
        let (low, low_shadow) = lit::<S, S::f64s>(simd, shaded, run, &color, m, x);
        let next = x + 3.0 * half as f64;
        let (high, high_shadow) = lit::<S, S::f64s>(simd, shaded, run, &color, m, next);
        let in_shadow = low_shadow.to_bitmask() | high_shadow.to_bitmask() << half;
        let samples = narrow::<S>(low, high);
        write::<S>(shaded, run, &mut first, samples, in_shadow);
    }
}

/// Writes one vector of pixels.
#[inline(always)]
fn write<S: Simd>(
    shaded: &ShadedSphere<'_>,
    run: &mut Run<'_>,
    first: &mut usize,
    mut vectors: [S::f32s; 3],
    in_shadow: u64,
) {
    let here = S::f32s::LEN.min(run.samples.len() / 3 - *first);
    for vector in &mut vectors {
        // −0 becomes +0.
        *vector += 0.0;
    }
    let samples = &mut run.samples[3 * *first..3 * (*first + here)];
    put::<S>(samples, &vectors);
    run.darken(*first..*first + here, in_shadow);
    run.decide(shaded, *first..*first + here, in_shadow);
    *first += here;
}

/// What colours are made of, as samples lie in memory.
#[inline(always)]
fn color<S: Simd, V: SimdFloat<S, Element: Lane>>(
    simd: S,
    sphere: &RowSphere,
) -> Coefficients<[V; 3]> {
    let Coefficients {
        ambient,
        diffuse,
        specular,
    } = &sphere.color;
    Coefficients {
        ambient: cycle(simd, ambient),
        diffuse: cycle(simd, diffuse),
        specular: cycle(simd, specular),
    }
}

#[inline(always)]
fn cycle<S: Simd, V: SimdFloat<S, Element: Lane>>(simd: S, cycle: &Cycle) -> [V; 3] {
    let mut vectors = [V::splat(simd, V::Element::of(0.0)); 3];
    for (i, vector) in vectors.iter_mut().enumerate() {
        for (lane, sample) in vector.as_mut_slice().iter_mut().enumerate() {
            *sample = V::Element::of(cycle[(i * V::LEN + lane) % 3]);
        }
    }
    vectors
}

/// The samples of neighbouring pixels, and who is in shadow.
#[inline(always)]
fn lit<S: Simd, V: SimdFloat<S, Element: Lane>>(
    simd: S,
    shaded: &ShadedSphere<'_>,
    run: &Run<'_>,
    color: &Coefficients<[V; 3]>,
    m: f64,
    x: f64,
) -> ([V; 3], V::Mask) {
    let sphere = &shaded.sphere;
    let zero = V::splat(simd, V::Element::of(0.0));
    let one = V::splat(simd, V::Element::of(1.0));
    // X − c_x as f64 has it: it must not depend on where a vector begins.
    let mut q = zero;
    for (i, q) in q.as_mut_slice().iter_mut().enumerate() {
        *q = V::Element::of(x + 3.0 * i as f64 - sphere.center);
    }
    let squared = V::splat(simd, V::Element::of(sphere.squared_radius - m * m)) - q * q;
    let s = squared.max(zero).sqrt();
    let light = value::<S, V>(simd, &sphere.light, m, q, s);
    let mut in_shadow = V::Mask::splat(simd, false);
    if !run.is_facing {
        in_shadow = light.simd_le(zero);
    }
    for &caster in &run.shading.in_reach {
        in_shadow |= shadowed::<S, V>(simd, &shaded.casters[caster], m, q, s);
    }
    let light = spread(light.max(zero));
    let mut samples = [zero; 3];
    for i in 0..3 {
        samples[i] = light[i] * color.diffuse[i] + color.ambient[i];
    }
    if let Some(halfway) = &sphere.halfway {
        let h = &halfway.form;
        let x = value::<S, V>(simd, h, m, q, s);
        let bright = x.simd_gt(V::splat(simd, V::Element::of(sphere.highlight)));
        if bright.any_true() {
            // |n − h|²/2 = 1 − n·h, in the axes of q, m and s, which are of length 1.
            let inverse = sphere.inverse_radius;
            let [h_across, h_off, h_out] = h.vector();
            let across = q * V::Element::of(inverse) - V::Element::of(h_across / inverse);
            let off = m * inverse - h_off / inverse;
            let out = s * V::Element::of(inverse) - V::Element::of(h_out / inverse);
            let squared = across * across + out * out + V::Element::of(off * off);
            let power = one_minus_to_the(one, squared * V::Element::of(0.5), sphere.exponent);
            let power = spread(bright.select(power, zero));
            for i in 0..3 {
                samples[i] += power[i] * color.specular[i];
            }
        }
    }
    (samples, in_shadow)
}

/// (1 − x)ⁿ for x from 0 on, and 0 from 1 on: by squaring 1 − x as 1 − x (2 − x), which keeps what
/// is known of a small x.
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
fn value<S: Simd, V: SimdFloat<S, Element: Lane>>(
    simd: S,
    form: &LinearForm,
    m: f64,
    q: V,
    s: V,
) -> V {
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
        Caster::Polyhedron(forms) => {
            for form in *forms {
                inside &= value::<S, V>(simd, form, m, q, s).simd_ge(zero);
            }
        }
        Caster::Sphere(cylinder) => {
            let x = value::<S, V>(simd, &cylinder.moment[0], m, q, s);
            let y = value::<S, V>(simd, &cylinder.moment[1], m, q, s);
            let z = value::<S, V>(simd, &cylinder.moment[2], m, q, s);
            let reach = V::splat(simd, V::Element::of(cylinder.reach));
            inside &= value::<S, V>(simd, &cylinder.before, m, q, s).simd_gt(zero);
            inside &= (reach - (x * x + y * y + z * z)).simd_ge(zero);
        }
    }
    inside
}
