//! What is remembered of a row for the next frame.

use crate::tracer::scanline::grid::Columns;
use crate::tracer::scanline::write::paint::Bits;

/// The columns of a row that were last given one colour.
#[derive(Default)]
pub(in crate::tracer) struct RowHistory {
    /// Whether any of the row's samples has been written since this was last unset.
    pub(in crate::tracer) is_written: bool,
    /// From the left, in the frame before.
    filled: Vec<Filled>,
    /// How many of these lie to the left of what is being filled.
    passed: usize,
    /// The same of the frame that is being traced.
    next: Vec<Filled>,
}

/// Columns of one colour.
#[derive(Clone, Copy)]
struct Filled {
    columns: Columns,
    color: Bits,
}

impl RowHistory {
    /// Forgets the row, which others may have written.
    pub(in crate::tracer) fn clear(&mut self) {
        self.filled.clear();
    }

    /// Fills columns, from the left to the right of the row: calls `write` with those that do not
    /// have this colour already.
    pub(crate) fn fill(&mut self, columns: Columns, color: Bits, mut write: impl FnMut(Columns)) {
        match self.next.last_mut() {
            Some(last) if last.columns.1 == columns.0 && last.color == color => {
                last.columns.1 = columns.1;
            }
            _ => self.next.push(Filled { columns, color }),
        }
        let (mut from, to) = columns;
        while let Some(before) = self.filled.get(self.passed)
            && before.columns.0 < to
        {
            if before.color == color && before.columns.1 > from {
                if before.columns.0 > from {
                    self.is_written = true;
                    write((from, before.columns.0));
                }
                from = before.columns.1;
            }
            if before.columns.1 > to {
                break;
            }
            self.passed += 1;
        }
        if from < to {
            self.is_written = true;
            write((from, to));
        }
    }

    /// The row is written.
    pub(crate) fn finish(&mut self) {
        std::mem::swap(&mut self.filled, &mut self.next);
        self.next.clear();
        self.passed = 0;
    }
}
