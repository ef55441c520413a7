//! Bounding balls of solids, and which of them can overlap.

use glam::DVec3;

use super::{Sphere, Tetrahedron};

/// 1 plus a relative error that fewer than 32 roundings in f64, each of at most 2⁻⁵³, do not reach.
pub(super) const MARGIN: f64 = 1.0 + 1e-12;

/// A bounding ball of a solid.
#[derive(Clone, Debug)]
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

/// The projections of balls onto a line, which tell which balls can overlap.
#[derive(Clone, Debug)]
pub(super) struct Projections {
    /// Where each projection begins and ends, and the number of its ball, in the order in which
    /// they begin.
    sorted: Vec<(f64, f64, usize)>,
    /// By the number of the ball, the index in `sorted`.
    places: Vec<usize>,
    /// The length of the longest.
    longest: f64,
}

impl Projections {
    /// The projections along `direction`, of length 1.
    pub(super) fn new(balls: &[BoundingBall], direction: DVec3) -> Self {
        let projection = |(number, ball): (usize, &BoundingBall)| {
            // More than rounding takes from a projection, and more than a rounded direction moves
            // it: so projections of balls that overlap do so by more than comparing them rounds.
            let slack = ball.center.abs().element_sum() * (MARGIN - 1.0);
            let half = ball.radius * MARGIN + slack;
            let middle = ball.center.dot(direction);
            (middle - half, middle + half, number)
        };
        let mut sorted: Vec<_> = balls.iter().enumerate().map(projection).collect();
        sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut places = vec![0; balls.len()];
        for (place, &(_, _, number)) in sorted.iter().enumerate() {
            places[number] = place;
        }
        let lengths = sorted.iter().map(|(begin, end, _)| end - begin);
        Projections {
            longest: lengths.fold(0.0, f64::max) * MARGIN,
            sorted,
            places,
        }
    }

    /// Calls `pair` with the numbers of any two balls whose projections may overlap.
    pub(super) fn each_overlapping_pair(&self, mut pair: impl FnMut(usize, usize)) {
        for (index, &(_, end, number)) in self.sorted.iter().enumerate() {
            let meets = |other: &&(f64, f64, usize)| other.0 <= end;
            for &(_, _, other) in self.sorted[index + 1..].iter().take_while(meets) {
                pair(number, other);
            }
        }
    }

    /// The numbers of the other balls whose projections may overlap that of this one.
    pub(super) fn overlapping(&self, number: usize) -> impl Iterator<Item = usize> {
        let place = self.places[number];
        let (begin, end, _) = self.sorted[place];
        let (before, after) = (&self.sorted[..place], &self.sorted[place + 1..]);
        // No projection is longer than `longest`, whose margin is more than a difference rounds:
        // what begins earlier than that ends before this one begins, and so does all before it.
        let begins_late = move |other: &&(f64, f64, usize)| other.0 + self.longest >= begin;
        let before = before.iter().rev().take_while(begins_late);
        let before = before.filter(move |other| other.1 >= begin);
        let after = after.iter().take_while(move |other| other.0 <= end);
        before.chain(after).map(|other| other.2)
    }
}
