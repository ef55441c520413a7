//! Balls that hold solids, and which of them can meet.

use glam::DVec3;

use super::{Sphere, Tetrahedron};

/// What is computed in f64 of a scene's coordinates in fewer than 32 roundings is off by at most
/// 32 · 2⁻⁵³ of the numbers that go in: a millionth of a millionth more is far more than that.
pub(super) const MORE: f64 = 1.0 + 1e-12;

/// A ball that holds a solid.
pub(super) struct Hull {
    pub(super) center: DVec3,
    pub(super) radius: f64,
}

/// Those of all solids, spheres first.
pub(super) fn hulls(spheres: &[Sphere], tetrahedra: &[Tetrahedron]) -> Vec<Hull> {
    let of_sphere = |sphere: &Sphere| Hull {
        center: sphere.center,
        radius: sphere.radius,
    };
    let of_tetrahedron = |tetrahedron: &Tetrahedron| {
        let center = tetrahedron.vertices.iter().sum::<DVec3>() / 4.0;
        let distances = tetrahedron.vertices.map(|vertex| vertex.distance(center));
        Hull {
            center,
            radius: distances.into_iter().fold(0.0, f64::max) * MORE,
        }
    };
    let spheres = spheres.iter().map(of_sphere);
    spheres
        .chain(tetrahedra.iter().map(of_tetrahedron))
        .collect()
}

/// Calls `pair` with the numbers of any two hulls whose shadows on a line along `way`, of length 1,
/// may have a point in common.
pub(super) fn each_pair_along(hulls: &[Hull], way: DVec3, mut pair: impl FnMut(usize, usize)) {
    let mut shadows: Vec<(f64, f64, usize)> = hulls
        .iter()
        .enumerate()
        .map(|(number, hull)| {
            let slack = hull.center.abs().element_sum() * (MORE - 1.0);
            let reach = hull.radius * MORE + slack;
            let middle = hull.center.dot(way);
            (middle - reach, middle + reach, number)
        })
        .collect();
    shadows.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    for (place, &(_, end, number)) in shadows.iter().enumerate() {
        let meets = |other: &&(f64, f64, usize)| other.0 <= end;
        for &(_, _, other) in shadows[place + 1..].iter().take_while(meets) {
            pair(number, other);
        }
    }
}
