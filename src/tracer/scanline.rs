//! The scan-line tracer: a frame, row by row, from the left to the right.
//!
//! Most pixels show what their left neighbour shows. So the tracer looks for the columns at which a
//! row may change what it shows. Its words:
//!
//! - A *region* is a convex part of the screen whose pixels have something in common: a solid, the
//!   surface, a shadow, a mirror image. Its *edges* are where a row enters and leaves it.
//! - A *gap* lies between two neighbouring edges of a row: all its pixels are in the same regions.
//! - A *span* is a sequence of gaps that show one thing.
//! - A *band* is [`ROWS`] neighbouring rows, whose edges are computed together.
//!
//! ```text
//!     frame → edge table → edges of a band → active edges → what gaps show → spans → samples
//!     prepare/  edges/table    edges/region    active, low   visibility/   active   shade/, write/
//!
//!     one row:
//!             edge      edge         edge       edge      edge           edge
//!               |         |            |          |         |              |
//!    background | surface | its shadow | sphere   | sphere  | mirror image | surface
//!               |         |            | in light | in dark |              |
//!       fill    |  fill   |    fill    | shade    |  fill   |     fill     |  fill
//! ```
//!
//! - `prepare/` makes a frame: the solids and mirror images (`outline`), those that others do not
//!   hide (`culling`), their colours (`appearance`) and shadows (`shadows`), and the surface
//!   (`surface`). The result is plain data (`frame`): regions and paints.
//! - `edges/` crosses regions with rows. Eye rays are parallel, and so are rays to the light: every
//!   silhouette, edge of a face, outline of a shadow on a plane or of a mirror image is a straight
//!   line or an ellipse. An edge is a root of its equation, enclosed by a bound on its error. So a
//!   region has *possible* columns and *certain* ones. For the columns between them the region is
//!   evaluated, and where that leaves a doubt, the whole pixel is. A shadow on a sphere is no
//!   region: `shade/` computes it.
//! - `active.rs` keeps the edges of a row in order, and what its gaps show, for the next row, where
//!   mostly nothing but the columns of the edges has changed.
//! - `row_edges.rs` sorts, band by band and all rows at once (`sort.rs`), edges whose order no row
//!   keeps for the next: those of the following two.
//! - `low.rs` lays the regions of few rows over those gaps: a crowd of them would leave nothing in
//!   order from one row to the next.
//! - `faces.rs` divides what a row shows of a tetrahedron on which many shadows may fall: its
//!   creases and shadows are no active edges. They are prepared when a row first shows the solid
//!   (`late_making`), since most solids of such a crowd are hidden, and kept in little memory,
//!   or made again in each band, since there may be millions.
//! - `visibility/` resolves a gap: which regions cover it (`coverage`), and which solid is in front
//!   by a separating plane (`separation`) or a depth test (`depth_test`).
//! - `shade/` shades spheres, many pixels at a time (`run`), by one formula (`equation`), with
//!   bounds on its errors for the certified kernel and without for the others (`policy`). The
//!   columns of a sphere that face the light, and those that may have a highlight, are found first
//!   (`columns`), except where there are so few that each finds out by itself.
//! - `write/` fills spans of one paint (`paint`), stores few pixels and shaded ones (`pixels`), and
//!   leaves out what stands there from the frame before (`history`).
//!
//! Edges and visibility are f32 and f64 with proven bounds for every kernel: a filter. Shading has
//! bounds for the kernel exact only. A pixel in doubt is decided by itself (`ladder.rs`), by the
//! definition of the picture (`pixel.rs`), from which every formula here is derived; one that
//! certainly shows a sphere is asked for nothing but the shadow and the colour of that sphere.
//!
//! A new kind of solid, such as a cylinder, would need
//!
//! - in `scene`: a type and its refusals (`file`, `builder`, `rules`), a place in the numbering
//!   (`solid`), a bounding ball (`bounding_ball`), a test whether it lies inside of others
//!   (`enclosed`), what is exactly decided about it (`exact`), what may cast a shadow on it
//!   (`casters`);
//! - in `tracer`: its intersection with a line, in a file beside `tracer/sphere.rs`; `view`,
//!   `extent`, `palette` and `decision` name every kind of solid (what is seen without a face is a
//!   sphere), and elsewhere the compiler names each `match` on a `Solid`;
//! - here: an outline and a depth (`prepare/outline`, `prepare/depth`), colours
//!   (`prepare/appearance`, `visibility/resolve`, and `shade/` where they vary), shadows on planes
//!   and on spheres (`prepare/shadows`, `shade/caster`), and separating planes
//!   (`visibility/separation`);
//! - in `diagnosis`: what other tracers may get wrong about it (`hypotheses`); in the tests: the
//!   oracle (`tests/oracle.rs`).
//!
//! A [`Region`](edges::region::Region) is convex, and has at most one ellipse. The outline of a
//! cylinder, two ellipses and what lies between them, would need several regions.
//!
//! What was tried and made it slower: closures given to `map` inside of vector code, which are
//! compiled without the vector instructions around them; bands of 16 rows; shading the spans that
//! show spheres after all others of a row, or of some rows; narrower vectors for short runs.

mod active;
mod edges;
mod faces;
mod fetch;
mod grid;
mod low;
mod prepare;
mod row_edges;
mod shade;
mod sort;
#[cfg(test)]
mod tests;
mod visibility;
mod write;

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::AtomicUsize;

use fearless_simd::Level;

use super::arena::Arena;
use super::decision::Decision;
use super::ladder::RowPixels;
use super::pixel::{left_half, quadrant};
use super::progress::Progress;
use super::tally::Tally;
use active::ActiveEdges;
use faces::FaceSplitter;
use grid::Columns;
pub(super) use grid::ROWS;
use low::LowEdges;
use prepare::frame::{Crowd, PreparedFrame};
use prepare::late_faces::LateFaces;
use prepare::late_source::{LateMaker, LateSource, LateWork};
use prepare::solids::Appearance;
pub(super) use shade::policy::Precision;
use shade::span::SpanShader;
use visibility::coverage::Coverage;
use visibility::depth_test::{DepthTester, DepthTests};
use visibility::resolve::visible;
use visibility::visible::{Shown, Visible};
pub(super) use write::history::RowHistory;
use write::paint::PaintNumber;
use write::row_writer::RowWriter;

/// From these crowds on, what is done for crowds pays.
const CROWD: Crowd = Crowd {
    cull_from: 4,
    low_from: 4.0,
    late_from: 4,
    late_bytes: 160 << 20,
    late_edges: 1 << 20,
};

/// A frame, ready to be traced row by row.
pub(super) struct RowTracer<'f> {
    /// Decides the pixels that rows leave in doubt.
    pixels: &'f dyn RowPixels,
    frame: PreparedFrame<'f>,
    late: LateSource<'f>,
    /// The number of places for edges of late faces from which on a thread forgets them.
    late_edges: usize,
    level: Level,
    precision: Precision,
}

/// What the tracing of a row needs, kept from row to row.
#[derive(Default)]
pub(super) struct Scratch {
    active: ActiveEdges,
    low: LowEdges,
    depth_tests: DepthTests,
    depth_tester: DepthTester,
    painters: Painters,
}

/// What writes columns that are not filled with one paint.
#[derive(Default)]
struct Painters {
    shader: SpanShader,
    face_splitter: FaceSplitter,
    late_work: LateWork,
}

impl<'f> RowTracer<'f> {
    /// Prepares the frame of `pixels`.
    pub(super) fn new(
        pixels: &'f dyn RowPixels,
        precision: Precision,
        level: Level,
        arena: &'f Arena,
    ) -> Self {
        RowTracer::with_crowd(CROWD, pixels, precision, level, arena)
    }

    /// The same, with another idea of what a crowd is.
    fn with_crowd(
        crowd: Crowd,
        pixels: &'f dyn RowPixels,
        precision: Precision,
        level: Level,
        arena: &'f Arena,
    ) -> Self {
        let color = |decision| pixels.color(decision);
        let picture = pixels.bounded();
        let frame = PreparedFrame::new(picture, &color, crowd, level, &arena.setup);
        RowTracer {
            pixels,
            late: LateSource {
                pixels,
                grid: frame.grid,
                level,
                threads: &arena.threads,
                most: crowd.late_bytes,
                taken: AtomicUsize::new(0),
                free: Mutex::default(),
            },
            late_edges: crowd.late_edges,
            frame,
            level,
            precision,
        }
    }

    /// Prepares `scratch` for rows of this frame.
    pub(super) fn begin(&self, scratch: &mut Scratch) {
        scratch
            .active
            .begin(&self.frame.edge_table, self.frame.grid);
        scratch.low.begin(&self.frame.edge_table);
        scratch.depth_tests.clear();
        scratch.painters.shader.begin(self.frame.shaded_spheres);
        scratch
            .painters
            .face_splitter
            .begin(self.frame.late_faces, self.late_edges);
    }

    /// Traces neighbouring rows into their samples and, if given, decisions. Returns what
    /// they took. `scratch` must be prepared for the frame. `history`, if given, must
    /// tell what `samples` show; then only differences are written.
    pub(super) fn trace(
        &self,
        rows: Range<u32>,
        samples: &mut [f32],
        decisions: Option<&mut [Decision]>,
        history: Option<&mut [RowHistory]>,
        scratch: &mut Scratch,
        progress: &Progress,
    ) -> Tally {
        let mut writer = RowWriter {
            level: self.level,
            precision: self.precision,
            grid: self.frame.grid,
            first: rows.start,
            row: rows.start,
            y: 0.0,
            samples,
            decisions,
            history,
            pending: None,
            tally: Tally::default(),
            progress,
        };
        let late = LateMaker::new(&self.late);
        let mut traced = 0;
        for number in rows {
            if progress.is_cancelled() {
                break;
            }
            writer.row = number;
            writer.y = self.frame.grid.coordinate(number);
            match &self.frame.quadrants {
                Some(quadrants) => self.trace_quadrants(&mut writer, quadrants),
                None => self.trace_row(&mut writer, scratch, &late),
            }
            writer.finish();
            traced += 1;
            if traced == ROWS as u32 {
                progress.add(std::mem::take(&mut traced));
            }
        }
        progress.add(traced);
        writer.finish_all()
    }

    /// Code 2-1, in which the left half of a row shows one quadrant and the right half another.
    fn trace_quadrants<'r>(&'r self, writer: &mut RowWriter<'r>, quadrants: &[PaintNumber; 4]) {
        let size = self.frame.grid.size;
        let middle = left_half(size).min(size);
        for columns in [(0, middle), (middle, size)] {
            if columns.0 < columns.1 {
                let paint = quadrants[usize::from(quadrant(columns.0, writer.row, size))];
                writer.fill(columns, &self.frame.paints[paint]);
                writer.tally.spans += 1;
            }
        }
    }

    fn trace_row<'r>(
        &'r self,
        writer: &mut RowWriter<'r>,
        scratch: &mut Scratch,
        late: &LateMaker<'_, 'f>,
    ) {
        let (frame, table) = (&self.frame, &self.frame.edge_table);
        let Scratch {
            active,
            low,
            depth_tests,
            depth_tester,
            painters,
        } = scratch;
        if depth_tests.is_full() {
            depth_tests.clear();
            active.forget();
        }
        let resolve = |coverage: &Coverage| visible(frame, coverage, depth_tests);
        active.enter(writer.row, table, self.level, frame.grid, resolve);
        writer.tally.edges += active.edge_count() as u64;
        if table.has_low() {
            let fetch = |regions: &[u32]| frame.fetch(regions);
            if low.enter(writer.row, table, self.level, frame.grid, fetch) {
                return self.trace_overlaid(writer, scratch, late);
            }
        }
        let depths = (depth_tester, &*depth_tests);
        self.show(writer, active.spans(writer.row), depths, (painters, late));
    }

    /// Traces a row that low regions reach.
    #[inline(never)]
    fn trace_overlaid<'r>(
        &'r self,
        writer: &mut RowWriter<'r>,
        scratch: &mut Scratch,
        late: &LateMaker<'_, 'f>,
    ) {
        let frame = &self.frame;
        let (low, depth_tests) = (&mut scratch.low, &mut scratch.depth_tests);
        let tests = depth_tests.count();
        let resolve = |coverage: &Coverage| visible(frame, coverage, depth_tests);
        low.overlay(writer.row, &frame.edge_table, &scratch.active, resolve);
        writer.tally.edges += low.edge_count(writer.row) as u64;
        let depths = (&mut scratch.depth_tester, &*depth_tests);
        self.show(writer, low.spans(), depths, (&mut scratch.painters, late));
        // No other row can use the tests of gaps with low regions.
        depth_tests.truncate(tests);
    }

    /// Writes the spans of a row: the column at which each ends, and what it shows.
    fn show<'r>(
        &'r self,
        writer: &mut RowWriter<'r>,
        spans: impl ExactSizeIterator<Item = (u32, Visible)>,
        (depth_tester, depth_tests): (&mut DepthTester, &DepthTests),
        (painters, late): (&mut Painters, &LateMaker<'_, 'f>),
    ) {
        writer.tally.spans += spans.len() as u64;
        let mut from = 0;
        for (to, visible) in spans {
            let columns = (from, to);
            from = to;
            match visible {
                // The span has no columns in this row, but may have some in the next.
                _ if columns.0 == columns.1 => {}
                Visible::Only(shows) => self.write(writer, columns, shows, (painters, late)),
                Visible::DepthTest(_) => {
                    let row = (&self.frame, depth_tests, writer.y);
                    for (columns, shows) in depth_tester.test(row, visible, columns) {
                        self.write(writer, columns, shows, (painters, late));
                    }
                }
            }
        }
    }

    /// Writes columns that all show the same.
    #[inline(always)]
    fn write<'r>(
        &'r self,
        writer: &mut RowWriter<'r>,
        columns: Columns,
        shows: Shown,
        (painters, maker): (&mut Painters, &LateMaker<'_, 'f>),
    ) {
        match shows {
            Shown::Paint(paint) => writer.fill(columns, &self.frame.paints[paint]),
            Shown::Sphere { mirrored, solid } => {
                if let Appearance::Sphere(shaded) = self.frame.solids(mirrored).appearance(solid) {
                    let shader = &mut painters.shader;
                    shader.shade(writer, columns, shaded, self.pixels);
                }
            }
            Shown::Faces { mirrored, solid } => {
                if let Appearance::LateFaces(late) = self.frame.solids(mirrored).appearance(solid) {
                    self.write_faces(writer, columns, late, (painters, maker));
                }
            }
            Shown::InDoubt => self.decide(writer, columns),
        }
    }

    /// Decides each pixel of some columns by itself.
    #[inline(never)]
    fn decide(&self, writer: &mut RowWriter<'_>, columns: Columns) {
        writer.decide(columns.0..columns.1, |column, row| {
            self.pixels.pixel(column, row)
        });
    }

    /// Writes columns that show a solid with late faces.
    #[inline(never)]
    fn write_faces<'r>(
        &'r self,
        writer: &mut RowWriter<'r>,
        columns: Columns,
        late: &'r LateFaces<'f>,
        (painters, maker): (&mut Painters, &LateMaker<'_, 'f>),
    ) {
        // The faces that a row is the first to show may take seconds. A row that is not whole is
        // never seen.
        if writer.progress.is_cancelled() {
            return;
        }
        let Painters {
            face_splitter,
            late_work,
            ..
        } = painters;
        let faces = late.get(writer.row, maker, late_work);
        let cross = |first, edges: &mut _| late.cross(faces, first, edges, maker.source, late_work);
        let numbered = (late.number, faces);
        for (columns, shows) in face_splitter.split(numbered, writer.row, columns, cross) {
            match shows {
                Shown::Paint(paint) => writer.fill(columns, &faces.paints[paint]),
                _ => self.decide(writer, columns),
            }
        }
    }
}
