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

/// The items of each of `count` buckets, in the order in which `items` has them; then where each
/// bucket begins among them, and where the last ends.
pub(super) fn bucketed<T: Copy + Default>(
    arena: &Bump,
    count: usize,
    items: impl DoubleEndedIterator<Item = (usize, T)> + Clone,
) -> (&[T], &[u32]) {
    let starts = arena.alloc_slice_fill_copy(count + 1, 0);
    for (bucket, _) in items.clone() {
        starts[bucket] += 1;
    }
    let mut end = 0;
    for start in &mut *starts {
        end += *start;
        *start = end;
    }
    let all = arena.alloc_slice_fill_copy(end as usize, T::default());
    // Each bucket is filled from its end.
    for (bucket, item) in items.rev() {
        starts[bucket] -= 1;
        all[starts[bucket] as usize] = item;
    }
    (all, starts)
}

/// A slice of at most so many items does not grow while they are collected.
const FEW: usize = 8;

/// A slice of all items, however many there are.
pub(super) fn collect<T>(arena: &Bump, items: impl IntoIterator<Item = T>) -> &[T] {
    // A slice that grows is copied. Room that is not needed is given back.
    let items = items.into_iter();
    let (least, most) = items.size_hint();
    let expected = most.map_or(least, |most| most.min(FEW).max(least));
    let mut all = Vec::with_capacity_in(expected, arena);
    all.extend(items);
    all.shrink_to_fit();
    all.into_bump_slice()
}
