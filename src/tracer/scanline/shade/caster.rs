//! What casts a shadow on a sphere.

use crate::number::Bounded;
use crate::tracer::scanline::rounding::{MORE, U};
use crate::tracer::scanline::shade::sphere::{LinearForm, Stretch};

/// What may stand between a pixel of a sphere and the light.
pub(crate) enum Caster<'f> {
    /// Any point within all of these half-spaces is in its shadow.
    Polyhedron(&'f [LinearForm]),
    /// Any point that is before it, and from which the way to the light passes its centre near
    /// enough.
    Sphere(&'f ShadowCylinder),
}

/// The shadow of a sphere: a cylinder that begins at it, along the way from the light.
pub(crate) struct ShadowCylinder {
    pub(crate) before: LinearForm,
    /// The components of a vector, of which the squared length is at most `reach`; a bound on the
    /// error of the difference.
    pub(crate) moment: [LinearForm; 3],
    pub(crate) reach: f64,
    pub(crate) error: f64,
}

impl Caster<'_> {
    /// Whether it certainly casts no shadow on a stretch.
    pub(crate) fn misses(&self, stretch: &Stretch) -> bool {
        match self {
            Caster::Polyhedron(forms) => forms.iter().any(|form| form.is_negative_along(stretch)),
            Caster::Sphere(cylinder) => {
                let least_square = |form: &LinearForm| {
                    let (low, high) = form.along(stretch);
                    if low <= 0.0 && high >= 0.0 {
                        0.0
                    } else {
                        (low * low).min(high * high)
                    }
                };
                let [x, y, z] = &cylinder.moment;
                let most = cylinder.reach - (least_square(x) + least_square(y) + least_square(z));
                most < -cylinder.error || cylinder.before.is_negative_along(stretch)
            }
        }
    }
}

impl ShadowCylinder {
    /// `reach` is |l|² R² of a sphere.
    pub(crate) fn new(
        before: LinearForm,
        moment: [LinearForm; 3],
        reach: Bounded,
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
        let error = (reach.error() + carried + 8.0 * U * (magnitudes + reach.value())) * MORE;
        ShadowCylinder {
            before,
            moment,
            reach: reach.value(),
            error,
        }
    }
}
