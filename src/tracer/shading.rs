//! Equation 4-1: ambient, diffuse and specular light at a point of a solid.

use std::cmp::Ordering;

use glam::DVec3;

use super::line::{Direction, Normal};
use super::vector::Vector;
use crate::number::Real;
use crate::scene::Scene;

/// The light and the material as one view sees them.
pub(super) struct Shading<R> {
    /// Toward the light: l, of any length.
    pub(super) to_light: Direction<R>,
    to_light_length: R,
    /// h, of length 1; `None` where v + l = 0, and there is no highlight.
    halfway: Option<Vector<R>>,
    /// k_a I_a.
    ambient: Vector<R>,
    /// k_d I.
    diffuse: Vector<R>,
    /// k_s I.
    specular: Vector<R>,
    /// n.
    exponent: u32,
}

impl<R: Real> Shading<R> {
    /// `halfway` is h, as the function [`halfway`] gives it, or `None` where v + l = 0.
    pub(super) fn new(scene: &Scene, to_light: Direction<R>, halfway: Option<Vector<R>>) -> Self {
        let (light, material) = (scene.light(), scene.material());
        let to_light_length = to_light.squared_length.sqrt();
        let intensity = Vector::exact(light.intensity);
        Shading {
            to_light,
            to_light_length,
            halfway,
            ambient: Vector::exact(material.ambient).times(Vector::exact(light.ambient_intensity)),
            diffuse: Vector::exact(material.diffuse).times(intensity),
            specular: Vector::exact(material.specular).times(intensity),
            exponent: material.exponent,
        }
    }

    /// k_a I_a: the light of a point in shadow, and the colour of the surface in shadow.
    pub(super) fn ambient(&self) -> Vector<R> {
        self.ambient
    }

    /// l, of length 1.
    pub(super) fn to_light_unit(&self) -> Vector<R> {
        self.to_light.vector.divided_by(self.to_light_length)
    }

    /// The coefficients of 1, n·l and (n·h)ⁿ in equation 4-1, for red, green and blue.
    pub(super) fn coefficients(&self) -> [[R; 3]; 3] {
        let (a, d, s) = (self.ambient, self.diffuse, self.specular);
        [[a.x, d.x, s.x], [a.y, d.y, s.y], [a.z, d.z, s.z]]
    }

    /// n, the exponent of the highlight.
    pub(super) fn exponent(&self) -> u32 {
        self.exponent
    }

    /// h, of length 1; `None` where there is no highlight.
    pub(super) fn halfway(&self) -> Option<Vector<R>> {
        self.halfway
    }

    /// The sign of n·l.
    pub(super) fn facing_light(&self, normal: &Normal<R>) -> Result<Ordering, R::Doubt> {
        match normal.facing_light {
            Some(decided) => Ok(decided),
            None => normal.vector.dot(self.to_light.vector).sign(),
        }
    }

    /// The terms of equation 4-1 at a point with this normal.
    pub(super) fn terms(&self, n: &Normal<R>) -> Result<Terms<R>, R::Doubt> {
        let (normal, length) = (n.vector, n.length);
        let none = Vector::exact(DVec3::ZERO);
        let normal_light = normal.dot(self.to_light.vector) / (length * self.to_light_length);
        let diffuse = if self.facing_light(n)?.is_gt() {
            self.diffuse * normal_light
        } else {
            none
        };
        // 1 − n·h = |n − h|²/2 for unit vectors: where the highlight is bright, it is small and has
        // a small relative error.
        let one_minus = self
            .halfway
            .map(|halfway| (normal.divided_by(length) - halfway).squared_length() * R::exact(0.5));
        let specular = match one_minus {
            Some(one_minus) => self.specular * one_minus.one_minus_to_the(self.exponent),
            None => none,
        };
        Ok(Terms {
            normal_light,
            one_minus_normal_halfway: one_minus,
            diffuse,
            specular,
        })
    }

    /// L of equation 4-1 at a point with this normal.
    pub(super) fn lit(&self, normal: &Normal<R>) -> Result<Vector<R>, R::Doubt> {
        let terms = self.terms(normal)?;
        Ok(self.ambient + terms.diffuse + terms.specular)
    }
}

/// h = (v + l)/|v + l|, where v + l is not 0. `eye_direction` is that of eye rays, the opposite of
/// v.
pub(super) fn halfway<R: Real>(eye_direction: &Direction<R>, to_light: &Direction<R>) -> Vector<R> {
    let v = -eye_direction
        .vector
        .divided_by(eye_direction.squared_length.sqrt());
    let sum = v + to_light.vector.divided_by(to_light.squared_length.sqrt());
    sum.divided_by(sum.length())
}

/// The terms of equation 4-1 that depend on the normal, and what they are made of.
pub(super) struct Terms<R> {
    /// n·l.
    pub(super) normal_light: R,
    /// 1 − n·h; `None` where there is no h.
    pub(super) one_minus_normal_halfway: Option<R>,
    /// k_d I max(0, n·l).
    pub(super) diffuse: Vector<R>,
    /// k_s I max(0, n·h)ⁿ.
    pub(super) specular: Vector<R>,
}
