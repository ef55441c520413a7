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

/// What a row shows.
#[derive(Default)]
pub(super) struct Plan {
    /// Each up to a crossing.
    pieces: Vec<(usize, Seen)>,
    contests: Vec<Kept>,
    solids: Vec<(usize, Show)>,
}

impl Plan {
    pub(super) fn clear(&mut self) {
        self.pieces.clear();
        self.contests.clear();
        self.solids.clear();
    }

    /// What is seen from the crossing before up to this one.
    pub(super) fn add(&mut self, crossing: usize, seen: Seen) {
        match self.pieces.last_mut() {
            Some((end, same)) if *same == seen => *end = crossing,
            _ => self.pieces.push((crossing, seen)),
        }
    }

    /// What is seen up to which crossing, from the left.
    pub(super) fn pieces(&self) -> &[(usize, Seen)] {
        &self.pieces
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
