//! The count of pixels in doubt.

use super::ladder::Rung;

/// How many pixels of a frame f64 with bounds left in doubt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InDoubt {
    /// Pixels that double-doubles settled.
    pub double_double: u64,
    /// Pixels that double-doubles left in doubt, and arbitrary precision settled.
    pub arbitrary: u64,
}

impl InDoubt {
    pub(super) fn count(&mut self, rung: Rung) {
        match rung {
            Rung::Double => {}
            Rung::DoubleDouble => self.double_double += 1,
            Rung::Arbitrary => self.arbitrary += 1,
        }
    }

    pub(super) fn and(self, other: InDoubt) -> InDoubt {
        InDoubt {
            double_double: self.double_double + other.double_double,
            arbitrary: self.arbitrary + other.arbitrary,
        }
    }
}
