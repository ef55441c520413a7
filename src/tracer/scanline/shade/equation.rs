//! Equation 4-1 along a row of a sphere: `shading.rs` and `sphere.rs` in the axes of q, m and s, as
//! derived in `shade/sphere.rs`, for as many pixels as a vector holds and in any arithmetic.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::tracer::scanline::shade::caster::Caster;
use crate::tracer::scanline::shade::lane::Lane;
use crate::tracer::scanline::shade::policy::{Answers, LaneVector, Mask, Policy, Samples};
use crate::tracer::scanline::shade::sphere::{LinearForm, SphereConstants, SphereHighlight};

/// The classes of some pixels of a sphere, which tell how they are shaded.
#[derive(Clone, Copy)]
pub(crate) struct Classes {
    /// The outermost zone that any of them is in.
    pub(crate) zone: usize,
    /// A bit for each: whether it may have a highlight.
    pub(crate) bright: u64,
    /// A bit for each: whether it lies beyond all zones.
    pub(crate) beyond: u64,
}

// No vectors in closures below: see `shade/run.rs`.

/// The coordinates of the hits of neighbouring pixels; m is that of the row.
#[derive(Clone, Copy)]
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

    /// s² = R² − m² − q².
    #[inline(always)]
    fn squares(&self, q: LaneVector<S, P>) -> LaneVector<S, P> {
        P::product_plus(q, -q, self.squared)
    }

    /// The hits from X = `x` on.
    #[inline(always)]
    pub(crate) fn hits(&self, x: f64) -> Hits<LaneVector<S, P>> {
        let q = P::Lane::differences(self.simd, x, self.sphere.center_x);
        Hits {
            q,
            s: self.squares(q).max(P::Lane::of(0.0)).sqrt(),
        }
    }

    /// What pixels tell of themselves: those whose bits are set in `pixels`.
    #[inline(always)]
    pub(crate) fn classify(&self, hits: &Hits<LaneVector<S, P>>, pixels: u64) -> Classes {
        let sphere = self.sphere;
        let squares = self.squares(hits.q);
        let [innermost, inner, outermost] = sphere.min_squares;
        // A NaN is in no zone. The margin of the zones allows for fused operations.
        let out_of_innermost = pixels & !squares.simd_ge(P::Lane::of(innermost)).to_bitmask();
        let out_of_inner = pixels & !squares.simd_ge(P::Lane::of(inner)).to_bitmask();
        let beyond = pixels & !squares.simd_ge(P::Lane::of(outermost)).to_bitmask();
        let mut bright = 0;
        if let Some(highlight) = &sphere.highlight {
            let threshold = P::Lane::of(sphere.lighting.highlight.threshold);
            bright = self
                .value(&highlight.form, hits)
                .simd_gt(threshold)
                .to_bitmask();
        }
        Classes {
            zone: usize::from(out_of_innermost != 0) + usize::from(out_of_inner != 0),
            bright: bright & pixels & !beyond,
            beyond,
        }
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

    /// Samples of pixels in the light without a highlight: ambient + diffuse · max(0, n·l). `light`
    /// is their n·l.
    #[inline(always)]
    pub(crate) fn lit(&self, light: LaneVector<S, P>, zone: usize) -> Samples<LaneVector<S, P>> {
        let color = &self.sphere.color;
        let light = light.max(P::Lane::of(0.0));
        let mut channels = [light; 3];
        for (i, channel) in channels.iter_mut().enumerate() {
            let ambient = splat::<S, P>(self.simd, color.ambient[i]);
            let diffuse = splat::<S, P>(self.simd, color.diffuse[i]);
            *channel = P::product_plus(light, diffuse, ambient);
        }
        Samples {
            channels,
            error: splat::<S, P>(self.simd, self.sphere.errors[zone]),
        }
    }

    /// Adds specular · (n·h)ⁿ to samples. `bright` has a bit for each pixel that may have a
    /// highlight.
    #[inline(always)]
    pub(crate) fn add_highlight(
        &self,
        samples: &mut Samples<LaneVector<S, P>>,
        hits: &Hits<LaneVector<S, P>>,
        (zone, bright): (usize, u64),
    ) {
        if let Some(highlight) = &self.sphere.highlight {
            let (power, error) = self.highlight(highlight, hits, (zone, bright));
            for i in 0..3 {
                let specular = splat::<S, P>(self.simd, self.sphere.color.specular[i]);
                samples.channels[i] = P::product_plus(power, specular, samples.channels[i]);
            }
            samples.error += error;
        }
    }

    /// (n·h)ⁿ of the bright pixels, and a bound on the error of the highlight in any channel.
    #[inline(always)]
    fn highlight(
        &self,
        highlight: &SphereHighlight,
        hits: &Hits<LaneVector<S, P>>,
        (zone, bright): (usize, u64),
    ) -> (LaneVector<S, P>, LaneVector<S, P>) {
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
        (power, (one_minus * of(slope) + of(constant)) * steep)
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
