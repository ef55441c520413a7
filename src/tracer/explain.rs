//! One pixel, worked through: the text of `firsthit explain` and of the viewer's inspector.
//!
//! Every number comes from the functions that trace, in the arithmetic that settled the pixel. For
//! printing, numbers are turned back from view space and shortened to nine digits.

use std::fmt::{self, Write as _};

use super::decision::{Decision, Seen};
use super::line::{Hit, Line};
use super::pixel::{Picture, Pixel};
use super::vector::Vector;
use super::view::{SolidKinds, View};
use super::view_space::{EYE_SQUARED, from_middle, reflect, reflect_direction, turn_back};
use crate::image::display_byte;
use crate::number::Real;
use crate::scene::{Scene, Solid};
use crate::stage::Stage;

/// A number with nine significant digits.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let magnitude = self.0.abs();
        if magnitude == 0.0 || (1e-4..1e9).contains(&magnitude) {
            let digits = if magnitude == 0.0 {
                0
            } else {
                (8 - magnitude.log10().floor() as i32).max(0) as usize
            };
            let text = format!("{:.digits$}", self.0);
            let text = if text.contains('.') {
                text.trim_end_matches('0').trim_end_matches('.')
            } else {
                &text
            };
            f.write_str(if text == "-0" { "0" } else { text })
        } else {
            write!(f, "{:.8e}", self.0)
        }
    }
}

/// Three numbers with nine significant digits.
struct ShortTriple([f64; 3]);

impl fmt::Display for ShortTriple {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "({}, {}, {})",
            Short(self.0[0]),
            Short(self.0[1]),
            Short(self.0[2])
        )
    }
}

/// A line of the text: what it is about, and what there is to say.
pub(crate) fn say(text: &mut String, about: &str, what: impl fmt::Display) {
    let _ = writeln!(text, "{about:<12} {what}");
}

impl<R: Real> Picture<'_, R> {
    /// The pixel at `column` and `row`, worked through; `traced` is what it shows in the picture.
    pub(super) fn explain(
        &self,
        column: u32,
        row: u32,
        (decision, samples): Pixel,
    ) -> Result<String, R::Doubt> {
        let mut text = String::new();
        if self.stage == Stage::Image {
            let middle = Short(f64::from(self.size) / 2.0);
            let sides = format!("column {column} and row {row} against N/2 = {middle}");
            say(&mut text, "quadrant", format!("{sides}, as in Code 2-1"));
        } else {
            self.explain_ray(&mut text, column, row)?;
            self.explain_decision(&mut text, column, row, decision)?;
        }
        text.push_str(&samples_of(samples));
        Ok(text)
    }

    fn explain_ray(&self, text: &mut String, column: u32, row: u32) -> Result<(), R::Doubt> {
        let ray = self.transform.eye_ray(column, row);
        let half = f64::from(self.size) / 2.0;
        let [u, v] = [column, row].map(|number| Short(from_middle(number, half) / half));
        say(text, "u, v", format!("{u}, {v}"));
        let e = ShortTriple(self.point(ray.origin));
        say(text, "e", format!("{e}  the pixel's place on the screen"));
        let d = ShortTriple(self.unit(ray.direction.vector));
        say(text, "d", format!("{d}  the way the eye looks"));
        let kinds = SolidKinds::of(self.stage);
        let first = self.view.first_hit((column, row), &ray, None, kinds)?;
        for (solid, hit) in self.view.hits((column, row), &ray, false, kinds)? {
            let rank = if first.as_ref().is_some_and(|(nearest, _)| *nearest == solid) {
                ", first of the solids"
            } else {
                ""
            };
            let (name, t) = (self.name(solid, hit.face), self.parameter(&ray, &hit));
            say(text, "meets", format!("{name} at t = {t}{rank}"));
        }
        if let Some(surface) = &self.surface {
            let (depth, point) = self.transform.on_surface(&surface.square, &ray, row);
            let inside = if surface.square.contains(point)? {
                "in the square"
            } else {
                "beside the square"
            };
            let t = Short(self.in_scene(depth) * EYE_SQUARED.sqrt());
            let place = format!("{} {inside}", ShortTriple(self.point(point)));
            say(
                text,
                "meets",
                format!("the surface's plane at t = {t}, {place}"),
            );
        }
        Ok(())
    }

    fn explain_decision(
        &self,
        text: &mut String,
        column: u32,
        row: u32,
        decision: Decision,
    ) -> Result<(), R::Doubt> {
        let ray = self.transform.eye_ray(column, row);
        match (decision, &self.surface) {
            (Decision::Background, _) => say(text, "shows", "the background: nothing is hit"),
            (Decision::Solid(seen), _) => {
                say(text, "shows", self.name(usize::from(seen.solid), seen.face));
                self.explain_solid(text, &self.view, ((column, row), &ray), false, seen)?;
            }
            (_, Some(surface)) => {
                let (_, point) = self.transform.on_surface(&surface.square, &ray, row);
                say(text, "shows", "the surface, which no solid hides");
                let casters = self
                    .view
                    .casters(&self.view.ray_to_light(point, surface.square.support))?;
                self.explain_shadow(text, "the surface", &casters);
                let mirrored_ray = surface.square.mirrored_ray(point);
                if let (Decision::Mirrored(seen), Some(mirror)) = (decision, &surface.mirror) {
                    let r = ShortTriple(self.unit(reflect_direction(ray.direction.vector, true)));
                    say(text, "r", format!("{r}  the way the mirrored ray goes"));
                    let (pixel, kinds) = ((column, row), SolidKinds::All);
                    for (solid, hit) in mirror.view.hits(pixel, &mirrored_ray, true, kinds)? {
                        let (name, t) = (
                            self.name(solid, hit.face),
                            self.parameter(&mirrored_ray, &hit),
                        );
                        say(
                            text,
                            "mirrors",
                            format!("{name} at t = {t} from the surface"),
                        );
                    }
                    let name = self.name(usize::from(seen.solid), seen.face);
                    say(text, "shows", format!("{name}, mirrored"));
                    self.explain_solid(
                        text,
                        &mirror.view,
                        ((column, row), &mirrored_ray),
                        true,
                        seen,
                    )?;
                    say(text, "reflectance", Short(mirror.reflectance.to_f64()));
                } else if decision == Decision::Surface && surface.mirror.is_some() {
                    let nothing = "no solid: the surface shows its own colour";
                    say(text, "mirrors", nothing);
                }
            }
            (_, None) => {}
        }
        Ok(())
    }

    /// The point, the normal, the light, and equation 4-1 term by term. In the mirror's view
    /// everything is reflected, which is undone.
    fn explain_solid(
        &self,
        text: &mut String,
        view: &View<'_, R>,
        (pixel, ray): ((u32, u32), &Line<R>),
        mirrored: bool,
        seen: Seen,
    ) -> Result<(), R::Doubt> {
        let solid = usize::from(seen.solid);
        let only = view
            .hits(pixel, ray, mirrored, SolidKinds::All)?
            .into_iter()
            .find(|(index, _)| *index == solid);
        let Some((_, hit)) = only else { return Ok(()) };
        let unit = |vector: Vector<R>| ShortTriple(self.unit(reflect_direction(vector, mirrored)));
        let surface = self.surface.as_ref().filter(|_| mirrored);
        let point = reflect(hit.point, surface.map(|surface| surface.square.height));
        say(text, "point", ShortTriple(self.point(point)));
        say(text, "n", unit(hit.normal.vector));
        if self.stage < Stage::Shading {
            return Ok(());
        }
        let shading = &view.shading;
        let (l, v) = (unit(shading.to_light.vector), unit(-ray.direction.vector));
        say(text, "l", format!("{l}  toward the light"));
        say(text, "v", format!("{v}  toward where the ray came from"));
        match shading.halfway() {
            Some(halfway) => say(text, "h", unit(halfway)),
            None => say(text, "h", "none: v + l = 0, and there is no highlight"),
        }
        let terms = shading.terms(&hit.normal)?;
        say(text, "n·l", Short(terms.normal_light.to_f64()));
        if let Some(rest) = terms.one_minus_normal_halfway.map(|rest| rest.to_f64()) {
            let (cosine, rest) = (Short(1.0 - rest), Short(rest));
            say(text, "n·h", format!("{cosine}  (1 − n·h = {rest})"));
        }
        if self.stage >= Stage::Shadow {
            self.explain_solid_shadow(text, view, &hit)?;
        }
        let ambient = self.amounts(shading.ambient());
        say(text, "ambient", format!("{ambient}  k_a I_a"));
        if !seen.in_shadow {
            let [diffuse, specular] = [terms.diffuse, terms.specular].map(|v| self.amounts(v));
            say(text, "diffuse", format!("{diffuse}  k_d I max(0, n·l)"));
            let power = format!("k_s I max(0, n·h)^{}", self.scene.material().exponent);
            say(text, "specular", format!("{specular}  {power}"));
        }
        let c = self.amounts(self.solid_color(solid));
        say(text, "c", format!("{c}  the solid's colour, times the sum"));
        Ok(())
    }

    fn explain_solid_shadow(
        &self,
        text: &mut String,
        view: &View<'_, R>,
        hit: &Hit<R>,
    ) -> Result<(), R::Doubt> {
        if view.shading.facing_light(&hit.normal)?.is_le() {
            let why = "the point is turned away from the light: n·l ≤ 0";
            say(text, "in shadow", why);
            return Ok(());
        }
        let ray = view.ray_to_light(hit.point, hit.support);
        let casters = view.casters(&ray)?;
        if let Some(surface) = &self.surface
            && surface.square.is_ahead(&ray)?
        {
            say(text, "in shadow", "the surface is in the light's way");
        } else {
            self.explain_shadow(text, "the point", &casters);
        }
        Ok(())
    }

    fn explain_shadow(&self, text: &mut String, of: &str, casters: &[usize]) {
        if casters.is_empty() {
            let why = format!("nothing stands between {of} and the light");
            say(text, "in light", why);
        }
        for &solid in casters {
            let name = self.name(solid, None);
            say(text, "in shadow", format!("{name} is in the light's way"));
        }
    }

    fn name(&self, solid: usize, face: Option<u8>) -> String {
        name(self.scene, solid, face)
    }

    /// A length of view space in the scene's unit.
    fn in_scene(&self, length: R) -> f64 {
        length.to_f64() / self.transform.scale.to_f64()
    }

    /// t of a hit, for a direction of length 1.
    fn parameter(&self, ray: &Line<R>, hit: &Hit<R>) -> Short {
        Short(self.in_scene(hit.depth) * ray.direction.squared_length.to_f64().sqrt())
    }

    /// A point of view space in the scene.
    fn point(&self, point: Vector<R>) -> [f64; 3] {
        let [x, y, z] = [point.x, point.y, point.z].map(|coordinate| self.in_scene(coordinate));
        self.turned_back(x, y, z)
    }

    /// A direction of view space in the scene, of length 1.
    fn unit(&self, v: Vector<R>) -> [f64; 3] {
        let length = v.length().to_f64();
        self.turned_back(
            v.x.to_f64() / length,
            v.y.to_f64() / length,
            v.z.to_f64() / length,
        )
    }

    fn turned_back(&self, x: f64, y: f64, z: f64) -> [f64; 3] {
        let (sin, cos) = (self.transform.sin.to_f64(), self.transform.cos.to_f64());
        let [x, z] = turn_back(sin, cos, Vector::new(x, y, z));
        [x, y, z]
    }

    fn amounts(&self, v: Vector<R>) -> ShortTriple {
        ShortTriple([v.x.to_f64(), v.y.to_f64(), v.z.to_f64()])
    }
}

/// A solid as a person would call it, counted from 1 as in the document.
pub(crate) fn name(scene: &Scene, solid: usize, face: Option<u8>) -> String {
    match (Solid::index(solid, scene.spheres().len()), face) {
        (Solid::Sphere(index), _) => format!("sphere {}", index + 1),
        (Solid::Tetrahedron(index), Some(face)) => {
            format!("tetrahedron {}, face {face}", index + 1)
        }
        (Solid::Tetrahedron(index), None) => format!("tetrahedron {}", index + 1),
    }
}

/// The outcome alone, for a kernel whose steps are not those of the others.
pub(super) fn outcome(scene: &Scene, decision: Decision, samples: [f32; 3]) -> String {
    let named = |seen: Seen| {
        let shadow = if seen.in_shadow { ", in shadow" } else { "" };
        format!(
            "{}{shadow}",
            name(scene, usize::from(seen.solid), seen.face)
        )
    };
    let mut text = String::new();
    match decision {
        Decision::Quadrant(number) => say(
            &mut text,
            "quadrant",
            format!("{number}, in the order of Code 2-1"),
        ),
        Decision::Background => say(&mut text, "shows", "the background: nothing is hit"),
        Decision::Surface => say(&mut text, "shows", "the surface"),
        Decision::SurfaceInShadow => say(&mut text, "shows", "the surface, in shadow"),
        Decision::Solid(seen) => say(&mut text, "shows", named(seen)),
        Decision::Mirrored(seen) => say(&mut text, "shows", format!("{}, mirrored", named(seen))),
    }
    text + &samples_of(samples)
}

/// The samples with all their digits, and the bytes of the display.
fn samples_of(samples: [f32; 3]) -> String {
    let mut text = String::new();
    let [r, g, b] = samples;
    say(&mut text, "samples", format!("{r:?} {g:?} {b:?}"));
    let [r, g, b] = samples.map(display_byte);
    say(&mut text, "bytes", format!("{r} {g} {b}"));
    text
}
