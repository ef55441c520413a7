//! Rows of pixels at once: what they show is decided where borders cross them, and most pixels are copies of their neighbour.
//!
//! A row is cut where a silhouette, an edge, a shadow or a mirror image begins or ends (`shape.rs`), and a sweep from crossing to
//! crossing (`sweep.rs`) tells what is seen between them (`plan.rs`): one colour, which is filled in (`paint.rs`), or a sphere. Of
//! that it is found which columns face the light (`chord.rs`); these are shaded many pixels at a time (`ball.rs`, `lanes.rs`), and
//! the others filled in. All of this is f64 with proven bounds. A pixel that the bounds leave in doubt is asked for by itself, of the
//! formulas that everything is derived from.
//!
//! # How it got there
//!
//! Milliseconds a frame of the built-in scene's stage 6 at N = 500, by `exact` on one thread of an AMD EPYC (Zen 5), which fills the
//! same picture in 0.03: what was expected, what was changed, and what came of it.
//!
//! - Every pixel by itself took 10 in plain f64, and more with bounds. Most pixels have the colour of their neighbour, so rows were
//!   cut and filled: 0.97, of which nearly half went to 840 pixels in doubt.
//! - One bound for all pixels of a sphere is that of its rim, where a root multiplies errors, and of its highlight, where the
//!   exponent does. Bounds by how far inside the outline a pixel is, and with the highlight only where there is one, are far
//!   smaller. Closures handed to `map` are compiled without the vector instructions around them, so none are left: 0.29.
//! - Sine and cosine in arbitrary precision were a tenth of what remained. A series in double-doubles, and no pool for one thread:
//!   0.23.
//! - Pixels turned away from the light need no colour computed: 0.226.
//! - A caster that a run of a sphere's pixels is out of reach of need not be asked in each of them, which the least and the most of
//!   its forms along the run tell; a colour's vectors are made once a frame, and the last of a run overlaps the one before: 0.187.
//! - Eight rows are crossed at once, and a sweep keeps what it has met instead of asking every border between two crossings: 0.170.
//!   Most rows show what the row before shows from crossing to crossing, so that is kept: 0.166.
//! - Of two solids that a plane keeps apart it is known for the whole frame which is in front, so no depth is computed: 0.150.
//! - A highlight multiplies the error of n·h by its exponent, here 1000, and its bound was that of the brightest pixel: 12 pixels a
//!   frame were in doubt, and 494 with 200 small spheres. 1 − n·h is known far better, and each pixel has its own bound now: 0.145,
//!   and 0.8 instead of 1.95 with the small spheres.
//! - A surface's border that lies exactly on a row was asked for pixel by pixel, because a third of its height rounds. Three times
//!   the surface has no thirds: at N = 512 and α = 0 it is 0.11 instead of 0.31.
//! - From one band of rows to the next mostly the same borders cross in the same order, so that and what is seen between them is kept
//!   too; expected was 0.003, it came to 0.006: 0.136.
//! - A frame's borders, solids and paints lay in 77 allocations, thought to cost 0.002 of 0.136. In one piece of memory that the next frame
//!   uses again (`arena.rs`) they are 0.131.
//! - Dead ends, all within the noise: a fixed-length interleave of the channels, one by shuffles (which the compiler makes by itself),
//!   and one by overlapping stores; fewer half-planes for shadows on the surface, fewer cuts to sort, one codegen unit; a last vector
//!   of a sphere's pixels that lies on the one before (and then must not leave in doubt what that knew); one test for a highlight
//!   in two vectors, and one in a whole run, which nearly every run passes; crossings narrowed to columns by vectors. The end of
//!   a sphere's light as one more border would cost more crossings (5 ns each) than the pixels behind it take.
//!
//! The same on a slower EPYC (Zen 4, 3.65 GHz), which fills the picture in 0.034 and took 0.207 with all of the above, 0.192 retained; the
//! old and the new program in turn, the least of 200 rounds each:
//!
//! - A vector of 16 pixels cost 160 cycles where its arithmetic, 32 for the two roots among it, should take 60. Vectors of samples instead of
//!   pixels, as they lie in memory, need no interleaving, and their colours' coefficients come in three patterns; a vector's roots begin before the
//!   one before it waits for its own; where the processor can, it multiplies and adds at once: 70 cycles. By that and what comes next
//!   expected 0.16, got 0.196: few pixels of stage 6 are spheres in the light.
//! - What of a sphere faces the light is an interval of every row, found for eight rows at once: nothing is asked in its pixels, and what is turned
//!   away is filled in. Which casters come into question is asked once in eight rows as well.
//! - The half-planes of a shape are cut in f64 before anything becomes a column. What is seen between crossings is kept until two change
//!   places, which 52 rows of a frame have, and planned without branches, because none was foreseen: 0.179.
//! - What ends a row and begins the next is filled at once, at whole cache lines: 0.166. A memory that is passed over once: 0.151
//!   retained.
//! - Dead ends: 16 rows at once instead of 8; bounds on products with fewer tests for exactness; asking a small sphere's pixels instead of
//!   its rows. With a fill shorter than four vectors alignment does not pay. A closure in `map` is compiled without vectors still, and two
//!   of them cost a quarter of the shading. 200 small spheres that overlap take 8 % longer than before (1.9): each has few
//!   pixels in eight rows to make up for what is found there.
//! - Where a fill ends is never foreseen: vectors that lie on part of others instead of branches on what is left over: 0.164, and 8 % of a
//!   picture of 1500 × 1500. What a column meets is bits, and not lists, because few gaps are looked at: 0.157, retained 0.144.
//! - 200 small spheres that overlap, 1.86: which borders reach eight rows is asked by vectors, what all spheres make of the light is
//!   computed once, and of two columns in which it is open who is in front each is decided by itself, by the depths of its row. They were
//!   asked pixel by pixel, 100 a frame, at 1.7 µs: 1.44.
//! - Dead ends: eight rows from crossing to crossing at once, so that what is seen is asked, and a sphere's vectors are made, once in them
//!   (as fast, but 5 % slower retained); a sphere's runs shaded together at the end of 8 or 64 rows (3 % slower); the error of a
//!   product by Dekker's arithmetic instead of by counting bits (all that comes before the first row takes 17 % longer).
//!
//! What is left of 0.157: 0.014 before the first row, the rest about evenly structure of rows, shading and filling. To fill the 1200 parts of one
//! colour that a frame has, with nothing to decide, takes 0.036, and to shade its 1270 vectors of pixels at the 76 cycles that each takes in
//! a picture full of sphere 0.026: together they are 1.8 times the fill. The structure is 350 rows of four parts, where every branch depends on
//! the frame: 15 ns a part are a few branches foretold wrongly.

mod ball;
mod border;
#[cfg(test)]
mod bounds;
mod caster;
mod chord;
mod column;
mod contest;
mod ellipse;
mod floor;
mod half_plane;
mod lanes;
mod lighting;
mod memory;
mod order;
mod paint;
mod parts;
mod place;
mod plain;
mod plan;
mod precision;
mod reaches;
mod rounding;
mod row;
mod seeing;
mod shaded;
mod shape;
mod sheet;
mod solids;
mod span;
mod sweep;

use std::ops::Range;

use fearless_simd::Level;

use super::arena::Arena;
use super::decision::Decision;
use super::in_doubt::InDoubt;
use super::ladder::Lines;
use super::pixel::quadrant;
use super::progress::Progress;
use crate::stage::Stage;
use border::{AllBorders, Borders};
use chord::AllChords;
use column::Column;
use floor::Floor;
use lanes::Shading;
pub(super) use memory::Memory;
use paint::{AllPaints, PaintNumber, Paints};
use parts::Parts;
pub(super) use place::ROWS;
use place::{Columns, Screen};
use plan::{Plan, Seen, Show};
pub(super) use precision::Precision;
use row::Row;
use solids::{Body, Solids};
use sweep::Sweep;

/// A frame, ready to be traced row by row.
pub(super) struct Rows<'f, P> {
    /// Asked for what is in doubt.
    pixels: &'f P,
    screen: Screen,
    level: Level,
    borders: AllBorders<'f>,
    direct: Solids<'f>,
    floor: Option<Floor<'f>>,
    paints: AllPaints<'f>,
    /// How many spheres are shaded.
    balls: usize,
    background: PaintNumber,
    /// The picture of code 2-1, where that is the stage.
    quadrants: Option<[PaintNumber; 4]>,
    precision: Precision,
}

/// What the tracing of a row needs, kept for the next.
#[derive(Default)]
pub(super) struct Scratch {
    sweep: Sweep,
    plan: Plan,
    settled: Vec<(Columns, Show)>,
    shade: Shade,
}

/// What the shading of spheres needs, kept for the next.
#[derive(Default)]
struct Shade {
    chords: AllChords,
    shading: Shading,
}

impl<'f, P: Lines> Rows<'f, P> {
    /// The frame that `pixels` are of.
    pub(super) fn new(pixels: &'f P, precision: Precision, level: Level, arena: &'f Arena) -> Self {
        let arena = &arena.frame;
        let picture = pixels.bounded();
        let screen = Screen::new(picture.size);
        let color = |decision| pixels.color(decision);
        let mut parts = Parts {
            screen,
            arena,
            borders: Borders::new(arena),
            paints: Paints::new(&color, arena),
            balls: 0,
        };
        let is_quadrants = picture.stage == Stage::Image;
        let background = parts.paints.of(Decision::Background);
        let floor = picture.floor.as_ref();
        let floor = floor.map(|floor| Floor::new(picture, floor, &mut parts));
        let direct = Solids::new(picture, &picture.view, false, &mut parts);
        let quadrant = |number| parts.paints.of(Decision::Quadrant(number));
        let quadrants = is_quadrants.then(|| [0, 1, 2, 3].map(quadrant));
        Rows {
            pixels,
            screen,
            level,
            borders: parts.borders.all(),
            paints: parts.paints.all(),
            balls: parts.balls,
            direct,
            floor,
            background,
            quadrants,
            precision,
        }
    }

    /// What tracing rows of this frame needs.
    pub(super) fn begin(&self, scratch: &mut Scratch) {
        scratch.sweep.begin(&self.borders, self.screen);
        scratch.plan.clear();
        scratch.shade.chords.begin(self.balls);
    }

    /// Traces neighbouring rows into their samples, and their decisions where they are asked for. How many pixels double-doubles and
    /// arbitrary precision had to settle. `scratch` is prepared for the frame. With a `memory` of the rows, which holds for `samples`, only
    /// what differs is written.
    pub(super) fn trace(
        &self,
        rows: Range<u32>,
        samples: &mut [f32],
        decisions: Option<&mut [Decision]>,
        memory: Option<&mut [Memory]>,
        scratch: &mut Scratch,
        progress: &Progress,
    ) -> InDoubt {
        let mut row = Row {
            level: self.level,
            precision: self.precision,
            screen: self.screen,
            first: rows.start,
            number: rows.start,
            y: 0.0,
            samples,
            decisions,
            memory,
            pending: None,
            in_doubt: InDoubt::default(),
        };
        let mut traced = 0;
        for number in rows {
            row.number = number;
            row.y = self.screen.place(number);
            match &self.quadrants {
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

    /// Code 2-1, which knows two kinds of column.
    fn trace_quadrants<'r>(&'r self, row: &mut Row<'r>, quadrants: &[PaintNumber; 4]) {
        let size = self.screen.size;
        let middle = (size / 2 + 1).min(size);
        for columns in [(0, middle), (middle, size)] {
            if columns.0 < columns.1 {
                let paint = quadrants[usize::from(quadrant(columns.0, row.number, size))];
                row.fill(columns, &self.paints[paint]);
            }
        }
    }

    fn trace_row<'r>(&'r self, row: &mut Row<'r>, scratch: &mut Scratch) {
        let screen = self.screen;
        let Scratch {
            sweep,
            plan,
            settled,
            shade,
        } = scratch;
        if plan.is_full() {
            plan.clear();
            sweep.forget();
        }
        let look = |column: &Column| self.seen(column, plan);
        sweep.enter(row.number, &self.borders, self.level, screen, look);
        let mut from = 0;
        for part in 0..sweep.len() {
            let (to, seen) = sweep.part(part, row.number);
            match seen {
                // A part that other rows have.
                _ if from == to => {}
                Seen::Only(shows) => self.write(row, (from, to), shows, shade),
                Seen::First(_) => {
                    self.settle(plan, seen, row.y, (from, to), settled);
                    for (columns, shows) in settled.drain(..) {
                        self.write(row, columns, shows, shade);
                    }
                }
            }
            from = to;
        }
    }

    /// The solids, or those in the mirror. Without a mirror nothing asks for these.
    fn solids(&self, mirrored: bool) -> &Solids<'f> {
        let in_mirror = self
            .floor
            .as_ref()
            .and_then(|floor| floor.mirrored.as_ref());
        in_mirror.filter(|_| mirrored).unwrap_or(&self.direct)
    }

    /// Columns that all show the same.
    fn write<'r>(&'r self, row: &mut Row<'r>, columns: Columns, shows: Show, shade: &mut Shade) {
        match shows {
            Show::Paint(paint) => row.fill(columns, &self.paints[paint]),
            Show::Ball { mirrored, solid } => {
                if let Body::Ball(ball) = &self.solids(mirrored).solids[solid as usize].body {
                    let paint = &self.paints[ball.in_shadow];
                    let Shade { chords, shading } = shade;
                    let chord = chords.of(ball, row.number, self.level, self.screen);
                    row.shade(columns, ball, &chord, paint, shading);
                    if !shading.doubts.is_empty() {
                        row.ask(shading.doubts.drain(..), self.pixels);
                    }
                }
            }
            Show::Unknown => row.ask(columns.0..columns.1, self.pixels),
        }
    }
}
