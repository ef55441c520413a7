//! Many pixels of a row at a time.

use std::ops::Range;

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::tracer::decision::Decision;
use crate::tracer::scanline::grid::{Columns, Grid, places};
use crate::tracer::scanline::shade::caster::{Caster, ShadowCylinder};
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::shade::sphere::{Cycle, Halfway, LinearForm, RowSphere};
use crate::tracer::scanline::write::paint::{Paint, fill};

/// What the shading of a run needs, kept for the next.
#[derive(Default)]
pub(crate) struct Shading {
    /// Which casters can throw a shadow on any pixel of the run.
    pub(crate) in_reach: Vec<usize>,
    /// The columns left in doubt.
    pub(crate) doubts: Vec<u32>,
}

/// The pixels of a run, all of them known: where they are, and where they go.
pub(crate) struct Run<'r> {
    pub(crate) grid: Grid,
    /// Y.
    pub(crate) y: f64,
    /// The first column.
    pub(crate) from: u32,
    /// The columns in the innermost zone, and those that may have a highlight.
    pub(crate) deep: Columns,
    pub(crate) bright: Columns,
    /// Whether all of them are certainly not turned away from the light, or it does not matter.
    pub(crate) is_facing: bool,
    pub(crate) samples: &'r mut [f32],
    pub(crate) decisions: Option<&'r mut [Decision]>,
    /// What pixels in shadow show.
    pub(crate) in_shadow: &'r Paint,
    pub(crate) shading: &'r mut Shading,
}

// Where the processor can multiply and add at once, `mul_add` rounds once instead of twice. So its
// errors are within the same bounds, and what is certain of a sample or a shadow is the same with
// and without; plain code, which is not certain, does not use it.
//
// No closures below: the instructions of a level are only there for what is inlined into its
// dispatch, which closures given to other functions are not.

impl Run<'_> {
    /// X of a pixel, and of that as many pixels on as there are f64 lanes.
    #[inline(always)]
    fn places<S: Simd>(&self, first: usize) -> [f64; 2] {
        let x = self.grid.place(self.from + first as u32);
        [x, x + 3.0 * S::f64s::LEN as f64]
    }

    /// Writes some pixels, those that are in shadow bit by bit.
    #[inline(always)]
    pub(crate) fn darken(&mut self, pixels: Range<usize>, in_shadow: u64) {
        if in_shadow != 0 {
            let samples = self.samples[3 * pixels.start..3 * pixels.end].chunks_exact_mut(3);
            for (i, pixel) in samples.enumerate() {
                if in_shadow >> i & 1 == 1 {
                    pixel.copy_from_slice(&self.in_shadow.color());
                }
            }
        }
    }

    /// Writes the decisions of some pixels, bit by bit in shadow or not.
    #[inline(always)]
    pub(crate) fn decide(
        &mut self,
        shaded: &ShadedSphere<'_>,
        pixels: Range<usize>,
        in_shadow: u64,
    ) {
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

/// As many pixels as f64 lanes: where they are hit.
#[derive(Clone, Copy)]
pub(crate) struct Hits<V> {
    pub(crate) q: V,
    pub(crate) s: V,
}

/// A linear form along a row.
#[derive(Clone, Copy)]
pub(crate) struct Along<V> {
    row: V,
    across: V,
    out: V,
}

/// Shades a run of pixels that see a sphere.
#[inline(always)]
pub(crate) fn shade<S: Simd>(simd: S, shaded: &ShadedSphere<'_>, run: &mut Run<'_>) {
    let sphere = &shaded.sphere;
    let width = S::f32s::LEN;
    let m = sphere.off.at(run.y);
    let light = along(simd, &sphere.light, m);
    let asks = !run.is_facing || !run.shading.in_reach.is_empty();
    let count = run.samples.len() / 3;
    let last = count.saturating_sub(width);
    let (mut done, mut first) = (0, 0);
    let mut lights = both_lights(simd, sphere, &light, m, run, first);
    while done < count {
        // The last vector may lie on part of the one before it.
        let next = (first + width).min(last);
        // A root takes its time: that of the next vector is begun before this one waits for its
        // own.
        let [low, high] = lights;
        if next > first {
            lights = both_lights(simd, sphere, &light, m, run, next);
        }
        let here = width.min(count - first);
        let all = u64::MAX >> (64 - here);
        let column = run.from + first as u32;
        let end = column + here as u32;
        let places = run.places::<S>(first);
        let mut in_shadow = 0;
        let mut unknown = 0;
        if asks {
            let (dark, known) = shadowed(simd, shaded, run, m, places, [low, high]);
            in_shadow = dark;
            unknown = !known;
        }
        let samples = &mut run.samples[3 * first..3 * (first + here)];
        if in_shadow & all == all {
            fill(simd, samples, run.in_shadow);
        } else {
            let is_deep = column >= run.deep.0 && end <= run.deep.1;
            let zone = usize::from(!is_deep);
            let is_bright = column < run.bright.1 && end > run.bright.0;
            let ambient = ambient(simd, sphere, zone);
            let bright = is_bright.then_some(zone);
            let [low_lower, low_upper] = lit(simd, sphere, m, places[0], low, &ambient, bright);
            let [high_lower, high_upper] = lit(simd, sphere, m, places[1], high, &ambient, bright);
            let lower = narrow::<S>(low_lower, high_lower);
            // An error is not −0, and so is no sum with one.
            let upper = narrow::<S>(low_upper, high_upper);
            put::<S>(samples, &upper);
            let first_differ = !lower[0].simd_eq(upper[0]);
            let second_differ = !lower[1].simd_eq(upper[1]);
            let third_differ = !lower[2].simd_eq(upper[2]);
            if (first_differ | second_differ | third_differ).any_true() {
                unknown |= pixels_of::<S>(0, first_differ.to_bitmask());
                unknown |= pixels_of::<S>(1, second_differ.to_bitmask());
                unknown |= pixels_of::<S>(2, third_differ.to_bitmask());
            }
            unknown &= !in_shadow;
            run.darken(first..first + here, in_shadow);
        }
        run.decide(shaded, first..first + here, in_shadow);
        let mut doubts = unknown & all;
        while doubts != 0 {
            // Where this vector has written over the one before, its own bounds count.
            let doubt = column + doubts.trailing_zeros();
            if doubt >= run.from + done as u32 || !run.shading.doubts.contains(&doubt) {
                run.shading.doubts.push(doubt);
            }
            doubts &= doubts - 1;
        }
        done = first + here;
        first = next;
    }
}

/// n·l of as many pixels as there are f32 lanes.
#[inline(always)]
fn both_lights<S: Simd>(
    simd: S,
    sphere: &RowSphere,
    light: &Along<S::f64s>,
    m: f64,
    run: &Run<'_>,
    first: usize,
) -> [S::f64s; 2] {
    let [low, high] = run.places::<S>(first);
    let (low, high) = (hits(simd, sphere, m, low), hits(simd, sphere, m, high));
    [
        value::<S>(light, low.q, low.s),
        value::<S>(light, high.q, high.s),
    ]
}

/// Of f64s that are three vectors each, f32s that are.
#[inline(always)]
pub(crate) fn narrow<S: Simd>(low: [S::f64s; 3], high: [S::f64s; 3]) -> [S::f32s; 3] {
    [
        low[0].narrow(low[1]),
        low[2].narrow(high[0]),
        high[1].narrow(high[2]),
    ]
}

/// The pixels, bit by bit, of some samples in one of three vectors.
#[inline(always)]
fn pixels_of<S: Simd>(vector: usize, mut samples: u64) -> u64 {
    let mut pixels = 0;
    while samples != 0 {
        let sample = vector * S::f32s::LEN + samples.trailing_zeros() as usize;
        pixels |= 1 << (sample / 3);
        samples &= samples - 1;
    }
    pixels
}

/// Writes as many samples as there are, or as three vectors hold.
#[inline(always)]
pub(crate) fn put<S: Simd>(samples: &mut [f32], vectors: &[S::f32s; 3]) {
    let width = S::f32s::LEN;
    if samples.len() == 3 * width {
        for (i, vector) in vectors.iter().enumerate() {
            vector.store_slice(&mut samples[i * width..(i + 1) * width]);
        }
    } else {
        let mut all = [0.0; 3 * 16];
        for (i, vector) in vectors.iter().enumerate() {
            vector.store_slice(&mut all[i * width..(i + 1) * width]);
        }
        // By constant lengths, which are moves instead of a call.
        let (pixels, _) = samples.as_chunks_mut::<3>();
        for (pixel, from) in pixels.iter_mut().zip(all.as_chunks::<3>().0) {
            *pixel = *from;
        }
    }
}

/// What is one number a pixel, once for each of its three samples.
#[inline(always)]
pub(crate) fn spread<S: Simd, V: SimdFloat<S>>(pixels: V) -> [V; 3] {
    let mut samples = [pixels; 3];
    for (i, vector) in samples.iter_mut().enumerate() {
        for (lane, sample) in vector.as_mut_slice().iter_mut().enumerate() {
            *sample = pixels.as_slice()[(i * V::LEN + lane) / 3];
        }
    }
    samples
}

#[inline(always)]
fn of_cycle<S: Simd>(simd: S, cycle: &Cycle) -> [S::f64s; 3] {
    let width = S::f64s::LEN;
    let (second, third) = (width % 3, 2 * width % 3);
    [
        S::f64s::from_slice(simd, &cycle[..width]),
        S::f64s::from_slice(simd, &cycle[second..second + width]),
        S::f64s::from_slice(simd, &cycle[third..third + width]),
    ]
}

#[inline(always)]
pub(crate) fn along<S: Simd>(simd: S, form: &LinearForm, m: f64) -> Along<S::f64s> {
    Along {
        row: S::f64s::splat(simd, form.of_row(m)),
        across: S::f64s::splat(simd, form.across),
        out: S::f64s::splat(simd, form.out),
    }
}

/// The value of a form at some pixels.
#[inline(always)]
pub(crate) fn value<S: Simd>(form: &Along<S::f64s>, q: S::f64s, s: S::f64s) -> S::f64s {
    s.mul_add(form.out, q.mul_add(form.across, form.row))
}

/// The hits from X = `x` on.
#[inline(always)]
pub(crate) fn hits<S: Simd>(simd: S, sphere: &RowSphere, m: f64, x: f64) -> Hits<S::f64s> {
    let q = places::<S>(simd, 0) + x - sphere.center;
    let squared = S::f64s::splat(simd, sphere.squared_radius - m * m);
    let s = q.mul_add(-q, squared).sqrt();
    Hits { q, s }
}

/// Which pixels are in shadow, and of which it is known.
#[inline(always)]
fn shadowed<S: Simd>(
    simd: S,
    shaded: &ShadedSphere<'_>,
    run: &Run<'_>,
    m: f64,
    places: [f64; 2],
    lights: [S::f64s; 2],
) -> (u64, u64) {
    let (mut all_dark, mut all_known) = (0, 0);
    // Of a short run there may be nothing in the second vector.
    let vectors = (run.samples.len() / 3).div_ceil(S::f64s::LEN).min(2);
    for i in 0..vectors {
        let mut dark = S::mask64s::splat(simd, false);
        let mut known = S::mask64s::splat(simd, true);
        if !run.is_facing {
            let error = shaded.sphere.light.error;
            dark = lights[i].simd_lt(-error);
            known = dark | lights[i].simd_gt(error);
        }
        if !run.shading.in_reach.is_empty() {
            let hits = hits(simd, &shaded.sphere, m, places[i]);
            for &caster in &run.shading.in_reach {
                let (inside, outside) = behind(simd, &shaded.casters[caster], m, &hits);
                dark |= inside;
                known &= inside | outside;
            }
        }
        all_dark |= dark.to_bitmask() << (i * S::f64s::LEN);
        all_known |= (known | dark).to_bitmask() << (i * S::f64s::LEN);
    }
    (all_dark, all_known)
}

/// The ambient part of samples as they lie in memory, less and more than it is by a bound on the
/// errors of all but the highlight.
#[inline(always)]
pub(crate) fn ambient<S: Simd>(simd: S, sphere: &RowSphere, zone: usize) -> [[S::f64s; 3]; 2] {
    let error = sphere.errors[zone];
    let [red, green, blue] = of_cycle(simd, &sphere.color.ambient);
    [
        [red - error, green - error, blue - error],
        [red + error, green + error, blue + error],
    ]
}

/// Samples of pixels in the light, from X = `x` on, as they lie in memory: from below and from
/// above. `light` is their n·l; `bright` is their zone where they may have a highlight.
#[inline(always)]
pub(crate) fn lit<S: Simd>(
    simd: S,
    sphere: &RowSphere,
    m: f64,
    x: f64,
    light: S::f64s,
    ambient: &[[S::f64s; 3]; 2],
    bright: Option<usize>,
) -> [[S::f64s; 3]; 2] {
    let [mut lower, mut upper] = *ambient;
    let light = spread(light.max(0.0));
    let diffuse = of_cycle(simd, &sphere.color.diffuse);
    for i in 0..3 {
        lower[i] = light[i].mul_add(diffuse[i], lower[i]);
        upper[i] = light[i].mul_add(diffuse[i], upper[i]);
    }
    if let (Some(halfway), Some(zone)) = (&sphere.halfway, bright) {
        let hits = hits(simd, sphere, m, x);
        let errors = halfway.errors[zone];
        let (power, error) = highlight(simd, sphere, (halfway, errors), m, &hits);
        // No coefficient is negative.
        let least = spread(power - error);
        let most = spread(power + error);
        let specular = of_cycle(simd, &sphere.color.specular);
        for i in 0..3 {
            lower[i] = least[i].mul_add(specular[i], lower[i]);
            upper[i] = most[i].mul_add(specular[i], upper[i]);
        }
    }
    [lower, upper]
}

/// (n·h)ⁿ, and a bound on its error.
#[inline(always)]
fn highlight<S: Simd>(
    simd: S,
    sphere: &RowSphere,
    (halfway, errors): (&Halfway, [f64; 2]),
    m: f64,
    hits: &Hits<S::f64s>,
) -> (S::f64s, S::f64s) {
    let [across, off, out] = halfway.at;
    let (across, off, out) = (hits.q - across, m - off, hits.s - out);
    let squared = across * across + out * out + off * off;
    // 1 − n·h = |n − h|²/2 is small, and known to a small relative error, where the highlight is
    // bright.
    let scale = 0.5 * sphere.inverse_radius * sphere.inverse_radius;
    let missing = (squared * scale).min(1.0 - sphere.highlight);
    let power = power(simd, -missing + 1.0, sphere.exponent);
    let [constant, slope] = errors;
    // With `missing` up to 1/2, xⁿ⁻¹ is at most 2xⁿ, and beyond 1/2 at most 2¹⁻ⁿ; the 1.06 is for
    // max(X, x) instead of x.
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
    hits: &Hits<S::f64s>,
) -> (S::mask64s, S::mask64s) {
    let &Hits { q, s, .. } = hits;
    match caster {
        Caster::Polyhedron(forms) => {
            let mut inside = S::mask64s::splat(simd, true);
            let mut outside = S::mask64s::splat(simd, false);
            for form in *forms {
                let depth = value::<S>(&along(simd, form, m), q, s);
                inside &= depth.simd_gt(form.error);
                outside |= depth.simd_lt(-form.error);
            }
            (inside, outside)
        }
        Caster::Sphere(cylinder) => {
            let ShadowCylinder {
                before,
                moment,
                reach,
                error,
            } = *cylinder;
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
