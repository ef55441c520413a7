//! Coverage of a column by the creases of one solid and the shadows on it: hundreds may cover it,
//! on three faces at most. So they are counted where an edge is crossed, and not where a column is
//! looked at.

use crate::tracer::scanline::edges::table::{Receiver, RegionKind, RegionKinds};
use crate::tracer::scanline::visibility::coverage::{Cover, CoverCount, FaceCoverage};

/// The creases and shadows of one solid that cover the present column.
#[derive(Default)]
pub(crate) struct CountedCoverage {
    /// By the number of the region.
    covers: Vec<Cover>,
    /// The shadows on each receiver.
    shadows: Vec<CoverCount>,
}

impl CountedCoverage {
    /// Goes to the left of regions of these kinds.
    pub(crate) fn clear(&mut self, kinds: &RegionKinds<'_>) {
        self.covers.clear();
        self.covers.resize(kinds.all.len(), Cover::Not);
        self.shadows.clear();
        self.shadows.resize(kinds.receivers, CoverCount::default());
    }

    /// Goes across an edge of a region, to columns that the region covers as `to` tells.
    pub(crate) fn cross(&mut self, kinds: &RegionKinds<'_>, region: usize, to: Cover) {
        let from = std::mem::replace(&mut self.covers[region], to);
        if let RegionKind::Shadow(Receiver(number)) = kinds.all[region] {
            let shadows = &mut self.shadows[number as usize];
            shadows.remove(from);
            shadows.add(to);
        }
    }
}

impl FaceCoverage for CountedCoverage {
    fn in_shadow(&self, Receiver(number): Receiver) -> Option<bool> {
        self.shadows[number as usize].any()
    }

    fn holds(&self, region: usize) -> Option<bool> {
        self.covers[region].holds()
    }
}
