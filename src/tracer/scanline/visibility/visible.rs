//! What a gap or a span shows. `resolve` finds it, and `active` keeps it from row to row.

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
    /// A tetrahedron whose faces are told apart in each row.
    Faces {
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
            Visible::Only(Shown::Faces { mirrored, solid }) => (5 + u64::from(mirrored), solid.0),
            Visible::DepthTest(number) => (7, number),
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
            kind @ (5 | 6) => Visible::Only(Shown::Faces {
                mirrored: kind == 6,
                solid: SolidIndex(number),
            }),
            7 => Visible::DepthTest(number),
            _ => Visible::IN_DOUBT,
        }
    }
}
