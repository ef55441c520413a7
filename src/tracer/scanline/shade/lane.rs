//! The floats that spheres are shaded in.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, SimdFloatElement};

use crate::tracer::scanline::grid::offsets;
use crate::tracer::scanline::shade::sphere::Cycle;
use crate::tracer::view_space::PIXEL;

/// f32 or f64.
pub(crate) trait Lane: SimdFloatElement {
    /// As many lanes as the processor computes with at once.
    type Vector<S: Simd>: SimdFloat<S, Element = Self>;

    fn of(value: f64) -> Self;

    /// X − c of neighbouring pixels from X = `x` on: computed in f64 and then rounded, so that no
    /// difference depends on where a vector begins.
    fn differences<S: Simd>(simd: S, x: f64, center: f64) -> Self::Vector<S>;

    /// Three vectors of samples as they lie in memory, from red on.
    fn samples_of<S: Simd>(simd: S, cycle: &Cycle) -> [Self::Vector<S>; 3];

    /// Samples rounded to f32. `high` holds the pixels for which `low` has no room.
    fn narrow<S: Simd>(low: [Self::Vector<S>; 3], high: [Self::Vector<S>; 3]) -> [S::f32s; 3];
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
    fn samples_of<S: Simd>(simd: S, cycle: &Cycle) -> [S::f32s; 3] {
        let half = S::f64s::LEN;
        [
            from_sample(simd, cycle, 0).narrow(from_sample(simd, cycle, half)),
            from_sample(simd, cycle, 2 * half).narrow(from_sample(simd, cycle, 3 * half)),
            from_sample(simd, cycle, 4 * half).narrow(from_sample(simd, cycle, 5 * half)),
        ]
    }

    #[inline(always)]
    fn narrow<S: Simd>(low: [S::f32s; 3], _: [S::f32s; 3]) -> [S::f32s; 3] {
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
        offsets::<S>(simd, 0) + x - center
    }

    #[inline(always)]
    fn samples_of<S: Simd>(simd: S, cycle: &Cycle) -> [S::f64s; 3] {
        let width = S::f64s::LEN;
        [
            from_sample(simd, cycle, 0),
            from_sample(simd, cycle, width),
            from_sample(simd, cycle, 2 * width),
        ]
    }

    #[inline(always)]
    fn narrow<S: Simd>(low: [S::f64s; 3], high: [S::f64s; 3]) -> [S::f32s; 3] {
        [
            low[0].narrow(low[1]),
            low[2].narrow(high[0]),
            high[1].narrow(high[2]),
        ]
    }
}

/// The vector of samples from number `sample` on.
#[inline(always)]
fn from_sample<S: Simd>(simd: S, cycle: &Cycle, sample: usize) -> S::f64s {
    let channel = sample % 3;
    S::f64s::from_slice(simd, &cycle[channel..channel + S::f64s::LEN])
}
