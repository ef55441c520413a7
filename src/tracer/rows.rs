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
mod sweep;

use fearless_simd::Level;

use super::InDoubt;
use super::decision::Decision;
use super::ladder::Lines;
use super::pixel::{self, Picture, quadrant};
use super::vector::Vector;
use crate::number::{Bounded, Real};
use crate::scene::Side;
use crate::stage::Stage;
use lanes::{Paint, Shading};
pub(super) use row::Memory;
use row::{Columns, Row};
use shape::{HalfPlane, MORE, Screen, Shape, Sheet, U};
use solids::{Body, Facet, Pair, ShadedBall, Solid, Solids};
use sweep::{Border, Borders, Column, Sweep};

/// A frame, ready to be traced row by row.
pub(super) struct Rows<'a, P> {
    /// Asked for what is in doubt.
    pixels: &'a P,
    screen: Screen,
    level: Level,
    borders: Borders,
    direct: Solids,
    floor: Option<Floor>,
    background: Paint,
    /// The picture of code 2-1, where that is the stage.
    quadrants: Option<[Paint; 4]>,
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
    mirrored: Option<Solids>,
    /// The parameter of eye rays that reach it at Y = 0, how it changes with Y, and a bound on its error.
    depth: [f64; 3],
    paint: Paint,
    in_shadow: Paint,
}

/// What the tracing of a row needs, kept for the next.
#[derive(Default)]
pub(super) struct Scratch {
    sweep: Sweep,
    shading: Shading,
}

/// What is in front of all else in some columns.
enum Front {
    Solid(usize),
    /// The surface, or where that is not met either, the background.
    Rest,
    Unknown,
}

/// What some columns show.
#[derive(Clone, Copy)]
enum Show<'f> {
    Paint(&'f Paint),
    Ball(&'f ShadedBall),
    /// It is not known: each is to be asked for.
    Unknown,
}

impl Show<'_> {
    fn is(&self, other: &Show<'_>) -> bool {
        match (self, other) {
            (Show::Paint(a), Show::Paint(b)) => std::ptr::eq(*a, *b),
            (Show::Ball(a), Show::Ball(b)) => std::ptr::eq(*a, *b),
            (Show::Unknown, Show::Unknown) => true,
            _ => false,
        }
    }
}

/// Columns that show the same, as far as the sweep has come.
struct Stretch<'f> {
    columns: Columns,
    shows: Show<'f>,
}

/// A row on its way: what is written, and what is about to be.
struct Progress<'r, 'f, 's> {
    row: Row<'r>,
    stretch: Option<Stretch<'f>>,
    shading: &'s mut Shading,
}

impl<'a, P: Lines> Rows<'a, P> {
    /// The frame that `pixels` are of.
    pub(super) fn new(pixels: &'a P, precision: Precision, level: Level) -> Self {
        let picture = pixels.bounded();
        let screen = Screen::new(picture.size);
        let color = |decision| pixels.color(decision);
        let paint = |decision| Paint::new(decision, pixels.color(decision));
        let mut borders = Borders::default();
        let is_quadrants = picture.stage == Stage::Image;
        let floor = picture
            .floor
            .as_ref()
            .map(|floor| Floor::new(picture, floor, &color, screen, &mut borders));
        Rows {
            pixels,
            screen,
            level,
            direct: Solids::new(picture, &picture.view, false, &color, screen, &mut borders),
            floor,
            borders,
            background: paint(Decision::Background),
            quadrants: is_quadrants
                .then(|| [0, 1, 2, 3].map(|number| paint(Decision::Quadrant(number)))),
            precision,
        }
    }

    /// What tracing rows of this frame needs.
    pub(super) fn begin(&self, scratch: &mut Scratch) {
        scratch.sweep.begin(&self.borders);
    }

    /// Traces a row into its samples, and its decisions where they are asked for. How many pixels double-doubles and arbitrary
    /// precision had to settle. `scratch` is prepared for the frame. With a `memory` of the row, which holds for `samples`, only what differs is written.
    pub(super) fn trace(
        &self,
        number: u32,
        samples: &mut [f32],
        decisions: Option<&mut [Decision]>,
        memory: Option<&mut Memory>,
        scratch: &mut Scratch,
    ) -> InDoubt {
        let screen = self.screen;
        let mut progress = Progress {
            row: Row {
                level: self.level,
                number,
                y: screen.place(number),
                samples,
                decisions,
                memory,
                in_doubt: InDoubt::default(),
            },
            stretch: None,
            shading: &mut scratch.shading,
        };
        if let Some(quadrants) = &self.quadrants {
            // Code 2-1 knows two kinds of column.
            let middle = (screen.size / 2 + 1).min(screen.size);
            for columns in [(0, middle), (middle, screen.size)] {
                if columns.0 < columns.1 {
                    let paint = &quadrants[usize::from(quadrant(columns.0, number, screen.size))];
                    progress.row.fill(columns, paint);
                }
            }
            return progress.row.finish();
        }
        let sweep = &mut scratch.sweep;
        sweep.enter(number, &self.borders, self.level, screen);
        let mut from = 0;
        for crossing in 0..sweep.len() {
            let to = sweep.place(crossing);
            if to > from {
                self.column(&mut progress, &sweep.column, (from, to));
                from = to;
            }
            sweep.pass(crossing, &self.borders);
        }
        if from < screen.size {
            self.column(&mut progress, &sweep.column, (from, screen.size));
        }
        self.write(&mut progress);
        progress.row.finish()
    }

    /// Columns between two crossings, of which `column` is one.
    fn column<'f>(
        &'f self,
        progress: &mut Progress<'_, 'f, '_>,
        column: &Column,
        columns: Columns,
    ) {
        let Some(met) = column.direct.known() else {
            return self.show(progress, columns, Show::Unknown);
        };
        // What is above the surface hides it.
        let hidden = |&solid: &usize| self.direct.solids[solid].side == Side::Above;
        let on_floor = if met.iter().any(hidden) {
            Some(false)
        } else {
            column.surface()
        };
        match on_floor {
            Some(on_floor) => {
                let floor = self.floor.as_ref().filter(|_| on_floor);
                self.first(progress, column, columns, met, floor);
            }
            None => self.show(progress, columns, Show::Unknown),
        }
    }

    /// Columns that all meet the same solids, and the surface where it is given.
    fn first<'f>(
        &'f self,
        progress: &mut Progress<'_, 'f, '_>,
        column: &Column,
        columns: Columns,
        met: &[usize],
        floor: Option<&'f Floor>,
    ) {
        let y = progress.row.y;
        let surface = floor.map(|floor| floor.depth_at(y));
        match self.front(&self.direct, met, surface, y, columns) {
            Front::Solid(solid) => {
                self.show(
                    progress,
                    columns,
                    solid_in(&self.direct.solids[solid], column),
                );
            }
            Front::Rest => match floor {
                Some(floor) => self.surface(progress, column, columns, floor),
                None => self.show(progress, columns, Show::Paint(&self.background)),
            },
            Front::Unknown => match halves(columns) {
                Some(halves) => {
                    for half in halves {
                        self.first(progress, column, half, met, floor);
                    }
                }
                None => self.show(progress, columns, Show::Unknown),
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

    /// Columns that show the surface.
    fn surface<'f>(
        &'f self,
        progress: &mut Progress<'_, 'f, '_>,
        column: &Column,
        columns: Columns,
        floor: &'f Floor,
    ) {
        let shows = match (column.surface_in_shadow(), &floor.mirrored) {
            (Some(true), _) => Show::Paint(&floor.in_shadow),
            (None, _) => Show::Unknown,
            (Some(false), None) => Show::Paint(&floor.paint),
            (Some(false), Some(mirrored)) => match column.mirrored.known() {
                Some(met) => {
                    return self.reflection(progress, column, columns, met, (floor, mirrored));
                }
                None => Show::Unknown,
            },
        };
        self.show(progress, columns, shows);
    }

    /// Columns in which the surface mirrors the first of these solids.
    fn reflection<'f>(
        &'f self,
        progress: &mut Progress<'_, 'f, '_>,
        column: &Column,
        columns: Columns,
        met: &[usize],
        (floor, mirrored): (&'f Floor, &'f Solids),
    ) {
        // A solid that goes through the surface may be met below it, where nothing is mirrored.
        let across = met
            .iter()
            .any(|&solid| mirrored.solids[solid].side != Side::Above);
        if across {
            return self.show(progress, columns, Show::Unknown);
        }
        let shows = match self.front(mirrored, met, None, progress.row.y, columns) {
            Front::Solid(solid) => solid_in(&mirrored.solids[solid], column),
            Front::Rest => Show::Paint(&floor.paint),
            Front::Unknown => match halves(columns) {
                Some(halves) => {
                    for half in halves {
                        self.reflection(progress, column, half, met, (floor, mirrored));
                    }
                    return;
                }
                None => Show::Unknown,
            },
        };
        self.show(progress, columns, shows);
    }

    /// The next columns of a row. They are written when it is known where what they show ends.
    fn show<'f>(&'f self, progress: &mut Progress<'_, 'f, '_>, columns: Columns, shows: Show<'f>) {
        match &mut progress.stretch {
            Some(stretch) if stretch.shows.is(&shows) => stretch.columns.1 = columns.1,
            _ => {
                self.write(progress);
                progress.stretch = Some(Stretch { columns, shows });
            }
        }
    }

    /// Writes what is about to be written.
    fn write(&self, progress: &mut Progress<'_, '_, '_>) {
        let Some(Stretch { columns, shows }) = progress.stretch.take() else {
            return;
        };
        let row = &mut progress.row;
        match shows {
            Show::Paint(paint) => row.fill(columns, paint),
            Show::Ball(ball) => {
                row.shade(columns, ball, self.precision, self.screen, progress.shading);
                row.ask(progress.shading.doubts.drain(..), self.pixels);
            }
            Show::Unknown => row.ask(columns.0..columns.1, self.pixels),
        }
    }
}

/// What columns show where they see a solid; `column` is one of them.
fn solid_in<'f>(solid: &'f Solid, column: &Column) -> Show<'f> {
    match &solid.body {
        Body::Flat(paint) => Show::Paint(paint),
        Body::Ball(ball) => Show::Ball(ball),
        Body::Facets(facets, pairs) => match last_entered(pairs, column) {
            Some(last) => facet_in(&facets[last], column),
            None => Show::Unknown,
        },
        Body::Unknown => Show::Unknown,
    }
}

/// What they show where they see a face.
fn facet_in<'f>(facet: &'f Facet, column: &Column) -> Show<'f> {
    if facet.turned_away {
        return Show::Paint(&facet.in_shadow);
    }
    let mut all_known = true;
    for shadow in facet.shadows.clone() {
        match column.holds(shadow) {
            Some(true) => return Show::Paint(&facet.in_shadow),
            Some(false) => {}
            None => all_known = false,
        }
    }
    if all_known {
        Show::Paint(&facet.lit)
    } else {
        Show::Unknown
    }
}

/// The facet that eye rays enter last.
fn last_entered(pairs: &[Pair], column: &Column) -> Option<usize> {
    let mut last = 0;
    for pair in pairs {
        if pair.facets.0 == last && !column.holds(pair.first)? {
            last = pair.facets.1;
        }
    }
    Some(last)
}

impl Floor {
    fn new(
        picture: &Picture<'_, Bounded>,
        floor: &pixel::Floor<Bounded>,
        color: &dyn Fn(Decision) -> [f32; 3],
        screen: Screen,
        borders: &mut Borders,
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
        let paint = |decision| Paint::new(decision, color(decision));
        let rows = floor.extent.rows(screen.size);
        let outline = Shape::new(sides.into(), None, screen);
        borders.add(outline.within(rows), Border::Surface);
        let casters = 0..solids as u16;
        for shadow in solids::shadows_on(&sheet, &picture.view, casters, is_ahead, screen) {
            borders.add(shadow.within(rows), Border::ShadowOnSurface);
        }
        Floor {
            mirrored: floor
                .mirror
                .as_ref()
                .map(|mirror| Solids::new(picture, &mirror.view, true, color, screen, borders)),
            depth: [
                -height.value(),
                third.value(),
                (height.error() + 8.0 * U * magnitude) * MORE,
            ],
            paint: paint(Decision::Surface),
            in_shadow: paint(Decision::SurfaceInShadow),
        }
    }

    /// The parameter at which the eye rays at Y reach it, from the least to the most that it can be.
    fn depth_at(&self, y: f64) -> (f64, f64) {
        let [constant, per_row, error] = self.depth;
        let depth = constant + per_row * y;
        (depth - error, depth + error)
    }
}

/// Both halves of some columns, if there are more than two.
fn halves((from, to): Columns) -> Option<[Columns; 2]> {
    let middle = from + (to - from) / 2;
    (to - from > 2).then_some([(from, middle), (middle, to)])
}
