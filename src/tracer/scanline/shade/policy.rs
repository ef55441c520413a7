//! The arithmetic of the shader of spheres: certified f64, with bounds on errors, or f32 and f64
//! without.
//!
//! Without bounds, every operation rounds, so that pictures are the same bytes on every machine.
//! Certified f64 uses fused multiply-add where the processor has it. A fused operation rounds once
//! instead of twice, so its error stays within the same bound; a sample is certified only if all
//! numbers within the bound round to it, so it is the same with and without fused operations.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::tracer::scanline::shade::lane::Lane;

/// The arithmetic that a kernel shades spheres with.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::tracer) enum Precision {
    /// f32.
    Single,
    /// f64.
    Double,
    /// f64 with bounds on its errors; pixels in doubt are decided by themselves.
    Certified,
}

/// A SIMD vector of a policy's floats.
pub(crate) type LaneVector<S, P> = <<P as Policy<S>>::Lane as Lane>::Vector<S>;

/// The pixels for which something certainly holds, and those for which it certainly does not: with
/// bounds, some may be in neither.
pub(crate) type Answers<S, P> = (Mask<S, P>, Mask<S, P>);

/// Some pixels of a vector.
pub(crate) type Mask<S, P> = <LaneVector<S, P> as SimdBase<S>>::Mask;

/// The red, the green and the blue of some pixels, and a bound on the errors of all three; without
/// bounds it is not used.
#[derive(Clone, Copy)]
pub(crate) struct Samples<V> {
    pub(crate) channels: [V; 3],
    pub(crate) error: V,
}

/// An arithmetic of the shader: its numbers, and what it does about their errors.
pub(crate) trait Policy<S: Simd> {
    type Lane: Lane;

    /// a b + c.
    fn product_plus(
        a: LaneVector<S, Self>,
        b: LaneVector<S, Self>,
        c: LaneVector<S, Self>,
    ) -> LaneVector<S, Self>;

    /// Whether values, of which `error` bounds the errors, are 0 or more.
    fn is_not_negative(value: LaneVector<S, Self>, error: f64) -> Answers<S, Self>;

    /// 1 − `one_minus`, as the factor of a power.
    #[inline(always)]
    fn factor(one_minus: LaneVector<S, Self>) -> LaneVector<S, Self> {
        -one_minus + <Self::Lane as Lane>::of(1.0)
    }

    /// The product of two factors.
    #[inline(always)]
    fn product(a: LaneVector<S, Self>, b: LaneVector<S, Self>) -> LaneVector<S, Self> {
        a * b
    }

    /// The square of a factor.
    #[inline(always)]
    fn square(factor: LaneVector<S, Self>) -> LaneVector<S, Self> {
        factor * factor
    }

    /// The number that a factor stands for.
    #[inline(always)]
    fn value(factor: LaneVector<S, Self>) -> LaneVector<S, Self> {
        factor
    }

    /// The highlights. `bright` has a bit for each pixel that may have one above 2⁻⁵⁹. Without
    /// bounds all others are made 0; with bounds they are kept, because the bounds allow for them.
    #[inline(always)]
    fn where_bright(_: S, highlight: LaneVector<S, Self>, _: u64) -> LaneVector<S, Self> {
        highlight
    }

    /// Samples rounded to f32, and those of each channel that are certain. `high` holds the pixels
    /// for which `low` has no room.
    fn round(
        simd: S,
        low: Samples<LaneVector<S, Self>>,
        high: Samples<LaneVector<S, Self>>,
    ) -> ([S::f32s; 3], [S::mask32s; 3]);
}

/// f64 with bounds.
pub(crate) struct Certified;

impl<S: Simd> Policy<S> for Certified {
    type Lane = f64;

    #[inline(always)]
    fn product_plus(a: S::f64s, b: S::f64s, c: S::f64s) -> S::f64s {
        a.mul_add(b, c)
    }

    #[inline(always)]
    fn is_not_negative(value: S::f64s, error: f64) -> Answers<S, Self> {
        (value.simd_gt(error), value.simd_lt(-error))
    }

    #[inline(always)]
    fn round(
        _: S,
        low: Samples<S::f64s>,
        high: Samples<S::f64s>,
    ) -> ([S::f32s; 3], [S::mask32s; 3]) {
        let [a, b, c] = low.channels;
        let [d, e, f] = high.channels;
        let lower = [
            f64::narrow::<S>(a - low.error, d - high.error),
            f64::narrow::<S>(b - low.error, e - high.error),
            f64::narrow::<S>(c - low.error, f - high.error),
        ];
        let upper = [
            f64::narrow::<S>(a + low.error, d + high.error),
            f64::narrow::<S>(b + low.error, e + high.error),
            f64::narrow::<S>(c + low.error, f + high.error),
        ];
        // A NaN is not equal to itself, so it is in doubt, too.
        let are_certain = [
            lower[0].simd_eq(upper[0]),
            lower[1].simd_eq(upper[1]),
            lower[2].simd_eq(upper[2]),
        ];
        (upper, are_certain)
    }
}

/// Without bounds.
impl<S: Simd, L: Lane> Policy<S> for L {
    type Lane = L;

    #[inline(always)]
    fn product_plus(a: L::Vector<S>, b: L::Vector<S>, c: L::Vector<S>) -> L::Vector<S> {
        a * b + c
    }

    #[inline(always)]
    fn is_not_negative(value: L::Vector<S>, _: f64) -> Answers<S, Self> {
        let is_not_negative = value.simd_ge(L::of(0.0));
        (is_not_negative, !is_not_negative)
    }

    // A factor 1 − x is kept as x: 1 − x would lose the digits of a small x.

    #[inline(always)]
    fn factor(one_minus: L::Vector<S>) -> L::Vector<S> {
        one_minus
    }

    #[inline(always)]
    fn product(a: L::Vector<S>, b: L::Vector<S>) -> L::Vector<S> {
        a + b - a * b
    }

    #[inline(always)]
    fn square(factor: L::Vector<S>) -> L::Vector<S> {
        factor * (-factor + L::of(2.0))
    }

    #[inline(always)]
    fn value(factor: L::Vector<S>) -> L::Vector<S> {
        -factor.min(L::of(1.0)) + L::of(1.0)
    }

    // Without this, a picture would depend on where vectors begin.
    #[inline(always)]
    fn where_bright(simd: S, highlight: L::Vector<S>, bright: u64) -> L::Vector<S> {
        let is_bright = <L::Vector<S> as SimdBase<S>>::Mask::from_bitmask(simd, bright);
        is_bright.select(highlight, L::Vector::<S>::splat(simd, L::of(0.0)))
    }

    #[inline(always)]
    fn round(
        simd: S,
        low: Samples<L::Vector<S>>,
        high: Samples<L::Vector<S>>,
    ) -> ([S::f32s; 3], [S::mask32s; 3]) {
        let [a, b, c] = low.channels;
        let [d, e, f] = high.channels;
        let samples = [
            L::narrow::<S>(a, d),
            L::narrow::<S>(b, e),
            L::narrow::<S>(c, f),
        ];
        (samples, [S::mask32s::splat(simd, true); 3])
    }
}
