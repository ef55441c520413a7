//! The bounds of the shader of spheres, compared with double-doubles: no error is larger than its
//! bound, and no bound is out of proportion to the errors.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use std::cell::OnceCell;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch};

use crate::number::{Bounded, DoubleDouble, Real};
use crate::scene::Scene;
use crate::stage::Stage;
use crate::tracer::arena::Arena;
use crate::tracer::ladder::{Ladder, RowPixels, Rung};
use crate::tracer::pixel::Picture;
use crate::tracer::scanline::edges::ellipses::SphereOutlines;
use crate::tracer::scanline::grid::{Columns, Grid, ROWS};
use crate::tracer::scanline::shade::caster::ShadowCylinder;
use crate::tracer::scanline::shade::columns::{SphereBand, SphereColumns};
use crate::tracer::scanline::shade::equation::{Hits, RowShader};
use crate::tracer::scanline::shade::light::Lighting;
use crate::tracer::scanline::shade::policy::Certified;
use crate::tracer::scanline::shade::sphere::{HitBounds, LinearForm, SphereConstants, ZONES};
use crate::tracer::sphere::Sphere;
use crate::tracer::vector::Vector;
use crate::tracer::view::View;

const SIZE: u32 = 400;

/// The largest error of one kind, over its bound.
#[derive(Default)]
struct Largest {
    part: f64,
    count: usize,
}

impl Largest {
    /// Notes a number that f64 `computed` with this bound.
    fn note(&mut self, truth: DoubleDouble, computed: f64, bound: f64) {
        let error = apart(truth, computed).abs();
        assert!(error <= bound, "{error:e} is more than {bound:e}");
        self.count += 1;
        if bound > 0.0 && bound.is_finite() {
            self.part = self.part.max(error / bound);
        }
    }

    /// Notes a number that f64 encloses.
    fn note_between(&mut self, truth: DoubleDouble, lower: f64, upper: f64) {
        assert!(
            apart(truth, lower) >= 0.0 && apart(truth, upper) <= 0.0,
            "{:e} is not within {lower:e} to {upper:e}",
            truth.to_f64()
        );
        self.count += 1;
        let half = (upper - lower) / 2.0;
        if half > 0.0 && half.is_finite() {
            self.part = self.part.max(apart(truth, lower + half).abs() / half);
        }
    }

    /// Expects errors of a thousandth of the bound: a bound is that of the worst pixel in a zone,
    /// and adds up errors that rarely come together.
    fn expect(&self, what: &str) {
        assert!(self.count > 1000, "{what}: only {} tried", self.count);
        assert!(
            self.part > 1e-3,
            "{what}: no error is more than {:e} of its bound",
            self.part
        );
    }
}

fn apart(truth: DoubleDouble, computed: f64) -> f64 {
    (truth - DoubleDouble::exact(computed)).to_f64()
}

#[derive(Default)]
struct Found {
    light: Largest,
    /// Channels without a visible highlight.
    dull: Largest,
    /// Channels with one.
    highlight: Largest,
    /// The forms of shadows.
    forms: Largest,
    /// How far hits are inside of shadow cylinders.
    cylinders: Largest,
    cache: ColumnCounts,
}

/// Counts of pixels.
#[derive(Default)]
struct ColumnCounts {
    /// Pixels in the zones.
    all: usize,
    /// Pixels that the row certifies.
    shadeable: usize,
    /// Shadeable pixels of which the row tells whether they face the light.
    settled: usize,
    /// Shadeable pixels that may have a highlight.
    bright: usize,
    /// Shadeable pixels that have one.
    highlight: usize,
}

impl ColumnCounts {
    /// Checks the columns of a row at a pixel with this n·l and n·h. There is no highlight to see
    /// below an n·h of `least`.
    fn note(
        &mut self,
        columns: &SphereColumns,
        column: u32,
        light: f64,
        halfway: Option<f64>,
        least: f64,
    ) {
        let is_in = |columns: Columns| columns.0 <= column && column < columns.1;
        self.all += 1;
        if !is_in(columns.shadeable) {
            return;
        }
        self.shadeable += 1;
        if let Some((inside, inside_faces)) = columns.facing {
            self.settled += 1;
            // A double-double does not tell smaller ones from 0.
            if light.abs() > 1e-25 {
                let faces = is_in(inside) == inside_faces;
                assert_eq!(faces, light > 0.0, "column {column}: n·l = {light:e}");
            }
        }
        self.bright += usize::from(is_in(columns.bright));
        if halfway.is_some_and(|halfway| halfway > least) {
            self.highlight += 1;
            assert!(is_in(columns.bright), "column {column}: n·h = {halfway:?}");
        }
    }

    /// Expects that nearly all pixels are shadeable and settled.
    fn expect(&self) {
        assert!(self.highlight > 1000 && self.settled > 1000);
        let missed = [self.all - self.shadeable, self.shadeable - self.settled];
        assert!(
            missed.iter().all(|&missed| missed < self.all / 50),
            "{missed:?}"
        );
        assert!(
            self.bright < 2 * self.highlight,
            "{} of {}",
            self.bright,
            self.highlight
        );
    }
}

/// What double-doubles give for a pixel of a sphere.
struct Truth {
    normal_light: DoubleDouble,
    /// n·h, where there is an h.
    normal_halfway: Option<f64>,
    /// The values of the forms of the shadow.
    forms: [DoubleDouble; 4],
    /// How far the hit is inside of the shadow cylinder.
    in_cylinder: DoubleDouble,
    /// The colour, and the highlight's part of it.
    channels: [DoubleDouble; 3],
    highlight: [f64; 3],
}

/// A sphere as rows shade it, and in double-doubles.
struct Case<'c> {
    picture: &'c Picture<'c, DoubleDouble>,
    view: &'c View<'c, DoubleDouble>,
    sphere: &'c Sphere<DoubleDouble>,
    color: Vector<DoubleDouble>,
    constants: SphereConstants<'c>,
    grid: Grid,
    /// Another sphere's centre.
    other: Vector<DoubleDouble>,
    /// Its radius.
    other_radius: DoubleDouble,
    /// Its shadow.
    cylinder: ShadowCylinder,
    /// The forms of the shadow: the moment, and whether the other sphere is before a pixel.
    forms: [LinearForm; 4],
}

impl Case<'_> {
    /// Checks what pixels with these hits find out about their zones.
    #[inline(always)]
    fn check_classes<S: Simd>(&self, in_row: &RowShader<'_, S, Certified>, hits: &Hits<S::f64s>) {
        let (s, least) = (hits.s.as_slice(), self.constants.min_squares);
        let is_near = |s: &f64| {
            least
                .iter()
                .any(|least| (s * s - least).abs() < 1e-6 * least)
        };
        if !s.iter().any(is_near) {
            let classes = in_row.classify(hits, (1 << s.len()) - 1);
            let zones = s
                .iter()
                .map(|s| least.iter().take_while(|least| s * s < **least).count());
            for (lane, zone) in zones.clone().enumerate() {
                assert_eq!(classes.beyond >> lane & 1 == 1, zone == ZONES, "{s:?}");
            }
            assert_eq!(
                Some(classes.zone),
                zones.map(|zone| zone.min(ZONES - 1)).max(),
                "{s:?}"
            );
        }
    }

    /// What double-doubles give for a pixel that hits the sphere.
    fn truth(&self, column: u32, row: u32) -> Truth {
        let line = self.picture.transform.eye_ray(column, row);
        let hit = self.sphere.first_hit(&line).unwrap().unwrap();
        let shading = &self.view.shading;
        let terms = shading.terms(&hit.normal).unwrap();
        let (from, l) = (hit.point - self.other, shading.to_light.vector);
        let moment = from.cross(l);
        let squared_radius = shading.to_light.squared_length * self.other_radius.squared();
        let light = shading.ambient() + terms.diffuse + terms.specular;
        let (color, specular) = (self.color.times(light), self.color.times(terms.specular));
        Truth {
            normal_light: terms.normal_light,
            normal_halfway: terms.one_minus_normal_halfway.map(|x| 1.0 - x.to_f64()),
            forms: [moment.x, moment.y, moment.z, -from.dot(l)],
            in_cylinder: squared_radius - moment.squared_length(),
            channels: [color.x, color.y, color.z],
            highlight: [specular.x, specular.y, specular.z].map(Real::to_f64),
        }
    }

    /// Checks a row. `truths` keeps what double-doubles give for its pixels, since several vector
    /// levels are checked.
    #[inline(always)]
    fn check<S: Simd>(&self, simd: S, row: u32, truths: &[OnceCell<Truth>], found: &mut Found) {
        let constants = &self.constants;
        let y = self.grid.coordinate(row);
        let m = constants.m.at(y);
        let in_row = RowShader::<S, Certified>::new(simd, constants, y);
        let (below, within) = (row - row % ROWS as u32, row as usize % ROWS);
        let mut cache = SphereBand::default();
        cache.find(simd, constants, below, self.grid);
        let columns = cache.row(within);
        for first in (0..SIZE).step_by(S::f64s::LEN) {
            let x = self.grid.coordinate(first);
            let hits = in_row.hits(x);
            let facing = in_row.value(&constants.n_dot_l, &hits);
            let zones = [0, 1, 2].map(|zone| {
                let mut samples = in_row.lit(facing, zone);
                in_row.add_highlight(&mut samples, &hits, (zone, u64::MAX));
                samples
            });
            let forms = self.forms.map(|form| in_row.value(&form, &hits));
            self.check_classes(&in_row, &hits);
            for lane in 0..S::f64s::LEN {
                let q = hits.q.as_slice()[lane];
                let squared = constants.squared_radius - m * m - q * q;
                if squared < constants.min_squares[2] {
                    continue;
                }
                let min_squares = constants.min_squares.iter();
                let zone = min_squares.take_while(|least| squared < **least).count();
                let samples = zones[zone];
                let column = first + lane as u32;
                let truth = truths[column as usize].get_or_init(|| self.truth(column, row));
                let computed = facing.as_slice()[lane];
                found
                    .light
                    .note(truth.normal_light, computed, constants.n_dot_l.error);

                let facing = truth.normal_light.to_f64();
                found.cache.note(
                    &columns,
                    column,
                    facing,
                    truth.normal_halfway,
                    constants.lighting.highlight.threshold,
                );

                for (i, form) in truth.forms.into_iter().enumerate() {
                    let computed = forms[i].as_slice()[lane];
                    found.forms.note(form, computed, self.forms[i].error);
                }
                let [x, y, z] = [0, 1, 2].map(|i| forms[i].as_slice()[lane]);
                let cylinder = &self.cylinder;
                found.cylinders.note(
                    truth.in_cylinder,
                    cylinder.squared_radius - (x * x + y * y + z * z),
                    cylinder.error,
                );

                for (i, channel) in truth.channels.into_iter().enumerate() {
                    let channels = if truth.highlight[i] > 1e-3 {
                        &mut found.highlight
                    } else {
                        &mut found.dull
                    };
                    let computed = samples.channels[i].as_slice()[lane];
                    let error = samples.error.as_slice()[lane];
                    channels.note_between(channel, computed - error, computed + error);
                }
            }
        }
    }
}

/// A picture, one of its views, and the factor of colours in that view: the reflectance, or 1.
type ViewCase<'s, R> = (&'s Picture<'s, R>, &'s View<'s, R>, R);

/// Checks the spheres of a view: `bounded` is in f64 with bounds, `truth` in double-doubles.
fn check_view(
    bounded: ViewCase<'_, Bounded>,
    truth: ViewCase<'_, DoubleDouble>,
    found: &mut Found,
) {
    let grid = Grid::new(SIZE);
    let (view, true_view) = (bounded.1, truth.1);
    let outlines = SphereOutlines::new(grid);
    for (index, sphere) in view.spheres.iter().enumerate() {
        let outline = outlines.of(sphere.center, sphere.radius);
        let color = bounded.0.solid_color(index) * bounded.2;
        let lighting = Lighting::new(&view.shading);
        let bounds = HitBounds::new(sphere, &outline);
        let constants = SphereConstants::new(sphere, &outline, &bounds, &lighting, color, true);
        let other = (index + 1) % view.spheres.len();
        let cylinder = ShadowCylinder::new(&bounds, &view.spheres[other], &lighting);
        let case = Case {
            picture: truth.0,
            view: true_view,
            sphere: &true_view.spheres[index],
            color: truth.0.solid_color(index) * truth.2,
            forms: cylinder.forms(&lighting),
            cylinder,
            other_radius: true_view.spheres[other].radius,
            constants,
            grid,
            other: true_view.spheres[other].center,
        };
        for row in (0..SIZE).step_by(7) {
            let truths: Vec<_> = (0..SIZE).map(|_| OnceCell::new()).collect();
            // With fused multiply-add, if the processor has it, and without.
            for level in [Level::new(), Level::baseline()] {
                dispatch!(level, simd => case.check(simd, row, &truths, found));
            }
        }
    }
}

fn check_frame(scene: &Scene, alpha: f64, found: &mut Found) {
    let arena = Arena::default();
    let ladder = Ladder::new(scene, Stage::Animation, alpha, SIZE, Rung::Hardware, &arena);
    let truth = ladder.picture::<DoubleDouble>(&&arena.setup);
    let (bounded, truth) = (ladder.bounded(), &truth);
    let one = (Bounded::exact(1.0), DoubleDouble::exact(1.0));
    check_view(
        (bounded, &bounded.view, one.0),
        (truth, &truth.view, one.1),
        found,
    );
    let surfaces = bounded.surface.as_ref().zip(truth.surface.as_ref());
    if let Some((Some(a), Some(b))) = surfaces.map(|(a, b)| (&a.mirror, &b.mirror)) {
        check_view(
            (bounded, &a.view, a.reflectance),
            (truth, &b.view, b.reflectance),
            found,
        );
    }
}

#[test]
fn every_error_is_within_its_bound() {
    let mut found = Found::default();
    for text in [
        "",
        include_str!("../../../../tests/scenes/highlights.toml"),
        include_str!("../../../../tests/scenes/exponent_million.toml"),
        include_str!("../../../../tests/scenes/far_spheres.toml"),
        include_str!("../../../../tests/scenes/wide_light.toml"),
    ] {
        let scene = match text {
            "" => Scene::builtin(),
            text => Scene::from_toml(text).unwrap(),
        };
        for alpha in [0.0, 0.7, 2.5, -1e9] {
            check_frame(&scene, alpha, &mut found);
        }
    }
    found.light.expect("n·l");
    found.forms.expect("other linear forms");
    found.cylinders.expect("shadow cylinders");
    found.dull.expect("channels");
    found.highlight.expect("channels with a highlight");
    found.cache.expect();
}
