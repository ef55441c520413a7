//! Coverage: which regions cover a column, and so which solids, shadows and mirror images are met.
//!
//! Coverage follows the edges of a row from the left to the right, and changes at each. Hundreds of
//! shadows may cover a column, so that they are counted; few solids do, which are listed.

use crate::tracer::scanline::edges::table::{Receiver, RegionKind, RegionKinds, SolidIndex};

/// How a region covers the present column.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Cover {
    #[default]
    Not = 0,
    Certainly = 1,
    Possibly = 2,
}

impl Cover {
    /// Whether the region covers the column; `None` where that is in doubt.
    fn holds(self) -> Option<bool> {
        match self {
            Cover::Not => Some(false),
            Cover::Certainly => Some(true),
            Cover::Possibly => None,
        }
    }
}

/// How a region covers the columns to the left and to the right of an edge.
#[derive(Clone, Copy)]
struct Crossing {
    from: Cover,
    to: Cover,
}

/// How many regions of one kind cover the column: the lower half of the word counts those that
/// certainly do, the upper half those that possibly do.
#[derive(Clone, Copy, Default)]
struct CoverCount(u64);

impl CoverCount {
    fn cross(&mut self, Crossing { from, to }: Crossing) {
        // No processor predicts the order of edges, so this has no branches.
        const ONE: [u64; 3] = [0, 1, 1 << 32];
        let changed = self.0.wrapping_add(ONE[to as usize]);
        self.0 = changed.wrapping_sub(ONE[from as usize]);
    }

    fn certain(self) -> u32 {
        self.0 as u32
    }

    fn possible(self) -> u32 {
        (self.0 >> 32) as u32
    }

    /// Whether any of the regions covers the column; `None` where that is in doubt.
    fn any(self) -> Option<bool> {
        let any = self.certain() > 0;
        (any || self.possible() == 0).then_some(any)
    }
}

/// The solids that eye rays or mirrored rays meet in a column.
#[derive(Default)]
pub(crate) struct CoveringSolids {
    /// Those that are certainly met, in any order.
    solids: Vec<SolidIndex>,
    count: CoverCount,
}

impl CoveringSolids {
    /// The solids in any order, if none is in doubt.
    pub(crate) fn certain(&self) -> Option<&[SolidIndex]> {
        (self.count.possible() == 0).then_some(&self.solids)
    }

    fn clear(&mut self) {
        self.solids.clear();
        self.count = CoverCount::default();
    }

    fn cross(&mut self, solid: SolidIndex, crossing: Crossing) {
        self.count.cross(crossing);
        if crossing.to == Cover::Certainly {
            self.solids.push(solid);
        } else if crossing.from == Cover::Certainly
            && let Some(index) = self.solids.iter().rposition(|other| *other == solid)
        {
            self.solids.swap_remove(index);
        }
    }
}

/// The regions that cover the present column.
#[derive(Default)]
pub(crate) struct Coverage {
    /// By the number of the region.
    covers: Vec<Cover>,
    /// Solids seen directly.
    pub(crate) direct: CoveringSolids,
    /// Solids seen in the mirror.
    pub(crate) mirrored: CoveringSolids,
    surface: CoverCount,
    /// The shadows on each receiver.
    shadows: Vec<CoverCount>,
}

impl Coverage {
    /// Goes to the left of regions of these kinds.
    pub(crate) fn clear(&mut self, kinds: &RegionKinds<'_>) {
        self.covers.clear();
        self.covers.resize(kinds.all.len(), Cover::Not);
        self.direct.clear();
        self.mirrored.clear();
        self.surface = CoverCount::default();
        self.shadows.clear();
        self.shadows.resize(kinds.receivers, CoverCount::default());
    }

    /// Goes across an edge of a region, to columns that the region covers as `to` tells.
    #[inline]
    pub(crate) fn cross(&mut self, kinds: &RegionKinds<'_>, region: usize, to: Cover) {
        let from = std::mem::replace(&mut self.covers[region], to);
        let crossing = Crossing { from, to };
        match kinds.all[region] {
            RegionKind::Surface => self.surface.cross(crossing),
            RegionKind::Shadow(Receiver(number)) => self.shadows[number as usize].cross(crossing),
            RegionKind::Direct(solid) => self.direct.cross(solid, crossing),
            RegionKind::Mirrored(solid) => self.mirrored.cross(solid, crossing),
            RegionKind::Crease => {}
        }
    }

    /// Whether the column meets the surface; `None` where that is in doubt.
    pub(crate) fn surface(&self) -> Option<bool> {
        self.surface.any()
    }

    /// Whether a receiver is in shadow in the column; `None` where that is in doubt.
    pub(crate) fn in_shadow(&self, Receiver(number): Receiver) -> Option<bool> {
        self.shadows[number as usize].any()
    }

    /// Whether a region covers the column; `None` where that is in doubt.
    pub(crate) fn holds(&self, region: usize) -> Option<bool> {
        self.covers[region].holds()
    }
}
