//! The count of what a frame took.

use super::ladder::Rung;

/// What a frame took: pixels that f64 with bounds left in doubt, and the parts of its rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Tally {
    /// Pixels that double-doubles settled: with the kernel reference, which tries no f64, nearly
    /// all.
    pub double_double: u64,
    /// Pixels that double-doubles left in doubt, and arbitrary precision settled.
    pub arbitrary: u64,
    /// Edges of regions that crossed rows, added up over the rows, without those that divide a
    /// single tetrahedron of a crowd; none for a kernel that goes pixel by pixel.
    pub edges: u64,
    /// Spans between them, each of which shows one thing, added up likewise.
    pub spans: u64,
}

impl Tally {
    pub(super) fn count(&mut self, rung: Rung) {
        match rung {
            Rung::Hardware => {}
            Rung::DoubleDouble => self.double_double += 1,
            Rung::Arbitrary => self.arbitrary += 1,
        }
    }

    /// The sum of both.
    pub(crate) fn and(self, other: Tally) -> Tally {
        Tally {
            double_double: self.double_double + other.double_double,
            arbitrary: self.arbitrary + other.arbitrary,
            edges: self.edges + other.edges,
            spans: self.spans + other.spans,
        }
    }
}
