//! What is found out about a scene once: facts that exact rational arithmetic decides, and lists of
//! what may cast a shadow on what, found in f64 with room to spare.

use std::cmp::Ordering;
use std::collections::HashMap;

use glam::DVec3;

use super::casters::Casters;
use super::enclosed::enclosed;
use super::rational::{Plane, cross, dot, exact, minus, sign};
use super::surface_casters::SurfaceCasters;
use super::{Sphere, Surface, Tetrahedron};

/// The sign of six times the signed volume, (b − a) · ((c − a) × (d − a)): equal where the four
/// points lie in one plane.
pub(super) fn orientation(vertices: [DVec3; 4]) -> Ordering {
    let [a, b, c, d] = vertices.map(exact);
    sign(&dot(&minus(&b, &a), &cross(&minus(&c, &a), &minus(&d, &a))))
}

/// The supporting plane of a face or of the surface, or the boundary of a sphere, by a number that
/// is equal for equal planes and spheres.
///
/// Two faces in one plane, a solid listed twice, a base that lies in the surface: at most angles no
/// number of digits would show that depths are equal there, and the tie covers an area.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Support(u32);

/// The facts of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Facts {
    /// The boundary of each sphere.
    pub(crate) spheres: Vec<Support>,
    /// Whether the edges 0→1, 0→2, 0→3 of each tetrahedron are right-handed.
    pub(crate) right_handed: Vec<bool>,
    /// The plane of each face of each tetrahedron.
    pub(crate) faces: Vec<[Support; 4]>,
    /// The plane of the surface.
    pub(crate) surface: Option<Support>,
    /// The sign of n·l for each face. Turning the scene does not change it.
    pub(crate) facing_light: Vec<[Ordering; 4]>,
    /// The side of the surface that each solid is on, spheres first; `Above` without a surface.
    pub(crate) sides: Vec<Side>,
    /// For each solid, spheres first, whether it lies inside of another. Then neither the solid nor
    /// its shadow is seen in stages where all solids take part.
    pub(crate) enclosed: Vec<bool>,
    /// The solids that may stand between a point of another one and the light.
    pub(crate) casters: Casters,
    /// The solids that may stand between a point of the surface and the light.
    pub(crate) surface_casters: Option<SurfaceCasters>,
}

/// The side of the surface's plane that a solid is on. The plane belongs to both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// No point of it is below.
    Above,
    /// No point of it is above.
    Below,
    /// It has points below and above.
    Across,
}

impl Side {
    /// The side of a solid, from how its lowest and highest points compare with the plane.
    fn new(lowest: Ordering, highest: Ordering) -> Side {
        if lowest.is_ge() {
            Side::Above
        } else if highest.is_le() {
            Side::Below
        } else {
            Side::Across
        }
    }
}

/// The side of a level plane that each solid is on, spheres first.
fn sides(spheres: &[Sphere], tetrahedra: &[Tetrahedron], height: f64) -> Vec<Side> {
    let of_sphere = |sphere: &Sphere| {
        let [y, radius, height] = exact(DVec3::new(sphere.center.y, sphere.radius, height));
        let lowest = sign(&(&y - &radius - &height));
        Side::new(lowest, sign(&(y + radius - height)))
    };
    let of_tetrahedron = |tetrahedron: &Tetrahedron| {
        let ys = tetrahedron.vertices.map(|vertex| vertex.y).into_iter();
        let against = |y: f64| y.partial_cmp(&height).unwrap_or(Ordering::Equal);
        let lowest = against(ys.clone().fold(f64::INFINITY, f64::min));
        Side::new(lowest, against(ys.fold(f64::NEG_INFINITY, f64::max)))
    };
    let spheres = spheres.iter().map(of_sphere);
    spheres
        .chain(tetrahedra.iter().map(of_tetrahedron))
        .collect()
}

impl Facts {
    /// `right_handed` has an entry for each tetrahedron; `direction` is the way the light travels.
    pub(super) fn new(
        spheres: &[Sphere],
        (tetrahedra, right_handed): (&[Tetrahedron], Vec<bool>),
        surface: Option<&Surface>,
        direction: DVec3,
    ) -> Facts {
        let mut count = 0;
        let mut number = || {
            count += 1;
            Support(count)
        };
        let sides = match surface {
            Some(surface) => sides(spheres, tetrahedra, surface.height),
            None => vec![Side::Above; spheres.len() + tetrahedra.len()],
        };
        let enclosed = enclosed(spheres, tetrahedra);
        let surface_casters = surface.map(|surface| {
            SurfaceCasters::new(spheres, tetrahedra, surface, -direction, &enclosed)
        });

        let mut same_spheres = HashMap::new();
        let sphere_supports = spheres.iter().map(|sphere| {
            let key = [
                sphere.center.x,
                sphere.center.y,
                sphere.center.z,
                sphere.radius,
            ]
            .map(f64::to_bits);
            *same_spheres.entry(key).or_insert_with(&mut number)
        });
        let sphere_supports = sphere_supports.collect();

        let to_light = exact(-direction);
        let mut same_planes = HashMap::new();
        let mut support = |plane| *same_planes.entry(plane).or_insert_with(&mut number);
        let (mut faces, mut facing_light) = (Vec::new(), Vec::new());
        for tetrahedron in tetrahedra {
            let vertices = tetrahedron.vertices.map(exact);
            let planes = [0, 1, 2, 3].map(|k| Plane::of_face(&vertices, k));
            facing_light.push(
                planes
                    .each_ref()
                    .map(|plane| sign(&dot(&plane.normal, &to_light))),
            );
            faces.push(planes.map(|plane| support(plane.coefficients())));
        }
        let surface = surface.map(|surface| {
            let height = exact(DVec3::Y * surface.height);
            let up = exact(DVec3::Y);
            support(
                Plane {
                    offset: dot(&up, &height),
                    normal: up,
                }
                .coefficients(),
            )
        });
        let casters = Casters::new(spheres, tetrahedra, -direction, &enclosed, &facing_light);
        Facts {
            spheres: sphere_supports,
            right_handed,
            faces,
            surface,
            facing_light,
            sides,
            enclosed,
            casters,
            surface_casters,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ulp_decides() {
        let flat = [
            DVec3::ZERO,
            DVec3::new(1.0, 0.0, 1.0),
            DVec3::new(0.0, 1.0, 1.0),
            DVec3::new(1.0, 1.0, 2.0),
        ];
        assert_eq!(orientation(flat), Ordering::Equal);
        for (z, expected) in [
            (2f64.next_up(), Ordering::Greater),
            (2f64.next_down(), Ordering::Less),
        ] {
            let mut nearly = flat;
            nearly[3].z = z;
            assert_eq!(orientation(nearly), expected);
        }
    }

    #[test]
    fn no_size_is_too_small_or_too_far() {
        let tiny = [
            DVec3::ZERO,
            DVec3::X * 1e-30,
            DVec3::Y * 1e-30,
            DVec3::Z * 1e-30,
        ];
        assert_eq!(orientation(tiny), Ordering::Greater);
        // In f64, 1e6 + 1e-30 is 1e6; the tetrahedron is given by what its numbers are, which is
        // flat.
        let far = tiny.map(|p| p + 1e6);
        assert_eq!(orientation(far), Ordering::Equal);
        // Coordinates of both magnitudes: a volume of 1e-30 · 1e6 · 1e6.
        let long = [
            DVec3::ZERO,
            DVec3::X * 1e-30,
            DVec3::Y * 1e6,
            DVec3::Z * -1e6,
        ];
        assert_eq!(orientation(long), Ordering::Less);
    }

    fn facts(tetrahedra: [[DVec3; 4]; 2]) -> Facts {
        let solids = tetrahedra.map(|vertices| Tetrahedron {
            vertices,
            color: DVec3::ONE,
        });
        let surface = Surface {
            height: -0.5,
            half_width: 1.0,
            color: DVec3::ONE,
            reflectance: 0.5,
        };
        let right_handed = tetrahedra.map(|vertices| orientation(vertices).is_gt());
        let solids = (&solids[..], right_handed.to_vec());
        Facts::new(&[], solids, Some(&surface), DVec3::new(0.0, -1.0, 0.0))
    }

    #[test]
    fn faces_in_one_plane_share_a_support() {
        let v = DVec3::new;
        // Both rest on y = −1/2, the first with face 3, the second with face 0.
        let first = [
            v(0.1, -0.5, 0.3),
            v(0.7, -0.5, 0.2),
            v(0.4, -0.5, 0.9),
            v(0.3, 0.3, 0.3),
        ];
        let second = [
            v(0.2, 0.9, 0.1),
            v(-0.3, -0.5, 0.7),
            v(-0.9, -0.5, 0.2),
            v(-0.1, -0.5, -0.3),
        ];
        let facts = facts([first, second]);
        assert_eq!(Some(facts.faces[0][3]), facts.surface);
        assert_eq!(Some(facts.faces[1][0]), facts.surface);
        assert_ne!(facts.faces[0][0], facts.faces[0][1]);
        // The light comes straight from above: the bases are turned away from it, whatever their
        // winding.
        assert_eq!(
            (facts.facing_light[0][3], facts.facing_light[1][0]),
            (Ordering::Less, Ordering::Less)
        );
    }

    #[test]
    fn an_ulp_parts_two_planes() {
        let v = DVec3::new;
        let first = [
            v(0.0, 0.0, 0.0),
            v(1.0, 0.0, 1.0),
            v(0.0, 1.0, 1.0),
            v(0.0, 0.0, 9.0),
        ];
        let mut second = [
            v(2.0, 3.0, 5.0),
            v(-1.0, 0.0, -1.0),
            v(7.0, 0.0, 7.0),
            v(0.0, 0.0, -9.0),
        ];
        let shared = facts([first, second]);
        assert_eq!(shared.faces[0][3], shared.faces[1][3]);
        second[0].z = 5f64.next_up();
        let parted = facts([first, second]);
        assert_ne!(parted.faces[0][3], parted.faces[1][3]);
    }
}
