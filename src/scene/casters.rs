//! Which solids can throw a shadow on which: no turning of the scene changes that, and most cannot.

use glam::DVec3;

use super::hull::{Hull, MORE, each_pair_along, hulls};
use super::{Sphere, Tetrahedron};

/// For each solid, spheres first, the other solids that may stand between a point of it and the
/// light; all others certainly do not. Nobody asks of hidden ones: what these shade, what hides
/// them does.
pub(super) fn casters(
    spheres: &[Sphere],
    tetrahedra: &[Tetrahedron],
    to_light: DVec3,
    hidden: &[bool],
) -> Vec<Vec<u16>> {
    let hulls = hulls(spheres, tetrahedra);
    let l = to_light.normalize();
    let mut all: Vec<Vec<u16>> = vec![Vec::new(); hulls.len()];
    each_pair_along(&hulls, l.any_orthonormal_vector(), |a, b| {
        if hidden[a] || hidden[b] {
            return;
        }
        let Hull { center, radius } = hulls[a];
        let other = &hulls[b];
        let between = other.center - center;
        let slack = (other.center.abs() + center.abs()).element_sum() * (MORE - 1.0);
        let reach = (other.radius + radius) * MORE + slack;
        if between.cross(l).length_squared() <= reach * reach * MORE {
            let ahead = between.dot(l);
            if ahead >= -reach {
                all[a].push(b as u16);
            }
            if ahead <= reach {
                all[b].push(a as u16);
            }
        }
    });
    for casters in &mut all {
        casters.sort_unstable();
    }
    all
}
