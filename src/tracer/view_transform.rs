//! How a frame turns and scales the scene into view space.

use glam::DVec3;

use super::line::{Direction, Line};
use super::shading::halfway;
use super::surface::Surface;
use super::tetrahedron::{Tetrahedron, outward_normals};
use super::vector::Vector;
use super::view_space::{
    EYE_Y, EYE_Z, PIXEL, coordinate, eye_direction, from_middle, reflect, reflect_direction,
};
use crate::number::Real;
use crate::scene::Scene;

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
        let [x, y] = [column, row].map(|number| coordinate(number, self.half));
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
    #[inline]
    pub(super) fn turn(&self, v: DVec3) -> Vector<R> {
        let v = Vector::<R>::exact(v);
        Vector::new(
            v.x * self.cos - v.z * self.sin,
            v.y,
            v.x * self.sin + v.z * self.cos,
        )
    }

    /// A point of the scene in view space.
    #[inline]
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
        self.tetrahedron_with(scene, index, mirror_height, outward_normals)
    }

    /// The same with normals from another function.
    #[inline(always)]
    pub(super) fn tetrahedron_with(
        &self,
        scene: &Scene,
        index: usize,
        mirror_height: Option<R>,
        outward_normals: impl FnOnce(&[Vector<R>; 4], bool) -> [Vector<R>; 4],
    ) -> Tetrahedron<R> {
        let (tetrahedron, facts) = (&scene.tetrahedra()[index], scene.facts());
        let vertices = tetrahedron
            .vertices
            .map(|vertex| reflect(self.point(vertex), mirror_height));
        // A reflection turns a right hand into a left one.
        let right_handed = facts.right_handed[index] != mirror_height.is_some();
        Tetrahedron::new(
            vertices,
            outward_normals(&vertices, right_handed),
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
            vector: reflect_direction(turned, mirrored),
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
