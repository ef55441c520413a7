//! The progress of a frame.

use std::sync::Arc;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

/// The progress of a tracer's frame, which any thread may read while it is traced.
#[derive(Clone, Debug, Default)]
pub struct Progress(Arc<AtomicU32>);

impl Progress {
    /// The number of rows that are done.
    pub fn rows(&self) -> u32 {
        self.0.load(Relaxed)
    }

    pub(super) fn begin(&self) {
        self.0.store(0, Relaxed);
    }

    pub(crate) fn add(&self, rows: u32) {
        self.0.fetch_add(rows, Relaxed);
    }
}
