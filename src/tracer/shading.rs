//! Equation 4-1: ambient, diffuse and specular light at a point of a solid.

use super::line::Direction;
use super::number::Real;
use super::vector::Vector;
use crate::scene::Scene;

/// The light and the material as one view sees them.
pub(super) struct Shading<R> {
    /// Toward the light: l, of any length.
    pub(super) to_light: Direction<R>,
    to_light_length: R,
    /// h, of length 1; `None` where v + l = 0, and there is no highlight.
    halfway: Option<Vector<R>>,
    ambient: Vector<R>,
    diffuse: Vector<R>,
    specular: Vector<R>,
    exponent: u32,
}

impl<R: Real> Shading<R> {
    /// `looking` is the way the eye's rays go: v is its opposite.
    pub(super) fn new(
        scene: &Scene,
        looking: &Direction<R>,
        to_light: Direction<R>,
    ) -> Result<Self, R::Doubt> {
        let (light, material) = (scene.light(), scene.material());
        let to_light_length = to_light.squared_length.sqrt();
        // l is opposite to v where it goes exactly the way that the eye looks.
        let crossed = looking.vector.cross(to_light.vector);
        let opposite = crossed.x.sign()?.is_eq()
            && crossed.y.sign()?.is_eq()
            && crossed.z.sign()?.is_eq()
            && looking.vector.dot(to_light.vector).sign()?.is_gt();
        let halfway = if opposite {
            None
        } else {
            let v = -looking.vector.divided_by(looking.squared_length.sqrt());
            let sum = v + to_light.vector.divided_by(to_light_length);
            Some(sum.divided_by(sum.length()))
        };
        let intensity = Vector::exact(light.intensity);
        Ok(Shading {
            to_light,
            to_light_length,
            halfway,
            ambient: Vector::exact(material.ambient).times(Vector::exact(light.ambient_intensity)),
            diffuse: Vector::exact(material.diffuse).times(intensity),
            specular: Vector::exact(material.specular).times(intensity),
            exponent: material.exponent,
        })
    }

    /// k_a I_a: what a point in shadow shows of its colour, and all that a shadow on the surface shows.
    pub(super) fn ambient(&self) -> Vector<R> {
        self.ambient
    }

    /// L of equation 4-1 where the outward normal is `normal`, of length `length`.
    pub(super) fn lit(&self, normal: Vector<R>, length: R) -> Result<Vector<R>, R::Doubt> {
        let mut sum = self.ambient;
        let cosine = normal.dot(self.to_light.vector);
        if cosine.sign()?.is_gt() {
            sum = sum + self.diffuse * (cosine / (length * self.to_light_length));
        }
        if let Some(halfway) = self.halfway {
            // 1 − n·h = |n − h|²/2 for unit vectors: small, and known to a small relative error, just where the
            // highlight is bright.
            let gap = normal.divided_by(length) - halfway;
            let one_minus = gap.squared_length() * R::exact(0.5);
            sum = sum + self.specular * one_minus.one_minus_to_the(self.exponent);
        }
        Ok(sum)
    }
}
