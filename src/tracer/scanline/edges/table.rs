//! The edges of a frame: what changes where a row crosses them.

use bumpalo::Bump;
use bumpalo::collections::Vec as Growing;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x8};

use crate::tracer::arena::collect;
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::grid::ROWS;

/// What an edge is of.
#[derive(Clone, Copy)]
pub(crate) enum Edge {
    Surface,
    /// A shadow on the surface or on a facet.
    Shadow(Receiver),
    /// Between two facets of a tetrahedron.
    Crease,
    /// A solid, by its place among those seen directly, or in the mirror.
    Direct(usize),
    Mirrored(usize),
}

/// What shadows fall on, by its number: the surface, or a facet.
#[derive(Clone, Copy)]
pub(crate) struct Receiver(pub(crate) u32);

/// All edges of a frame, as they are found. Each is known by its number.
pub(crate) struct Edges<'f> {
    arena: &'f Bump,
    shapes: Growing<'f, Region<'f>>,
    of: Growing<'f, Edge>,
    receivers: u32,
}

/// The edges of a frame.
pub(crate) struct EdgeTable<'f> {
    pub(crate) shapes: &'f [Region<'f>],
    pub(crate) of: &'f [Edge],
    /// How many receivers of shadows there are.
    pub(crate) receivers: usize,
    /// Of 64 at a time the first of the rows that each can cross, and the first after these. Where
    /// the last are fewer, the others cross none.
    rows: &'f [[[u32; 64]; 2]],
}

impl EdgeTable<'_> {
    /// How many times 64 edges there are.
    pub(crate) fn words(&self) -> usize {
        self.rows.len()
    }

    /// Which of 64 edges can cross any of the rows from `first` on, bit by bit.
    #[inline(always)]
    pub(crate) fn reaching<S: Simd>(&self, simd: S, word: usize, first: u32) -> u64 {
        let [from, to] = &self.rows[word];
        let mut reaching = 0;
        for bit in (0..64).step_by(8) {
            let from = u32x8::from_slice(simd, &from[bit..bit + 8]);
            let to = u32x8::from_slice(simd, &to[bit..bit + 8]);
            let is_reaching = from.simd_lt(first + ROWS as u32) & to.simd_gt(first);
            reaching |= is_reaching.to_bitmask() << bit;
        }
        reaching
    }
}

impl<'f> Edges<'f> {
    pub(crate) fn new(arena: &'f Bump) -> Self {
        Edges {
            arena,
            shapes: Growing::new_in(arena),
            of: Growing::new_in(arena),
            receivers: 0,
        }
    }

    /// Adds one, and returns its number. Those of one kind come in the order of their solids.
    pub(crate) fn add(&mut self, shape: Region<'f>, of: Edge) -> usize {
        self.shapes.push(shape);
        self.of.push(of);
        self.of.len() - 1
    }

    /// Something that is seen in these rows only, and the shadows on it.
    pub(crate) fn add_receiver(
        &mut self,
        shadows: impl IntoIterator<Item = Region<'f>>,
        rows: (u32, u32),
    ) -> Receiver {
        let receiver = Receiver(self.receivers);
        self.receivers += 1;
        let shadows = shadows.into_iter().map(|shadow| shadow.within(rows));
        for shadow in shadows.filter(|shadow| !shadow.is_nowhere()) {
            self.add(shadow, Edge::Shadow(receiver));
        }
        receiver
    }

    pub(crate) fn all(self) -> EdgeTable<'f> {
        let rows = self.shapes.chunks(64).map(|shapes| {
            let mut rows = [[0; 64]; 2];
            for (bit, shape) in shapes.iter().enumerate() {
                (rows[0][bit], rows[1][bit]) = shape.rows();
            }
            rows
        });
        EdgeTable {
            rows: collect(self.arena, rows),
            receivers: self.receivers as usize,
            shapes: self.shapes.into_bump_slice(),
            of: self.of.into_bump_slice(),
        }
    }
}
