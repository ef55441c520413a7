//! What a row shows from crossing to crossing. The next row mostly shows the same, only a little
//! further left or right.

use crate::tracer::scanline::write::paint::PaintNumber;

/// What columns show.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shown {
    Paint(PaintNumber),
    /// A sphere that is shaded, by its place among the solids or those in the mirror.
    Sphere {
        mirrored: bool,
        solid: u32,
    },
    /// It is not known: each is to be asked for.
    Unknown,
}

/// What is seen between two crossings.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Visible {
    /// This, whatever the row.
    Only(Shown),
    /// What is in front, by the number of the contest that a row decides.
    First(u32),
}

impl Visible {
    pub(crate) const UNKNOWN: Visible = Visible::Only(Shown::Unknown);
}

/// What is seen, or that this has not been found out, in a word: rows of these are compared without
/// a branch.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Packed(u64);

impl Packed {
    /// Nobody has looked yet.
    pub(crate) const OPEN: Packed = Packed(0);

    pub(crate) fn new(seen: Visible) -> Packed {
        let (kind, number) = match seen {
            Visible::Only(Shown::Unknown) => (1, 0),
            Visible::Only(Shown::Paint(PaintNumber(number))) => (2, number),
            Visible::Only(Shown::Sphere { mirrored, solid }) => (3 + u64::from(mirrored), solid),
            Visible::First(number) => (5, number),
        };
        Packed(kind << 32 | u64::from(number))
    }

    /// The same where no columns are open, and otherwise nothing.
    pub(crate) fn if_closed(self, columns: i32) -> Packed {
        if columns == 0 { self } else { Packed::OPEN }
    }

    pub(crate) fn seen(self) -> Visible {
        let number = self.0 as u32;
        match self.0 >> 32 {
            2 => Visible::Only(Shown::Paint(PaintNumber(number))),
            kind @ (3 | 4) => Visible::Only(Shown::Sphere {
                mirrored: kind == 4,
                solid: number,
            }),
            5 => Visible::First(number),
            _ => Visible::UNKNOWN,
        }
    }
}

/// Several solids, and what each shows where it is in front.
pub(crate) struct DepthTest<'p> {
    pub(crate) mirrored: bool,
    pub(crate) solids: &'p [(usize, Shown)],
    /// Whether the surface may be in front of them.
    pub(crate) surface: bool,
    /// What is seen where none of them is in front.
    pub(crate) rest: Visible,
}

/// The same, as it is kept: where its solids end among those of all contests.
struct Stored {
    mirrored: bool,
    from: usize,
    to: usize,
    surface: bool,
    rest: Visible,
}

/// More contests than this are forgotten, and found anew where they are still needed.
const MANY: usize = 4096;

/// What rows have to decide.
#[derive(Default)]
pub(crate) struct DepthTests {
    contests: Vec<Stored>,
    solids: Vec<(usize, Shown)>,
}

impl DepthTests {
    pub(crate) fn clear(&mut self) {
        self.contests.clear();
        self.solids.clear();
    }

    /// Whether there are so many contests that the oldest are hardly needed any more.
    pub(crate) fn is_full(&self) -> bool {
        self.contests.len() > MANY
    }

    /// Leaves it to the row what is in front.
    pub(crate) fn defer(
        &mut self,
        mirrored: bool,
        solids: impl Iterator<Item = (usize, Shown)>,
        surface: bool,
        rest: Visible,
    ) -> Visible {
        let from = self.solids.len();
        self.solids.extend(solids);
        self.contests.push(Stored {
            mirrored,
            from,
            to: self.solids.len(),
            surface,
            rest,
        });
        Visible::First(self.contests.len() as u32 - 1)
    }

    pub(crate) fn test(&self, number: u32) -> DepthTest<'_> {
        let Stored {
            mirrored,
            from,
            to,
            surface,
            rest,
        } = self.contests[number as usize];
        DepthTest {
            mirrored,
            solids: &self.solids[from..to],
            surface,
            rest,
        }
    }
}
