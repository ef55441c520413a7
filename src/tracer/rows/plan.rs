//! What a row shows from crossing to crossing. The next row mostly shows the same, only a little further left or right.

use super::paint::PaintNumber;

/// What columns show.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Show {
    Paint(PaintNumber),
    /// A sphere that is shaded, by its place among the solids or those in the mirror.
    Ball {
        mirrored: bool,
        solid: u32,
    },
    /// It is not known: each is to be asked for.
    Unknown,
}

/// What is seen between two crossings.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Seen {
    /// This, whatever the row.
    Only(Show),
    /// What is in front, by the number of the contest that a row decides.
    First(u32),
}

impl Seen {
    pub(super) const UNKNOWN: Seen = Seen::Only(Show::Unknown);
}

/// What is seen, or that this has not been found out, in a word: rows of these are compared without a branch.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Packed(u64);

impl Packed {
    /// Nobody has looked yet.
    pub(super) const OPEN: Packed = Packed(0);

    pub(super) fn new(seen: Seen) -> Packed {
        let (kind, number) = match seen {
            Seen::Only(Show::Unknown) => (1, 0),
            Seen::Only(Show::Paint(PaintNumber(number))) => (2, number),
            Seen::Only(Show::Ball { mirrored, solid }) => (3 + u64::from(mirrored), solid),
            Seen::First(number) => (5, number),
        };
        Packed(kind << 32 | u64::from(number))
    }

    /// The same where no columns are open, and otherwise nothing.
    pub(super) fn if_closed(self, columns: i32) -> Packed {
        if columns == 0 { self } else { Packed::OPEN }
    }

    pub(super) fn seen(self) -> Seen {
        let number = self.0 as u32;
        match self.0 >> 32 {
            2 => Seen::Only(Show::Paint(PaintNumber(number))),
            kind @ (3 | 4) => Seen::Only(Show::Ball {
                mirrored: kind == 4,
                solid: number,
            }),
            5 => Seen::First(number),
            _ => Seen::UNKNOWN,
        }
    }
}

/// Several solids, and what each shows where it is in front.
pub(super) struct Contest<'p> {
    pub(super) mirrored: bool,
    pub(super) solids: &'p [(usize, Show)],
    /// Whether the surface may be in front of them.
    pub(super) surface: bool,
    /// What is seen where none of them is in front.
    pub(super) rest: Seen,
}

/// The same, as it is kept: where its solids end among those of all contests.
struct Kept {
    mirrored: bool,
    from: usize,
    to: usize,
    surface: bool,
    rest: Seen,
}

/// More contests than this are forgotten, and found anew where they are still needed.
const MANY: usize = 4096;

/// What rows have to decide.
#[derive(Default)]
pub(super) struct Plan {
    contests: Vec<Kept>,
    solids: Vec<(usize, Show)>,
}

impl Plan {
    pub(super) fn clear(&mut self) {
        self.contests.clear();
        self.solids.clear();
    }

    /// Whether there are so many contests that the oldest are hardly needed any more.
    pub(super) fn is_full(&self) -> bool {
        self.contests.len() > MANY
    }

    /// Leaves it to the row what is in front.
    pub(super) fn contest(
        &mut self,
        mirrored: bool,
        solids: impl Iterator<Item = (usize, Show)>,
        surface: bool,
        rest: Seen,
    ) -> Seen {
        let from = self.solids.len();
        self.solids.extend(solids);
        self.contests.push(Kept {
            mirrored,
            from,
            to: self.solids.len(),
            surface,
            rest,
        });
        Seen::First(self.contests.len() as u32 - 1)
    }

    pub(super) fn contest_of(&self, number: u32) -> Contest<'_> {
        let Kept {
            mirrored,
            from,
            to,
            surface,
            rest,
        } = self.contests[number as usize];
        Contest {
            mirrored,
            solids: &self.solids[from..to],
            surface,
            rest,
        }
    }
}
