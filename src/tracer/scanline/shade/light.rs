//! The light of a view in the axes of q, m and s, as in `shade/sphere.rs`: the same for all
//! spheres.

use crate::number::rounding::INFLATION;
use crate::number::{Bounded, Real};
use crate::tracer::line::Direction;
use crate::tracer::shading::Shading;
use crate::tracer::vector::Vector;
use crate::tracer::view_space::{EYE_SQUARED, EYE_Y, EYE_Z};

/// The logarithm of a power that is too small to be seen: e⁻⁴¹ < 2⁻⁵⁹.
const CUT: f64 = -41.0;

/// The axes of q, m and s: (1, 0, 0), (0, 10, −3)/√109 and (0, 3, 10)/√109.
#[derive(Clone, Copy)]
pub(crate) struct Axes {
    /// 3/√109 and 10/√109.
    three: Bounded,
    ten: Bounded,
}

impl Axes {
    fn new() -> Axes {
        let root = Bounded::exact(EYE_SQUARED).sqrt();
        let [three, ten] = [EYE_Y, EYE_Z].map(|part| Bounded::exact(part) / root);
        Axes { three, ten }
    }

    /// The coordinates of a vector along these axes.
    pub(crate) fn of(self, vector: Vector<Bounded>) -> [Bounded; 3] {
        [
            vector.x,
            self.ten * vector.y - self.three * vector.z,
            self.three * vector.y + self.ten * vector.z,
        ]
    }
}

/// Equation 4-1 for the spheres of a view.
pub(crate) struct Lighting {
    pub(crate) axes: Axes,
    /// l, of length 1.
    pub(crate) to_light_unit: [Bounded; 3],
    /// The direction to the light, of any length.
    pub(crate) to_light: Direction<Bounded>,
    /// The vectors whose products with n are the components of n × l, and −n·l, with that l.
    pub(crate) moment: [[f64; 3]; 4],
    /// The largest magnitude and the largest error of their components along each axis.
    pub(crate) moment_sizes: [(f64, f64); 3],
    /// h, of length 1; `None` where there is no highlight.
    pub(crate) halfway: Option<[Bounded; 3]>,
    pub(crate) highlight: Highlight,
    /// For red, green and blue: the coefficients of ambient light, n·l and (n·h)ⁿ.
    pub(crate) coefficients: [[Bounded; 3]; 3],
}

/// The highlight of all spheres of a view.
pub(crate) struct Highlight {
    /// h, of length 1; 0 where there is no highlight.
    pub(crate) halfway: [f64; 3],
    /// n.
    pub(crate) exponent: u32,
    /// Below this n·h, (n·h)ⁿ is below 2⁻⁵⁹.
    pub(crate) threshold: f64,
    /// 1 − n·h at the threshold.
    pub(crate) one_minus_threshold: f64,
    /// A bound on |n − h| where a highlight can be seen.
    pub(crate) max_distance: f64,
    /// |n − h| where a highlight is steepest.
    pub(crate) steepest: f64,
    /// 2¹⁻ⁿ.
    pub(crate) smallest_power: f64,
}

impl Lighting {
    pub(crate) fn new(shading: &Shading<Bounded>) -> Lighting {
        let axes = Axes::new();
        let l = shading.to_light.vector;
        let zero = Bounded::exact(0.0);
        let moment = [
            Vector::new(zero, l.z, -l.y),
            Vector::new(-l.z, zero, l.x),
            Vector::new(l.y, -l.x, zero),
            -l,
        ]
        .map(|vector| axes.of(vector));
        let largest = |axis: usize, of: fn(Bounded) -> f64| {
            let along = moment.iter().map(|vector| of(vector[axis]));
            along.fold(0.0, f64::max)
        };
        let halfway = shading.halfway().map(|h| axes.of(h));
        let exponent = shading.exponent();
        let n = f64::from(exponent);
        // (1 − x)ⁿ ≤ e^−nx.
        let threshold = libm::exp(CUT / n);
        let one_minus_threshold = 1.0 - threshold;
        Lighting {
            axes,
            to_light_unit: axes.of(shading.to_light_unit()),
            to_light: shading.to_light,
            moment: moment.map(|vector| vector.map(Bounded::value)),
            moment_sizes: [0, 1, 2].map(|axis| {
                let magnitude = largest(axis, |x| x.value().abs());
                (magnitude, largest(axis, Bounded::error))
            }),
            halfway,
            highlight: Highlight {
                halfway: halfway.unwrap_or([zero; 3]).map(Bounded::value),
                exponent,
                threshold,
                one_minus_threshold,
                // 1 − n·h = |n − h|²/2.
                max_distance: (2.0 * one_minus_threshold).sqrt() * INFLATION,
                steepest: 1.0 / n.sqrt(),
                smallest_power: libm::exp2(1.0 - n),
            },
            coefficients: shading.coefficients(),
        }
    }
}
