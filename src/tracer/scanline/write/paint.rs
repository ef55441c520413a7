//! The colours of a frame that are filled in.

use bumpalo::Bump;
use bumpalo::collections::Vec;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4};

use crate::tracer::decision::Decision;

/// What many pixels show, and their colour as it lies in memory: the same pixel again and again.
pub(crate) struct Paint {
    pub(crate) decision: Decision,
    /// As many as a vector of any width holds, from any of the three channels on.
    samples: [f32; 16 + 2],
}

impl Paint {
    pub(crate) fn new(decision: Decision, color: [f32; 3]) -> Paint {
        Paint {
            decision,
            samples: std::array::from_fn(|i| color[i % 3]),
        }
    }

    /// A vector of samples, of which the first is so many on from a pixel's first.
    #[inline(always)]
    fn from<S: Simd, V: SimdFloat<S, Element = f32>>(&self, simd: S, index: usize) -> V {
        let channel = index % 3;
        V::from_slice(simd, &self.samples[channel..channel + V::LEN])
    }

    pub(crate) fn bits(&self) -> Bits {
        let [red, green, blue] = self.color().map(f32::to_bits);
        (u64::from(red) << 32 | u64::from(green), blue)
    }

    pub(crate) fn color(&self) -> [f32; 3] {
        [self.samples[0], self.samples[1], self.samples[2]]
    }
}

/// The bits of a colour's three samples.
pub(crate) type Bits = (u64, u32);

/// All paints of a frame, as they are found to be needed.
pub(crate) struct Paints<'f, 'c> {
    color: &'c dyn Fn(Decision) -> [f32; 3],
    all: Vec<'f, Paint>,
}

/// Which of them.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct PaintNumber(pub(crate) u32);

impl<'f, 'c> Paints<'f, 'c> {
    /// `color` tells what decisions look like.
    pub(crate) fn new(color: &'c dyn Fn(Decision) -> [f32; 3], arena: &'f Bump) -> Self {
        Paints {
            color,
            all: Vec::new_in(arena),
        }
    }

    pub(crate) fn of(&mut self, decision: Decision) -> PaintNumber {
        self.all.push(Paint::new(decision, (self.color)(decision)));
        PaintNumber(self.all.len() as u32 - 1)
    }

    pub(crate) fn all(self) -> AllPaints<'f> {
        AllPaints(self.all.into_bump_slice())
    }
}

/// The paints of a frame.
pub(crate) struct AllPaints<'f>(&'f [Paint]);

impl std::ops::Index<PaintNumber> for AllPaints<'_> {
    type Output = Paint;

    fn index(&self, number: PaintNumber) -> &Paint {
        &self.0[number.0 as usize]
    }
}

/// Fills samples with a colour, from its first channel on.
#[inline(always)]
pub(crate) fn fill<S: Simd>(simd: S, samples: &mut [f32], paint: &Paint) {
    if samples.len() >= S::f32s::LEN {
        fill_by::<S, S::f32s>(simd, samples, paint);
    } else if samples.len() >= 4 {
        fill_by::<S, f32x4<S>>(simd, samples, paint);
    } else {
        for (sample, color) in samples.iter_mut().zip(&paint.samples) {
            *sample = *color;
        }
    }
}

/// Fills no fewer samples than a vector holds. How many there are is not to be foreseen, so no
/// branch depends on that but one and the end of the loop: vectors may lie on part of others.
#[inline(always)]
fn fill_by<S: Simd, V: SimdFloat<S, Element = f32>>(simd: S, samples: &mut [f32], paint: &Paint) {
    let width = V::LEN;
    let last = samples.len() - width;
    store::<S, V>(simd, samples, 0, paint);
    if last <= 4 * width {
        for index in [width, 2 * width, 3 * width, last] {
            store::<S, V>(simd, samples, index.min(last), paint);
        }
        return;
    }
    // Of all others but the last none crosses from one cache line into the next: that takes twice
    // as long.
    let first = samples.as_ptr().align_offset(4 * width).min(last);
    let one = paint.from::<S, V>(simd, first);
    let two = paint.from::<S, V>(simd, first + width);
    let three = paint.from::<S, V>(simd, first + 2 * width);
    for block in samples[first..].chunks_exact_mut(3 * width) {
        one.store_slice(&mut block[..width]);
        two.store_slice(&mut block[width..2 * width]);
        three.store_slice(&mut block[2 * width..]);
    }
    for back in [2 * width, width, 0] {
        store::<S, V>(simd, samples, last - back, paint);
    }
}

/// Stores a vector of samples at `index`.
#[inline(always)]
fn store<S: Simd, V: SimdFloat<S, Element = f32>>(
    simd: S,
    samples: &mut [f32],
    index: usize,
    paint: &Paint,
) {
    let vector = paint.from::<S, V>(simd, index);
    vector.store_slice(&mut samples[index..index + V::LEN]);
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};

    use super::*;

    #[test]
    fn samples_are_filled_from_any_place_to_any_other() {
        let paint = Paint::new(Decision::Background, [0.25, 0.5, 0.75]);
        for level in [Level::new(), Level::baseline()] {
            for length in (0..80).chain([150, 299, 300, 301]) {
                for start in 0..20 {
                    let mut samples = vec![1.0; start + 3 * length + 20];
                    let filled = &mut samples[start..start + 3 * length];
                    dispatch!(level, simd => fill(simd, filled, &paint));
                    for (index, sample) in samples.into_iter().enumerate() {
                        let expected = match index.checked_sub(start) {
                            Some(index) if index < 3 * length => [0.25, 0.5, 0.75][index % 3],
                            _ => 1.0,
                        };
                        assert_eq!(sample, expected, "{length} pixels from {start}: {index}");
                    }
                }
            }
        }
    }
}
