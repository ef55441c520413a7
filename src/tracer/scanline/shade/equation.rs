//! Equation 4-1 along a row of a sphere: `shading.rs` and `sphere.rs` in the axes of q, m and s, as
//! derived in `shade/sphere.rs`, for as many pixels as a vector holds and in any arithmetic.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::tracer::scanline::shade::caster::Caster;
use crate::tracer::scanline::shade::lane::Lane;
use crate::tracer::scanline::shade::policy::{Answers, LaneVector, Mask, Policy, Samples};
use crate::tracer::scanline::shade::sphere::{LinearForm, SphereConstants, SphereHighlight};

/// The classes of some pixels of a sphere, which tell how they are shaded.
pub(crate) struct Classes {
    /// The outermost zone that any of them is in.
    pub(crate) zone: usize,
    /// A bit for each: whether it may have a highlight.
    pub(crate) bright: u64,
    /// A bit for each: whether it lies beyond all zones.
    pub(crate) beyond: u64,
}

// No closures below: see `shade/run.rs`.

/// The coordinates of the hits of neighbouring pixels; m is that of the row.
pub(crate) struct Hits<V> {
    pub(crate) q: V,
    pub(crate) s: V,
}

/// A sphere in a row, in the arithmetic of a policy.
pub(crate) struct RowShader<'s, S: Simd, P: Policy<S>> {
    simd: S,
    sphere: &'s SphereConstants<'s>,
    /// m of the row.
    m: f64,
    /// R² − m².
    squared: LaneVector<S, P>,
}

impl<'s, S: Simd, P: Policy<S>> RowShader<'s, S, P> {
    #[inline(always)]
    pub(crate) fn new(simd: S, sphere: &'s SphereConstants<'s>, y: f64) -> Self {
        let m = sphere.m.at(y);
        RowShader {
            simd,
            sphere,
            m,
            squared: splat::<S, P>(simd, sphere.squared_radius - m * m),
        }
    }

    /// A linear form at some hits.
    #[inline(always)]
    pub(crate) fn value(
        &self,
        form: &LinearForm,
        hits: &Hits<LaneVector<S, P>>,
    ) -> LaneVector<S, P> {
        let q = splat::<S, P>(self.simd, form.q);
        let s = splat::<S, P>(self.simd, form.s);
        let of_row = splat::<S, P>(self.simd, form.of_row(self.m));
        P::product_plus(hits.s, s, P::product_plus(hits.q, q, of_row))
    }

    /// q and s² = R² − m² − q² of the pixels from X = `x` on.
    #[inline(always)]
    fn squares(&self, x: f64) -> [LaneVector<S, P>; 2] {
        let q = P::Lane::differences(self.simd, x, self.sphere.center_x);
        [q, P::product_plus(q, -q, self.squared)]
    }

    /// The hits from X = `x` on.
    #[inline(always)]
    pub(crate) fn hits(&self, x: f64) -> Hits<LaneVector<S, P>> {
        let [q, squared] = self.squares(x);
        Hits {
            q,
            s: squared.max(P::Lane::of(0.0)).sqrt(),
        }
    }

    /// What the pixels of a run tell of themselves: those whose bits are set in `pixels`, from X =
    /// `x` to X = `last`, in two vectors if one does not hold all, from `next` on.
    #[inline(always)]
    pub(crate) fn classify(&self, [x, next]: [f64; 2], last: f64, pixels: u64) -> Classes {
        let sphere = self.sphere;
        // s² falls with |q|, and rounding is monotonic: so s² is least at an end. The margin of the
        // zones allows for fused operations.
        let squares = [x, last].map(|x| {
            let q = x - sphere.center_x;
            (sphere.squared_radius - self.m * self.m) - q * q
        });
        // A NaN is in no zone.
        let is_out = |least: f64| !(squares[0] >= least && squares[1] >= least);
        let [innermost, inner, outermost] = sphere.min_squares;
        let mut beyond = 0;
        if is_out(outermost) {
            beyond = pixels;
            for (shift, x) in self.vectors([x, next], pixels) {
                let [_, squared] = self.squares(x);
                let is_inside = squared.simd_ge(P::Lane::of(outermost));
                beyond &= !(is_inside.to_bitmask() << shift);
            }
        }
        let mut bright = 0;
        if let Some(highlight) = &sphere.highlight
            && highlight.reaches(self.m * sphere.inverse_radius, sphere.lighting)
        {
            let threshold = P::Lane::of(sphere.lighting.highlight.threshold);
            for (shift, x) in self.vectors([x, next], pixels) {
                let halfway = self.value(&highlight.form, &self.hits(x));
                bright |= halfway.simd_gt(threshold).to_bitmask() << shift;
            }
        }
        Classes {
            zone: usize::from(is_out(innermost)) + usize::from(is_out(inner)),
            bright: bright & pixels & !beyond,
            beyond,
        }
    }

    /// The first pixel of each vector that holds any of `pixels`: its number, and its X.
    #[inline(always)]
    fn vectors(&self, x: [f64; 2], pixels: u64) -> impl Iterator<Item = (usize, f64)> {
        let lanes = LaneVector::<S, P>::LEN;
        let has_two = lanes < S::f32s::LEN && pixels >> lanes != 0;
        [0, lanes].into_iter().zip(x).take(1 + usize::from(has_two))
    }

    /// n·l of the pixels from X = `x` on, in two vectors if one does not hold all, from `next` on.
    #[inline(always)]
    pub(crate) fn lights(&self, [x, next]: [f64; 2]) -> [LaneVector<S, P>; 2] {
        let mut lights = [self.value(&self.sphere.n_dot_l, &self.hits(x)); 2];
        if LaneVector::<S, P>::LEN < S::f32s::LEN {
            lights[1] = self.value(&self.sphere.n_dot_l, &self.hits(next));
        }
        lights
    }

    /// Whether a caster stands between a hit and the light.
    #[inline(always)]
    pub(crate) fn behind(
        &self,
        caster: &Caster<'_>,
        hits: &Hits<LaneVector<S, P>>,
    ) -> Answers<S, P> {
        match caster {
            Caster::Polyhedron(forms) => {
                let (mut yes, mut no) = (self.mask(true), self.mask(false));
                for form in *forms {
                    let (inside, outside) = P::is_not_negative(self.value(form, hits), form.error);
                    yes &= inside;
                    no |= outside;
                }
                (yes, no)
            }
            Caster::Sphere(cylinder) => {
                let [x, y, z, before] = &cylinder.forms(self.sphere.lighting);
                let [x, y, z] = [
                    self.value(x, hits),
                    self.value(y, hits),
                    self.value(z, hits),
                ];
                let inside =
                    splat::<S, P>(self.simd, cylinder.squared_radius) - (x * x + y * y + z * z);
                let (inside, outside) = P::is_not_negative(inside, cylinder.error);
                // A caster abreast of the hit casts no shadow on it.
                let (not_before, is_before) =
                    P::is_not_negative(-self.value(before, hits), cylinder.form_error);
                (inside & is_before, outside | not_before)
            }
        }
    }

    /// The mask of all pixels, or of none.
    #[inline(always)]
    pub(crate) fn mask(&self, all: bool) -> Mask<S, P> {
        Mask::<S, P>::splat(self.simd, all)
    }

    /// The ambient part of samples, with the bound on the error of all parts but the highlight.
    #[inline(always)]
    pub(crate) fn ambient(&self, zone: usize) -> Samples<S, P> {
        let error = splat::<S, P>(self.simd, self.sphere.errors[zone]);
        let [red, green, blue] = P::Lane::samples_of(self.simd, &self.sphere.color.ambient);
        [
            P::within(red, error),
            P::within(green, error),
            P::within(blue, error),
        ]
    }

    /// Samples of pixels in the light, from X = `x` on: ambient + diffuse · max(0, n·l) + specular
    /// · (n·h)ⁿ. `light` is their n·l; `bright` has a bit for each that may have a highlight.
    #[inline(always)]
    pub(crate) fn lit(
        &self,
        x: f64,
        light: LaneVector<S, P>,
        ambient: &Samples<S, P>,
        (zone, bright): (usize, u64),
    ) -> Samples<S, P> {
        let mut samples = *ambient;
        let light = spread(light.max(P::Lane::of(0.0)));
        let diffuse = P::Lane::samples_of(self.simd, &self.sphere.color.diffuse);
        for i in 0..3 {
            for sample in samples[i].as_mut() {
                *sample = P::product_plus(light[i], diffuse[i], *sample);
            }
        }
        if let Some(highlight) = &self.sphere.highlight
            && bright != 0
        {
            let power = self.highlight(highlight, &self.hits(x), (zone, bright));
            let specular = P::Lane::samples_of(self.simd, &self.sphere.color.specular);
            for (side, power) in power.as_ref().iter().enumerate() {
                // No coefficient is negative, so lower ends stay lower ends.
                let power = spread(*power);
                for i in 0..3 {
                    let sample = &mut samples[i].as_mut()[side];
                    *sample = P::product_plus(power[i], specular[i], *sample);
                }
            }
        }
        samples
    }

    /// (n·h)ⁿ of the bright pixels.
    #[inline(always)]
    fn highlight(
        &self,
        highlight: &SphereHighlight,
        hits: &Hits<LaneVector<S, P>>,
        (zone, bright): (usize, u64),
    ) -> P::Enclosure<LaneVector<S, P>> {
        let (simd, of) = (self.simd, P::Lane::of);
        // 1 − n·h = |n − h|²/2 is small, and known to a small relative error, where the highlight
        // is bright.
        let view = &self.sphere.lighting.highlight;
        let [q, m, s] = view.halfway;
        let inverse = splat::<S, P>(simd, self.sphere.inverse_radius);
        let q = P::product_plus(hits.q, inverse, splat::<S, P>(simd, -q));
        let m = self.m * self.sphere.inverse_radius - m;
        let s = P::product_plus(hits.s, inverse, splat::<S, P>(simd, -s));
        let squared = q * q + s * s + of(m * m);
        let one_minus = (squared * of(0.5)).min(of(view.one_minus_threshold));
        let power = power::<S, P>(simd, one_minus, view.exponent);
        let power = P::where_bright(simd, power, bright);
        let [constant, slope] = highlight.errors[zone];
        // xⁿ⁻¹ is at most 2xⁿ for x ≥ 1/2, and at most 2¹⁻ⁿ for smaller x; the factor 1.06 is that
        // of max(X, x)ⁿ⁻¹ over xⁿ⁻¹.
        let steep = power * of(2.0 * 1.06) + of(1.06 * view.smallest_power);
        P::within(power, (one_minus * of(slope) + of(constant)) * steep)
    }
}

#[inline(always)]
fn splat<S: Simd, P: Policy<S>>(simd: S, value: f64) -> LaneVector<S, P> {
    LaneVector::<S, P>::splat(simd, P::Lane::of(value))
}

/// (1 − `one_minus`)ⁿ, by squaring.
#[inline(always)]
fn power<S: Simd, P: Policy<S>>(
    simd: S,
    one_minus: LaneVector<S, P>,
    exponent: u32,
) -> LaneVector<S, P> {
    let mut power = P::factor(splat::<S, P>(simd, 0.0));
    let (mut square, mut bits) = (P::factor(one_minus), exponent);
    loop {
        if bits & 1 == 1 {
            power = P::product(power, square);
        }
        bits >>= 1;
        if bits == 0 {
            return P::value(power);
        }
        square = P::square(square);
    }
}

/// The number of each pixel three times, once for each of its samples.
#[inline(always)]
fn spread<S: Simd, V: SimdFloat<S>>(pixels: V) -> [V; 3] {
    let mut samples = [pixels; 3];
    for (i, vector) in samples.iter_mut().enumerate() {
        for (lane, sample) in vector.as_mut_slice().iter_mut().enumerate() {
            *sample = pixels.as_slice()[(i * V::LEN + lane) / 3];
        }
    }
    samples
}
