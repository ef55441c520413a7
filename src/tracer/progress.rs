//! How far a frame is.

use std::sync::Arc;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

/// How far a tracer is with its frame, to be asked on any thread while it traces.
#[derive(Clone, Debug, Default)]
pub struct Progress(Arc<AtomicU32>);

impl Progress {
    /// How many rows of the frame are done.
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
