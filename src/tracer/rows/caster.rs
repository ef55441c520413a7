//! What throws a shadow on a sphere.

use super::ball::{Form, Stretch};
use super::rounding::{MORE, U};
use crate::number::Bounded;

/// What may stand between a pixel of a sphere and the light.
pub(super) enum Caster<'f> {
    /// Any point within all of these half-spaces is in its shadow.
    Cell(&'f [Form]),
    /// Any point that is before it, and from which the way to the light passes its centre near enough.
    Ball(&'f Passing),
}

/// Points in the shadow of a ball.
pub(super) struct Passing {
    pub(super) before: Form,
    /// The components of a vector, of which the squared length is at most `reach`; a bound on the error of the difference.
    pub(super) moment: [Form; 3],
    pub(super) reach: f64,
    pub(super) error: f64,
}

impl Caster<'_> {
    /// Whether it certainly throws no shadow on a stretch.
    pub(super) fn misses(&self, stretch: &Stretch) -> bool {
        match self {
            Caster::Cell(forms) => forms.iter().any(|form| form.is_negative_along(stretch)),
            Caster::Ball(passing) => {
                let least_square = |form: &Form| {
                    let (low, high) = form.along(stretch);
                    if low <= 0.0 && high >= 0.0 {
                        0.0
                    } else {
                        (low * low).min(high * high)
                    }
                };
                let [x, y, z] = &passing.moment;
                let most = passing.reach - (least_square(x) + least_square(y) + least_square(z));
                most < -passing.error || passing.before.is_negative_along(stretch)
            }
        }
    }
}

impl Passing {
    /// `reach` is |l|² R² of a sphere.
    pub(super) fn new(before: Form, moment: [Form; 3], reach: Bounded) -> Passing {
        let magnitudes: f64 = moment
            .iter()
            .map(|form| form.magnitude * form.magnitude)
            .sum();
        // |(a + ε)² − a²| ≤ 2|a|ε + ε²; six operations round, each by less than u of all magnitudes.
        let carried: f64 = moment
            .iter()
            .map(|form| (2.0 * form.magnitude + form.error) * form.error)
            .sum();
        let error = (reach.error() + carried + 8.0 * U * (magnitudes + reach.value())) * MORE;
        Passing {
            before,
            moment,
            reach: reach.value(),
            error,
        }
    }
}
