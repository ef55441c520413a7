//! Rows written past the caches, for pictures that do not fit into them.
//!
//! A plain store first fetches the cache line that it writes to, and pushes another one out. Both
//! are for nothing if the picture leaves the cache before it is read. So a row is traced into a
//! buffer that stays in the cache, and copied from there by stores that go to memory directly.
//! Where a picture fits, these are slower: on an AMD EPYC (Zen 5, 32 MiB of last-level cache), one
//! thread of `exact` took 0.20 instead of 0.17 ms at N = 500, 0.99 instead of 0.83 at 1400, but
//! 1.98 instead of 2.15 at 2000 and 7.9 instead of 8.8 at 4000.

/// The bytes of the largest picture that is stored as usual: N is 1672.
pub(super) const PLAIN: usize = 32 << 20;

/// Copies a row; the slices are of one length. Other threads see it in order only after [`finish`].
#[cfg(target_arch = "x86_64")]
pub(super) fn copy(from: &[f32], to: &mut [f32]) {
    use std::arch::x86_64::{_mm_loadu_ps, _mm_stream_ps};

    /// Floats in a cache line, and in a vector of SSE2, which every x86-64 has.
    const LINE: usize = 16;
    const VECTOR: usize = 4;

    // What shares its line with another row is stored as usual.
    let head = to.as_ptr().align_offset(4 * LINE).min(to.len());
    let (to_head, to) = to.split_at_mut(head);
    let (from_head, from) = from.split_at(head);
    to_head.copy_from_slice(from_head);
    let (to_lines, to_tail) = to.as_chunks_mut::<LINE>();
    let (from_lines, from_tail) = from.as_chunks::<LINE>();
    to_tail.copy_from_slice(from_tail);
    for (to, from) in to_lines.iter_mut().zip(from_lines) {
        for place in (0..LINE).step_by(VECTOR) {
            // SAFETY: both lines have 16 floats, of which these are four, and `to` begins at a
            // multiple of 64 bytes: `head` floats on from where the row begins, and whole lines on
            // from there.
            unsafe {
                let vector = _mm_loadu_ps(from.as_ptr().add(place));
                _mm_stream_ps(to.as_mut_ptr().add(place), vector);
            }
        }
    }
}

/// Orders all that this thread has copied before whatever it writes from now on.
#[cfg(target_arch = "x86_64")]
pub(super) fn finish() {
    // SAFETY: every x86-64 processor has SSE.
    unsafe { std::arch::x86_64::_mm_sfence() };
}

/// Copies a row; the slices are of one length.
#[cfg(not(target_arch = "x86_64"))]
pub(super) fn copy(from: &[f32], to: &mut [f32]) {
    to.copy_from_slice(from);
}

/// There is nothing to order.
#[cfg(not(target_arch = "x86_64"))]
pub(super) fn finish() {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_copied_whatever_its_alignment_and_length() {
        let from: Vec<f32> = (0..300).map(|sample| sample as f32).collect();
        for start in 0..20 {
            for length in [0, 1, 3, 15, 16, 17, 33, 100, 257] {
                let mut to = vec![-1.0; 300];
                copy(&from[7..7 + length], &mut to[start..start + length]);
                finish();
                assert!(to[start..start + length] == from[7..7 + length]);
                let outside = to[..start].iter().chain(&to[start + length..]);
                assert!(outside.copied().all(|sample| sample == -1.0));
            }
        }
    }
}
