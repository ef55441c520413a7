//! On which side of each border a column is, and so which solids, shadows and mirror images it meets.

use super::border::Border;

/// Whether a column is one of a border's.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Held {
    No,
    Unknown,
    Yes,
}

/// How many borders hold a column, and of how many it is not known.
#[derive(Default)]
struct Count([usize; 3]);

impl Count {
    fn change(&mut self, before: Held, after: Held) {
        // Those that hold it not are counted from the first change on, which matters to nobody.
        self.0[before as usize] = self.0[before as usize].wrapping_sub(1);
        self.0[after as usize] = self.0[after as usize].wrapping_add(1);
    }

    /// Whether any does.
    fn any(&self) -> Option<bool> {
        let [_, unknown, yes] = self.0;
        (yes > 0 || unknown == 0).then_some(yes > 0)
    }
}

/// Solids met in a column, in their order.
#[derive(Default)]
pub(super) struct Met {
    solids: Vec<usize>,
    count: Count,
}

impl Met {
    /// The solids, if they are known.
    pub(super) fn known(&self) -> Option<&[usize]> {
        (self.count.0[Held::Unknown as usize] == 0).then_some(&self.solids)
    }

    fn change(&mut self, solid: usize, before: Held, after: Held) {
        self.count.change(before, after);
        let place = self.solids.partition_point(|&other| other < solid);
        if after == Held::Yes {
            self.solids.insert(place, solid);
        } else if before == Held::Yes {
            self.solids.remove(place);
        }
    }
}

/// What is known of a column.
#[derive(Default)]
pub(super) struct Column {
    pub(super) direct: Met,
    pub(super) mirrored: Met,
    surface: Count,
    shadows: Count,
    /// Whether it is one of each border's.
    pub(super) held: Vec<Held>,
}

impl Column {
    /// Whether it meets the surface.
    pub(super) fn surface(&self) -> Option<bool> {
        self.surface.any()
    }

    /// Whether the surface is in shadow there.
    pub(super) fn surface_in_shadow(&self) -> Option<bool> {
        self.shadows.any()
    }

    /// Whether it is one of a border's.
    pub(super) fn holds(&self, border: usize) -> Option<bool> {
        match self.held[border] {
            Held::No => Some(false),
            Held::Unknown => None,
            Held::Yes => Some(true),
        }
    }

    pub(super) fn change(&mut self, border: usize, of: Border, after: Held) {
        let before = std::mem::replace(&mut self.held[border], after);
        match of {
            Border::Surface => self.surface.change(before, after),
            Border::ShadowOnSurface => self.shadows.change(before, after),
            Border::Detail => {}
            Border::Direct(solid) => self.direct.change(solid, before, after),
            Border::Mirrored(solid) => self.mirrored.change(solid, before, after),
        }
    }
}
