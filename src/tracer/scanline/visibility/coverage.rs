//! Coverage: which regions cover a column, and so which solids, shadows and mirror images are met.
//!
//! Coverage follows the edges of a row from the left to the right, and keeps the regions that cover
//! the present column. Few columns are looked at: only there their solids and shadows are told
//! apart.

use crate::tracer::scanline::edges::table::{Receiver, RegionKind, RegionKinds, SolidIndex};

/// How a region covers the present column.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Cover {
    #[default]
    Not,
    Certainly,
    Possibly,
}

impl Cover {
    /// Whether the region covers the column; `None` where that is in doubt.
    pub(super) fn holds(self) -> Option<bool> {
        match self {
            Cover::Not => Some(false),
            Cover::Certainly => Some(true),
            Cover::Possibly => None,
        }
    }
}

/// What tells which face of a tetrahedron a column sees, and whether the face is in shadow there.
pub(crate) trait FaceCoverage {
    /// Whether a receiver is in shadow in the column; `None` where that is in doubt.
    fn in_shadow(&self, receiver: Receiver) -> Option<bool>;

    /// Whether a region covers the column; `None` where that is in doubt.
    fn holds(&self, region: usize) -> Option<bool>;
}

/// How many regions of one kind cover the column.
#[derive(Clone, Copy, Default)]
pub(super) struct CoverCount {
    certain: u32,
    /// How many more may cover it.
    possible: u32,
}

impl CoverCount {
    pub(super) fn add(&mut self, cover: Cover) {
        match cover {
            Cover::Not => {}
            Cover::Certainly => self.certain += 1,
            Cover::Possibly => self.possible += 1,
        }
    }

    /// Takes back an [`CoverCount::add`] of the same cover.
    pub(super) fn remove(&mut self, cover: Cover) {
        match cover {
            Cover::Not => {}
            Cover::Certainly => self.certain -= 1,
            Cover::Possibly => self.possible -= 1,
        }
    }

    /// Whether any of the regions covers the column; `None` where that is in doubt.
    pub(super) fn any(self) -> Option<bool> {
        (self.certain > 0 || self.possible == 0).then_some(self.certain > 0)
    }
}

/// The solids that eye rays or mirrored rays meet in a column, by increasing index.
#[derive(Default)]
pub(crate) struct CoveringSolids {
    solids: Vec<SolidIndex>,
    count: CoverCount,
}

impl CoveringSolids {
    /// The solids, if none is in doubt.
    pub(crate) fn certain(&self) -> Option<&[SolidIndex]> {
        (self.count.possible == 0).then_some(&self.solids)
    }

    fn clear(&mut self) {
        self.solids.clear();
        self.count = CoverCount::default();
    }

    fn add(&mut self, solid: SolidIndex, cover: Cover) {
        self.count.add(cover);
        if cover == Cover::Certainly {
            self.solids.push(solid);
        }
    }
}

/// The regions that cover the present column.
#[derive(Default)]
pub(crate) struct Coverage {
    /// By the number of the region.
    covers: Vec<Cover>,
    /// The regions that cover the column certainly or possibly.
    covering: Vec<usize>,
    /// Solids seen directly.
    pub(crate) direct: CoveringSolids,
    /// Solids seen in the mirror.
    pub(crate) mirrored: CoveringSolids,
    surface: CoverCount,
    /// The shadows on each receiver.
    shadows: Vec<CoverCount>,
    /// The receivers whose entries in `shadows` are in use.
    receivers: Vec<Receiver>,
}

impl Coverage {
    /// Goes to the left of regions of these kinds.
    pub(crate) fn clear(&mut self, kinds: &RegionKinds<'_>) {
        self.covers.clear();
        self.covers.resize(kinds.all.len(), Cover::Not);
        self.covering.clear();
        self.shadows.clear();
        self.shadows.resize(kinds.receivers, CoverCount::default());
        self.receivers.clear();
    }

    /// Goes across an edge of a region, to columns that the region covers as `to` tells.
    pub(crate) fn cross(&mut self, region: usize, to: Cover) {
        let from = std::mem::replace(&mut self.covers[region], to);
        if from == Cover::Not {
            self.covering.push(region);
        } else if to == Cover::Not
            && let Some(index) = self.covering.iter().rposition(|other| *other == region)
        {
            self.covering.swap_remove(index);
        }
    }

    /// Tells solids and shadows of the present column apart.
    pub(crate) fn look(&mut self, kinds: &RegionKinds<'_>) {
        self.direct.clear();
        self.mirrored.clear();
        self.surface = CoverCount::default();
        for Receiver(number) in self.receivers.drain(..) {
            self.shadows[number as usize] = CoverCount::default();
        }
        for &region in &self.covering {
            let cover = self.covers[region];
            match kinds.all[region] {
                RegionKind::Surface => self.surface.add(cover),
                RegionKind::Shadow(receiver) => {
                    self.shadows[receiver.0 as usize].add(cover);
                    self.receivers.push(receiver);
                }
                RegionKind::Direct(solid) => self.direct.add(solid, cover),
                RegionKind::Mirrored(solid) => self.mirrored.add(solid, cover),
                RegionKind::Crease => {}
            }
        }
        self.direct.solids.sort_unstable();
        self.mirrored.solids.sort_unstable();
    }

    /// Whether the column meets the surface.
    pub(crate) fn surface(&self) -> Option<bool> {
        self.surface.any()
    }
}

impl FaceCoverage for Coverage {
    fn in_shadow(&self, Receiver(number): Receiver) -> Option<bool> {
        self.shadows[number as usize].any()
    }

    fn holds(&self, region: usize) -> Option<bool> {
        self.covers[region].holds()
    }
}
