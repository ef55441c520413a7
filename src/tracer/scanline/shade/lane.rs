//! The floats that spheres are shaded in.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, SimdFloatElement};

use crate::tracer::scanline::grid::offsets;
use crate::tracer::view_space::PIXEL;

/// f32 or f64.
pub(crate) trait Lane: SimdFloatElement {
    /// As many lanes as the processor computes with at once.
    type Vector<S: Simd>: SimdFloat<S, Element = Self>;

    fn of(value: f64) -> Self;

    /// X − c of neighbouring pixels from X = `x` on: computed in f64 and then rounded, so that no
    /// difference depends on where a vector begins.
    fn differences<S: Simd>(simd: S, x: f64, center: f64) -> Self::Vector<S>;

    /// Numbers rounded to f32. `high` holds those for which `low` has no room.
    fn narrow<S: Simd>(low: Self::Vector<S>, high: Self::Vector<S>) -> S::f32s;
}

impl Lane for f32 {
    type Vector<S: Simd> = S::f32s;

    #[inline(always)]
    fn of(value: f64) -> f32 {
        value as f32
    }

    #[inline(always)]
    fn differences<S: Simd>(simd: S, x: f64, center: f64) -> S::f32s {
        let next = x + PIXEL * S::f64s::LEN as f64;
        let low = f64::differences(simd, x, center);
        low.narrow(f64::differences(simd, next, center))
    }

    #[inline(always)]
    fn narrow<S: Simd>(low: S::f32s, _: S::f32s) -> S::f32s {
        low
    }
}

impl Lane for f64 {
    type Vector<S: Simd> = S::f64s;

    #[inline(always)]
    fn of(value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn differences<S: Simd>(simd: S, x: f64, center: f64) -> S::f64s {
        offsets(simd, 0) + x - center
    }

    #[inline(always)]
    fn narrow<S: Simd>(low: S::f64s, high: S::f64s) -> S::f32s {
        low.narrow(high)
    }
}
