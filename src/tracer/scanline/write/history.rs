//! What a row shows, remembered for the next frame.

use crate::tracer::scanline::grid::Columns;
use crate::tracer::scanline::write::paint::Bits;

/// The columns of a row that were filled in the last frame, and their colours.
#[derive(Default)]
pub(in crate::tracer) struct RowHistory {
    /// Whether a sample of the row was written since this flag was last cleared.
    pub(in crate::tracer) is_written: bool,
    /// The intervals of the frame before, from the left.
    filled: Vec<Filled>,
    /// How many of `filled` lie to the left of the columns that are filled now.
    passed: usize,
    /// The intervals of the frame that is traced now.
    next: Vec<Filled>,
}

/// An interval of columns of one colour.
#[derive(Clone, Copy)]
struct Filled {
    columns: Columns,
    color: Bits,
}

impl RowHistory {
    /// Forgets the row: somebody else may have written it.
    pub(in crate::tracer) fn clear(&mut self) {
        self.filled.clear();
    }

    /// Fills columns; calls come from the left to the right of the row. `write` is called with the
    /// columns that do not have this colour already.
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

    /// Ends the row.
    pub(crate) fn finish(&mut self) {
        std::mem::swap(&mut self.filled, &mut self.next);
        self.next.clear();
        self.passed = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    const COLUMNS: u32 = 40;

    /// A row of pixels, cut into intervals of one colour out of three.
    fn intervals(random: &mut Random) -> Vec<(Columns, Bits)> {
        let mut intervals = Vec::new();
        let mut from = 0;
        while from < COLUMNS {
            let to = (from + 1 + random.below(12) as u32).min(COLUMNS);
            intervals.push(((from, to), (0, random.below(3) as u32)));
            from = to;
        }
        intervals
    }

    #[test]
    fn what_has_its_colour_already_is_not_written() {
        let mut random = Random::new();
        let mut history = RowHistory::default();
        // No colour is that of a row that nobody has written.
        let mut pixels = [(1, 0); COLUMNS as usize];
        for round in 0..2000 {
            // Some intervals are shaded instead of filled.
            let intervals = intervals(&mut random);
            let is_filled: Vec<bool> = intervals.iter().map(|_| random.below(6) > 0).collect();
            if round % 50 == 49 {
                history.clear();
                pixels.fill((2, 0));
            }
            history.is_written = false;
            let mut written = Vec::new();
            for (&(columns, color), filled) in intervals.iter().zip(&is_filled) {
                if *filled {
                    history.fill(columns, color, |(from, to)| written.extend(from..to));
                }
            }
            history.finish();
            assert_eq!(history.is_written, !written.is_empty());
            for (&((from, to), color), filled) in intervals.iter().zip(&is_filled) {
                for column in from..to {
                    let pixel = &mut pixels[column as usize];
                    if *filled {
                        let writes = written.contains(&column);
                        assert_eq!(writes, *pixel != color, "round {round}, column {column}");
                        *pixel = color;
                    } else {
                        // Shaded pixels are not remembered.
                        *pixel = (1, 0);
                    }
                }
            }
        }
    }
}
