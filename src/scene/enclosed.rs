//! Which solids lie inside of others: where all solids take part, neither they nor their shadows
//! are seen.
//!
//! Every ray begins outside of all solids, or leaves a solid that is seen. So a ray meets a solid
//! before it meets another one inside; where it meets both at once, the earlier in the scene's
//! order is seen.

use std::cmp::Ordering;

use dashu_ratio::Relaxed;
use glam::DVec3;

use super::bounding_ball::{MARGIN, Projections, bounding_balls};
use super::rational::{Plane, dot, exact, minus, sign};
use super::{FACES, Solid, Sphere, Tetrahedron};

/// For each solid, spheres first, whether it lies inside of another, and is hidden also at points
/// that both have in common.
pub(super) fn enclosed(spheres: &[Sphere], tetrahedra: &[Tetrahedron]) -> Vec<bool> {
    let balls = bounding_balls(spheres, tetrahedra);
    let solid = |number| Solid::numbered(number, spheres, tetrahedra);
    let mut enclosed = vec![false; balls.len()];
    Projections::new(&balls, DVec3::X).each_overlapping_pair(|a, b| {
        for (inner, outer) in [(a, b), (b, a)] {
            let (small, large) = (&balls[inner], &balls[outer]);
            let slack = small.slack(large);
            let distance = small.center.distance(large.center);
            // A tetrahedron may lie inside although its ball does not.
            let may = match (solid(inner), solid(outer)) {
                (Solid::Sphere(_), _) => distance + small.radius <= large.radius * MARGIN + slack,
                (Solid::Tetrahedron(_), _) => distance <= large.radius * MARGIN + slack,
            };
            if may && !enclosed[inner] && !enclosed[outer] {
                enclosed[inner] = is_inside(solid(inner), solid(outer), outer < inner);
            }
        }
    });
    enclosed
}

/// Whether a solid lies inside of another: in its interior or, if `closed`, also on its border.
fn is_inside(
    inner: Solid<&Sphere, &Tetrahedron>,
    outer: Solid<&Sphere, &Tetrahedron>,
    closed: bool,
) -> bool {
    let is_in = |distance: &Relaxed| match sign(distance) {
        Ordering::Greater => true,
        Ordering::Equal => closed,
        Ordering::Less => false,
    };
    let number = |x: f64| Relaxed::try_from(x).unwrap_or(Relaxed::ZERO);
    match (inner, outer) {
        (Solid::Sphere(inner), Solid::Sphere(outer)) => {
            let between = minus(&exact(inner.center), &exact(outer.center));
            let gap = number(outer.radius) - number(inner.radius);
            !sign(&gap).is_lt() && is_in(&(&gap * &gap - dot(&between, &between)))
        }
        (Solid::Tetrahedron(inner), Solid::Sphere(outer)) => {
            let (center, radius) = (exact(outer.center), number(outer.radius));
            inner.vertices.iter().all(|vertex| {
                let from = minus(&exact(*vertex), &center);
                is_in(&(&radius * &radius - dot(&from, &from)))
            })
        }
        (inner, Solid::Tetrahedron(outer)) => {
            let points: Vec<DVec3> = match inner {
                Solid::Sphere(sphere) => vec![sphere.center],
                Solid::Tetrahedron(tetrahedron) => tetrahedron.vertices.to_vec(),
            };
            let radius = match inner {
                Solid::Sphere(sphere) => number(sphere.radius),
                Solid::Tetrahedron(_) => Relaxed::ZERO,
            };
            // Most points are far outside, as f64 tells.
            let beyond = |point: &DVec3| {
                (0..4).any(|k: usize| {
                    let [a, b, c] = FACES[k].map(|vertex| outer.vertices[vertex]);
                    let normal = (b - a).cross(c - a);
                    let side = |p: DVec3| normal.dot(p - a);
                    let scale = normal.length() * (point.abs() + a.abs()).element_sum();
                    let own = side(outer.vertices[k]);
                    side(*point) * own.signum() < -1e-6 * scale
                })
            };
            if points.iter().any(beyond) {
                return false;
            }
            let vertices = outer.vertices.map(exact);
            (0..4).all(|k| {
                let plane = Plane::of_face(&vertices, k);
                let length = dot(&plane.normal, &plane.normal);
                points.iter().all(|point| {
                    let distance = &plane.offset - dot(&plane.normal, &exact(*point));
                    // distance/√length > radius.
                    !sign(&distance).is_lt()
                        && is_in(&(&distance * &distance - &length * &radius * &radius))
                })
            })
        }
    }
}
