//! Crowds: scenes that differ in how many spheres they have, to see what a sphere costs.
//!
//! A crowd has the built-in surface and the built-in tetrahedron; its spheres lie over the surface
//! and beside it, and touch nothing. Their radii shrink with the cube root of their number, so
//! that all of them together fill about the same part of space. Each crowd is drawn at random by
//! itself: none is part of another. The random numbers and the arithmetic are the same on every
//! machine.

use glam::DVec3;

use crate::Scene;
use crate::scene::{MAX_SOLIDS, SceneBuilder, SceneError, Sphere, Tetrahedron};

/// The most spheres of a crowd: its tetrahedron is a solid too.
pub const MAX_CROWD: u16 = MAX_SOLIDS as u16 - 1;

/// The radius of the upright cylinder that holds the spheres: seen from any side, it is narrower
/// than the picture.
const CYLINDER_RADIUS: f64 = 0.9375;

/// The y of the cylinder's upper end, which is in the picture where the cylinder is farthest away.
const CYLINDER_TOP: f64 = 0.375;

/// The largest radius of a sphere that is alone.
const LARGEST_RADIUS: f64 = 0.4;

/// The crowd of so many spheres.
///
/// # Errors
/// [`SceneError`] where they are more than [`MAX_CROWD`].
pub(super) fn scene(spheres: u16) -> Result<Scene, SceneError> {
    let builtin = Scene::builtin();
    let mut crowd = Scene::builder();
    let mut floor = -CYLINDER_TOP;
    if let Some(&surface) = builtin.surface() {
        floor = surface.height;
        crowd = crowd.surface(surface);
    }
    let solids = builtin.tetrahedra();
    crowd = solids
        .iter()
        .copied()
        .fold(crowd, SceneBuilder::tetrahedron);
    let spheres = place(spheres, floor, solids).into_iter();
    spheres.fold(crowd, SceneBuilder::sphere).build()
}

/// So many spheres above `floor` that touch neither each other nor the boxes around `tetrahedra`.
///
/// A sphere is drawn again where it touches something. All of them fill a twentieth of the
/// cylinder, so that there is always room.
fn place(spheres: u16, floor: f64, tetrahedra: &[Tetrahedron]) -> Vec<Sphere> {
    let mut random = Random(spheres.into());
    let largest = LARGEST_RADIUS / libm::cbrt(spheres.into());
    let mut placed: Vec<Sphere> = Vec::new();
    while placed.len() < spheres.into() {
        let radius = random.between(0.5 * largest, largest);
        let reach = CYLINDER_RADIUS - radius;
        let center = DVec3::new(
            random.between(-reach, reach),
            random.between(floor + radius, CYLINDER_TOP - radius),
            random.between(-reach, reach),
        );
        let color = DVec3::from_array([(); 3].map(|()| random.between(0.1, 1.0)));
        let sphere = Sphere {
            center,
            radius,
            color,
        };
        if center.x * center.x + center.z * center.z < reach * reach
            && tetrahedra.iter().all(|other| is_apart(&sphere, other))
            && placed.iter().all(|other| are_apart(&sphere, other))
        {
            placed.push(sphere);
        }
    }
    placed
}

/// Whether two spheres have no point in common.
fn are_apart(a: &Sphere, b: &Sphere) -> bool {
    let reach = a.radius + b.radius;
    a.center.distance_squared(b.center) > reach * reach
}

/// Whether a sphere has no point in common with the box around a tetrahedron.
fn is_apart(sphere: &Sphere, tetrahedron: &Tetrahedron) -> bool {
    let [first, others @ ..] = tetrahedron.vertices;
    let low = others.into_iter().fold(first, DVec3::min);
    let high = others.into_iter().fold(first, DVec3::max);
    let nearest = sphere.center.clamp(low, high);
    nearest.distance_squared(sphere.center) > sphere.radius * sphere.radius
}

/// SplitMix64 of Steele, Lea and Flood: seeds that follow each other give unrelated numbers.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number from `low` to `high`.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        let fraction = (self.bits() >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * fraction
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn a_crowd_is_the_same_on_every_machine() {
        // FNV-1a.
        let text = scene(200).unwrap().to_toml();
        let checksum = text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        assert_eq!(checksum, 0x877d_b4bc_933d_0e4c, "{checksum:#x}");
    }

    /// Points all over a tetrahedron, its vertices among them.
    fn points(tetrahedron: &Tetrahedron) -> impl Iterator<Item = DVec3> {
        const PARTS: usize = 8;
        let [a, b, c, d] = tetrahedron.vertices;
        let weights = (0..(PARTS + 1).pow(3)).map(|number| {
            let digit = |place| number / (PARTS + 1_usize).pow(place) % (PARTS + 1);
            [digit(0), digit(1), digit(2)]
        });
        let inside = weights.filter(|weights| weights.iter().sum::<usize>() <= PARTS);
        inside.map(move |weights| {
            let [b_part, c_part, d_part] = weights.map(|part| part as f64 / PARTS as f64);
            a + (b - a) * b_part + (c - a) * c_part + (d - a) * d_part
        })
    }

    #[test]
    fn nothing_in_a_crowd_touches_anything() {
        for spheres in (1..40).chain([200, 1000, MAX_CROWD]) {
            let crowd = scene(spheres).unwrap();
            let (builtin, all) = (Scene::builtin(), crowd.spheres());
            assert_eq!(all.len(), usize::from(spheres));
            assert_eq!(crowd.tetrahedra(), builtin.tetrahedra());
            assert_eq!(crowd.surface(), builtin.surface());
            let mut colors = BTreeSet::new();
            for (index, sphere) in all.iter().enumerate() {
                let Sphere { center, radius, .. } = *sphere;
                assert!(center.y - radius > crowd.surface().unwrap().height);
                let distance = |other: &Sphere| other.center.distance(center) - other.radius;
                assert!(all[..index].iter().all(|other| distance(other) > radius));
                let mut tetrahedron = points(&crowd.tetrahedra()[0]);
                assert!(tetrahedron.all(|point| point.distance(center) > radius));
                assert!(colors.insert(sphere.color.to_array().map(f64::to_bits)));
            }
        }
        assert!(scene(MAX_CROWD + 1).is_err());
    }

    #[test]
    fn radii_shrink_with_the_cube_root_of_the_number() {
        for spheres in [1, 8, 1000] {
            let root = libm::cbrt(spheres.into());
            for sphere in scene(spheres).unwrap().spheres() {
                let alone = sphere.radius * root;
                assert!((0.2..=0.4).contains(&alone), "{alone} of {spheres}");
            }
        }
    }

    #[test]
    fn no_crowd_is_part_of_another() {
        let numbers = [1, 2, 20, 21, 200, 1000];
        let crowds = numbers.map(|spheres| scene(spheres).unwrap());
        for (index, smaller) in crowds.iter().enumerate() {
            for larger in &crowds[index + 1..] {
                for sphere in smaller.spheres() {
                    let is_other = |other: &Sphere| {
                        other.center != sphere.center && other.color != sphere.color
                    };
                    assert!(larger.spheres().iter().all(is_other));
                }
            }
        }
    }
}
