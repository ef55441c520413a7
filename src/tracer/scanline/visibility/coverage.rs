//! Coverage: which regions cover a column, and so which solids, shadows and mirror images are met.
//!
//! It follows the crossings of a row from the left to the right, so that its lists hold what covers
//! one column, and nobody goes through all edges to find that.

use crate::tracer::scanline::edges::table::{Edge, EdgeTable, Receiver};

/// How a region covers the present column.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Cover {
    #[default]
    Not,
    Certainly,
    Unknown,
}

/// How many regions of one kind cover the column, and of how many this is unknown.
#[derive(Clone, Copy, Default)]
struct Tally {
    certain: u32,
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

    /// Whether any of the regions covers the column, where that is known.
    fn any(self) -> Option<bool> {
        (self.certain > 0 || self.unknown == 0).then_some(self.certain > 0)
    }
}

/// Solids met in a column, in their order.
#[derive(Default)]
pub(crate) struct Met {
    solids: Vec<usize>,
    tally: Tally,
}

impl Met {
    /// The solids, if they are known.
    pub(crate) fn known(&self) -> Option<&[usize]> {
        (self.tally.unknown == 0).then_some(&self.solids)
    }

    fn clear(&mut self) {
        self.solids.clear();
        self.tally = Tally::default();
    }

    fn change(&mut self, solid: usize, from: Cover, to: Cover) {
        self.tally.change(from, to);
        match (self.solids.binary_search(&solid), to) {
            (Err(place), Cover::Certainly) => self.solids.insert(place, solid),
            (Ok(place), Cover::Not | Cover::Unknown) => {
                self.solids.remove(place);
            }
            _ => {}
        }
    }
}

/// The regions that cover the present column.
#[derive(Default)]
pub(crate) struct Coverage {
    /// By the number of the edge.
    covers: Vec<Cover>,
    pub(crate) direct: Met,
    pub(crate) mirrored: Met,
    surface: Tally,
    /// The shadows on each receiver.
    shadows: Vec<Tally>,
}

impl Coverage {
    /// Goes to where none of a frame's regions covers the column.
    pub(crate) fn clear(&mut self, edges: &EdgeTable<'_>) {
        self.covers.clear();
        self.covers.resize(edges.of.len(), Cover::Not);
        self.direct.clear();
        self.mirrored.clear();
        self.surface = Tally::default();
        self.shadows.clear();
        self.shadows.resize(edges.receivers, Tally::default());
    }

    /// Goes across an edge: how its region covers the column then.
    pub(crate) fn cross(&mut self, edges: &EdgeTable<'_>, edge: usize, to: Cover) {
        let from = std::mem::replace(&mut self.covers[edge], to);
        match edges.of[edge] {
            Edge::Surface => self.surface.change(from, to),
            Edge::Shadow(Receiver(number)) => self.shadows[number as usize].change(from, to),
            Edge::Direct(solid) => self.direct.change(solid, from, to),
            Edge::Mirrored(solid) => self.mirrored.change(solid, from, to),
            Edge::Crease => {}
        }
    }

    /// Whether the column meets the surface.
    pub(crate) fn surface(&self) -> Option<bool> {
        self.surface.any()
    }

    /// Whether a receiver is in shadow there.
    pub(crate) fn in_shadow(&self, Receiver(number): Receiver) -> Option<bool> {
        self.shadows[number as usize].any()
    }

    /// Whether an edge's region covers the column.
    pub(crate) fn holds(&self, edge: usize) -> Option<bool> {
        match self.covers[edge] {
            Cover::Not => Some(false),
            Cover::Certainly => Some(true),
            Cover::Unknown => None,
        }
    }
}
