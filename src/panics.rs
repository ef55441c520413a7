//! Panics of libraries that we call, as errors.

use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static CAUGHT: Cell<bool> = const { Cell::new(false) };
}

/// Whether a panic on this thread would be caught now and become an error: a panic hook need not
/// print it.
pub fn is_caught() -> bool {
    CAUGHT.get()
}

/// What `call` returns, or what it panics with, in one line. What `call` has changed must not be
/// used after a panic.
pub(crate) fn caught<T>(call: impl FnOnce() -> T) -> Result<T, String> {
    let outer = CAUGHT.replace(true);
    let result = catch_unwind(AssertUnwindSafe(call));
    CAUGHT.set(outer);
    result.map_err(|panic| {
        words(&*panic)
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    })
}

/// What a panic says.
pub fn words(panic: &(dyn Any + Send)) -> &str {
    let owned = panic.downcast_ref::<String>().map(String::as_str);
    let words = owned.or_else(|| panic.downcast_ref::<&str>().copied());
    words.unwrap_or("a panic without words")
}
