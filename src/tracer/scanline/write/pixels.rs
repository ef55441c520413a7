//! Stores pixels as they lie in memory: red, green, blue, red and so on.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

/// The most floats of a vector at any level.
pub(crate) const MAX_LANES: usize = 16;

/// A bit for each sample of [`MAX_LANES`] pixels: whether it is red.
const RED: u64 = 0o1_111_111_111_111_111;

/// The samples of pixels as they lie in memory, in as many vectors as there are channels.
#[inline(always)]
pub(crate) fn interleaved<S: Simd>(simd: S, [red, green, blue]: [S::f32s; 3]) -> [S::f32s; 3] {
    const { assert!(S::f32s::LEN <= MAX_LANES) };
    let (mut samples, greens, blues) = (spread(red), spread(green), spread(blue));
    for (i, sample) in samples.iter_mut().enumerate() {
        let is_green = S::mask32s::from_bitmask(simd, RED << 1 >> (i * S::f32s::LEN));
        let is_blue = S::mask32s::from_bitmask(simd, RED << 2 >> (i * S::f32s::LEN));
        *sample = is_blue.select(blues[i], is_green.select(greens[i], *sample));
    }
    samples
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

/// Stores the first `count` of the pixels in three vectors. The processor can predict whether they
/// are all, but not how many: so what follows them in memory is stored again.
#[inline(always)]
pub(crate) fn store<S: Simd>(simd: S, samples: &mut [f32], vectors: &[S::f32s; 3], count: usize) {
    let width = S::f32s::LEN;
    if samples.len() < 3 * width {
        let mut all = [0.0; 3 * MAX_LANES];
        for (i, vector) in vectors.iter().enumerate() {
            vector.store_slice(&mut all[i * width..(i + 1) * width]);
        }
        samples[..3 * count].copy_from_slice(&all[..3 * count]);
        return;
    }
    if count == width {
        for (i, vector) in vectors.iter().enumerate() {
            vector.store_slice(&mut samples[i * width..(i + 1) * width]);
        }
        return;
    }
    let stored = (1_u64 << (3 * count)) - 1;
    for (i, vector) in vectors.iter().enumerate() {
        let place = &mut samples[i * width..(i + 1) * width];
        let is_stored = S::mask32s::from_bitmask(simd, stored >> (i * width));
        let after = S::f32s::from_slice(simd, place);
        is_stored.select(*vector, after).store_slice(place);
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};

    use super::*;

    #[inline(always)]
    fn interleaved_numbers<S: Simd>(simd: S) -> Vec<f32> {
        let numbers: [f32; MAX_LANES] = std::array::from_fn(|pixel| pixel as f32);
        let red = S::f32s::from_slice(simd, &numbers[..S::f32s::LEN]);
        let samples = interleaved(simd, [red, red + 100.0, red + 200.0]);
        samples
            .iter()
            .flat_map(|vector| vector.as_slice().to_vec())
            .collect()
    }

    #[test]
    fn samples_lie_as_in_memory() {
        for level in [Level::new(), Level::baseline(), Level::fallback()] {
            let samples = dispatch!(level, simd => interleaved_numbers(simd));
            assert!(!samples.is_empty());
            for (index, sample) in samples.into_iter().enumerate() {
                let expected = (index / 3 + 100 * (index % 3)) as f32;
                assert_eq!(sample, expected, "{level:?}, {index}");
            }
        }
    }
}
