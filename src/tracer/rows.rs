//! Rows of pixels at once: what they show is decided where borders cross them, and most pixels are copies of their neighbour.
//!
//! A row is cut where a silhouette, an edge, a shadow or a mirror image begins or ends (see `shape.rs`). Between two cuts all
//! pixels show the same: one colour, which is filled in, or a sphere in the light, which is shaded many pixels at a time
//! (`ball.rs`, `lanes.rs`). All of this is f64 with proven bounds. A pixel that the bounds leave in doubt is asked for by itself, of the
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
//! - Dead ends, all within the noise: a fixed-length interleave of the channels, fewer half-planes for shadows on the surface,
//!   fewer cuts to sort, one codegen unit.
//!
//! What is left is the structure of rows (0.1), shading (0.06), filling (0.03), and what a frame needs before its first row (0.013).

mod ball;
mod lanes;
mod plain;
mod row;
mod shape;
mod solids;
mod span;

use fearless_simd::{Level, dispatch};

use super::InDoubt;
use super::decision::Decision;
use super::ladder::Lines;
use super::pixel::{self, Picture, quadrant};
use super::vector::Vector;
use crate::number::{Bounded, Real};
use crate::scene::Side;
use crate::stage::Stage;
use lanes::{Paint, Run, Shade};
pub(super) use row::Memory;
use row::{Columns, Row};
use shape::{HalfPlane, MORE, Screen, Shape, Sheet, U};
use solids::{Body, Facet, Pair, Solid, Solids};
use span::Span;

/// A frame, ready to be traced row by row.
pub(super) struct Rows<'a, P> {
    /// Asked for what is in doubt.
    pixels: &'a P,
    screen: Screen,
    level: Level,
    direct: Solids,
    floor: Option<Floor>,
    background: Paint,
    stage: Stage,
    precision: Precision,
}

/// The arithmetic that spheres are shaded with.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Precision {
    /// f32.
    Single,
    /// f64.
    Double,
    /// f64, and pixels that its errors may make wrong are asked for by themselves.
    Bounded,
}

/// The surface.
struct Floor {
    outline: Shape,
    /// Of each solid.
    shadows: Vec<Shape>,
    mirrored: Option<Solids>,
    /// The parameter of eye rays that reach it at Y = 0, how it changes with Y, and a bound on its error.
    depth: [f64; 3],
    paint: Paint,
    in_shadow: Paint,
}

/// What the tracing of a row needs, kept for the next.
#[derive(Default)]
pub(super) struct Scratch {
    /// The solids that the row crosses, and where it is cut for them and the surface.
    direct: Crossed,
    /// The mirrored solids that it crosses, and where it is cut for them and the shadows on the surface.
    mirrored: Crossed,
    floor_shadows: Vec<Span>,
    /// Where a tetrahedron's run is cut between its faces, and a face's for the shadows on it.
    cuts: Vec<u32>,
    shadows: Vec<Span>,
    shadow_cuts: Vec<u32>,
    doubts: Vec<u32>,
    /// The casters in reach of a run.
    in_reach: Vec<usize>,
}

#[derive(Default)]
struct Crossed {
    spans: Vec<(usize, Span)>,
    cuts: Vec<u32>,
    met: Vec<usize>,
}

impl Crossed {
    /// Whether it is known which of the solids a column meets; they are then in `met`.
    fn meet(&mut self, column: u32) -> bool {
        self.met.clear();
        for (solid, span) in &self.spans {
            match span.holds(column) {
                Some(true) => self.met.push(*solid),
                Some(false) => {}
                None => return false,
            }
        }
        true
    }
}

/// What is in front of all else in some columns.
enum Front {
    Solid(usize),
    /// The surface, or where that is not met either, the background.
    Rest,
    Unknown,
}

impl<'a, P: Lines> Rows<'a, P> {
    /// The frame that `pixels` are of.
    pub(super) fn new(pixels: &'a P, precision: Precision, level: Level) -> Self {
        let picture = pixels.bounded();
        let screen = Screen::new(picture.size);
        let color = |decision| pixels.color(decision);
        let floor = picture
            .floor
            .as_ref()
            .map(|floor| Floor::new(picture, floor, &color, screen));
        Rows {
            pixels,
            screen,
            level,
            direct: Solids::new(picture, &picture.view, false, &color, screen),
            floor,
            background: Paint::new(color(Decision::Background)),
            stage: picture.stage,
            precision,
        }
    }

    /// Traces a row into its samples, and its decisions where they are asked for. How many pixels double-doubles and arbitrary
    /// precision had to settle. With a `memory` of the row, which holds for `samples`, only what differs is written.
    pub(super) fn trace(
        &self,
        number: u32,
        samples: &mut [f32],
        decisions: Option<&mut [Decision]>,
        memory: Option<&mut Memory>,
        scratch: &mut Scratch,
    ) -> InDoubt {
        let screen = self.screen;
        let mut row = Row {
            level: self.level,
            number,
            y: screen.place(number),
            samples,
            decisions,
            memory,
            in_doubt: InDoubt::default(),
        };
        if self.stage == Stage::Image {
            // Code 2-1 knows two kinds of column.
            let middle = (screen.size / 2 + 1).min(screen.size);
            for columns in [(0, middle), (middle, screen.size)] {
                if columns.0 < columns.1 {
                    let decision = Decision::Quadrant(quadrant(columns.0, number, screen.size));
                    row.fill(columns, decision, &Paint::new(self.pixels.color(decision)));
                }
            }
            return row.finish();
        }
        let mut crossed = std::mem::take(&mut scratch.direct);
        self.direct.cross(number, screen, &mut crossed.spans);
        let on_floor = match &self.floor {
            Some(floor) => floor.outline.cross(number, screen),
            None => Span::NONE,
        };
        let spans = crossed.spans.iter().map(|(_, span)| span);
        cut(
            (0, screen.size),
            spans.chain([&on_floor]),
            &mut crossed.cuts,
        );
        // Of the mirrored solids and the shadows on the surface nothing is known before it is seen.
        scratch.mirrored.cuts.clear();
        let cuts = std::mem::take(&mut crossed.cuts);
        for columns in cuts.windows(2).map(|ends| (ends[0], ends[1])) {
            let known = crossed.meet(columns.0);
            let hidden = |&solid: &usize| self.direct.solids[solid].side == Side::Above;
            let on_floor = match on_floor.holds(columns.0) {
                // What is above the surface hides it.
                _ if crossed.met.iter().any(hidden) => Some(false),
                held => held,
            };
            match on_floor.filter(|_| known) {
                Some(on_floor) => {
                    let floor = self.floor.as_ref().filter(|_| on_floor);
                    self.first(&mut row, scratch, columns, &crossed.met, floor);
                }
                None => row.ask(columns.0..columns.1, self.pixels),
            }
        }
        crossed.cuts = cuts;
        scratch.direct = crossed;
        row.finish()
    }

    /// Columns that all meet the same solids, and the surface where it is given.
    fn first(
        &self,
        row: &mut Row<'_>,
        scratch: &mut Scratch,
        columns: Columns,
        met: &[usize],
        floor: Option<&Floor>,
    ) {
        let surface = floor.map(|floor| floor.depth_at(row.y));
        match self.front(&self.direct, met, surface, row.y, columns) {
            Front::Solid(solid) => self.solid(row, scratch, &self.direct, solid, columns),
            Front::Rest => match floor {
                Some(floor) => self.surface(row, scratch, columns, floor),
                None => row.fill(columns, Decision::Background, &self.background),
            },
            Front::Unknown => match halves(columns) {
                Some(halves) => {
                    for half in halves {
                        self.first(row, scratch, half, met, floor);
                    }
                }
                None => row.ask(columns.0..columns.1, self.pixels),
            },
        }
    }

    /// What is in front in all these columns, of the solids met and a surface whose depth is given from the least to the most.
    fn front(
        &self,
        view: &Solids,
        met: &[usize],
        surface: Option<(f64, f64)>,
        y: f64,
        columns: Columns,
    ) -> Front {
        match (met, surface) {
            ([], _) => return Front::Rest,
            ([solid], None) => return Front::Solid(*solid),
            _ => {}
        }
        let ends = [columns.0, columns.1 - 1].map(|column| self.screen.place(column));
        let depth = |solid: usize| view.solids[solid].depth(y, ends);
        // The candidate is what ends first; it is in front if all others begin behind that.
        let mut candidate = (Front::Rest, surface.map_or(f64::INFINITY, |(_, most)| most));
        for &solid in met {
            let (_, most) = depth(solid);
            if most < candidate.1 {
                candidate = (Front::Solid(solid), most);
            }
        }
        let (front, most) = candidate;
        let behind = |&other: &usize| match front {
            Front::Solid(solid) if solid == other => true,
            // Of a sphere that is listed twice the first is seen.
            Front::Solid(solid)
                if solid < other && view.solids[solid].is_same_sphere(&view.solids[other]) =>
            {
                true
            }
            _ => depth(other).0 > most,
        };
        let surface_is_behind = match (&front, surface) {
            (Front::Solid(_), Some((least, _))) => least > most,
            _ => true,
        };
        if surface_is_behind && most.is_finite() && met.iter().all(behind) {
            front
        } else {
            Front::Unknown
        }
    }

    /// Columns that show a solid.
    fn solid(
        &self,
        row: &mut Row<'_>,
        scratch: &mut Scratch,
        view: &Solids,
        solid: usize,
        columns: Columns,
    ) {
        let solid = &view.solids[solid];
        match &solid.body {
            Body::Flat => {
                let decision = view.decision(solid.index, None, false);
                row.fill(columns, decision, &solid.paint);
            }
            Body::Ball(ball, casters) => {
                let last = self.screen.place(columns.1 - 1);
                let stretch = ball.stretch(row.y, (self.screen.place(columns.0), last));
                let near = |&caster: &usize| !casters[caster].misses(&stretch);
                scratch.in_reach.clear();
                scratch.in_reach.extend((0..casters.len()).filter(near));
                let shade = Shade {
                    ball,
                    casters,
                    in_reach: &scratch.in_reach,
                    shadows: view.shadows,
                    in_shadow: &solid.paint,
                };
                let both = [false, true].map(|dark| view.decision(solid.index, None, dark));
                let range = columns.0 as usize..columns.1 as usize;
                let mut run = Run {
                    screen: self.screen,
                    y: row.y,
                    from: columns.0,
                    samples: &mut row.samples[3 * range.start..3 * range.end],
                    decisions: row.decisions.as_mut().map(|all| (&mut all[range], both)),
                    doubts: &mut scratch.doubts,
                };
                match self.precision {
                    Precision::Bounded => {
                        dispatch!(self.level, simd => lanes::shade(simd, &shade, &mut run));
                        row.ask(scratch.doubts.drain(..), self.pixels);
                    }
                    Precision::Double => {
                        dispatch!(self.level, simd => plain::shade_in_double(simd, &shade, &mut run));
                    }
                    Precision::Single => {
                        dispatch!(self.level, simd => plain::shade_in_single(simd, &shade, &mut run));
                    }
                }
            }
            Body::Facets(facets, pairs) => {
                let mut cuts = std::mem::take(&mut scratch.cuts);
                // Eye rays enter at most three faces.
                let mut lines = [Span::NONE; 3];
                for (line, pair) in lines.iter_mut().zip(pairs) {
                    *line = pair.first.cross(row.y, self.screen).span(self.screen.size);
                }
                cut(columns, lines.iter(), &mut cuts);
                for columns in cuts.windows(2).map(|ends| (ends[0], ends[1])) {
                    match last_entered(pairs, &lines, columns.0) {
                        Some(last) => {
                            self.facet(row, scratch, view, (solid, &facets[last]), columns);
                        }
                        None => row.ask(columns.0..columns.1, self.pixels),
                    }
                }
                scratch.cuts = cuts;
            }
            Body::Unknown => row.ask(columns.0..columns.1, self.pixels),
        }
    }

    /// Columns that show a face.
    fn facet(
        &self,
        row: &mut Row<'_>,
        scratch: &mut Scratch,
        view: &Solids,
        (solid, facet): (&Solid, &Facet),
        columns: Columns,
    ) {
        let show = |row: &mut Row<'_>, columns, in_shadow: bool| {
            let paint = if in_shadow {
                &solid.paint
            } else {
                &facet.paint
            };
            let decision = view.decision(solid.index, Some(facet.face), in_shadow);
            row.fill(columns, decision, paint);
        };
        if facet.turned_away || facet.shadows.is_empty() {
            return show(row, columns, facet.turned_away);
        }
        scratch.shadows.clear();
        scratch.shadows.extend(
            facet
                .shadows
                .iter()
                .map(|shadow| shadow.cross(row.number, self.screen)),
        );
        cut(columns, scratch.shadows.iter(), &mut scratch.shadow_cuts);
        for ends in scratch.shadow_cuts.windows(2) {
            let columns = (ends[0], ends[1]);
            match any(&scratch.shadows, columns.0) {
                Some(in_shadow) => show(row, columns, in_shadow),
                None => row.ask(columns.0..columns.1, self.pixels),
            }
        }
    }

    /// Columns that show the surface.
    fn surface(&self, row: &mut Row<'_>, scratch: &mut Scratch, columns: Columns, floor: &Floor) {
        let mut crossed = std::mem::take(&mut scratch.mirrored);
        if crossed.cuts.is_empty() {
            let shadows = floor
                .shadows
                .iter()
                .map(|shadow| shadow.cross(row.number, self.screen));
            scratch.floor_shadows.clear();
            scratch.floor_shadows.extend(shadows);
            match &floor.mirrored {
                Some(mirrored) => mirrored.cross(row.number, self.screen, &mut crossed.spans),
                None => crossed.spans.clear(),
            }
            let spans = crossed.spans.iter().map(|(_, span)| span);
            let spans = spans.chain(&scratch.floor_shadows);
            cut((0, self.screen.size), spans, &mut crossed.cuts);
        }
        let cuts = std::mem::take(&mut crossed.cuts);
        let runs = cuts
            .windows(2)
            .map(|ends| (ends[0].max(columns.0), ends[1].min(columns.1)));
        for columns in runs.filter(|(from, to)| from < to) {
            match any(&scratch.floor_shadows, columns.0) {
                Some(true) => row.fill(columns, Decision::SurfaceInShadow, &floor.in_shadow),
                Some(false) if crossed.meet(columns.0) => match &floor.mirrored {
                    Some(mirrored) => {
                        self.reflection(row, scratch, columns, &crossed.met, (floor, mirrored));
                    }
                    None => row.fill(columns, Decision::Surface, &floor.paint),
                },
                _ => row.ask(columns.0..columns.1, self.pixels),
            }
        }
        crossed.cuts = cuts;
        scratch.mirrored = crossed;
    }

    /// Columns in which the surface mirrors the first of these solids.
    fn reflection(
        &self,
        row: &mut Row<'_>,
        scratch: &mut Scratch,
        columns: Columns,
        met: &[usize],
        (floor, mirrored): (&Floor, &Solids),
    ) {
        // A solid that goes through the surface may be met below it, where nothing is mirrored.
        let across = met
            .iter()
            .any(|&solid| mirrored.solids[solid].side != Side::Above);
        if across {
            return row.ask(columns.0..columns.1, self.pixels);
        }
        match self.front(mirrored, met, None, row.y, columns) {
            Front::Solid(solid) => self.solid(row, scratch, mirrored, solid, columns),
            Front::Rest => row.fill(columns, Decision::Surface, &floor.paint),
            Front::Unknown => match halves(columns) {
                Some(halves) => {
                    for half in halves {
                        self.reflection(row, scratch, half, met, (floor, mirrored));
                    }
                }
                None => row.ask(columns.0..columns.1, self.pixels),
            },
        }
    }
}

impl Floor {
    fn new(
        picture: &Picture<'_, Bounded>,
        floor: &pixel::Floor<Bounded>,
        color: &dyn Fn(Decision) -> [f32; 3],
        screen: Screen,
    ) -> Floor {
        let zero = Bounded::exact(0.0);
        let [one, third] = [1.0, 3.0].map(|x| Bounded::exact(1.0) / Bounded::exact(x));
        // An eye ray reaches the surface at t = Y/3 − (N/2) · height, and z = Z − 10 t there.
        let ten = Bounded::exact(10.0);
        let height = floor.height_in_pixels;
        let sheet = Sheet {
            origin: Vector::new(
                zero,
                floor.surface.height,
                Bounded::exact(screen.reach) + ten * height,
            ),
            per_column: Vector::new(one, zero, zero),
            per_row: Vector::new(zero, zero, -(ten * third)),
            plane: Some(floor.surface.support),
        };
        let sides = floor
            .surface
            .sides([sheet.origin, sheet.per_column, sheet.per_row]);
        let sides = sides
            .map(|[constant, column, row]| HalfPlane::new(constant, column, row, true, screen));
        let scene = picture.scene;
        let solids = scene.spheres().len() + scene.tetrahedra().len();
        let magnitude = height.value().abs() + screen.reach;
        // Rays that rise from the surface meet what is above it ahead. They may touch it at their very beginning, but there the solid is
        // seen, and not the surface.
        let rises = scene.light().direction.y < 0.0;
        let is_ahead = |caster: usize| rises && scene.facts().sides[caster] == Side::Above;
        Floor {
            outline: Shape::new(sides.into(), None, screen).within(floor.extent.rows(screen.size)),
            shadows: solids::shadows_on(&sheet, &picture.view, 0..solids as u16, is_ahead, screen),
            mirrored: floor
                .mirror
                .as_ref()
                .map(|mirror| Solids::new(picture, &mirror.view, true, color, screen)),
            depth: [
                -height.value(),
                third.value(),
                (height.error() + 8.0 * U * magnitude) * MORE,
            ],
            paint: Paint::new(color(Decision::Surface)),
            in_shadow: Paint::new(color(Decision::SurfaceInShadow)),
        }
    }

    /// The parameter at which the eye rays at Y reach it, from the least to the most that it can be.
    fn depth_at(&self, y: f64) -> (f64, f64) {
        let [constant, per_row, error] = self.depth;
        let depth = constant + per_row * y;
        (depth - error, depth + error)
    }
}

/// Cuts columns where any of the spans begins or ends, certainly or possibly.
fn cut<'s>(columns: Columns, spans: impl Iterator<Item = &'s Span>, cuts: &mut Vec<u32>) {
    cuts.clear();
    cuts.push(columns.0);
    for span in spans {
        span.cut(columns, cuts);
    }
    cuts.push(columns.1);
    cuts.sort_unstable();
    cuts.dedup();
}

/// Both halves of some columns, if there are more than two.
fn halves((from, to): Columns) -> Option<[Columns; 2]> {
    let middle = from + (to - from) / 2;
    (to - from > 2).then_some([(from, middle), (middle, to)])
}

/// Whether any of the spans holds a column.
fn any(spans: &[Span], column: u32) -> Option<bool> {
    let mut all_known = true;
    for span in spans {
        match span.holds(column) {
            Some(true) => return Some(true),
            Some(false) => {}
            None => all_known = false,
        }
    }
    all_known.then_some(false)
}

/// The facet that eye rays enter last: `lines` tells where the first of each pair is.
fn last_entered(pairs: &[Pair], lines: &[Span], column: u32) -> Option<usize> {
    let mut last = 0;
    for (pair, line) in pairs.iter().zip(lines) {
        if pair.facets.0 == last && !line.holds(column)? {
            last = pair.facets.1;
        }
    }
    Some(last)
}
