//! The memory of a frame: all its parts lie side by side, and the next frame reuses the memory.
//!
//! The parts in `setup` and `threads` own nothing, so none is dropped. The tiles own their memory,
//! which the next frame reuses.

use std::cell::Cell;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, OnceLock};

use bumpalo::Bump;
use bumpalo::collections::Vec;
use bumpalo_herd::{Herd, Member};

use super::pool::lock;
use super::tiles::Tiles;

/// The memory of one frame after the other. After the first few, it does not grow any more.
#[derive(Default)]
pub(super) struct Arena {
    /// For the parts that are made before the first row.
    pub(super) setup: Bump,
    /// For the parts that threads make while they trace.
    pub(super) threads: Herd,
    /// The tiles of the scene, and of its mirror image.
    pub(super) tiles: [OnDemand<Tiles>; 2],
}

impl Arena {
    /// Makes room for the next frame.
    pub(super) fn clear(&mut self) {
        self.setup.reset();
        self.threads.reset();
        self.tiles.iter_mut().for_each(OnDemand::clear);
    }
}

/// A part of a frame that is made where it is first asked for, in memory of its own.
#[derive(Default)]
pub(super) struct OnDemand<T> {
    made: OnceLock<T>,
    /// The part of a frame before, whose memory is reused.
    before: Mutex<T>,
    /// How often [`OnDemand::pays_after`] was called before the part was made.
    calls: AtomicU32,
}

impl<T: Default> OnDemand<T> {
    /// The part. The first call makes it: `make` gets that of an earlier frame, or an empty one,
    /// and overwrites it.
    pub(super) fn get(&self, make: impl FnOnce(&mut T)) -> &T {
        self.made.get_or_init(|| {
            let mut part = std::mem::take(&mut *lock(&self.before));
            make(&mut part);
            part
        })
    }

    /// Whether the part is made, or this is not one of the first so many calls of a frame: for a
    /// part that takes longer to make than a few do without.
    pub(super) fn pays_after(&self, calls: u32) -> bool {
        self.made.get().is_some() || self.calls.fetch_add(1, Ordering::Relaxed) >= calls
    }

    fn clear(&mut self) {
        *self.calls.get_mut() = 0;
        if let Some(part) = self.made.take() {
            self.before = Mutex::new(part);
        }
    }
}

/// Short slices, kept in blocks of memory. A block is written as a whole before it is needed, so
/// that it is in the cache: a copy to other memory would wait for each of its cache lines.
pub(super) struct Blocks<'f, T> {
    /// What is left of a block.
    rest: Cell<&'f mut [T]>,
}

/// The bytes of a block: a part of the first cache.
const BLOCK: usize = 1 << 14;

impl<T> Default for Blocks<'_, T> {
    fn default() -> Self {
        Blocks {
            rest: Cell::default(),
        }
    }
}

impl<'f, T: Copy> Blocks<'f, T> {
    /// A copy of a slice, in a block or in a part of `memory` that becomes one.
    pub(super) fn keep(&self, items: &[T], memory: &Member<'f>) -> &'f [T] {
        let Some(first) = items.first() else {
            return &[];
        };
        let mut rest = self.rest.take();
        if rest.len() < items.len() {
            let count = items.len().max(BLOCK / size_of::<T>());
            rest = memory.alloc_slice_fill_copy(count, *first);
        }
        let (kept, rest) = rest.split_at_mut(items.len());
        kept.copy_from_slice(items);
        self.rest.set(rest);
        kept
    }
}

/// Memory for slices that live as long as a frame.
pub(super) trait SliceAllocator<'f> {
    /// A slice of all items.
    fn slice_of<T>(&self, items: impl ExactSizeIterator<Item = T>) -> &'f [T];

    /// A slice of as many items as `count`, each made from its index where it is kept.
    fn slice_with<T>(&self, count: usize, item: impl FnMut(usize) -> T) -> &'f [T];
}

impl<'f> SliceAllocator<'f> for &'f Bump {
    fn slice_of<T>(&self, items: impl ExactSizeIterator<Item = T>) -> &'f [T] {
        self.alloc_slice_fill_iter(items)
    }

    fn slice_with<T>(&self, count: usize, item: impl FnMut(usize) -> T) -> &'f [T] {
        self.alloc_slice_fill_with(count, item)
    }
}

impl<'f> SliceAllocator<'f> for Member<'f> {
    fn slice_of<T>(&self, items: impl ExactSizeIterator<Item = T>) -> &'f [T] {
        self.alloc_slice_fill_iter(items)
    }

    fn slice_with<T>(&self, count: usize, item: impl FnMut(usize) -> T) -> &'f [T] {
        self.alloc_slice_fill_with(count, item)
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

/// A slice of all items, however many there are.
pub(super) fn collect<T>(arena: &Bump, items: impl IntoIterator<Item = T>) -> &[T] {
    let mut all = Vec::new_in(arena);
    all.extend(items);
    all.into_bump_slice()
}
