//! Coverage: which regions cover a column, and so which solids, shadows and mirror images are met.
//!
//! Coverage follows the edges of a row from the left to the right: each edge changes one entry, and
//! nothing is computed anew for a column.

use crate::tracer::scanline::edges::table::{EdgeTable, Receiver, RegionKind, SolidIndex};

/// How a region covers the present column.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Cover {
    #[default]
    Not,
    Certainly,
    Unknown,
}

/// How many regions of one kind cover the column.
#[derive(Clone, Copy, Default)]
struct Tally {
    certain: u32,
    /// How many more may cover it.
    unknown: u32,
}

impl Tally {
    fn count(&mut self, cover: Cover) -> Option<&mut u32> {
        match cover {
            Cover::Not => None,
            Cover::Certainly => Some(&mut self.certain),
            Cover::Unknown => Some(&mut self.unknown),
        }
    }

    fn change(&mut self, from: Cover, to: Cover) {
        if let Some(count) = self.count(from) {
            *count -= 1;
        }
        if let Some(count) = self.count(to) {
            *count += 1;
        }
    }

    /// Whether any of the regions covers the column; `None` where that is in doubt.
    fn any(self) -> Option<bool> {
        (self.certain > 0 || self.unknown == 0).then_some(self.certain > 0)
    }
}

/// The solids that eye rays or mirrored rays meet in a column, by increasing index.
#[derive(Default)]
pub(crate) struct CoveringSolids {
    solids: Vec<SolidIndex>,
    tally: Tally,
}

impl CoveringSolids {
    /// The solids, if none is in doubt.
    pub(crate) fn certain(&self) -> Option<&[SolidIndex]> {
        (self.tally.unknown == 0).then_some(&self.solids)
    }

    fn clear(&mut self) {
        self.solids.clear();
        self.tally = Tally::default();
    }

    fn change(&mut self, solid: SolidIndex, from: Cover, to: Cover) {
        self.tally.change(from, to);
        match (self.solids.binary_search(&solid), to) {
            (Err(index), Cover::Certainly) => self.solids.insert(index, solid),
            (Ok(index), Cover::Not | Cover::Unknown) => {
                self.solids.remove(index);
            }
            _ => {}
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
    surface: Tally,
    /// The shadows on each receiver.
    shadows: Vec<Tally>,
}

impl Coverage {
    /// Goes to the left of all regions of a frame.
    pub(crate) fn clear(&mut self, table: &EdgeTable<'_>) {
        self.covers.clear();
        self.covers.resize(table.kinds.len(), Cover::Not);
        self.direct.clear();
        self.mirrored.clear();
        self.surface = Tally::default();
        self.shadows.clear();
        self.shadows.resize(table.receivers, Tally::default());
    }

    /// Goes across an edge of a region, to columns that the region covers as `to` tells.
    pub(crate) fn cross(&mut self, table: &EdgeTable<'_>, region: usize, to: Cover) {
        let from = std::mem::replace(&mut self.covers[region], to);
        match table.kinds[region] {
            RegionKind::Surface => self.surface.change(from, to),
            RegionKind::Shadow(Receiver(number)) => self.shadows[number as usize].change(from, to),
            RegionKind::Direct(solid) => self.direct.change(solid, from, to),
            RegionKind::Mirrored(solid) => self.mirrored.change(solid, from, to),
            RegionKind::Crease => {}
        }
    }

    /// Whether the column meets the surface.
    pub(crate) fn surface(&self) -> Option<bool> {
        self.surface.any()
    }

    /// Whether a receiver is in shadow in the column.
    pub(crate) fn in_shadow(&self, Receiver(number): Receiver) -> Option<bool> {
        self.shadows[number as usize].any()
    }

    /// Whether a region covers the column.
    pub(crate) fn holds(&self, region: usize) -> Option<bool> {
        match self.covers[region] {
            Cover::Not => Some(false),
            Cover::Certainly => Some(true),
            Cover::Unknown => None,
        }
    }
}
