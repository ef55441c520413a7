//! Stores pixels as they lie in memory: red, green, blue, red and so on.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

/// Stores the first `count` of the pixels in three vectors. The processor cannot predict how many,
/// so no branch depends on it: what follows them in memory is stored again.
#[inline(always)]
pub(crate) fn store<S: Simd>(simd: S, samples: &mut [f32], vectors: &[S::f32s; 3], count: usize) {
    let width = S::f32s::LEN;
    if samples.len() < 3 * width {
        let mut all = [0.0; 3 * 16];
        for (i, vector) in vectors.iter().enumerate() {
            vector.store_slice(&mut all[i * width..(i + 1) * width]);
        }
        samples[..3 * count].copy_from_slice(&all[..3 * count]);
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
