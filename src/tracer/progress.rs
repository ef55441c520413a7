//! How far a frame is.

use std::sync::Arc;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

/// How far a tracer is with its frame, to be asked on any thread while it traces.
#[derive(Clone, Debug, Default)]
pub struct Progress(Arc<AtomicU32>);

impl Progress {
    /// How many rows of the frame are done. The kernels that go pixel by pixel count each row; the others are done at once with all.
    pub fn rows(&self) -> u32 {
        self.0.load(Relaxed)
    }

    pub(super) fn set(&self, rows: u32) {
        self.0.store(rows, Relaxed);
    }

    pub(super) fn add_row(&self) {
        self.0.fetch_add(1, Relaxed);
    }
}
