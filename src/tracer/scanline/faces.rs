//! What a row shows of late faces: the creases and shadows that divide a span.

use crate::tracer::scanline::grid::{Columns, ROWS};
use crate::tracer::scanline::prepare::late_faces::SplitFaces;
use crate::tracer::scanline::row_edges::{Added, RowEdges};
use crate::tracer::scanline::visibility::coverage::Coverage;
use crate::tracer::scanline::visibility::resolve::front_face;
use crate::tracer::scanline::visibility::visible::Shown;

/// The parts of a span that shows late faces, and the edges of the faces that a band shows.
#[derive(Default)]
pub(crate) struct FaceSplitter {
    /// The first row of the band.
    first: Option<u32>,
    /// The number of places from which on edges are forgotten before others are added.
    enough: usize,
    slots: Vec<Slot>,
    /// By the number of late faces, the slot that they had last.
    slot_of: Vec<u32>,
    /// The edges of all faces that have slots.
    edges: RowEdges,
    coverage: Coverage,
    parts: Vec<(Columns, Shown)>,
}

/// The edges of late faces.
struct Slot {
    /// The number of the late faces.
    number: usize,
    edges: Added,
}

impl FaceSplitter {
    /// Prepares for rows of a frame in which so many solids have late faces. Where edges have
    /// `enough` places, all are forgotten before others are added: no crowd takes more memory than
    /// that and the edges of one solid, but for the room in which a vector grows.
    pub(crate) fn begin(&mut self, count: usize, enough: usize) {
        self.first = None;
        self.enough = enough;
        self.slot_of.resize(count, 0);
    }

    /// What a row shows in columns that show the late faces of this number, from the left. `cross`
    /// adds their edges in the band of rows from the given one on.
    pub(crate) fn split(
        &mut self,
        (number, faces): (usize, &SplitFaces<'_>),
        row: u32,
        columns: Columns,
        cross: impl FnOnce(u32, &mut RowEdges) -> Added,
    ) -> impl Iterator<Item = (Columns, Shown)> {
        let edges = match faces.kept_edges(row) {
            Some(edges) => edges,
            None => {
                let slot = self.slot(number, row, cross);
                self.edges.sorted(&self.slots[slot].edges, row)
            }
        };
        self.parts.clear();
        self.coverage.clear(&faces.kinds);
        let (mut from, end) = columns;
        for edge in edges {
            let to = edge.column().min(end);
            if from < to {
                let (_, shown) = front_face(&faces.front_faces, &self.coverage);
                match self.parts.last_mut() {
                    Some((last, same)) if *same == shown => last.1 = to,
                    _ => self.parts.push(((from, to), shown)),
                }
                from = to;
            }
            if from == end {
                break;
            }
            let edge = edge.edge();
            self.coverage
                .cross(&faces.kinds, edge.region(), edge.cover());
        }
        if from < end {
            let (_, shown) = front_face(&faces.front_faces, &self.coverage);
            self.parts.push(((from, end), shown));
        }
        self.parts.drain(..)
    }

    /// The slot with the edges of the late faces of this number in the band of a row.
    fn slot(
        &mut self,
        number: usize,
        row: u32,
        cross: impl FnOnce(u32, &mut RowEdges) -> Added,
    ) -> usize {
        let first = row - row % ROWS as u32;
        if self.first != Some(first) {
            self.first = Some(first);
            self.forget();
        }
        let slot = self.slots.get(self.slot_of[number] as usize);
        if slot.is_none_or(|slot| slot.number != number) {
            self.add(number, |edges| cross(first, edges));
        }
        self.slot_of[number] as usize
    }

    /// Adds the edges of the late faces of this number.
    fn add(&mut self, number: usize, cross: impl FnOnce(&mut RowEdges) -> Added) {
        if self.edges.places() >= self.enough {
            self.forget();
        }
        let edges = cross(&mut self.edges);
        self.slot_of[number] = self.slots.len() as u32;
        self.slots.push(Slot { number, edges });
    }

    /// Forgets all edges.
    fn forget(&mut self) {
        self.slots.clear();
        self.edges.clear();
    }
}
