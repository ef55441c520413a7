//! Paints: the colours that spans are filled with.

use bumpalo::Bump;
use bumpalo::collections::Vec;
use bumpalo_herd::Member;
use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::tracer::arena::Blocks;
use crate::tracer::decision::Decision;
use crate::tracer::scanline::write::pixels;

/// A decision that many pixels show, and its colour as it lies in memory.
#[derive(Clone, Copy)]
pub(crate) struct Paint {
    pub(crate) decision: Decision,
    /// The three channels again and again: enough for a vector that begins with any of them.
    samples: [f32; pixels::MAX_LANES + 2],
}

impl Paint {
    pub(crate) fn new(decision: Decision, color: [f32; 3]) -> Paint {
        Paint {
            decision,
            samples: std::array::from_fn(|i| color[i % 3]),
        }
    }

    /// The vector of samples from number `index` on, where 0 is the first sample of a pixel.
    #[inline(always)]
    fn from<S: Simd>(&self, simd: S, index: usize) -> S::f32s {
        let channel = index % 3;
        S::f32s::from_slice(simd, &self.samples[channel..channel + S::f32s::LEN])
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

/// Room for the paints of a solid with late faces: two for each of its front faces, mostly three or
/// fewer. The paints of a frame take more, and grow.
const FEW: usize = 6;

/// The paints of a frame, or of late faces, while they are prepared.
pub(crate) struct Paints<'f, 'c> {
    color: &'c dyn Fn(Decision) -> [f32; 3],
    all: Vec<'f, Paint>,
}

/// The number of a paint.
#[derive(Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct PaintNumber(pub(crate) u32);

impl<'f, 'c> Paints<'f, 'c> {
    /// `color` tells the colour of a decision.
    pub(crate) fn new(color: &'c dyn Fn(Decision) -> [f32; 3], arena: &'f Bump) -> Self {
        Paints {
            color,
            all: Vec::with_capacity_in(FEW, arena),
        }
    }

    /// The paint of a decision.
    pub(crate) fn of(&self, decision: Decision) -> Paint {
        Paint::new(decision, (self.color)(decision))
    }

    pub(crate) fn add(&mut self, decision: Decision) -> PaintNumber {
        self.all.push(self.of(decision));
        PaintNumber(self.all.len() as u32 - 1)
    }

    /// Adds the paint of a decision that has the colour of another paint.
    pub(crate) fn add_like(&mut self, other: PaintNumber, decision: Decision) -> PaintNumber {
        self.all.push(Paint {
            decision,
            ..self.all[other.0 as usize]
        });
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

impl AllPaints<'_> {
    /// The same in other memory.
    pub(crate) fn kept_in<'k>(
        &self,
        blocks: &Blocks<'k, Paint>,
        memory: &Member<'k>,
    ) -> AllPaints<'k> {
        AllPaints(blocks.keep(self.0, memory))
    }
}

/// Fills the first `count` pixels of `samples` with a colour.
#[inline(always)]
pub(crate) fn fill<S: Simd>(simd: S, samples: &mut [f32], count: usize, paint: &Paint) {
    let width = S::f32s::LEN;
    if count <= width {
        let vectors = [
            paint.from(simd, 0),
            paint.from(simd, width),
            paint.from(simd, 2 * width),
        ];
        pixels::store(simd, samples, &vectors, count);
    } else {
        fill_many(simd, &mut samples[..3 * count], paint);
    }
}

/// Fills more than three vectors. The processor cannot predict how many, so only one branch and the
/// end of the loop depend on it: vectors may overlap instead.
#[inline(always)]
fn fill_many<S: Simd>(simd: S, samples: &mut [f32], paint: &Paint) {
    let width = S::f32s::LEN;
    let last = samples.len() - width;
    store(simd, samples, 0, paint);
    if last <= 4 * width {
        for index in [width, 2 * width, 3 * width, last] {
            store(simd, samples, index.min(last), paint);
        }
        return;
    }
    // A store that crosses into another cache line takes twice as long, so the rest is aligned.
    let first = samples.as_ptr().align_offset(4 * width).min(last);
    let one = paint.from(simd, first);
    let two = paint.from(simd, first + width);
    let three = paint.from(simd, first + 2 * width);
    for block in samples[first..].chunks_exact_mut(3 * width) {
        one.store_slice(&mut block[..width]);
        two.store_slice(&mut block[width..2 * width]);
        three.store_slice(&mut block[2 * width..]);
    }
    for back in [2 * width, width, 0] {
        store(simd, samples, last - back, paint);
    }
}

/// Stores a vector of samples at `index`.
#[inline(always)]
fn store<S: Simd>(simd: S, samples: &mut [f32], index: usize, paint: &Paint) {
    let vector = paint.from(simd, index);
    vector.store_slice(&mut samples[index..index + S::f32s::LEN]);
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};

    use super::*;

    #[test]
    fn samples_are_filled_from_any_place_to_any_other() {
        let paint = Paint::new(Decision::Background, [0.25, 0.5, 0.75]);
        for level in [Level::new(), Level::baseline(), Level::fallback()] {
            for length in (0..80).chain([150, 299, 300, 301]) {
                for start in 0..20 {
                    // With room for whole vectors after the span, and without.
                    let mut samples = vec![1.0; start + 3 * length + 3 * start];
                    dispatch!(level, simd => fill(simd, &mut samples[start..], length, &paint));
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
