//! The edges of a frame: what changes where a row crosses them.

use std::ops::Range;

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
    ShadowOnSurface,
    /// Part of a solid: it is asked for where that is seen.
    Detail,
    /// A solid, by its place among those seen directly, or in the mirror.
    Direct(usize),
    Mirrored(usize),
}

/// All edges of a frame, as they are found. Each is known by its number.
pub(crate) struct Edges<'f> {
    arena: &'f Bump,
    shapes: Growing<'f, Region<'f>>,
    of: Growing<'f, Edge>,
}

/// The edges of a frame.
pub(crate) struct EdgeTable<'f> {
    pub(crate) shapes: &'f [Region<'f>],
    pub(crate) of: &'f [Edge],
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
        }
    }

    /// Those of one kind come in the order of their solids.
    pub(crate) fn add(&mut self, shape: Region<'f>, of: Edge) {
        self.shapes.push(shape);
        self.of.push(of);
    }

    /// Details of a solid that is seen in these rows only. Returns their numbers.
    pub(crate) fn add_details(
        &mut self,
        shapes: impl IntoIterator<Item = Region<'f>>,
        rows: (u32, u32),
    ) -> Range<usize> {
        let first = self.of.len();
        for shape in shapes {
            self.add(shape.within(rows), Edge::Detail);
        }
        first..self.of.len()
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
            shapes: self.shapes.into_bump_slice(),
            of: self.of.into_bump_slice(),
        }
    }
}
