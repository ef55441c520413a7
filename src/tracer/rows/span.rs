//! Parts of a row of pixels, as far as they are known.

/// A run of columns of which some are certain and, at both ends, some only possible: `possible` holds `certain`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    /// From the first to before the last column that may belong to it.
    pub(super) possible: (u32, u32),
    /// The same of those that do.
    pub(super) certain: (u32, u32),
}

impl Span {
    pub(super) const NONE: Span = Span {
        possible: (0, 0),
        certain: (0, 0),
    };

    /// Columns of which the certain ones may be none.
    pub(super) fn new(possible: (u32, u32), certain: (u32, u32)) -> Span {
        Span {
            possible,
            certain: if certain.0 < certain.1 {
                certain
            } else {
                (possible.0, possible.0)
            },
        }
    }

    /// All columns.
    pub(super) fn whole(size: u32) -> Span {
        Span {
            possible: (0, size),
            certain: (0, size),
        }
    }

    /// Any column, or none.
    pub(super) fn unknown(size: u32) -> Span {
        Span {
            possible: (0, size),
            certain: (0, 0),
        }
    }

    pub(super) fn is_none(&self) -> bool {
        self.possible.0 >= self.possible.1
    }

    /// What both have.
    pub(super) fn and(self, other: Span) -> Span {
        let common = |a: (u32, u32), b: (u32, u32)| (a.0.max(b.0), a.1.min(b.1));
        let possible = common(self.possible, other.possible);
        let certain = common(self.certain, other.certain);
        if possible.0 >= possible.1 {
            return Span::NONE;
        }
        Span::new(possible, certain)
    }

    /// Whether a column belongs to it; `None` where that is not known.
    pub(super) fn holds(&self, column: u32) -> Option<bool> {
        if column < self.possible.0 || column >= self.possible.1 {
            Some(false)
        } else if column >= self.certain.0 && column < self.certain.1 {
            Some(true)
        } else {
            None
        }
    }

    /// Adds the columns between `from` and `to` at which `holds` gives another answer than one to the left.
    pub(super) fn cut(&self, (from, to): (u32, u32), cuts: &mut Vec<u32>) {
        let mut add = |column: u32| {
            if column > from && column < to {
                cuts.push(column);
            }
        };
        add(self.possible.0);
        add(self.possible.1);
        // Mostly all is known.
        if self.certain != self.possible {
            add(self.certain.0);
            add(self.certain.1);
        }
    }
}

/// All columns on one side of a border, which lies anywhere from one column to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct HalfLine {
    /// Whether it holds the columns from the border on, rather than those before it.
    pub(super) rightward: bool,
    /// The border that makes it largest.
    pub(super) possible: u32,
    /// The border that makes it smallest.
    pub(super) certain: u32,
}

impl HalfLine {
    /// All columns or none.
    pub(super) fn all(all: bool, size: u32) -> HalfLine {
        let border = if all { 0 } else { size };
        HalfLine {
            rightward: true,
            possible: border,
            certain: border,
        }
    }

    /// As a part of a row of `size` columns.
    pub(super) fn span(self, size: u32) -> Span {
        if self.rightward {
            Span {
                possible: (self.possible, size),
                certain: (self.certain, size),
            }
        } else {
            Span {
                possible: (0, self.possible),
                certain: (0, self.certain),
            }
        }
    }
}
