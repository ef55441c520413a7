//! The memory that rows are traced into.

use super::decision::Decision;
use super::scanline::RowHistory;

/// The memory of some rows.
pub(super) struct Target<'t> {
    /// N.
    pub(super) size: u32,
    pub(super) samples: &'t mut [f32],
    pub(super) decisions: Option<&'t mut [Decision]>,
    pub(super) history: Option<&'t mut [RowHistory]>,
}

impl<'t> Target<'t> {
    /// Splits the rows into bands of `rows`.
    pub(super) fn split(self, rows: usize) -> impl Iterator<Item = Target<'t>> {
        let size = self.size;
        let width = size as usize;
        let mut decisions = self.decisions.map(|all| all.chunks_mut(width * rows));
        let mut history = self.history.map(|all| all.chunks_mut(rows));
        let samples = self.samples.chunks_mut(3 * width * rows);
        samples.map(move |samples| Target {
            size,
            samples,
            decisions: decisions.as_mut().and_then(Iterator::next),
            history: history.as_mut().and_then(Iterator::next),
        })
    }
}
