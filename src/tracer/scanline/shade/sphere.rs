//! A sphere in a row: the f64s that its pixels are shaded with, and bounds on their errors.
//!
//! A hit's normal, of the radius's length, has the coordinates q, m and s along three axes:
//!
//! q (1, 0, 0) + m (0, 10, −3)/√109 + s (0, 3, 10)/√109, s = √(R² − m² − q²).
//!
//! This follows from `sphere.rs` with d = −(0, 3, 10). q = X − c_x depends on the column and m on
//! the row, as in `edges/ellipses.rs`; s is toward the eye. So n·l, n·h and every plane's equation
//! at the hit are linear forms in q, m and s, and a pixel costs a root, a few products and sums.

use std::cmp::Ordering;

use crate::number::rounding::{INFLATION, U};
use crate::number::{Bounded, Divisor, Real};
use crate::tracer::half_space::HalfSpace;
use crate::tracer::scanline::edges::ellipse::{Ellipse, RowOffset};
use crate::tracer::scanline::shade::light::{Highlight, Lighting};
use crate::tracer::sphere::Sphere;
use crate::tracer::vector::Vector;

/// The zones of a sphere, from the middle of its outline to the rim: s ≥ R/8, s ≥ R/128, and s ≥
/// R/16384. A root multiplies errors by 1/s, so each zone has bounds of its own; what lies beyond
/// the last zone is left in doubt.
pub(crate) const ZONES: usize = 3;

/// R over the smallest s of each zone.
const ZONE_DIVISORS: [f64; ZONES] = [8.0, 128.0, 16384.0];

/// s² is computed with and without fused operations. They differ by less than 4u R², which is no
/// more than 2⁻²³ of the smallest s² of any zone.
const FUSED_MARGIN: f64 = 1.0 + 1.0 / (1 << 22) as f64;

/// The radius below which a sphere is small, in thirds of a pixel.
const SMALL: f64 = 30.0;

/// A linear form in the coordinates of a normal: constant + a_q q + a_m m + a_s s.
#[derive(Clone, Copy)]
pub(crate) struct LinearForm {
    pub(crate) constant: f64,
    /// a_q.
    pub(crate) q: f64,
    /// a_m.
    pub(crate) m: f64,
    /// a_s.
    pub(crate) s: f64,
    /// A bound on the error of the form in f64, in any zone.
    pub(crate) error: f64,
    /// Whether a_s is certainly not negative, or certainly not positive: then the form is concave,
    /// or convex, along a row.
    pub(crate) is_concave: Option<bool>,
}

impl LinearForm {
    /// A form whose sign is always in doubt; shaders without bounds take it for negative.
    pub(crate) const IN_DOUBT: LinearForm = LinearForm {
        constant: -1.0,
        q: 0.0,
        m: 0.0,
        s: 0.0,
        error: f64::INFINITY,
        is_concave: None,
    };

    /// The sum of a form without a constant and of `constant`.
    fn plus(self, constant: Bounded) -> LinearForm {
        let magnitude = constant.value().abs();
        LinearForm {
            constant: constant.value(),
            error: self.error + (constant.error() + 8.0 * U * magnitude) * INFLATION,
            ..self
        }
    }

    /// The part of the form that is the same in all pixels of a row.
    pub(crate) fn of_row(&self, m: f64) -> f64 {
        self.constant + self.m * m
    }

    /// The interval of the values that f64 computes for the pixels of a box without fused
    /// operations. Rounding is monotonic, so the same operations on the ends of the coordinates
    /// give the ends of the interval. `error` bounds how far either of them is from the truth.
    pub(crate) fn range(&self, hits: &HitBox) -> (f64, f64) {
        let ends = |factor: f64, (low, high): (f64, f64)| {
            let (a, b) = (low * factor, high * factor);
            (a.min(b), a.max(b))
        };
        let m = ends(self.m, hits.m);
        let q = ends(self.q, hits.q);
        let s = ends(self.s, hits.s);
        (
            self.constant + m.0 + q.0 + s.0,
            self.constant + m.1 + q.1 + s.1,
        )
    }

    /// Whether the form is certainly less than 0 in every pixel of a box.
    pub(crate) fn is_negative(&self, hits: &HitBox) -> bool {
        self.range(hits).1 < -self.error
    }
}

/// The intervals of m, q and s of some pixels of a sphere, as f64 computes them.
pub(crate) struct HitBox {
    m: (f64, f64),
    q: (f64, f64),
    s: (f64, f64),
}

/// The magnitudes and the errors of a form's factors.
fn sizes(factors: &[Bounded; 3]) -> [(f64, f64); 3] {
    factors.map(|factor| (factor.value().abs(), factor.error()))
}

/// The highlight of a sphere.
pub(crate) struct SphereHighlight {
    /// n·h.
    pub(crate) form: LinearForm,
    /// In each zone, a bound on n times the error of 1 − n·h, times the largest coefficient of any
    /// channel: a constant and a factor of 1 − n·h.
    pub(crate) errors: [[f64; 2]; ZONES],
    /// The largest difference of m/R and that of h at which there is a highlight.
    pub(crate) max_distance: f64,
}

/// The centre of a sphere, and bounds on q, m and s of any pixel.
pub(crate) struct HitBounds {
    pub(crate) center: Vector<Bounded>,
    /// A bound on the magnitude of each.
    radius: f64,
    /// Bounds on their errors; that of s in each zone.
    q_error: f64,
    m_error: f64,
    s_errors: [f64; ZONES],
}

impl HitBounds {
    /// Those of a sphere with this outline.
    pub(crate) fn new(sphere: &Sphere<Bounded>, outline: &Ellipse) -> HitBounds {
        let radius = sphere.radius.at_most() * INFLATION;
        // q = X − c_x rounds once, and |q| ≤ R where the sphere is hit.
        let q_error = (sphere.center.x.error() * (1.0 + U) + U * radius) * INFLATION;
        // s² = (R² − m²) − q²: |(q + ε)² − q²| ≤ 2|q|ε + ε², and the square and the difference
        // round.
        let squared =
            outline.chord_error + (2.0 * radius + q_error) * q_error + 2.0 * U * radius * radius;
        // |√A − √a| ≤ |A − a|/√a, and the root rounds.
        let over_radius = squared / radius;
        let s_errors =
            ZONE_DIVISORS.map(|divisor| (over_radius * divisor + U * radius) * INFLATION);
        HitBounds {
            center: sphere.center,
            radius,
            q_error,
            m_error: outline.m_error,
            s_errors,
        }
    }

    /// The form vector · n, of a vector in the axes of q, m and s.
    fn form(&self, factors: [Bounded; 3]) -> LinearForm {
        LinearForm {
            constant: 0.0,
            q: factors[0].value(),
            m: factors[1].value(),
            s: factors[2].value(),
            error: self.errors(sizes(&factors))[ZONES - 1],
            is_concave: factors[2].sign().ok().map(Ordering::is_ge),
        }
    }

    /// A bound on the magnitude of a form without a constant, whose factors have these sizes.
    pub(crate) fn magnitude(&self, [q, m, s]: [(f64, f64); 3]) -> f64 {
        (q.0 + m.0 + s.0) * self.radius
    }

    /// In each zone, a bound on the error of such a form.
    pub(crate) fn errors(&self, sizes: [(f64, f64); 3]) -> [f64; ZONES] {
        // AB − ab = α B + a β + …; three products and three sums round, each by less than u of the
        // sum of all magnitudes.
        let carried = |(magnitude, factor_error): (f64, f64), error: f64| {
            factor_error * (self.radius + error) + magnitude * error
        };
        let [q, m, s] = sizes;
        let rounded = 8.0 * U * self.magnitude(sizes);
        let others = carried(q, self.q_error) + carried(m, self.m_error) + rounded;
        self.s_errors
            .map(|error| (others + carried(s, error)) * INFLATION)
    }

    /// The distance of the hit from the border of a half-space, positive inside, in units of the
    /// length of the half-space's normal.
    pub(crate) fn inside(
        &self,
        half_space: &HalfSpace<Bounded>,
        lighting: &Lighting,
    ) -> LinearForm {
        let n = half_space.normal;
        let form = self.form(lighting.axes.of(n));
        form.plus(n.dot(self.center - half_space.at))
    }

    /// The highlight of a sphere of this radius, where `h` is that of the view, `form` is n·h, and
    /// `specular` is the largest coefficient of any channel.
    fn highlight(
        &self,
        (h, form): ([Bounded; 3], LinearForm),
        highlight: &Highlight,
        radius: Bounded,
        specular: f64,
    ) -> SphereHighlight {
        // 1 − n·h is computed as Y = |D|²/2, where D = n − h = (q, m, s)/R − h. Let ε be the error
        // of D without the rounding of its three differences, which is less than u of D. Then the
        // error of Y is at most |D| |ε| + |ε|² + 16u Y. |D| = √(2Y) is at most (δ + 2Y/δ)/2 for any
        // δ > 0, which is linear in Y, and equal to |D| where δ² = 2Y. δ = 1/√n, where the
        // highlight is steepest.
        let n = f64::from(highlight.exponent);
        let steepest = highlight.steepest;
        // No component of n is more than 1. 1/R and the product with it round.
        let inverse = 1.0 / radius.value();
        let scaled = radius.error() * inverse + 3.0 * U;
        let part = |error: f64, h: Bounded| error * inverse + h.error() + scaled;
        let (q, m) = (part(self.q_error, h[0]), part(self.m_error, h[1]));
        let mut errors = [[0.0; 2]; ZONES];
        for (errors, s_error) in errors.iter_mut().zip(self.s_errors) {
            let error = (q + m + part(s_error, h[2])) * INFLATION;
            // |Xⁿ − xⁿ| ≤ n |X − x| max(X, x)ⁿ⁻¹, where X = 1 − Y; 1 − Y rounds, and so do n − 1
            // products, by u of what they give.
            let constant = n * (error * steepest / 2.0 + error * error + 2.0 * U) * INFLATION;
            let slope = n * (error / steepest + 16.0 * U) * INFLATION;
            let is_small = constant + slope * highlight.one_minus_threshold < 1.0 / 64.0;
            let constant = if is_small { constant } else { f64::INFINITY };
            *errors = [constant * specular, slope * specular];
        }
        SphereHighlight {
            form,
            errors,
            max_distance: (highlight.max_distance + m) * INFLATION,
        }
    }
}

/// What the shading of a sphere depends on and all of its pixels share.
pub(crate) struct SphereConstants<'f> {
    /// c_x.
    pub(crate) center_x: f64,
    /// R².
    pub(crate) squared_radius: f64,
    /// m of each row.
    pub(crate) m: RowOffset,
    /// The smallest s² of each zone.
    pub(crate) min_squares: [f64; ZONES],
    /// What all spheres of the view share.
    pub(crate) lighting: &'f Lighting,
    /// n·l, with n and l of length 1.
    pub(crate) n_dot_l: LinearForm,
    /// 1/R.
    pub(crate) inverse_radius: f64,
    /// `None` where there is no highlight.
    pub(crate) highlight: Option<SphereHighlight>,
    pub(crate) color: Coefficients,
    /// In each zone, a bound on the error of any channel without that of the highlight.
    pub(crate) errors: [f64; ZONES],
    /// Whether its pixels are so few that each finds out its zone, its side and its highlight.
    pub(crate) is_small: bool,
    /// Whether there are shadows in this stage; without, a point turned away from the light has its
    /// ambient and specular light.
    pub(crate) has_shadows: bool,
}

/// The coefficients of ambient + diffuse · max(0, n·l) + specular · max(0, n·h)ⁿ, times the
/// sphere's colour.
pub(crate) struct Coefficients {
    pub(crate) ambient: [f64; 3],
    pub(crate) diffuse: [f64; 3],
    pub(crate) specular: [f64; 3],
    /// If the colour, or the light, does not have some channel, whether it does not have each: then
    /// its samples are 0 without error.
    pub(crate) is_absent: Option<[bool; 3]>,
}

impl<'f> SphereConstants<'f> {
    /// `bounds` are those of the sphere, `color` is its colour, in the mirror times the
    /// reflectance.
    pub(crate) fn new(
        sphere: &Sphere<Bounded>,
        outline: &Ellipse,
        bounds: &HitBounds,
        lighting: &'f Lighting,
        color: Vector<Bounded>,
        has_shadows: bool,
    ) -> SphereConstants<'f> {
        let divisor = Divisor::new(sphere.radius);
        let to_light = lighting.to_light_unit.map(|part| divisor.divide(part));
        let n_dot_l = bounds.form(to_light);
        let highlight = &lighting.highlight;
        let n_dot_h = lighting
            .halfway
            .map(|h| (h, bounds.form(h.map(|part| divisor.divide(part)))));
        // A power below 2⁻⁵⁹ is left out, or replaced by 2⁻⁵⁹. The form tells such powers, if its
        // error changes the power by no more than a factor of 1.05.
        let tiny = 4.0 * f64::from_bits((1023 - 59) << 52);
        let form_error = n_dot_h.map_or(0.0, |(_, form)| form.error);
        let is_small = f64::from(highlight.exponent) * (form_error + U) < 1.0 / 64.0;
        let left_out = if is_small { tiny } else { f64::INFINITY };
        // The largest of each part of the bound among all channels.
        let (mut carried, mut diffuse, mut rest) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut channel = |color: Bounded, coefficients: [Bounded; 3]| {
            let [a, d, s] = coefficients.map(|coefficient| coefficient.value() * color.value());
            let magnitudes = a.abs() + d.abs() + s.abs();
            let sum = |of: fn(Bounded) -> f64| coefficients.map(of).iter().sum::<f64>();
            // AB − ab = α B + a β + …, for all three products together.
            let of_color = sum(|x| x.value().abs()) * color.error()
                + sum(Bounded::error) * (color.value().abs() + color.error());
            let specular = if s == 0.0 { 0.0 } else { s.abs() * left_out };
            carried = carried.max(of_color);
            diffuse = diffuse.max(d.abs());
            rest = rest.max(specular + 10.0 * U * magnitudes);
            // −0 becomes +0, so that no sample is −0.
            [a + 0.0, d + 0.0, s + 0.0]
        };
        let [red, green, blue] = lighting.coefficients;
        let channels = [
            channel(color.x, red),
            channel(color.y, green),
            channel(color.z, blue),
        ];
        let specular = channels.iter().fold(0.0_f64, |a, [.., s]| a.max(s.abs()));
        // |n·l| ≤ 1, but for its error, and a power is at most 1.1 of its own; three products
        // round, then two products and two sums, and at last the sum of a sample and its bound.
        let errors = bounds
            .errors(sizes(&to_light))
            .map(|light| ((1.1 + light) * carried + diffuse * light + rest) * INFLATION);
        let is_absent =
            [(color.x, red), (color.y, green), (color.z, blue)].map(|(color, coefficients)| {
                color.is_zero() || coefficients.iter().all(|coefficient| coefficient.is_zero())
            });
        let part = |part: usize| channels.map(|channel| channel[part]);
        SphereConstants {
            center_x: sphere.center.x.value(),
            squared_radius: outline.squared_radius,
            m: outline.m,
            min_squares: ZONE_DIVISORS.map(|divisor| {
                (bounds.radius / divisor) * (bounds.radius / divisor) * FUSED_MARGIN
            }),
            lighting,
            n_dot_l,
            inverse_radius: 1.0 / sphere.radius.value(),
            highlight: n_dot_h
                .map(|n_dot_h| bounds.highlight(n_dot_h, highlight, sphere.radius, specular)),
            color: Coefficients {
                ambient: part(0),
                diffuse: part(1),
                specular: part(2),
                is_absent: is_absent.contains(&true).then_some(is_absent),
            },
            errors,
            is_small: bounds.radius < SMALL,
            has_shadows,
        }
    }

    /// The box of the pixels in these intervals of X and Y. m and q are linear in Y and X, and s² =
    /// R² − m² − q² falls with |m| and |q|: so the ends of each are those of the pixels at the ends
    /// of the intervals, or at m = 0 and q = 0. Rounding is monotonic, as in [`LinearForm::range`].
    pub(crate) fn hit_box(&self, x: (f64, f64), y: (f64, f64)) -> HitBox {
        let ends = |(a, b): (f64, f64)| if a < b { (a, b) } else { (b, a) };
        let m = ends((self.m.at(y.0), self.m.at(y.1)));
        let q = (x.0 - self.center_x, x.1 - self.center_x);
        let squares = |(low, high): (f64, f64)| {
            let (a, b) = ends((low * low, high * high));
            (if low < 0.0 && high > 0.0 { 0.0 } else { a }, b)
        };
        let (m_squares, q_squares) = (squares(m), squares(q));
        let s = |m: f64, q: f64| ((self.squared_radius - m) - q).max(0.0).sqrt();
        HitBox {
            m,
            q,
            s: (s(m_squares.1, q_squares.1), s(m_squares.0, q_squares.0)),
        }
    }
}
