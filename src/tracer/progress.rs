//! How far a frame is, and whether anybody still wants it.

use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicBool, AtomicU32};

/// How far a tracer is with its frame, to be asked on any thread while it traces.
#[derive(Clone, Debug, Default)]
pub struct Progress(Arc<State>);

#[derive(Debug, Default)]
struct State {
    rows: AtomicU32,
    is_cancelled: AtomicBool,
}

impl Progress {
    /// How many rows of the frame are done, 0 to N, in steps of some rows; 0 before the first
    /// frame.
    pub fn rows(&self) -> u32 {
        self.0.rows.load(Relaxed)
    }

    /// Ends the frame that is traced now, within the row that each thread is in or after it, with
    /// [`TraceError::Cancelled`](super::TraceError::Cancelled). The frames after it are traced as
    /// ever; between frames this has no effect.
    pub fn cancel(&self) {
        self.0.is_cancelled.store(true, Relaxed);
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.0.is_cancelled.load(Relaxed)
    }

    pub(super) fn begin(&self) {
        self.0.rows.store(0, Relaxed);
        self.0.is_cancelled.store(false, Relaxed);
    }

    pub(crate) fn add(&self, rows: u32) {
        self.0.rows.fetch_add(rows, Relaxed);
    }
}
