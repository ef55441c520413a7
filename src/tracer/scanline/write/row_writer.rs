//! Writes the pixels of neighbouring rows.

use std::ops::Range;

use fearless_simd::{Level, dispatch};

use crate::tracer::decision::Decision;
use crate::tracer::ladder::Rung;
use crate::tracer::pixel::Pixel;
use crate::tracer::progress::Progress;
use crate::tracer::scanline::grid::{Columns, Grid};
use crate::tracer::scanline::shade::policy::Precision;
use crate::tracer::scanline::write::history::RowHistory;
use crate::tracer::scanline::write::paint::{self, Paint};
use crate::tracer::tally::Tally;

/// Neighbouring rows, which are written one after the other.
pub(crate) struct RowWriter<'r> {
    pub(crate) level: Level,
    pub(crate) precision: Precision,
    pub(crate) grid: Grid,
    /// The first of the rows.
    pub(crate) first: u32,
    /// The number of the row that is being written.
    pub(crate) row: u32,
    /// Y of that row.
    pub(crate) y: f64,
    /// The samples of all rows.
    pub(crate) samples: &'r mut [f32],
    pub(crate) decisions: Option<&'r mut [Decision]>,
    /// What the samples show from the frame before, if only differences are to be written.
    pub(crate) history: Option<&'r mut [RowHistory]>,
    /// Pixels that are still to be filled: the end of a row and the beginning of the next mostly
    /// show one paint, and lie side by side.
    pub(crate) pending: Option<(Range<usize>, &'r Paint)>,
    pub(crate) tally: Tally,
    /// Tells whether the rows are still wanted.
    pub(crate) progress: &'r Progress,
}

impl<'r> RowWriter<'r> {
    /// The indices of columns of the row among the pixels of all rows.
    pub(crate) fn pixels(&self, (from, to): Columns) -> Range<usize> {
        let start = (self.row - self.first) as usize * self.grid.size as usize;
        start + from as usize..start + to as usize
    }

    /// The history of the row.
    fn history(&mut self) -> Option<&mut RowHistory> {
        let index = (self.row - self.first) as usize;
        self.history.as_mut().map(|history| &mut history[index])
    }

    /// Fills columns with one paint.
    pub(crate) fn fill(&mut self, columns: Columns, paint: &'r Paint) {
        let pixels = self.pixels(columns);
        if let Some(decisions) = &mut self.decisions {
            decisions[pixels].fill(paint.decision);
        }
        // `self` cannot be borrowed while its history is.
        match self.history.take() {
            Some(history) => {
                let index = (self.row - self.first) as usize;
                let write = |columns| self.extend_pending(columns, paint);
                history[index].fill(columns, paint.bits(), write);
                self.history = Some(history);
            }
            None => self.extend_pending(columns, paint),
        }
    }

    fn extend_pending(&mut self, columns: Columns, paint: &'r Paint) {
        let pixels = self.pixels(columns);
        match &mut self.pending {
            Some((pending, same)) if pending.end == pixels.start && same.bits() == paint.bits() => {
                pending.end = pixels.end;
            }
            _ => {
                self.write_pending();
                self.pending = Some((pixels, paint));
            }
        }
    }

    fn write_pending(&mut self) {
        if let Some((pixels, paint)) = self.pending.take() {
            let samples = &mut self.samples[3 * pixels.start..];
            dispatch!(self.level, simd => paint::fill(simd, samples, pixels.len(), paint));
        }
    }

    /// Records that samples of the row are written by other means than [`RowWriter::fill`].
    pub(crate) fn mark_written(&mut self) {
        if let Some(history) = self.history() {
            history.is_written = true;
        }
    }

    /// Ends the row.
    pub(crate) fn finish(&mut self) {
        if let Some(history) = self.history() {
            history.finish();
        }
    }

    /// Writes what is pending. Returns the tally of the band.
    pub(crate) fn finish_all(mut self) -> Tally {
        self.write_pending();
        self.tally
    }

    /// Decides each pixel by itself, as `pixel` tells from its column and row.
    pub(crate) fn decide(
        &mut self,
        columns: impl IntoIterator<Item = u32>,
        pixel: impl Fn(u32, u32) -> (Pixel, Rung),
    ) {
        for column in columns {
            self.mark_written();
            let ((decision, color), rung) = pixel(column, self.row);
            let index = self.pixels((column, column)).start;
            self.samples[3 * index..3 * index + 3].copy_from_slice(&color);
            if let Some(decisions) = &mut self.decisions {
                decisions[index] = decision;
            }
            self.tally.count(rung);
        }
    }
}
