//! How often the cheaper arithmetic did not do.

use super::ladder::Rung;

/// How many pixels of a frame were left in doubt by the cheaper arithmetic of the kernels that are
/// right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InDoubt {
    /// Settled by double-doubles only.
    pub double_double: u64,
    /// Settled by arbitrary precision only.
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
