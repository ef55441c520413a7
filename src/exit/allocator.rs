//! The global allocator: the system's, and one line where that has no more memory.

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::{self, Cursor, Write as _};

use firsthit::memory::is_dispensable;

use super::{claim, now};

/// The system's allocator, except that the program exits where memory is refused that it cannot do
/// without. Otherwise each caller would abort or panic in its own words, and some only after asking
/// for more.
pub(crate) struct Allocator;

// SAFETY: every call is handed on to the system's allocator with what it came with, and what that
// returns is returned, or nothing is.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller has promised.
        checked(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller has promised.
        checked(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as the caller has promised.
        checked(unsafe { System.realloc(memory, layout, size) }, size)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as the caller has promised.
        unsafe { System.dealloc(memory, layout) };
    }
}

/// The memory that was asked for; else exits.
fn checked(memory: *mut u8, size: usize) -> *mut u8 {
    if memory.is_null() && !is_dispensable() {
        refused(size);
    }
    memory
}

#[cold]
fn refused(size: usize) -> ! {
    claim();
    // A line for which no memory is needed.
    let mut line = [0; 160];
    let mut end = Cursor::new(&mut line[..]);
    let _ = writeln!(
        end,
        "firsthit: not enough memory ({size} bytes more are refused): choose a smaller size, a smaller scene or fewer threads"
    );
    let length = end.position() as usize;
    let _ = io::stderr().write_all(&line[..length]);
    now();
}
