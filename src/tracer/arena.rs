//! The memory of a frame: everything that a frame is made of lies side by side, and the next frame
//! lies in the same place.
//!
//! Nothing here is dropped; what frames are made of owns nothing.

use bumpalo::Bump;
use bumpalo::collections::Vec;
use bumpalo_herd::{Herd, Member};

/// What frames lie in, one after the other. After the first few the system is asked for no more
/// memory.
#[derive(Default)]
pub(super) struct Arena {
    /// For what every frame needs, made before its first row.
    pub(super) frame: Bump,
    /// For what threads find to be needed while they trace.
    pub(super) late: Herd,
}

impl Arena {
    /// Makes room for the next frame.
    pub(super) fn clear(&mut self) {
        self.frame.reset();
        self.late.reset();
    }
}

/// Where slices can be laid down that live as long as a frame.
pub(super) trait Room<'f> {
    /// All items, side by side.
    fn lay<T>(&self, items: impl ExactSizeIterator<Item = T>) -> &'f [T];
}

impl<'f> Room<'f> for &'f Bump {
    fn lay<T>(&self, items: impl ExactSizeIterator<Item = T>) -> &'f [T] {
        self.alloc_slice_fill_iter(items)
    }
}

impl<'f> Room<'f> for Member<'f> {
    fn lay<T>(&self, items: impl ExactSizeIterator<Item = T>) -> &'f [T] {
        self.alloc_slice_fill_iter(items)
    }
}

/// As many items as there are, side by side.
pub(super) fn collect<T>(arena: &Bump, items: impl IntoIterator<Item = T>) -> &[T] {
    let mut all = Vec::new_in(arena);
    all.extend(items);
    all.into_bump_slice()
}
