//! What a row shows of late faces: the creases and shadows that divide a span.

use fearless_simd::Level;

use crate::tracer::scanline::grid::{Columns, Grid, ROWS};
use crate::tracer::scanline::prepare::late_faces::SplitFaces;
use crate::tracer::scanline::row_edges::RowEdges;
use crate::tracer::scanline::visibility::coverage::Coverage;
use crate::tracer::scanline::visibility::resolve::front_face;
use crate::tracer::scanline::visibility::visible::Shown;

/// The parts of a span that shows late faces, and the edges of the faces that a band shows.
#[derive(Default)]
pub(crate) struct FaceSplitter {
    /// The first row of the band.
    first: Option<u32>,
    /// How many of `slots` are in use in the band.
    used: usize,
    slots: Vec<Slot>,
    /// By the number of late faces, the slot that they had last.
    slot_of: Vec<u32>,
    /// The numbers of the regions that reach the band, while they are crossed.
    reaching: Vec<u32>,
    coverage: Coverage,
    parts: Vec<(Columns, Shown)>,
}

/// The edges of late faces in the band.
#[derive(Default)]
struct Slot {
    /// The number of the late faces.
    number: usize,
    edges: RowEdges,
}

impl FaceSplitter {
    /// Prepares for rows of a frame in which so many solids have late faces.
    pub(crate) fn begin(&mut self, count: usize) {
        self.first = None;
        self.slot_of.resize(count, 0);
    }

    /// What a row shows in columns that show the late faces of this number, from the left.
    pub(crate) fn split(
        &mut self,
        (number, faces): (usize, &SplitFaces<'_>),
        row: u32,
        columns: Columns,
        level: Level,
        grid: Grid,
    ) -> impl Iterator<Item = (Columns, Shown)> {
        let first = row - row % ROWS as u32;
        if self.first != Some(first) {
            self.first = Some(first);
            self.used = 0;
        }
        let slot = self.slot_of[number] as usize;
        let is_kept = slot < self.used && self.slots[slot].number == number;
        let slot = if is_kept { slot } else { self.used };
        if !is_kept {
            if slot == self.slots.len() {
                self.slots.push(Slot::default());
            }
            self.used += 1;
            self.slot_of[number] = slot as u32;
            self.slots[slot].number = number;
            let regions = (0..).zip(faces.regions.all);
            let reaching = regions.filter(|(_, region)| {
                let (from, to) = region.rows();
                from < first + ROWS as u32 && first < to
            });
            self.reaching.clear();
            self.reaching.extend(reaching.map(|(number, _)| number));
            let edges = &mut self.slots[slot].edges;
            edges.cross(&faces.regions, &self.reaching, first, level, grid);
        }
        self.parts.clear();
        self.coverage.clear(&faces.regions);
        let (mut from, end) = columns;
        for edge in self.slots[slot].edges.sorted(row) {
            let to = edge.column().min(end);
            if from < to {
                self.coverage.look(&faces.regions);
                let (_, shown) = front_face(&faces.front_faces, &self.coverage);
                self.parts.push(((from, to), shown));
                from = to;
            }
            self.coverage
                .cross(edge.edge().region(), edge.edge().cover());
        }
        if from < end {
            self.coverage.look(&faces.regions);
            let (_, shown) = front_face(&faces.front_faces, &self.coverage);
            self.parts.push(((from, end), shown));
        }
        self.parts.drain(..)
    }
}
