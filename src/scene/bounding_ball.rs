//! Bounding balls of solids, and which of them can overlap.

use glam::DVec3;

use super::{Sphere, Tetrahedron};

/// 1 plus a relative error that fewer than 32 roundings in f64, each of at most 2⁻⁵³, do not reach.
pub(super) const MARGIN: f64 = 1.0 + 1e-12;

/// A bounding ball of a solid.
pub(super) struct BoundingBall {
    pub(super) center: DVec3,
    pub(super) radius: f64,
}

impl BoundingBall {
    /// More than what rounding takes from a distance between points of this ball and another one.
    pub(super) fn slack(&self, other: &BoundingBall) -> f64 {
        (self.center.abs() + other.center.abs()).element_sum() * (MARGIN - 1.0)
    }
}

/// The bounding balls of all solids, spheres first.
pub(super) fn bounding_balls(spheres: &[Sphere], tetrahedra: &[Tetrahedron]) -> Vec<BoundingBall> {
    let of_sphere = |sphere: &Sphere| BoundingBall {
        center: sphere.center,
        radius: sphere.radius,
    };
    let of_tetrahedron = |tetrahedron: &Tetrahedron| {
        let center = tetrahedron.vertices.iter().sum::<DVec3>() / 4.0;
        let distances = tetrahedron.vertices.map(|vertex| vertex.distance(center));
        BoundingBall {
            center,
            radius: distances.into_iter().fold(0.0, f64::max) * MARGIN,
        }
    };
    let spheres = spheres.iter().map(of_sphere);
    spheres
        .chain(tetrahedra.iter().map(of_tetrahedron))
        .collect()
}

/// Calls `pair` with the numbers of any two balls whose projections onto a line along `direction`,
/// of length 1, may overlap.
pub(super) fn each_overlapping_pair(
    balls: &[BoundingBall],
    direction: DVec3,
    mut pair: impl FnMut(usize, usize),
) {
    let mut projections: Vec<(f64, f64, usize)> = balls
        .iter()
        .enumerate()
        .map(|(number, ball)| {
            let slack = ball.center.abs().element_sum() * (MARGIN - 1.0);
            let half = ball.radius * MARGIN + slack;
            let middle = ball.center.dot(direction);
            (middle - half, middle + half, number)
        })
        .collect();
    projections.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    for (index, &(_, end, number)) in projections.iter().enumerate() {
        let meets = |other: &&(f64, f64, usize)| other.0 <= end;
        for &(_, _, other) in projections[index + 1..].iter().take_while(meets) {
            pair(number, other);
        }
    }
}
