//! A sphere in a row: the f64s that its pixels are shaded with, and bounds on their errors.
//!
//! In a row, with q = X − c_x and m as in [`Ellipse::outline`], the hit's normal, of the radius's
//! length, is
//!
//! q (1, 0, 0) + m (0, 10, −3)/√109 + s (0, 3, 10)/√109, s = √(R² − m² − q²),
//!
//! which follows from `sphere.rs` with d = −(0, 3, 10). So n·l, n·h and every plane's equation at
//! the hit are linear forms in q, m and s, and per pixel there are a root, a few products and sums.

use std::cmp::Ordering;

use crate::number::{Bounded, Real};
use crate::tracer::line::Direction;
use crate::tracer::scanline::edges::ellipse::{Ellipse, RowOffset};
use crate::tracer::scanline::rounding::{MORE, U};
use crate::tracer::scanline::shade::light::{Highlight, Lighting};
use crate::tracer::sphere::Sphere;
use crate::tracer::tetrahedron::HalfSpace;
use crate::tracer::vector::Vector;

/// How far inside its outline a sphere is hit. A root multiplies errors by 1/s, and few pixels have
/// a small s: those with s ≥ R/8, with s ≥ R/128, with s ≥ R/16384, and the rest, which is left in doubt.
pub(crate) const ZONES: usize = 3;

/// What R is divided by for the least s of each zone.
const DEPTHS: [f64; ZONES] = [8.0, 128.0, 16384.0];

/// constant + across · q + off · m + out · s, and a bound on its error in f64 in any zone.
#[derive(Clone, Copy)]
pub(crate) struct LinearForm {
    pub(crate) constant: f64,
    pub(crate) across: f64,
    pub(crate) off: f64,
    pub(crate) out: f64,
    pub(crate) error: f64,
    /// A bound on its magnitude.
    pub(crate) magnitude: f64,
    /// Whether `out` is certainly not negative, or certainly not positive.
    pub(crate) is_concave: Option<bool>,
}

impl LinearForm {
    /// One of which nothing is known; computed without its error it is negative.
    pub(crate) const UNKNOWN: LinearForm = LinearForm {
        constant: -1.0,
        across: 0.0,
        off: 0.0,
        out: 0.0,
        error: f64::INFINITY,
        magnitude: f64::INFINITY,
        is_concave: None,
    };

    /// A form without a constant, and one.
    fn plus(self, constant: Bounded) -> LinearForm {
        let magnitude = constant.value().abs();
        LinearForm {
            constant: constant.value(),
            error: self.error + (constant.error() + 8.0 * U * magnitude) * MORE,
            magnitude: self.magnitude + magnitude * MORE,
            ..self
        }
    }

    /// The part that does not change along a row.
    pub(crate) fn of_row(&self, m: f64) -> f64 {
        self.constant + self.off * m
    }

    /// The least and the most that f64 computes of it in a pixel of a stretch, by these operations:
    /// rounding keeps order, so where a term is less it is not more rounded, and so are sums.
    /// Therefore this needs no bound of its own.
    pub(crate) fn along(&self, stretch: &Stretch) -> (f64, f64) {
        let ends = |factor: f64, (low, high): (f64, f64)| {
            let (a, b) = (low * factor, high * factor);
            (a.min(b), a.max(b))
        };
        let off = ends(self.off, stretch.m);
        let across = ends(self.across, stretch.q);
        let out = ends(self.out, stretch.s);
        (
            self.constant + off.0 + across.0 + out.0,
            self.constant + off.1 + across.1 + out.1,
        )
    }

    /// Whether it is certainly less than 0 in every pixel of a stretch.
    pub(crate) fn is_negative_along(&self, stretch: &Stretch) -> bool {
        self.along(stretch).1 < -self.error
    }
}

/// Neighbouring pixels of a sphere: between which m, q and s they are, as f64 computes them.
pub(crate) struct Stretch {
    m: (f64, f64),
    q: (f64, f64),
    s: (f64, f64),
}

/// The way halfway between the light and the eye.
pub(crate) struct Halfway {
    /// n·h.
    pub(crate) form: LinearForm,
    /// h, of length 1, in the axes of q, m and s.
    pub(crate) direction: [f64; 3],
    /// In each zone, a bound on n times the error of 1 − n·h: a constant, and what 1 − n·h is
    /// multiplied with.
    pub(crate) errors: [[f64; 2]; ZONES],
    /// 2¹⁻ⁿ.
    pub(crate) least: f64,
    /// Where m/R is farther than this from that of h there is no highlight.
    pub(crate) reach: f64,
}

/// What is known about q, m and s of any pixel: a bound on their magnitudes, and on their errors.
#[derive(Clone, Copy)]
struct Known {
    radius: f64,
    across: f64,
    off: f64,
    out: [f64; ZONES],
}

impl Known {
    /// vector · n, as a form, of a vector in the axes of q, m and s.
    fn form(&self, factors: [Bounded; 3]) -> LinearForm {
        LinearForm {
            constant: 0.0,
            across: factors[0].value(),
            off: factors[1].value(),
            out: factors[2].value(),
            error: self.error(&factors, self.out[ZONES - 1]),
            magnitude: self.magnitude(&factors) * MORE,
            is_concave: factors[2].sign().ok().map(Ordering::is_ge),
        }
    }

    fn magnitude(&self, factors: &[Bounded; 3]) -> f64 {
        factors.iter().map(|f| f.value().abs() * self.radius).sum()
    }

    /// A bound on the error of a form without a constant where that of s is at most `out`.
    fn error(&self, factors: &[Bounded; 3], out: f64) -> f64 {
        // AB − ab = α B + a β + …; three products and three sums round, each by less than u of the
        // sum of all magnitudes.
        let terms = factors.iter().zip([self.across, self.off, out]);
        let carried: f64 = terms
            .map(|(factor, error)| {
                factor.error() * (self.radius + error) + factor.value().abs() * error
            })
            .sum();
        let rounded = 8.0 * U * self.magnitude(factors);
        (carried + rounded) * MORE
    }

    /// `h` is that of a view, `radius` the sphere's.
    fn halfway(&self, h: [Bounded; 3], highlight: &Highlight, radius: Bounded) -> Halfway {
        // Y = |D|²/2 with D = (q, m, s)/R − h. With |ε| the length of the error of D but for the
        // rounding of its differences, which is less than u of D, that of Y is at most |D| |ε| +
        // |ε|² + 16u Y. Any bound on |D| that is linear in Y will do: (δ + 2Y/δ)/2 is one for each
        // δ, and touches it where δ² = 2Y; a highlight is steepest at 1/√n.
        let n = f64::from(highlight.exponent);
        let steepest = highlight.steepest;
        // No part of n is more than 1, and it is multiplied with 1/R, which rounds, as the product
        // does.
        let scaled = radius.error() / radius.value() + 3.0 * U;
        let part = |error: f64, h: Bounded| error / radius.value() + h.error() + scaled;
        let errors = self.out.map(|out| {
            let [across, off, out] = [
                part(self.across, h[0]),
                part(self.off, h[1]),
                part(out, h[2]),
            ];
            let off = (across + off + out) * MORE;
            // |Xⁿ − xⁿ| ≤ n |X − x| max(X, x)ⁿ⁻¹, where X = 1 − Y; 1 − Y rounds, and so do n − 1
            // products, by u of what they give.
            let constant = n * (off * steepest / 2.0 + off * off + 2.0 * U) * MORE;
            let slope = n * (off / steepest + 16.0 * U) * MORE;
            let tame = constant + slope * highlight.limit < 1.0 / 64.0;
            if tame {
                [constant, slope]
            } else {
                [f64::INFINITY, 0.0]
            }
        });
        Halfway {
            form: self.form(h.map(|component| component / radius)),
            direction: h.map(Bounded::value),
            errors,
            least: highlight.least_power,
            reach: (highlight.reach + part(self.off, h[1])) * MORE,
        }
    }
}

/// A sphere whose pixels are to be shaded.
pub(crate) struct RowSphere {
    pub(crate) center: f64,
    pub(crate) squared_radius: f64,
    pub(crate) off: RowOffset,
    /// The least s² of each zone.
    pub(crate) least: [f64; ZONES],
    known: Known,
    at: Vector<Bounded>,
    /// n·l, with n and l of length 1.
    pub(crate) light: LinearForm,
    /// 1/R.
    pub(crate) inverse_radius: f64,
    /// `None` where there is no highlight.
    pub(crate) halfway: Option<Halfway>,
    pub(crate) exponent: u32,
    /// Below this n·h, (n·h)ⁿ is below 2⁻⁵⁹.
    pub(crate) highlight: f64,
    pub(crate) color: Coefficients,
    /// In each zone, a bound on the error of any channel, but for what the power's adds.
    pub(crate) errors: [f64; ZONES],
    /// Whether points turned away from the light are in shadow, and not just without its diffuse
    /// part.
    pub(crate) shadows: bool,
}

/// What is multiplied in ambient + diffuse · max(0, n·l) + specular · max(0, n·h)ⁿ, times the
/// colour.
pub(crate) struct Coefficients {
    pub(crate) ambient: Cycle,
    pub(crate) diffuse: Cycle,
    pub(crate) specular: Cycle,
}

/// Red, green, blue, red and so on, as samples lie in memory: a vector of up to 8 lanes, from any
/// of the three on.
pub(crate) type Cycle = [f64; 8 + 2];

impl RowSphere {
    /// `color` is the sphere's, times the reflectance in the mirror.
    pub(crate) fn new(
        sphere: &Sphere<Bounded>,
        outline: &Ellipse,
        lighting: &Lighting,
        color: Vector<Bounded>,
        shadows: bool,
    ) -> RowSphere {
        let radius = sphere.radius.at_most() * MORE;
        // q = X − c_x rounds once, and |q| ≤ R where the sphere is hit.
        let across = (sphere.center.x.error() * (1.0 + U) + U * radius) * MORE;
        // s² = (R² − m²) − q²: |(q + ε)² − q²| ≤ 2|q|ε + ε², and the square and the difference
        // round.
        let squared =
            outline.chord_error + (2.0 * radius + across) * across + 2.0 * U * radius * radius;
        // |√A − √a| ≤ |A − a|/√a, and the root rounds.
        let out = DEPTHS.map(|depth| (squared * depth / radius + U * radius) * MORE);
        let known = Known {
            radius,
            across,
            off: outline.off_error,
            out,
        };
        let to_light = lighting.to_light_unit.map(|part| part / sphere.radius);
        let light = known.form(to_light);
        let highlight = &lighting.highlight;
        let halfway = lighting
            .halfway
            .map(|h| known.halfway(h, highlight, sphere.radius));
        // Where the power is below 2⁻⁵⁹ it is left out, or put at that. The form tells where that
        // is, if its error is no more than that of a factor of 1.05 in the power.
        let tiny = 4.0 * f64::from_bits((1023 - 59) << 52);
        let form_error = halfway.as_ref().map_or(0.0, |h| h.form.error);
        let tame = f64::from(highlight.exponent) * (form_error + U) < 1.0 / 64.0;
        let left_out = if tame { tiny } else { f64::INFINITY };
        let light_errors = known.out.map(|out| known.error(&to_light, out));
        let mut errors = [0.0_f64; ZONES];
        let mut channel = |color: Bounded, coefficients: [Bounded; 3]| {
            let parts = coefficients.map(|coefficient| coefficient * color);
            let [a, d, s] = parts;
            let magnitudes: f64 = parts.iter().map(|part| part.value().abs()).sum();
            let error = |light: f64| {
                let specular = if s.is_zero() {
                    0.0
                } else {
                    1.1 * s.error() + s.value().abs() * left_out
                };
                // |n·l| ≤ 1, but for its error; two products and two sums round.
                let diffuse = d.error() * (1.0 + light) + d.value().abs() * light;
                (a.error() + diffuse + specular + 8.0 * U * magnitudes) * MORE
            };
            for (all, light) in errors.iter_mut().zip(light_errors) {
                *all = error(light).max(*all);
            }
            // +0 for −0: a sum that begins with +0 is not −0.
            parts.map(|part| part.value() + 0.0)
        };
        let [red, green, blue] = lighting.coefficients;
        let channels = [
            channel(color.x, red),
            channel(color.y, green),
            channel(color.z, blue),
        ];
        let cycle = |part: usize| std::array::from_fn(|sample| channels[sample % 3][part]);
        RowSphere {
            center: sphere.center.x.value(),
            squared_radius: outline.squared_radius,
            off: outline.off,
            least: DEPTHS.map(|depth| (radius / depth) * (radius / depth) * MORE),
            known,
            at: sphere.center,
            light,
            inverse_radius: 1.0 / sphere.radius.value(),
            halfway,
            exponent: highlight.exponent,
            highlight: highlight.least,
            color: Coefficients {
                ambient: cycle(0),
                diffuse: cycle(1),
                specular: cycle(2),
            },
            errors,
            shadows,
        }
    }

    /// The pixels from the column at X to another, in the rows from that at Y to another.
    pub(crate) fn stretch(&self, x: (f64, f64), y: (f64, f64)) -> Stretch {
        let ends = |(a, b): (f64, f64)| if a < b { (a, b) } else { (b, a) };
        let m = ends((self.off.at(y.0), self.off.at(y.1)));
        let q = (x.0 - self.center, x.1 - self.center);
        let squares = |(low, high): (f64, f64)| {
            let (a, b) = ends((low * low, high * high));
            (if low < 0.0 && high > 0.0 { 0.0 } else { a }, b)
        };
        let (off, across) = (squares(m), squares(q));
        let s = |off: f64, across: f64| ((self.squared_radius - off) - across).max(0.0).sqrt();
        Stretch {
            m,
            q,
            s: (s(off.1, across.1), s(off.0, across.0)),
        }
    }

    /// How far the hit is inside a half-space, in units of its normal's length.
    pub(crate) fn inside(
        &self,
        half_space: &HalfSpace<Bounded>,
        lighting: &Lighting,
    ) -> LinearForm {
        let n = half_space.normal;
        let form = self.known.form(lighting.axes.of(n));
        form.plus(n.dot(self.at - half_space.at))
    }

    /// n × l, component by component, and −n·l, with n of the radius's length: what
    /// [`RowSphere::around`] has in common for all spheres.
    pub(crate) fn beside(&self, lighting: &Lighting) -> ([LinearForm; 3], LinearForm) {
        let moment = lighting.moment.map(|factors| self.known.form(factors));
        (moment, self.known.form(lighting.before))
    }

    /// The components of (hit − c) × l, and (c − hit)·l, for another sphere's centre c.
    pub(crate) fn around(
        &self,
        center: Vector<Bounded>,
        to_light: &Direction<Bounded>,
        ([x, y, z], before): &([LinearForm; 3], LinearForm),
    ) -> ([LinearForm; 3], LinearForm) {
        let l = to_light.vector;
        let from = self.at - center;
        let at = from.cross(l);
        let moment = [x.plus(at.x), y.plus(at.y), z.plus(at.z)];
        (moment, before.plus(-from.dot(l)))
    }
}
