//! Memory that is asked for before it is needed.

/// Reads what is needed soon, so that it is in the cache by then. Work that needs what is not waits
/// for it, each time anew; what is read side by side comes at once. Nothing but time depends on it.
#[inline(always)]
pub(crate) fn fetch<T: Copy>(value: &T) {
    std::hint::black_box(*value);
}
