//! The scene as one frame sees it.
//!
//! # View space
//!
//! The scene is turned by α instead of the eye, and measured in thirds of a pixel from the picture's centre: x right,
//! y up, z toward the eye, a scene's length 1 being 3N/2. There the pixel (x, y) has its place on the screen at
//! e = 3 (x − N/2, y − N/2, N/2), the eye looks along −(0, 3, 10), which is −10 w, and a ray reaches the surface at
//! t = (y − N/2) − (N/2) · height. Directions need no unit length, so nothing is rounded that need not be: pixels and eye
//! rays are small whole or half numbers, and at α = 0 so is a scene of short binary fractions.
//!
//! # The mirror
//!
//! What a ray sees in the surface is what the same ray, going on straight, would see of the scene reflected in the
//! surface's plane. So the mirror is a second view of the same kind, of reflected solids under a reflected light, and
//! every formula serves both.

use glam::DVec3;

use super::line::{Direction, Hit, Line};
use super::real::Real;
use super::shading::Shading;
use super::sphere::Sphere;
use super::surface::Surface;
use super::tetrahedron::{Sight, Tetrahedron};
use super::vector::Vector;
use crate::scene::Scene;

/// How the scene is turned and scaled into view space.
#[derive(Clone, Copy)]
pub(super) struct Frame<R> {
    pub(super) sin: R,
    pub(super) cos: R,
    /// 3N/2.
    pub(super) scale: R,
}

impl<R: Real> Frame<R> {
    fn turn(&self, v: DVec3) -> Vector<R> {
        let v = Vector::<R>::exact(v);
        Vector::new(
            v.x * self.cos - v.z * self.sin,
            v.y,
            v.x * self.sin + v.z * self.cos,
        )
    }

    fn place(&self, point: DVec3) -> Vector<R> {
        self.turn(point) * self.scale
    }

    /// The surface in view space.
    pub(super) fn surface(&self, surface: &crate::scene::Surface) -> Surface<R> {
        Surface {
            height: R::exact(surface.height) * self.scale,
            half_width: R::exact(surface.half_width) * self.scale,
            sin: self.sin,
            cos: self.cos,
        }
    }
}

/// The way every eye ray goes: −10 w, of length √109.
pub(super) fn looking<R: Real>() -> Direction<R> {
    let vector = Vector::new(R::exact(0.0), R::exact(-3.0), R::exact(-10.0));
    Direction {
        vector,
        squared_length: R::exact(109.0),
    }
}

/// All solids and the light, turned, scaled, and for the mirror reflected.
pub(super) struct View<R> {
    spheres: Vec<Sphere<R>>,
    tetrahedra: Vec<TetrahedronInView<R>>,
    pub(super) shading: Shading<R>,
}

struct TetrahedronInView<R> {
    solid: Tetrahedron<R>,
    from_eye: Sight<R>,
    from_light: Sight<R>,
}

/// Which rays are meant: the whole line, or only what lies at t > 0.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Reach {
    Line,
    Ahead,
}

/// Which solids take part.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Solids {
    Spheres,
    Tetrahedra,
    All,
}

impl<R: Real> View<R> {
    /// `mirror`: the height in view space of the plane in which everything is reflected.
    pub(super) fn new(
        scene: &Scene,
        frame: &Frame<R>,
        mirror: Option<R>,
    ) -> Result<View<R>, R::Doubt> {
        let reflect_point = |p: Vector<R>| match mirror {
            Some(height) => Vector::new(p.x, height + height - p.y, p.z),
            None => p,
        };
        let light = -frame.turn(scene.light().scaled_direction());
        let light = if mirror.is_some() {
            Vector::new(light.x, -light.y, light.z)
        } else {
            light
        };
        let to_light = Direction {
            vector: light,
            squared_length: light.squared_length(),
        };
        let spheres = scene.spheres().iter().map(|sphere| Sphere {
            center: reflect_point(frame.place(sphere.center)),
            radius: R::exact(sphere.radius) * frame.scale,
        });
        let tetrahedra = scene.tetrahedra().iter().map(|tetrahedron| {
            let vertices = tetrahedron
                .vertices
                .map(|vertex| reflect_point(frame.place(vertex)));
            // A reflection turns a right hand into a left one.
            let solid = Tetrahedron::new(vertices, tetrahedron.right_handed != mirror.is_some());
            let (from_eye, from_light) = (solid.sight(&looking())?, solid.sight(&to_light)?);
            Ok(TetrahedronInView {
                solid,
                from_eye,
                from_light,
            })
        });
        Ok(View {
            spheres: spheres.collect(),
            tetrahedra: tetrahedra.collect::<Result<_, _>>()?,
            shading: Shading::new(scene, &looking(), to_light)?,
        })
    }

    /// The first solid along an eye ray, and where it is hit; of solids hit at once, the earliest in the scene's order.
    pub(super) fn first_hit(
        &self,
        ray: &Line<R>,
        reach: Reach,
        solids: Solids,
    ) -> Result<Option<(usize, Hit<R>)>, R::Doubt> {
        let mut first: Option<(usize, Hit<R>)> = None;
        let mut meet = |solid: usize, hit: Option<Hit<R>>| -> Result<(), R::Doubt> {
            if let Some(hit) = hit {
                let nearer = match &first {
                    Some((_, other)) => (hit.depth - other.depth).sign()?.is_lt(),
                    None => true,
                };
                if nearer {
                    first = Some((solid, hit));
                }
            }
            Ok(())
        };
        if solids != Solids::Tetrahedra {
            for (solid, sphere) in self.spheres.iter().enumerate() {
                if reach == Reach::Line || sphere.is_ahead(ray)? {
                    meet(solid, sphere.first_hit(ray)?)?;
                }
            }
        }
        if solids != Solids::Spheres {
            for (solid, t) in (self.spheres.len()..).zip(&self.tetrahedra) {
                if reach == Reach::Line || t.solid.is_ahead(&t.from_eye, ray)? {
                    meet(solid, t.solid.first_hit(&t.from_eye, ray)?)?;
                }
            }
        }
        Ok(first)
    }

    /// Whether a solid other than `besides` stands between `point` and the light. The point is in no solid's interior.
    pub(super) fn is_shadowed(
        &self,
        point: Vector<R>,
        besides: Option<usize>,
    ) -> Result<bool, R::Doubt> {
        let ray = self.ray_to_light(point);
        for (solid, sphere) in self.spheres.iter().enumerate() {
            if Some(solid) != besides && sphere.is_ahead(&ray)? {
                return Ok(true);
            }
        }
        for (solid, t) in (self.spheres.len()..).zip(&self.tetrahedra) {
            if Some(solid) != besides && t.solid.is_ahead(&t.from_light, &ray)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The ray from `point` toward the light.
    pub(super) fn ray_to_light(&self, point: Vector<R>) -> Line<R> {
        Line {
            origin: point,
            direction: self.shading.to_light,
        }
    }
}
