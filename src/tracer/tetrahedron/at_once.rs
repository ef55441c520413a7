//! The normals of a tetrahedron, four at once, for numbers with bounds.

use fearless_simd::{Level, Simd, dispatch};

use super::{
    Tetrahedron, WALLS_AT_ONCE, Wall, edge_normal, outward, outward_normals, plane_normal,
};
use crate::number::{Bounded, FourBounded};
use crate::scene::{EDGES, FACES};
use crate::tracer::vector::Vector;

/// As [`outward_normals`].
pub(in crate::tracer) fn outward_normals_at_once(
    vertices: &[Vector<Bounded>; 4],
    right_handed: bool,
    level: Level,
) -> [Vector<Bounded>; 4] {
    if any_exact(vertices) {
        return outward_normals(vertices, right_handed);
    }
    dispatch!(level, simd => outward_normals_with(simd, vertices, right_handed))
}

#[inline(always)]
fn outward_normals_with<S: Simd>(
    simd: S,
    vertices: &[Vector<Bounded>; 4],
    right_handed: bool,
) -> [Vector<Bounded>; 4] {
    let [a, b, c, d] = FACES;
    let corners = [
        chosen(simd, vertices, [a[0], b[0], c[0], d[0]]),
        chosen(simd, vertices, [a[1], b[1], c[1], d[1]]),
        chosen(simd, vertices, [a[2], b[2], c[2], d[2]]),
    ];
    Vector::apart(outward(plane_normal(corners), right_handed))
}

impl Tetrahedron<Bounded> {
    /// The normals of half-spaces with these walls, and a point of each wall, as
    /// [`Tetrahedron::half_space`] has them; not where [`Tetrahedron::may_be_exact`] is true.
    #[inline(always)]
    pub(in crate::tracer) fn half_spaces_at_once<S: Simd>(
        &self,
        simd: S,
        walls: &[Wall; WALLS_AT_ONCE],
        d: Vector<Bounded>,
    ) -> [Vector<FourBounded<S>>; 2] {
        let (mut from, mut to, mut at) = ([0; 4], [0; 4], [0; 4]);
        let mut any_face = false;
        for i in 0..4 {
            match walls[i] {
                Wall::Face { face, .. } => {
                    any_face = true;
                    at[i] = FACES[usize::from(face)][0];
                }
                Wall::Edge { edge, opposite } => {
                    let (.., [first, last]) = EDGES[usize::from(edge)];
                    // The normal of a reversed edge is the opposite one.
                    let is_reversed = opposite == self.right_handed;
                    (from[i], to[i]) = if is_reversed {
                        (last, first)
                    } else {
                        (first, last)
                    };
                    at[i] = first;
                }
            }
        }
        let ends = [
            chosen(simd, &self.vertices, from),
            chosen(simd, &self.vertices, to),
        ];
        let mut normals = edge_normal(ends, Vector::splat(simd, d));
        if any_face {
            let mut each = normals.apart();
            for i in 0..4 {
                if let Wall::Face { face, .. } = walls[i] {
                    each[i] = -self.normals[usize::from(face)];
                }
            }
            normals = Vector::together(simd, each);
        }
        [normals, chosen(simd, &self.vertices, at)]
    }

    /// Whether products of its vertices may be exact, which is known only one by one.
    pub(in crate::tracer) fn may_be_exact(&self) -> bool {
        any_exact(&self.vertices)
    }
}

/// Whether any x or z is known exactly: if y is, too, products may be, which is known only one by
/// one.
fn any_exact(vertices: &[Vector<Bounded>; 4]) -> bool {
    let is_exact = |x: Bounded| x.error() == 0.0;
    vertices.iter().any(|v| is_exact(v.x) || is_exact(v.z))
}

/// Four of the vertices, by their numbers.
#[inline(always)]
fn chosen<S: Simd>(
    simd: S,
    vertices: &[Vector<Bounded>; 4],
    [a, b, c, d]: [usize; 4],
) -> Vector<FourBounded<S>> {
    Vector::together(simd, [vertices[a], vertices[b], vertices[c], vertices[d]])
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::number::Real as _;
    use crate::random::Random;
    use crate::scene::Scene;
    use crate::tracer::tetrahedron::Passage;
    use crate::tracer::view_space::eye_direction;
    use crate::tracer::view_transform::ViewTransform;

    fn bits(v: Vector<Bounded>) -> [(u64, u64); 3] {
        [v.x, v.y, v.z].map(|x| (x.value().to_bits(), x.error().to_bits()))
    }

    #[test]
    fn four_half_spaces_at_once_have_the_bits_of_each_by_itself() {
        let mut random = Random::new();
        let (mut faces, mut edges, mut hands) = (0, 0, [0; 2]);
        for round in 0..100 {
            let mut number = || 2.0 * random.fraction() - 1.0;
            let vertices = [(); 4].map(|()| [number(), number(), number()]);
            let text =
                format!("[[tetrahedron]]\nvertices = {vertices:?}\ncolor = [0.5, 0.5, 0.5]\n");
            let scene = Scene::from_toml(&text).unwrap();
            let (sin, cos) = Bounded::sin_cos(number());
            let transform = ViewTransform::new(sin, cos, 500);
            let mirror = (round % 2 == 0).then(|| Bounded::exact(-0.25));
            let solid = transform.tetrahedron(&scene, 0, mirror);
            assert!(!solid.may_be_exact());
            hands[usize::from(solid.right_handed)] += 1;
            let eye = eye_direction::<Bounded>();
            let light = Vector::exact(DVec3::new(number(), number(), number()));
            let lines = [
                (eye.vector, solid.face_signs(&eye).unwrap()),
                (light, solid.facing_light),
            ];
            for (d, signs) in lines {
                let walls: Vec<Wall> = Passage::of(signs).ahead.iter().collect();
                for four in walls.windows(4) {
                    let four: &[Wall; 4] = four.try_into().unwrap();
                    let is_face = |wall: &&Wall| matches!(wall, Wall::Face { .. });
                    let count = four.iter().filter(is_face).count();
                    (faces, edges) = (faces + count, edges + 4 - count);
                    for level in [Level::new(), Level::baseline(), Level::fallback()] {
                        dispatch!(level, simd => {
                            let [normals, points] = solid.half_spaces_at_once(simd, four, d);
                            let (normals, points) = (normals.apart(), points.apart());
                            for (i, wall) in four.iter().enumerate() {
                                let expected = solid.half_space(*wall, d);
                                assert_eq!(bits(normals[i]), bits(expected.normal));
                                assert_eq!(bits(points[i]), bits(expected.at));
                            }
                        });
                    }
                }
            }
        }
        let counts = (faces, edges, hands);
        assert!(
            faces > 400 && edges > 400 && hands.iter().all(|&n| n > 20),
            "{counts:?}"
        );
    }
}
