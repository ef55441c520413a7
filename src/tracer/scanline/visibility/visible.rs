//! What a gap or a span shows. `resolve` finds it, and `active` keeps it from row to row.

use std::ops::Range;

use crate::tracer::scanline::edges::table::SolidIndex;
use crate::tracer::scanline::write::paint::PaintNumber;

/// What all columns of an interval show.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shown {
    Paint(PaintNumber),
    /// A sphere that is shaded.
    Sphere {
        mirrored: bool,
        solid: SolidIndex,
    },
    /// Every pixel is decided by itself.
    InDoubt,
}

/// What a gap shows.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Visible {
    /// One thing in every row.
    Only(Shown),
    /// The nearest of some solids, by the depth test of this number, which each row carries out.
    DepthTest(u32),
}

impl Visible {
    pub(crate) const IN_DOUBT: Visible = Visible::Only(Shown::InDoubt);
}

/// What a gap shows, or that the gap is unresolved, in one word: two are compared without a branch.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Packed(u64);

impl Packed {
    pub(crate) const UNRESOLVED: Packed = Packed(0);

    pub(crate) fn new(visible: Visible) -> Packed {
        let (kind, number) = match visible {
            Visible::Only(Shown::InDoubt) => (1, 0),
            Visible::Only(Shown::Paint(PaintNumber(number))) => (2, number),
            Visible::Only(Shown::Sphere { mirrored, solid }) => (3 + u64::from(mirrored), solid.0),
            Visible::DepthTest(number) => (5, number),
        };
        Packed(kind << 32 | u64::from(number))
    }

    /// The same for a gap that no changed region covers; otherwise the gap is unresolved.
    pub(crate) fn unless_changed(self, covering: i32) -> Packed {
        if covering == 0 {
            self
        } else {
            Packed::UNRESOLVED
        }
    }

    pub(crate) fn visible(self) -> Visible {
        let number = self.0 as u32;
        match self.0 >> 32 {
            2 => Visible::Only(Shown::Paint(PaintNumber(number))),
            kind @ (3 | 4) => Visible::Only(Shown::Sphere {
                mirrored: kind == 4,
                solid: SolidIndex(number),
            }),
            5 => Visible::DepthTest(number),
            _ => Visible::IN_DOUBT,
        }
    }
}

/// A solid that may be in front.
#[derive(Clone, Copy)]
pub(crate) struct Candidate {
    pub(crate) solid: SolidIndex,
    /// The index of the front face that is seen of a tetrahedron, if known.
    pub(crate) front_face: Option<usize>,
    /// What it shows where it is in front.
    pub(crate) shown: Shown,
}

/// A depth test among several solids.
pub(crate) struct DepthTest {
    /// Whether the solids are seen in the mirror.
    pub(crate) mirrored: bool,
    /// The range of its candidates among those of all tests.
    candidates: Range<usize>,
    /// Whether the surface may be in front of them.
    pub(crate) surface: bool,
    /// What is visible where none of them is in front.
    pub(crate) rest: Visible,
}

/// Beyond so many tests all are forgotten, and those still needed are made anew.
const MANY: usize = 4096;

/// The depth tests of all gaps.
#[derive(Default)]
pub(crate) struct DepthTests {
    tests: Vec<DepthTest>,
    candidates: Vec<Candidate>,
}

impl DepthTests {
    pub(crate) fn clear(&mut self) {
        self.tests.clear();
        self.candidates.clear();
    }

    /// The number of tests.
    pub(crate) fn count(&self) -> usize {
        self.tests.len()
    }

    /// Forgets all but the first `count` tests.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.tests.truncate(count);
        let end = self.tests.last().map_or(0, |test| test.candidates.end);
        self.candidates.truncate(end);
    }

    /// Whether all tests should be forgotten: most of so many are not needed any more.
    pub(crate) fn is_full(&self) -> bool {
        self.tests.len() > MANY
    }

    /// Adds a test, which leaves it to each row what is in front.
    pub(crate) fn defer(
        &mut self,
        mirrored: bool,
        candidates: impl Iterator<Item = Candidate>,
        surface: bool,
        rest: Visible,
    ) -> Visible {
        let first = self.candidates.len();
        self.candidates.extend(candidates);
        self.tests.push(DepthTest {
            mirrored,
            candidates: first..self.candidates.len(),
            surface,
            rest,
        });
        Visible::DepthTest(self.tests.len() as u32 - 1)
    }

    /// The test of this number, and its candidates.
    pub(crate) fn test(&self, number: u32) -> (&DepthTest, &[Candidate]) {
        let test = &self.tests[number as usize];
        (test, &self.candidates[test.candidates.clone()])
    }
}
