//! The colours of a frame that are filled in.

use bumpalo::Bump;
use bumpalo::collections::Vec;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4};

use crate::tracer::decision::Decision;

/// What many pixels show, and their colour as it lies in memory: the same pixel again and again.
pub(super) struct Paint {
    pub(super) decision: Decision,
    /// Three vectors hold a whole number of pixels, of any width up to a third of this.
    samples: [f32; 3 * 16],
}

impl Paint {
    pub(super) fn new(decision: Decision, color: [f32; 3]) -> Paint {
        Paint {
            decision,
            samples: std::array::from_fn(|i| color[i % 3]),
        }
    }

    pub(super) fn color(&self) -> [f32; 3] {
        [self.samples[0], self.samples[1], self.samples[2]]
    }
}

/// All paints of a frame, as they are found to be needed.
pub(super) struct Paints<'f, 'c> {
    color: &'c dyn Fn(Decision) -> [f32; 3],
    all: Vec<'f, Paint>,
}

/// Which of them.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct PaintNumber(u32);

impl<'f, 'c> Paints<'f, 'c> {
    /// `color` tells what decisions look like.
    pub(super) fn new(color: &'c dyn Fn(Decision) -> [f32; 3], arena: &'f Bump) -> Self {
        Paints {
            color,
            all: Vec::new_in(arena),
        }
    }

    pub(super) fn of(&mut self, decision: Decision) -> PaintNumber {
        self.all.push(Paint::new(decision, (self.color)(decision)));
        PaintNumber(self.all.len() as u32 - 1)
    }

    pub(super) fn all(self) -> AllPaints<'f> {
        AllPaints(self.all.into_bump_slice())
    }
}

/// The paints of a frame.
pub(super) struct AllPaints<'f>(&'f [Paint]);

impl std::ops::Index<PaintNumber> for AllPaints<'_> {
    type Output = Paint;

    fn index(&self, number: PaintNumber) -> &Paint {
        &self.0[number.0 as usize]
    }
}

/// Fills samples with a colour.
#[inline(always)]
pub(super) fn fill<S: Simd>(simd: S, samples: &mut [f32], paint: &Paint) {
    if samples.len() >= 3 * S::f32s::LEN {
        fill_by::<S, S::f32s>(simd, samples, paint);
    } else if samples.len() >= 3 * 4 {
        fill_by::<S, f32x4<S>>(simd, samples, paint);
    } else {
        for (sample, color) in samples.iter_mut().zip(&paint.samples) {
            *sample = *color;
        }
    }
}

/// Fills no fewer samples than three vectors hold.
#[inline(always)]
fn fill_by<S: Simd, V: SimdFloat<S, Element = f32>>(simd: S, samples: &mut [f32], paint: &Paint) {
    let width = V::LEN;
    let first = V::from_slice(simd, &paint.samples[..width]);
    let second = V::from_slice(simd, &paint.samples[width..2 * width]);
    let third = V::from_slice(simd, &paint.samples[2 * width..3 * width]);
    // The last block may lie on part of the one before it.
    let last = samples.len() - 3 * width;
    for block in samples.chunks_exact_mut(3 * width) {
        put(block, first, second, third);
    }
    put(&mut samples[last..], first, second, third);
}

/// By value, so that the vectors stay in registers.
#[inline(always)]
fn put<S: Simd, V: SimdFloat<S, Element = f32>>(block: &mut [f32], first: V, second: V, third: V) {
    let (one, rest) = block.split_at_mut(V::LEN);
    let (two, three) = rest.split_at_mut(V::LEN);
    first.store_slice(one);
    second.store_slice(two);
    third.store_slice(three);
}
