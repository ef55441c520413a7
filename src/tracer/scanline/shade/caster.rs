//! Casters on a sphere, as forms of its coordinates.

use crate::number::rounding::{INFLATION, U};
use crate::number::{Bounded, Real};
use crate::tracer::scanline::shade::light::Lighting;
use crate::tracer::scanline::shade::sphere::{HitBounds, HitBox, LinearForm, ZONES};
use crate::tracer::sphere::Sphere;
use crate::tracer::vector::Vector;

/// A solid or the surface, which may stand between a pixel of a sphere and the light.
pub(crate) enum Caster<'f> {
    /// The shadow is an intersection of half-spaces: all forms are 0 or more.
    Polyhedron(&'f [LinearForm]),
    /// The shadow is a cylinder.
    Sphere(ShadowCylinder),
}

/// The shadow of a sphere with centre c: the points p before it, for which (c − p)·l > 0, whose ray
/// to the light meets it, |(p − c) × l|² ≤ |l|² R².
///
/// With p = o + n, where o is the centre of the sphere that it falls on and n is the normal there,
/// the moment is (o − c) × l + n × l. Only the constants differ from caster to caster.
pub(crate) struct ShadowCylinder {
    /// (o − c) × l, and −(o − c)·l.
    constants: [f64; 4],
    /// A bound on the error of each of the four sums.
    pub(crate) form_error: f64,
    /// |l|² R².
    pub(crate) squared_radius: f64,
    /// A bound on the error of the difference of `squared_radius` and the squared moment.
    pub(crate) error: f64,
}

impl Caster<'_> {
    /// Whether the caster certainly casts no shadow on the pixels of a box.
    pub(crate) fn misses(&self, lighting: &Lighting, hits: &HitBox) -> bool {
        match self {
            Caster::Polyhedron(forms) => forms.iter().any(|form| form.is_negative(hits)),
            Caster::Sphere(cylinder) => {
                let min_square = |form: &LinearForm| {
                    let (low, high) = form.range(hits);
                    if low <= 0.0 && high >= 0.0 {
                        0.0
                    } else {
                        (low * low).min(high * high)
                    }
                };
                let [x, y, z, before] = &cylinder.forms(lighting);
                let upper =
                    cylinder.squared_radius - (min_square(x) + min_square(y) + min_square(z));
                upper < -cylinder.error || before.is_negative(hits)
            }
        }
    }
}

impl ShadowCylinder {
    /// The shadow of `caster` on a sphere.
    pub(crate) fn new(
        sphere: &HitBounds,
        caster: &Sphere<Bounded>,
        lighting: &Lighting,
    ) -> ShadowCylinder {
        let from = sphere.center - caster.center;
        let l = lighting.to_light.vector;
        let sum = |v: Vector<Bounded>, of: fn(Bounded) -> f64| of(v.x) + of(v.y) + of(v.z);
        let magnitude = |x: Bounded| x.value().abs();
        let (distance, distance_error) = (sum(from, magnitude), sum(from, Bounded::error));
        let (length, length_error) = (sum(l, magnitude), sum(l, Bounded::error));
        let [x, y, z] = [from.x, from.y, from.z].map(Bounded::value);
        let [l_x, l_y, l_z] = [l.x, l.y, l.z].map(Bounded::value);
        let constants = [
            y * l_z - z * l_y,
            z * l_x - x * l_z,
            x * l_y - y * l_x,
            -(x * l_x + y * l_y + z * l_z),
        ];
        let largest = constants.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        // AB − ab = α B + a β; at most three products and two sums round, each by u of no more than
        // all magnitudes. Then the constant is part of three sums, which round.
        let carried = distance * length_error + (length + length_error) * distance_error;
        let own_error = sphere.errors(lighting.moment_sizes)[ZONES - 1];
        let form_error =
            (own_error + carried + 5.0 * U * distance * length + 8.0 * U * largest) * INFLATION;
        let magnitude = sphere.magnitude(lighting.moment_sizes) + largest;
        let squared_radius = lighting.to_light.squared_length * caster.radius.squared();
        // |(a + ε)² − a²| ≤ 2|a|ε + ε² for each component; six operations round, each by less than
        // u of all magnitudes.
        let error = (squared_radius.error()
            + 3.0 * (2.0 * magnitude + form_error) * form_error
            + 8.0 * U * (3.0 * magnitude * magnitude + squared_radius.value()))
            * INFLATION;
        ShadowCylinder {
            constants,
            form_error,
            squared_radius: squared_radius.value(),
            error,
        }
    }

    /// The components of the moment (p − c) × l, and (c − p)·l.
    #[inline(always)]
    pub(crate) fn forms(&self, lighting: &Lighting) -> [LinearForm; 4] {
        let form = |i: usize| LinearForm {
            constant: self.constants[i],
            q: lighting.moment[i][0],
            m: lighting.moment[i][1],
            s: lighting.moment[i][2],
            error: self.form_error,
            is_concave: None,
        };
        [form(0), form(1), form(2), form(3)]
    }
}
