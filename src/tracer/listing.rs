//! The document's listings, Code 2-1 to 6-1, as they are printed: the baseline.
//!
//! In f64, pixel by pixel, in the document's order and under the document's names, so that it can
//! be laid beside this file. Where a listing and the equation that it implements disagree, the
//! listing is kept: each such place is marked `Slip`, with what the equation says. Every other
//! kernel follows the equations.
//!
//! What the document leaves out is filled in with the least:
//! - `....//parameters initializing`: a local variable starts at zero. A flag starts so that the
//!   printed lines, which only ever change it one way, have something to change; it is started
//!   again as seldom as they can bear. `IntSphere` must be true again before every sphere, or
//!   nothing would be hit after the first miss. `IntTriangle` must be false again before every
//!   tetrahedron, or everything would be hit after the first hit, but no printed line and no need
//!   makes it false between two faces. A flag that starts again with every call is an `Option`
//!   here.
//! - Of the solids and the surface the one nearest to the pixel is seen, as among the faces in Code
//!   3-2; of several at the same distance the first, the surface last.
//! - The document's numbers are read from the scene: 250 is half of the picture's size, `pow`'s
//!   1000 the exponent, the factor 0.5 of a mirrored colour the reflectance.
//!
//! Two slips of the document are not here. Section III prints LookAt = (0, 0.3, 0), whose rays
//! never leave the plane of the screen: (0, 0.3, 1) is Code 6-1 at α = 0. And that α gathers a
//! rounding error with every `alpha+0.3`, and jumps where it starts again at 0 instead of at 2π, is
//! up to whoever advances it.

mod color;
mod inter_point;
mod unit;

use glam::{DVec3, dvec3};

use super::decision::{Decision, Seen};
use super::ladder::{Pixels, Rung};
use super::pixel::{Pixel, QUADRANTS, quadrant};
use super::{TraceError, explain};
use crate::camera;
use crate::scene::{FACES, Scene, Sphere, Surface};
use crate::stage::Stage;
use color::get_pixel_color;
use inter_point::{
    Triangle, get_inter_point_sphere, get_inter_point_surface, get_inter_point_tetrahedron,
};
use unit::get_unit;

/// A scene of the document's shape, seen in one frame.
pub(super) struct Listing<'a> {
    scene: &'a Scene,
    stage: Stage,
    size: u32,
    sin_alpha: f64,
    cos_alpha: f64,
    look_at: DVec3,
    lig_dir: DVec3,
    spheres: [Sphere; 2],
    /// The document's T.t1 to T.t4: triangle k + 1 is face k, the one opposite vertex k.
    t: [Triangle; 4],
    t_color: DVec3,
    sur: Surface,
}

/// A solid where a line meets it.
struct ListingHit {
    seen: Seen,
    point: DVec3,
    normal: DVec3,
    color: DVec3,
}

impl<'a> Listing<'a> {
    /// # Errors
    /// [`TraceError::Listing`] unless the scene is two spheres, one tetrahedron and a surface.
    pub(super) fn new(
        scene: &'a Scene,
        stage: Stage,
        alpha: f64,
        size: u32,
    ) -> Result<Self, TraceError> {
        let (&[sphere1, sphere2], [t], Some(&sur)) =
            (scene.spheres(), scene.tetrahedra(), scene.surface())
        else {
            return Err(TraceError::Listing {
                spheres: scene.spheres().len(),
                tetrahedra: scene.tetrahedra().len(),
                surfaces: usize::from(scene.surface().is_some()),
            });
        };
        // Code 6-1, to which static stages belong with α = 0.
        let (sin_alpha, cos_alpha) = camera::sin_cos(alpha);
        Ok(Listing {
            scene,
            stage,
            size,
            sin_alpha,
            cos_alpha,
            look_at: get_unit(dvec3(sin_alpha, 0.3, cos_alpha)),
            lig_dir: get_unit(scene.light().direction),
            spheres: [sphere1, sphere2],
            t: FACES.map(|[a, b, c]| {
                // Counter-clockwise from outside, as Equation 3-3 needs it.
                let right_handed = scene.facts().right_handed.first() == Some(&true);
                let (b, c) = if right_handed { (b, c) } else { (c, b) };
                Triangle::new(t.vertices[a], t.vertices[b], t.vertices[c])
            }),
            t_color: t.color,
            sur,
        })
    }

    /// Code 6-1: the pixel's place on the screen.
    ///
    /// Slip (Code 6-1): `d=10` stands here and is never used.
    fn place(&self, column: u32, row: u32) -> DVec3 {
        let half = f64::from(self.size) / 2.0;
        let (x_d, y_d) = (f64::from(column), f64::from(row));
        dvec3(
            (x_d - half) / half * self.cos_alpha + self.sin_alpha,
            (y_d - half) / half,
            self.cos_alpha - (x_d - half) / half * self.sin_alpha,
        )
    }

    /// Sphere `i` along a line, i = 0 or 1.
    fn meet_sphere(&self, i: usize, from: DVec3, dir: DVec3) -> Option<ListingHit> {
        let sphere = &self.spheres[i];
        let point = get_inter_point_sphere(from, dir, sphere)?;
        Some(ListingHit {
            seen: Seen {
                solid: i as u16,
                face: None,
                in_shadow: false,
            },
            point,
            normal: get_normal_sphere(point, sphere),
            color: sphere.color,
        })
    }

    /// The tetrahedron along a line.
    fn meet_tetrahedron(&self, from: DVec3, dir: DVec3) -> Option<ListingHit> {
        let (point, face) = get_inter_point_tetrahedron(from, dir, &self.t)?;
        Some(ListingHit {
            seen: Seen {
                solid: 2,
                face: Some(face as u8),
                in_shadow: false,
            },
            point,
            // Section III credits this, which only looks a normal up, with the intersection, which
            // is GetInterPoint_Triangle.
            normal: self.t[face].normal,
            color: self.t_color,
        })
    }

    /// Equation 4-1 times the solid's colour.
    ///
    /// Slip (Code 5-1): LigDir is the way the light travels, and shadows are traced against it, but
    /// Equation 4-1 is handed it as l, which points toward the light. So solids are lit from below,
    /// and their shadows are thrown from above.
    ///
    /// Slip (Code 5-1): v points back along the ray that found the point, for a mirrored one toward
    /// the surface. Here it is LookAt for those too, so a mirror image has its highlights where the
    /// solid itself has them.
    ///
    /// Slip (Code 5-1): section V.1 lets a shadow fall on any point, but nothing asks for one here:
    /// only the surface receives shadows.
    fn shaded(&self, hit: &ListingHit) -> DVec3 {
        get_pixel_color(self.lig_dir, self.look_at, hit.normal, self.scene) * hit.color
    }

    /// The nearest solid, coloured by `color`, or the background.
    fn seen(
        &self,
        nearest: Option<ListingHit>,
        color: impl Fn(&ListingHit) -> DVec3,
    ) -> (Decision, DVec3) {
        match nearest {
            Some(hit) => (Decision::Solid(hit.seen), color(&hit)),
            None => (Decision::Background, self.scene.background()),
        }
    }

    fn nearest_sphere(&self, pixel: DVec3) -> Option<ListingHit> {
        let [sphere1, sphere2] = [0, 1].map(|i| self.meet_sphere(i, pixel, self.look_at));
        nearer(pixel, sphere1, sphere2)
    }

    fn nearest_solid(&self, pixel: DVec3) -> Option<ListingHit> {
        let tetrahedron = self.meet_tetrahedron(pixel, self.look_at);
        nearer(pixel, self.nearest_sphere(pixel), tetrahedron)
    }

    /// Stages 5 to 7: the nearest solid, or else Code 5-1.
    fn glazed_surface(&self, pixel: DVec3) -> (Decision, DVec3) {
        let interpoint0 = get_inter_point_surface(pixel, self.look_at, &self.sur);
        let nearest = self.nearest_solid(pixel);
        match (nearest, interpoint0) {
            (Some(hit), Some(point)) if pixel.distance(point) < pixel.distance(hit.point) => {
                self.surface_at(point)
            }
            (None, Some(point)) => self.surface_at(point),
            (nearest, _) => self.seen(nearest, |hit| self.shaded(hit)),
        }
    }

    /// Code 5-1, from the surface's own colour on: each later object overwrites what an earlier one
    /// has drawn.
    fn surface_at(&self, interpoint0: DVec3) -> (Decision, DVec3) {
        let mut drawn = (Decision::Surface, self.sur.color);
        if self.stage >= Stage::Reflection {
            // LookAt points toward the eye, so this is the way that the eye's ray goes on from the
            // surface.
            let pro_dir = -get_projection(self.look_at, DVec3::Y);
            // Slip (Code 5-1): the first solid along the ray is mirrored; here it is the last in
            // this order that the line meets at all.
            for mirrored in [
                self.meet_sphere(0, interpoint0, pro_dir),
                self.meet_sphere(1, interpoint0, pro_dir),
                self.meet_tetrahedron(interpoint0, pro_dir),
            ]
            .into_iter()
            .flatten()
            {
                let color = self.shaded(&mirrored) * self.sur.reflectance;
                drawn = (Decision::Mirrored(mirrored.seen), color);
            }
        }
        let [sphere1, sphere2] = &self.spheres;
        let ligtemp = -self.lig_dir;
        let in_shadow = get_inter_point_sphere(interpoint0, ligtemp, sphere1).is_some()
            // Slip (Code 5-1): sphere 2 casts its shadow along +LigDir, away from the light. Since
            // Code 3-1 never asks for t > 0, both ways are one line, and the shadow falls where it
            // should.
            || get_inter_point_sphere(interpoint0, self.lig_dir, sphere2).is_some()
            || get_inter_point_tetrahedron(interpoint0, ligtemp, &self.t).is_some();
        if in_shadow {
            let ambient = self.scene.material().ambient * self.scene.light().ambient_intensity;
            drawn = (Decision::SurfaceInShadow, ambient);
        }
        drawn
    }
}

impl Pixels for Listing<'_> {
    fn pixel(&self, column: u32, row: u32) -> (Pixel, Rung) {
        let pixel = self.place(column, row);
        let (decision, color) = match self.stage {
            Stage::Image => {
                let number = quadrant(column, row, self.size);
                (Decision::Quadrant(number), QUADRANTS[usize::from(number)])
            }
            Stage::Spheres => self.seen(self.nearest_sphere(pixel), |hit| hit.color),
            Stage::Tetrahedron => {
                self.seen(self.meet_tetrahedron(pixel, self.look_at), |hit| hit.color)
            }
            Stage::Shading => self.seen(self.nearest_solid(pixel), |hit| self.shaded(hit)),
            Stage::Shadow | Stage::Reflection | Stage::Animation => self.glazed_surface(pixel),
        };
        let samples = color.to_array().map(|sample| sample as f32);
        ((decision, samples), Rung::Hardware)
    }

    /// The outcome alone: the steps are in the listings.
    fn explain(&self, _: u32, _: u32, (decision, samples): Pixel) -> String {
        explain::outcome(self.scene, decision, samples)
    }
}

/// Of two solids the one nearer to the pixel, and of two that are as near the first.
fn nearer(
    pixel: DVec3,
    first: Option<ListingHit>,
    second: Option<ListingHit>,
) -> Option<ListingHit> {
    match (first, second) {
        (Some(first), Some(second))
            if pixel.distance(second.point) < pixel.distance(first.point) =>
        {
            Some(second)
        }
        (Some(first), _) => Some(first),
        (None, second) => second,
    }
}

/// Equation 5-1.
fn get_projection(d: DVec3, n: DVec3) -> DVec3 {
    d - 2.0 * d.dot(n) * n
}

fn get_normal_sphere(point: DVec3, sphere: &Sphere) -> DVec3 {
    get_unit(point - sphere.center)
}
