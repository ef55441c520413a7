//! The scan-line tracer: a frame, row by row, from the left to the right.
//!
//! Most pixels show what their left neighbour shows. So a pixel is not asked what it shows: it is
//! found where *edges* cross its row. Between two crossings, in a *gap*, all pixels meet the same
//! solids, shadows and mirror images; neighbouring gaps that show the same are one *span*.
//!
//! ```text
//!     frame → edge table → crossings of 8 rows → active edges → what gaps show → spans → samples
//!     prepare/  edges/table    edges/region        active       visibility/     active   shade/, write/
//!
//!     one row:
//!               edge    edge         edge         edge      edge            edge
//!                 |       |            |            |         |               |
//!      background | surface | its shadow | sphere   | sphere  | mirror image | surface
//!                 |       |            | in light   | in dark | image         |
//!        fill       fill    fill         shade        fill      fill            fill
//! ```
//!
//! - `prepare/` makes a frame: which solids and mirror images there are (`outline`), which of them
//!   others hide (`culling`), how each is coloured (`bodies`) and what shades it (`shadows`), and
//!   the surface (`surface`); all of it as plain data (`prepared`) with its edges and paints.
//! - `edges/` holds the edges on the screen at which a row may change what it shows. Eye rays are
//!   parallel, and so are rays to the light: every silhouette, edge of a face, outline of a shadow
//!   on a plane or of a mirror image is a straight line or an ellipse, and where it crosses a row
//!   is a root, known within a bound. So the *possible* columns of a region and its *certain* ones
//!   may differ: in the columns between them first the region is evaluated, and where that does
//!   not tell, the whole pixel. Shadows on spheres have no edges: `shade/` finds them.
//! - `active.rs` keeps the crossings of a row in order, and what is visible between them, for the
//!   next row, where mostly nothing but places has changed.
//! - `visibility/` finds out what a span shows: which regions cover it (`coverage`), which solid is
//!   in front by a plane that keeps solids apart (`separation`) or by a test of depth (`depth`),
//!   and what of it is seen (`resolve`).
//! - `shade/` computes the pixels of spheres, many at a time (`run`), by one formula (`equation`):
//!   within bounds for the kernels that are right, or without (`policy`). Columns turned away from
//!   the light are found as runs, too, and those that may have a highlight (`columns`).
//! - `write/` fills spans of one paint, and leaves out what stands there from the frame before
//!   (`history`).
//!
//! All of this is f64 with proven bounds. A pixel that they leave in doubt is asked by itself
//! (`ladder.rs`), by the formulas that everything here is derived from: `pixel.rs` is the
//! definition, this is how it is computed fast.
//!
//! A new kind of solid, such as a cylinder, would need
//!
//! - in `scene`: its type and its refusals (`file`), a ball around it (`hull`), when it lies inside
//!   of others (`hidden`), what is exactly known of it (`exact`);
//! - in `tracer`: the line that meets it, in a file beside `tracer/sphere.rs`; `frame`, `view`,
//!   `extent`, `pixel`, `palette` and `explain` name every kind of solid;
//! - here: an outline and a depth (`prepare/outline`, `prepare/depth`), its colours
//!   (`prepare/bodies`, `visibility/resolve`, and `shade/` where they vary), its shadow on planes
//!   and on spheres (`prepare/shadows`, `shade/caster`), and planes that keep it apart from others
//!   (`visibility/separation`).
//!
//! A [`Region`](edges::region::Region) is half-planes and at most one ellipse, and a solid has one:
//! the outline of a cylinder, which is a union of two ellipses and what lies between them, would
//! need several.
//!
//! What not to try again: closures given to `map` inside of vector code, which are compiled without
//! the vector instructions around them; 16 rows at once; shading the runs of a sphere together at
//! the end of some rows.

mod active;
#[cfg(test)]
mod bounds;
mod edges;
mod grid;
mod precision;
mod prepare;
mod rounding;
mod shade;
#[cfg(test)]
mod tests;
mod visibility;
mod write;

use std::ops::Range;

use fearless_simd::Level;

use super::arena::Arena;
use super::decision::Decision;
use super::in_doubt::InDoubt;
use super::ladder::RowPixels;
use super::pixel::quadrant;
use super::progress::Progress;
use active::ActiveEdges;
use grid::Columns;
pub(super) use grid::ROWS;
pub(super) use precision::Precision;
use prepare::prepared::Prepared;
use prepare::solids::Body;
use shade::span::SpanShader;
use visibility::coverage::Coverage;
use visibility::depth::Settled;
use visibility::resolve::visible;
use visibility::visible::{DepthTests, Shown, Visible};
pub(super) use write::history::RowHistory;
use write::paint::PaintNumber;
use write::row::Row;

/// The mean number of solids behind a pixel from which on it pays to look for hidden ones.
const CULL_FROM: u64 = 4;

/// A frame, ready to be traced row by row.
pub(super) struct RowTracer<'f, P> {
    /// The pixels one by one, for those that rows leave in doubt.
    pixels: &'f P,
    frame: Prepared<'f>,
    level: Level,
    precision: Precision,
}

/// What the tracing of a row needs, kept from row to row.
#[derive(Default)]
pub(super) struct Scratch {
    active: ActiveEdges,
    depth_tests: DepthTests,
    settled: Settled,
    shader: SpanShader,
}

impl<'f, P: RowPixels> RowTracer<'f, P> {
    /// The frame that `pixels` are of.
    pub(super) fn new(pixels: &'f P, precision: Precision, level: Level, arena: &'f Arena) -> Self {
        RowTracer::culled_from(CULL_FROM, pixels, precision, level, arena)
    }

    /// The same, with what is hidden looked for where a pixel may show so many solids.
    fn culled_from(
        cull_from: u64,
        pixels: &'f P,
        precision: Precision,
        level: Level,
        arena: &'f Arena,
    ) -> Self {
        let color = |decision| pixels.color(decision);
        RowTracer {
            pixels,
            frame: Prepared::new(pixels.bounded(), &color, cull_from, level, &arena.frame),
            level,
            precision,
        }
    }

    /// Prepares `scratch` for rows of this frame.
    pub(super) fn begin(&self, scratch: &mut Scratch) {
        scratch
            .active
            .begin(&self.frame.edge_table, self.frame.grid);
        scratch.depth_tests.clear();
        scratch.shader.begin(self.frame.shaded_spheres);
    }

    /// Traces neighbouring rows into their samples, and their decisions where they are asked for.
    /// Returns how many pixels double-doubles and arbitrary precision had to settle. `scratch` is
    /// prepared for the frame. With a `history` of the rows, which holds for `samples`, only
    /// what differs is written.
    pub(super) fn trace(
        &self,
        rows: Range<u32>,
        samples: &mut [f32],
        decisions: Option<&mut [Decision]>,
        history: Option<&mut [RowHistory]>,
        scratch: &mut Scratch,
        progress: &Progress,
    ) -> InDoubt {
        let mut row = Row {
            level: self.level,
            precision: self.precision,
            grid: self.frame.grid,
            first: rows.start,
            number: rows.start,
            y: 0.0,
            samples,
            decisions,
            history,
            pending: None,
            in_doubt: InDoubt::default(),
        };
        let mut traced = 0;
        for number in rows {
            row.number = number;
            row.y = self.frame.grid.coordinate(number);
            match &self.frame.quadrants {
                Some(quadrants) => self.trace_quadrants(&mut row, quadrants),
                None => self.trace_row(&mut row, scratch),
            }
            row.finish();
            traced += 1;
            if traced == ROWS as u32 {
                progress.add(std::mem::take(&mut traced));
            }
        }
        progress.add(traced);
        row.finish_all()
    }

    /// Code 2-1, in which the left half of a row shows one quadrant and the right half another.
    fn trace_quadrants<'r>(&'r self, row: &mut Row<'r>, quadrants: &[PaintNumber; 4]) {
        let size = self.frame.grid.size;
        let middle = (size / 2 + 1).min(size);
        for columns in [(0, middle), (middle, size)] {
            if columns.0 < columns.1 {
                let paint = quadrants[usize::from(quadrant(columns.0, row.number, size))];
                row.fill(columns, &self.frame.paints[paint]);
            }
        }
    }

    fn trace_row<'r>(&'r self, row: &mut Row<'r>, scratch: &mut Scratch) {
        let frame = &self.frame;
        let Scratch {
            active,
            depth_tests,
            settled,
            shader,
        } = scratch;
        if depth_tests.is_full() {
            depth_tests.clear();
            active.forget();
        }
        let resolve = |coverage: &Coverage| visible(frame, coverage, depth_tests);
        active.enter(
            row.number,
            &frame.edge_table,
            self.level,
            frame.grid,
            resolve,
        );
        let mut from = 0;
        for span in 0..active.len() {
            let (to, visible) = active.span(span, row.number);
            match visible {
                // The span has no columns in this row.
                _ if from == to => {}
                Visible::Only(shows) => self.write(row, (from, to), shows, shader),
                Visible::First(_) => {
                    let columns = (from, to);
                    let parts = settled.settle(frame, depth_tests, visible, row.y, columns);
                    for (columns, shows) in parts {
                        self.write(row, columns, shows, shader);
                    }
                }
            }
            from = to;
        }
    }

    /// Writes columns that all show the same.
    fn write<'r>(
        &'r self,
        row: &mut Row<'r>,
        columns: Columns,
        shows: Shown,
        shader: &mut SpanShader,
    ) {
        match shows {
            Shown::Paint(paint) => row.fill(columns, &self.frame.paints[paint]),
            Shown::Sphere { mirrored, solid } => {
                if let Body::Sphere(shaded) = &self.frame.solids(mirrored).solid(solid).body {
                    let in_shadow = &self.frame.paints[shaded.in_shadow];
                    shader.shade(row, columns, shaded, in_shadow, self.pixels);
                }
            }
            Shown::Unknown => row.decide(columns.0..columns.1, self.pixels),
        }
    }
}
