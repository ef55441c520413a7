//! Coverage: which regions cover a column, and so which solids, shadows and mirror images are met.
//!
//! A crossing changes two bits of it; what the bits mean is found out for spans whose visibility is
//! not cached.

use crate::tracer::scanline::edges::table::{Edge, EdgeTable};

/// Edges of one kind: whether any of them holds a column, and of which this is not known.
#[derive(Clone, Copy, Default)]
struct Any {
    held: bool,
    unknown: bool,
}

impl Any {
    fn add(&mut self, kind: u64, (held, unknown): (u64, u64)) {
        self.held |= held & kind != 0;
        self.unknown |= unknown & kind != 0;
    }

    fn known(self) -> Option<bool> {
        (self.held || !self.unknown).then_some(self.held)
    }
}

/// Solids met in a column, in their order.
#[derive(Default)]
pub(crate) struct Met {
    solids: Vec<usize>,
    any: Any,
}

impl Met {
    /// The solids, if they are known.
    pub(crate) fn known(&self) -> Option<&[usize]> {
        (!self.any.unknown).then_some(&self.solids)
    }

    fn clear(&mut self) {
        self.solids.clear();
        self.any = Any::default();
    }
}

/// The regions that cover the present column.
#[derive(Default)]
pub(crate) struct Coverage {
    /// For each edge a bit whether its region certainly covers the column, and one whether that is
    /// unknown; 64 edges a word.
    held: Vec<(u64, u64)>,
    pub(crate) direct: Met,
    pub(crate) mirrored: Met,
    surface: Any,
    shadows: Any,
}

impl Coverage {
    /// Goes to where none of a frame's edges holds it.
    pub(crate) fn clear(&mut self, edges: &EdgeTable<'_>) {
        self.held.clear();
        self.held.resize(edges.kinds.len(), (0, 0));
    }

    /// Goes across an edge: whether that holds it then, and whether this is unknown.
    pub(crate) fn cross(&mut self, edge: usize, is_held: bool, is_unknown: bool) {
        let (held, unknown) = &mut self.held[edge / 64];
        let bit = edge % 64;
        *held = *held & !(1 << bit) | u64::from(is_held) << bit;
        *unknown = *unknown & !(1 << bit) | u64::from(is_unknown) << bit;
    }

    /// Finds out what it meets.
    pub(crate) fn look(&mut self, edges: &EdgeTable<'_>) {
        self.direct.clear();
        self.mirrored.clear();
        (self.surface, self.shadows) = (Any::default(), Any::default());
        for (word, (kinds, &bits)) in edges.kinds.iter().zip(&self.held).enumerate() {
            if bits == (0, 0) {
                continue;
            }
            self.surface.add(kinds.surface, bits);
            self.shadows.add(kinds.shadows, bits);
            self.direct.any.add(kinds.direct, bits);
            self.mirrored.any.add(kinds.mirrored, bits);
            // Edges of solids are numbered in the order of these.
            let mut solids = bits.0 & (kinds.direct | kinds.mirrored);
            while solids != 0 {
                match edges.of[64 * word + solids.trailing_zeros() as usize] {
                    Edge::Direct(solid) => self.direct.solids.push(solid),
                    Edge::Mirrored(solid) => self.mirrored.solids.push(solid),
                    Edge::Surface | Edge::ShadowOnSurface | Edge::Detail => {}
                }
                solids &= solids - 1;
            }
        }
    }

    /// Whether it meets the surface.
    pub(crate) fn surface(&self) -> Option<bool> {
        self.surface.known()
    }

    /// Whether the surface is in shadow there.
    pub(crate) fn surface_in_shadow(&self) -> Option<bool> {
        self.shadows.known()
    }

    /// Whether it is one of an edge's.
    pub(crate) fn holds(&self, edge: usize) -> Option<bool> {
        let (held, unknown) = self.held[edge / 64];
        let is = |bits: u64| bits >> (edge % 64) & 1 == 1;
        (!is(unknown)).then_some(is(held))
    }
}
