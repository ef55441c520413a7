//! The memory of a frame: all its parts lie side by side, and the next frame reuses the memory.
//!
//! The parts of frames own nothing, so none is dropped.

use bumpalo::Bump;
use bumpalo::collections::Vec;
use bumpalo_herd::{Herd, Member};

/// The memory of one frame after the other. After the first few, it does not grow any more.
#[derive(Default)]
pub(super) struct Arena {
    /// For the parts that are made before the first row.
    pub(super) setup: Bump,
    /// For the parts that threads make while they trace.
    pub(super) threads: Herd,
}

impl Arena {
    /// Makes room for the next frame.
    pub(super) fn clear(&mut self) {
        self.setup.reset();
        self.threads.reset();
    }
}

/// Memory for slices that live as long as a frame.
pub(super) trait SliceAllocator<'f> {
    /// A slice of all items.
    fn slice_of<T>(&self, items: impl ExactSizeIterator<Item = T>) -> &'f [T];
}

impl<'f> SliceAllocator<'f> for &'f Bump {
    fn slice_of<T>(&self, items: impl ExactSizeIterator<Item = T>) -> &'f [T] {
        self.alloc_slice_fill_iter(items)
    }
}

impl<'f> SliceAllocator<'f> for Member<'f> {
    fn slice_of<T>(&self, items: impl ExactSizeIterator<Item = T>) -> &'f [T] {
        self.alloc_slice_fill_iter(items)
    }
}

/// A slice of all items, however many there are.
pub(super) fn collect<T>(arena: &Bump, items: impl IntoIterator<Item = T>) -> &[T] {
    let mut all = Vec::new_in(arena);
    all.extend(items);
    all.into_bump_slice()
}
