//! Casters on a sphere, as forms of its coordinates.

use crate::number::Bounded;
use crate::number::rounding::{INFLATION, U};
use crate::tracer::scanline::shade::sphere::{HitBox, LinearForm};

/// A solid or the surface, which may stand between a pixel of a sphere and the light.
pub(crate) enum Caster<'f> {
    /// The shadow is an intersection of half-spaces: all forms are 0 or more.
    Polyhedron(&'f [LinearForm]),
    /// The shadow is a cylinder.
    Sphere(&'f ShadowCylinder),
}

/// The shadow of a sphere with centre c: the points p before it, for which (c − p)·l > 0, whose ray
/// to the light meets it, |(p − c) × l|² ≤ |l|² R².
pub(crate) struct ShadowCylinder {
    /// (c − p)·l.
    pub(crate) before: LinearForm,
    /// The components of the moment (p − c) × l.
    pub(crate) moment: [LinearForm; 3],
    /// |l|² R².
    pub(crate) squared_radius: f64,
    /// A bound on the error of the difference of `squared_radius` and the squared moment.
    pub(crate) error: f64,
}

impl Caster<'_> {
    /// Whether the caster certainly casts no shadow on the pixels of a box.
    pub(crate) fn misses(&self, hits: &HitBox) -> bool {
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
                let [x, y, z] = &cylinder.moment;
                let upper =
                    cylinder.squared_radius - (min_square(x) + min_square(y) + min_square(z));
                upper < -cylinder.error || cylinder.before.is_negative(hits)
            }
        }
    }
}

impl ShadowCylinder {
    pub(crate) fn new(
        before: LinearForm,
        moment: [LinearForm; 3],
        squared_radius: Bounded,
    ) -> ShadowCylinder {
        let magnitudes: f64 = moment
            .iter()
            .map(|form| form.magnitude * form.magnitude)
            .sum();
        // |(a + ε)² − a²| ≤ 2|a|ε + ε²; six operations round, each by less than u of all
        // magnitudes.
        let carried: f64 = moment
            .iter()
            .map(|form| (2.0 * form.magnitude + form.error) * form.error)
            .sum();
        let error =
            (squared_radius.error() + carried + 8.0 * U * (magnitudes + squared_radius.value()))
                * INFLATION;
        ShadowCylinder {
            before,
            moment,
            squared_radius: squared_radius.value(),
            error,
        }
    }
}
