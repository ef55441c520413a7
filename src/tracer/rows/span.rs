//! Parts of neighbouring rows of pixels, as far as they are known.

/// Rows are crossed so many at a time.
pub(in crate::tracer) const ROWS: usize = 8;

/// In each of some rows, a run of columns of which some are certain and, at both ends, some only possible: `possible` holds `certain`.
/// Every run goes from its first column to before its last; one without columns begins and ends in the same place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Spans {
    pub(super) possible: [[u32; ROWS]; 2],
    pub(super) certain: [[u32; ROWS]; 2],
}

impl Spans {
    pub(super) const NONE: Spans = Spans {
        possible: [[0; ROWS]; 2],
        certain: [[0; ROWS]; 2],
    };

    /// All columns.
    pub(super) fn whole(size: u32) -> Spans {
        let all = [[0; ROWS], [size; ROWS]];
        Spans {
            possible: all,
            certain: all,
        }
    }

    /// Any columns, or none.
    pub(super) fn unknown(size: u32) -> Spans {
        Spans {
            possible: [[0; ROWS], [size; ROWS]],
            ..Spans::NONE
        }
    }

    /// What both have.
    #[inline(always)]
    pub(super) fn and(&mut self, other: &Spans) {
        for row in 0..ROWS {
            self.possible[0][row] = self.possible[0][row].max(other.possible[0][row]);
            self.possible[1][row] = self.possible[1][row].min(other.possible[1][row]);
            self.certain[0][row] = self.certain[0][row].max(other.certain[0][row]);
            self.certain[1][row] = self.certain[1][row].min(other.certain[1][row]);
        }
    }

    /// The same with no run that ends before it begins, and none in rows before the first or from the last on.
    #[inline(always)]
    pub(super) fn tidy(&mut self, (first, last): (u32, u32)) {
        for row in 0..ROWS {
            let outside = (row as u32) < first || row as u32 >= last;
            let [from, to] = &mut self.possible;
            if outside || from[row] >= to[row] {
                (from[row], to[row]) = (0, 0);
            }
            let begin = from[row];
            let [from, to] = &mut self.certain;
            if outside || from[row] >= to[row] {
                (from[row], to[row]) = (begin, begin);
            }
        }
    }

    /// Whether there are any columns.
    pub(super) fn is_none(&self) -> bool {
        self.possible[0] == self.possible[1]
    }
}

/// In each of some rows, all columns on one side of a border, which lies anywhere from one column to another.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfLines {
    /// Whether they hold the columns from the border on, rather than those before it.
    pub(super) rightward: bool,
    /// The border that makes each largest.
    pub(super) possible: [u32; ROWS],
    /// The border that makes it smallest.
    pub(super) certain: [u32; ROWS],
}

impl HalfLines {
    /// As parts of rows of `size` columns.
    #[inline(always)]
    pub(super) fn spans(self, size: u32) -> Spans {
        if self.rightward {
            Spans {
                possible: [self.possible, [size; ROWS]],
                certain: [self.certain, [size; ROWS]],
            }
        } else {
            Spans {
                possible: [[0; ROWS], self.possible],
                certain: [[0; ROWS], self.certain],
            }
        }
    }
}
