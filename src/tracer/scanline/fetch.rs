//! Memory that is asked for before it is needed.

/// Asks for the memory of what is needed soon. What is not at hand makes the work that needs it
/// wait, each time anew; what is asked for in a row comes at once.
#[inline(always)]
pub(crate) fn fetch<T: Copy>(value: &T) {
    std::hint::black_box(*value);
}
