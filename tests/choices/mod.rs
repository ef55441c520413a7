//! Choices at random, the same in every run.

/// Chooses numbers from 0 to before the one that it is called with.
pub(crate) fn choices() -> impl FnMut(usize) -> usize {
    let mut random = 1u64;
    move |count| {
        // Knuth's multiplier for 64 bits; the upper half is the random one.
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (random >> 33) as usize % count
    }
}
