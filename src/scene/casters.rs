//! Which solids can throw a shadow on which: no turning of the scene changes that, and most cannot.

use glam::DVec3;

use super::{Sphere, Tetrahedron};

/// A ball that holds a solid.
struct Hull {
    center: DVec3,
    radius: f64,
}

/// For each solid, spheres first, the other solids that may stand between a point of it and the
/// light; all others certainly do not.
pub(super) fn casters(
    spheres: &[Sphere],
    tetrahedra: &[Tetrahedron],
    to_light: DVec3,
) -> Vec<Vec<u16>> {
    // Everything below is computed in f64 in fewer than 32 roundings, each off by at most 2⁻⁵³ of
    // the numbers that go in: a millionth of a millionth more is far more than they add up to.
    const MORE: f64 = 1.0 + 1e-12;
    let hulls = spheres.iter().map(|sphere| Hull {
        center: sphere.center,
        radius: sphere.radius,
    });
    let hulls: Vec<Hull> = hulls
        .chain(tetrahedra.iter().map(|tetrahedron| {
            let center = tetrahedron.vertices.iter().sum::<DVec3>() / 4.0;
            let distances = tetrahedron.vertices.map(|vertex| vertex.distance(center));
            Hull {
                center,
                radius: distances.into_iter().fold(0.0, f64::max) * MORE,
            }
        }))
        .collect();
    let l = to_light.normalize();
    let may = |caster: &Hull, receiver: &Hull| {
        let between = caster.center - receiver.center;
        let slack = (caster.center.abs() + receiver.center.abs()).element_sum() * (MORE - 1.0);
        let reach = (caster.radius + receiver.radius) * MORE + slack;
        between.dot(l) >= -reach && between.cross(l).length() <= reach
    };
    let of = |receiver: usize| {
        let others = (0..hulls.len()).filter(|&other| other != receiver);
        others
            .filter(|&other| may(&hulls[other], &hulls[receiver]))
            .map(|other| other as u16)
            .collect()
    };
    (0..hulls.len()).map(of).collect()
}
