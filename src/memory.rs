//! Memory that may be refused.
//!
//! A collection that cannot grow ends the process, as Rust has it. What is as large as a picture is
//! asked for so that a refusal is an error instead, and a program's own allocator can tell the two
//! apart by [`is_dispensable`].

use std::cell::Cell;
use std::collections::TryReserveError;

thread_local! {
    static DISPENSABLE: Cell<bool> = const { Cell::new(false) };
}

/// Whether the memory that this thread is asking for now may be refused: an error is returned then,
/// and nothing else happens.
///
/// For a global allocator that ends the program in its own way where other memory cannot be had. It
/// allocates nothing.
pub fn is_dispensable() -> bool {
    DISPENSABLE.get()
}

/// Makes room for exactly so many items more, if there is room.
pub(crate) fn reserve<T>(items: &mut Vec<T>, more: usize) -> Result<(), TryReserveError> {
    DISPENSABLE.set(true);
    let reserved = items.try_reserve_exact(more);
    DISPENSABLE.set(false);
    reserved
}
