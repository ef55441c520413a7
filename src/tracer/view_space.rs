//! How a frame turns and scales the scene.
//!
//! # View space
//!
//! The scene is turned by α instead of the eye, and measured in thirds of a pixel from the
//! picture's centre: x right, y up, z toward the eye, a scene's length 1 being 3N/2. There the
//! pixel (x, y) lies on the screen at e = 3 (x − N/2, y − N/2, N/2), the eye looks along
//! −(0, 3, 10), which is −10 w, and a ray reaches the surface at t = (y − N/2) − (N/2) · height.
//! Directions need no unit length. So pixels and eye rays are small whole or half numbers, which
//! nothing rounds, and at α = 0 a scene of short binary fractions is, too.

use glam::DVec3;

use super::line::{Direction, Line};
use super::shading::halfway;
use super::surface::Surface;
use super::tetrahedron::Tetrahedron;
use super::vector::Vector;
use crate::number::Real;
use crate::scene::Scene;

/// The width and height of a pixel in view space.
pub(super) const PIXEL: f64 = 3.0;

/// Eye rays go along d = (0, −[`EYE_Y`], −[`EYE_Z`]) in view space.
pub(super) const EYE_Y: f64 = 3.0;
/// See [`EYE_Y`].
pub(super) const EYE_Z: f64 = 10.0;
/// |d|² = 109.
pub(super) const EYE_SQUARED: f64 = EYE_Y * EYE_Y + EYE_Z * EYE_Z;

/// The rotation and the scale from the scene into view space.
#[derive(Clone, Copy)]
pub(super) struct ViewTransform<R> {
    /// sin α.
    pub(super) sin: R,
    /// cos α.
    pub(super) cos: R,
    /// 3N/2.
    pub(super) scale: R,
    /// N/2.
    half: f64,
}

impl<R: Real> ViewTransform<R> {
    /// `sin` and `cos` are those of α, `size` is N.
    pub(super) fn new(sin: R, cos: R, size: u32) -> Self {
        let half = f64::from(size) / 2.0;
        ViewTransform {
            sin,
            cos,
            scale: R::exact(PIXEL * half),
            half,
        }
    }

    /// The whole line of sight through the pixel at `column` from the left and `row` from the
    /// bottom.
    pub(super) fn eye_ray(&self, column: u32, row: u32) -> Line<R> {
        let [x, y] = [column, row].map(|number| PIXEL * from_middle(number, self.half));
        let origin = [x, y, PIXEL * self.half].map(R::exact);
        Line {
            origin: Vector::new(origin[0], origin[1], origin[2]),
            direction: eye_direction(),
            origin_support: None,
        }
    }

    /// The parameter and the point at which the eye ray of a pixel in `row` meets the surface's
    /// plane. The point's height is not rounded.
    pub(super) fn on_surface(
        &self,
        surface: &Surface<R>,
        ray: &Line<R>,
        row: u32,
    ) -> (R, Vector<R>) {
        let depth = R::exact(from_middle(row, self.half)) - surface.height_in_pixels;
        let point = Vector {
            y: surface.height,
            ..ray.at(depth)
        };
        (depth, point)
    }

    /// The height of the surface's plane in view space, if there is one.
    pub(super) fn surface_height(&self, scene: &Scene) -> Option<R> {
        scene
            .surface()
            .map(|surface| R::exact(surface.height) * self.scale)
    }

    /// A direction of the scene in view space, unscaled.
    pub(super) fn turn(&self, v: DVec3) -> Vector<R> {
        let v = Vector::<R>::exact(v);
        Vector::new(
            v.x * self.cos - v.z * self.sin,
            v.y,
            v.x * self.sin + v.z * self.cos,
        )
    }

    /// A point of the scene in view space.
    pub(super) fn point(&self, point: DVec3) -> Vector<R> {
        self.turn(point) * self.scale
    }

    /// The surface in view space.
    pub(super) fn surface(&self, scene: &Scene) -> Option<Surface<R>> {
        let surface = scene.surface()?;
        Some(Surface {
            height: self.surface_height(scene)?,
            height_in_pixels: R::exact(surface.height) * R::exact(self.half),
            half_width: R::exact(surface.half_width) * self.scale,
            sin: self.sin,
            cos: self.cos,
            support: scene.facts().surface?,
        })
    }

    /// A tetrahedron in view space, reflected in the plane of height `mirror_height`.
    pub(super) fn tetrahedron(
        &self,
        scene: &Scene,
        index: usize,
        mirror_height: Option<R>,
    ) -> Tetrahedron<R> {
        let (tetrahedron, facts) = (&scene.tetrahedra()[index], scene.facts());
        let vertices = tetrahedron
            .vertices
            .map(|vertex| reflect(self.point(vertex), mirror_height));
        // A reflection turns a right hand into a left one.
        let right_handed = facts.right_handed[index] != mirror_height.is_some();
        Tetrahedron::new(
            vertices,
            right_handed,
            facts.faces[index],
            facts.facing_light[index],
        )
    }

    /// The direction to the light, reflected for the mirror.
    pub(super) fn direction_to_light(&self, scene: &Scene, mirrored: bool) -> Direction<R> {
        let direction = scene.light().scaled_direction();
        let turned = -self.turn(direction);
        Direction {
            vector: if mirrored {
                Vector::new(turned.x, -turned.y, turned.z)
            } else {
                turned
            },
            // Turning does not change a length, but would round it.
            squared_length: Vector::exact(direction).squared_length(),
        }
    }

    /// h, where v + l is not 0.
    pub(super) fn halfway(&self, scene: &Scene, mirrored: bool) -> Vector<R> {
        halfway(&eye_direction(), &self.direction_to_light(scene, mirrored))
    }
}

impl ViewTransform<f64> {
    /// The direction of eye rays in the scene's own axes; of mirrored rays, reflected back.
    pub(super) fn eye_direction_in_scene(&self, mirrored: bool) -> DVec3 {
        let y = if mirrored { EYE_Y } else { -EYE_Y };
        DVec3::new(-EYE_Z * self.sin, y, -EYE_Z * self.cos)
    }
}

/// How many pixels a column or row is from the picture's middle; `half` is N/2.
#[inline]
pub(super) fn from_middle(number: u32, half: f64) -> f64 {
    f64::from(number) - half
}

/// The reflection in the horizontal plane of height `mirror_height`, if there is one.
pub(super) fn reflect<R: Real>(point: Vector<R>, mirror_height: Option<R>) -> Vector<R> {
    match mirror_height {
        Some(height) => Vector::new(point.x, height + height - point.y, point.z),
        None => point,
    }
}

/// The direction of every eye ray: −10 w, of length √109.
pub(super) fn eye_direction<R: Real>() -> Direction<R> {
    let vector = Vector::new(R::exact(0.0), R::exact(-EYE_Y), R::exact(-EYE_Z));
    Direction {
        vector,
        squared_length: R::exact(EYE_SQUARED),
    }
}
