//! What an observer sees of a pixel and its neighbours.
//!
//! The filters of the paper are products of a function of the row and one of the column, or sums of
//! two such products: they are applied to columns first, then along the row.

use std::f64::consts::PI;

use glam::DVec3;

use super::color::ColorSpace;
use super::neighborhood::Neighborhood;

/// What is seen at a pixel.
pub(super) struct Seen {
    /// Its colour, as [`ColorSpace::perceived`] gives it.
    pub(super) color: DVec3,
    /// How strong an edge of luminance there is.
    pub(super) edge: f64,
    /// How strong a point of luminance there is.
    pub(super) point: f64,
}

/// The weights of filters, each an odd number of them around a pixel.
pub(super) struct Filters {
    /// For luminance, and for red against green.
    contrast: [Vec<f64>; 2],
    /// For blue against yellow: the filter is a sum of two.
    blue_yellow: [Vec<f64>; 2],
    gaussian: Vec<f64>,
    edge: Vec<f64>,
    point: Vec<f64>,
}

impl Filters {
    pub(super) fn new(pixels_per_degree: f64) -> Filters {
        // The contrast that is seen, of the paper's colour pipeline: Gaussians
        // a √(π/b) exp(−π² d²/b) of the distance d in degrees.
        const WIDEST: f64 = 0.04;
        let sigmas = 3.0 * (WIDEST / 2.0).sqrt() / PI;
        let radius = (sigmas * pixels_per_degree).ceil();
        let gaussian = |a: f64, b: f64| {
            let height = (a * (PI / b).sqrt()).sqrt();
            let weight = |x: f64| {
                let degrees = x / pixels_per_degree;
                height * libm::exp(-PI * PI * degrees * degrees / b)
            };
            sampled(radius, weight)
        };
        let contrast = [gaussian(1.0, 0.0047), gaussian(1.0, 0.0053)];
        let blue_yellow = [gaussian(34.1, WIDEST), gaussian(13.5, 0.025)];
        let [first, second] = blue_yellow.each_ref().map(|part| part.iter().sum::<f64>());
        let sum = (first * first + second * second).sqrt();

        // Edges and points, of its feature pipeline: the first and the second derivative of a
        // Gaussian.
        let sigma = 0.5 * 0.082 * pixels_per_degree;
        let radius = (3.0 * sigma).ceil();
        let height = |x: f64| libm::exp(-x * x / (2.0 * sigma * sigma));
        Filters {
            contrast: contrast.map(balanced),
            blue_yellow: blue_yellow.map(|part| part.iter().map(|weight| weight / sum).collect()),
            gaussian: balanced(sampled(radius, height)),
            edge: balanced(sampled(radius, |x| -x * height(x))),
            point: balanced(sampled(radius, |x| {
                (x * x / (sigma * sigma) - 1.0) * height(x)
            })),
        }
    }

    /// How far the widest filter reaches from a pixel.
    pub(super) fn radius(&self) -> usize {
        let [luminance, red_green] = &self.contrast;
        let [first, second] = &self.blue_yellow;
        let features = [&self.gaussian, &self.edge, &self.point];
        let filters = [luminance, red_green, first, second].into_iter();
        let lengths = filters.chain(features).map(|weights| weights.len() / 2);
        lengths.max().unwrap_or_default()
    }

    /// What is seen at each pixel of a row.
    pub(super) fn seen(&self, around: &Neighborhood<'_>, colors: &ColorSpace) -> Vec<Seen> {
        let filtered = |opponent, weights: &[f64]| {
            let columns = around.sums_of_columns(opponent, weights);
            around.sums_along(&columns, weights)
        };
        let [luminance, red_green] = &self.contrast;
        let luminance = filtered(0, luminance);
        let red_green = filtered(1, red_green);
        let [first, second] = self.blue_yellow.each_ref().map(|part| filtered(2, part));

        let smooth = around.sums_of_columns(0, &self.gaussian);
        let features = [&self.edge, &self.point].map(|weights| {
            let along = around.sums_along(&smooth, weights);
            let columns = around.sums_of_columns(0, weights);
            let across = around.sums_along(&columns, &self.gaussian);
            let pairs = along.into_iter().zip(across);
            pairs
                .map(|(x, y)| (x * x + y * y).sqrt())
                .collect::<Vec<_>>()
        });
        let [edges, points] = features;
        let pixel = |i: usize| Seen {
            color: colors.perceived([luminance[i], red_green[i], first[i] + second[i]]),
            edge: edges[i],
            point: points[i],
        };
        (0..luminance.len()).map(pixel).collect()
    }
}

/// The weights from `-radius` to `radius` pixels.
fn sampled(radius: f64, weight: impl Fn(f64) -> f64) -> Vec<f64> {
    let radius = radius as i32;
    (-radius..=radius).map(|x| weight(x.into())).collect()
}

/// The weights, of which the positive ones have a sum of 1 now, and the negative ones of -1.
fn balanced(weights: Vec<f64>) -> Vec<f64> {
    let sum = |sign: f64| weights.iter().map(|weight| (sign * weight).max(0.0)).sum();
    let (positive, negative): (f64, f64) = (sum(1.0), sum(-1.0));
    let balanced = |weight| match weight < 0.0 {
        true => weight / negative,
        false => weight / positive,
    };
    weights.into_iter().map(balanced).collect()
}
