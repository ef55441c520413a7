//! The fastest way to give every pixel one colour: what no kernel that writes the whole picture can
//! beat.

use std::fmt;

use crate::tracer::pool::Pool;

/// Floats after which the three of a colour stand again at the same place of a cache line.
const PATTERN: usize = 48;

/// The bytes of a cache line.
const LINE: usize = 64;

/// How a processor writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stores {
    /// Through the caches.
    Plain,
    /// Past them, into memory: faster for pictures that do not fit.
    NonTemporal,
}

impl Stores {
    pub(super) const ALL: [Stores; 2] = [Stores::Plain, Stores::NonTemporal];
}

impl fmt::Display for Stores {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Stores::Plain => "plain",
            Stores::NonTemporal => "non-temporal",
        })
    }
}

/// Gives every pixel of `samples`, three floats each, the same colour; in as many threads as `pool`
/// has, in this one without.
pub(super) fn fill(samples: &mut [f32], color: [f32; 3], stores: Stores, pool: Option<&mut Pool>) {
    match pool {
        None => fill_part(samples, color, stores),
        Some(pool) => {
            let threads = pool.threads();
            // Whole patterns, so that every part begins with a whole pixel.
            let part = samples
                .len()
                .div_ceil(threads)
                .max(1)
                .next_multiple_of(PATTERN);
            pool.share(samples.chunks_mut(part), |_, _, part| {
                fill_part(part, color, stores)
            });
        }
    }
}

fn fill_part(samples: &mut [f32], color: [f32; 3], stores: Stores) {
    // Stores that cross from one cache line into the next take twice as long.
    let unaligned = samples.as_ptr().align_offset(LINE).min(samples.len());
    let (head, rest) = samples.split_at_mut(unaligned);
    let (blocks, tail) = rest.as_chunks_mut::<PATTERN>();
    let pattern: [f32; PATTERN] = std::array::from_fn(|i| color[(unaligned + i) % 3]);
    for (sample, &of_color) in head.iter_mut().zip(color.iter().cycle()) {
        *sample = of_color;
    }
    tail.copy_from_slice(&pattern[..tail.len()]);
    fill_blocks(blocks, &pattern, stores);
}

#[cfg(not(target_arch = "x86_64"))]
fn fill_blocks(blocks: &mut [[f32; PATTERN]], pattern: &[f32; PATTERN], _: Stores) {
    blocks.fill(*pattern);
}

/// The blocks begin at a cache line.
#[cfg(target_arch = "x86_64")]
fn fill_blocks(blocks: &mut [[f32; PATTERN]], pattern: &[f32; PATTERN], stores: Stores) {
    use x86::*;
    let avx512 = is_x86_feature_detected!("avx512f");
    let avx = is_x86_feature_detected!("avx");
    // SAFETY: the processor has what the functions need, and the blocks are aligned.
    unsafe {
        match stores {
            Stores::Plain if avx512 => plain_512(blocks, pattern),
            Stores::Plain if avx => plain_256(blocks, pattern),
            Stores::Plain => plain_128(blocks, pattern),
            Stores::NonTemporal if avx512 => non_temporal_512(blocks, pattern),
            Stores::NonTemporal if avx => non_temporal_256(blocks, pattern),
            Stores::NonTemporal => non_temporal_128(blocks, pattern),
        }
        // Non-temporal stores are in no order with those of other threads until they are fenced.
        std::arch::x86_64::_mm_sfence();
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;

    use super::PATTERN;

    /// A function that writes `pattern` over every block by aligned stores of one width.
    ///
    /// # Safety
    /// The blocks begin at a multiple of 64 bytes; since a block has 192 bytes, then all do. The
    /// processor has the feature.
    macro_rules! stores {
        ($name:ident, $feature:literal, $lanes:literal, $zero:ident, $load:ident, $store:ident) => {
            #[target_feature(enable = $feature)]
            pub(super) unsafe fn $name(blocks: &mut [[f32; PATTERN]], pattern: &[f32; PATTERN]) {
                let mut vectors = [$zero(); PATTERN / $lanes];
                for (vector, part) in vectors.iter_mut().zip(pattern.chunks_exact($lanes)) {
                    // SAFETY: the part has as many floats as are loaded.
                    *vector = unsafe { $load(part.as_ptr()) };
                }
                for block in blocks {
                    for (part, &vector) in block.chunks_exact_mut($lanes).zip(&vectors) {
                        // SAFETY: the part has as many floats as are stored, and begins at a
                        // multiple of their bytes.
                        unsafe { $store(part.as_mut_ptr(), vector) };
                    }
                }
            }
        };
    }

    stores!(
        plain_128,
        "sse2",
        4,
        _mm_setzero_ps,
        _mm_loadu_ps,
        _mm_store_ps
    );
    stores!(
        plain_256,
        "avx",
        8,
        _mm256_setzero_ps,
        _mm256_loadu_ps,
        _mm256_store_ps
    );
    stores!(
        plain_512,
        "avx512f",
        16,
        _mm512_setzero_ps,
        _mm512_loadu_ps,
        _mm512_store_ps
    );
    stores!(
        non_temporal_128,
        "sse2",
        4,
        _mm_setzero_ps,
        _mm_loadu_ps,
        _mm_stream_ps
    );
    stores!(
        non_temporal_256,
        "avx",
        8,
        _mm256_setzero_ps,
        _mm256_loadu_ps,
        _mm256_stream_ps
    );
    stores!(
        non_temporal_512,
        "avx512f",
        16,
        _mm512_setzero_ps,
        _mm512_loadu_ps,
        _mm512_stream_ps
    );
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_has_the_colour_whatever_the_alignment_and_the_threads() {
        let color = [0.25, 0.5, 1.0];
        for mut pool in [None, Some(Pool::new(3).unwrap())] {
            for stores in Stores::ALL {
                for start in 0..20 {
                    for pixels in [0, 1, 5, 15, 16, 17, 33, 100, 1000] {
                        let mut samples = vec![-1.0; start + 3 * pixels + 1];
                        let inside = &mut samples[start..start + 3 * pixels];
                        fill(inside, color, stores, pool.as_mut());
                        assert!(inside.chunks_exact(3).all(|pixel| pixel == color));
                        let outside = samples[..start].iter().chain(samples.last());
                        assert!(outside.copied().all(|sample| sample == -1.0));
                    }
                }
            }
        }
    }
}
