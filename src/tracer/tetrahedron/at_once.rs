//! The normals of a tetrahedron, four at once, for numbers with bounds.

use std::cmp::Ordering;

use fearless_simd::{Level, Simd, dispatch};

use super::{EdgeFunctions, Tetrahedron, edge_normal, outward, outward_normals, plane_normal};
use crate::number::{Bounded, FourBounded};
use crate::scene::{EDGES, FACES};
use crate::tracer::line::Direction;
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
    /// As [`Tetrahedron::edge_functions`].
    pub(in crate::tracer) fn edge_functions_at_once(
        &self,
        direction: &Direction<Bounded>,
        face_signs: [Ordering; 4],
        level: Level,
    ) -> EdgeFunctions<Bounded> {
        if any_exact(&self.vertices) {
            return self.edge_functions(direction, face_signs);
        }
        EdgeFunctions {
            face_signs,
            edge_normals: dispatch!(level, simd => self.edge_normals_with(simd, direction.vector)),
        }
    }

    #[inline(always)]
    fn edge_normals_with<S: Simd>(&self, simd: S, d: Vector<Bounded>) -> [Vector<Bounded>; 6] {
        let d = Vector::splat(simd, d);
        let [first, second, third, fourth, ..] = EDGES;
        let [.., fifth, sixth] = EDGES;
        let [a, b, c, e] = self.edge_normals_of(simd, [first, second, third, fourth], d);
        // Two are computed twice, and are the same.
        let [_, _, f, g] = self.edge_normals_of(simd, [third, fourth, fifth, sixth], d);
        [a, b, c, e, f, g]
    }

    /// The normals of four edges.
    #[inline(always)]
    fn edge_normals_of<S: Simd>(
        &self,
        simd: S,
        [a, b, c, e]: [(usize, usize, [usize; 2]); 4],
        d: Vector<FourBounded<S>>,
    ) -> [Vector<Bounded>; 4] {
        let edges = [
            chosen(simd, &self.vertices, [a.2[0], b.2[0], c.2[0], e.2[0]]),
            chosen(simd, &self.vertices, [a.2[1], b.2[1], c.2[1], e.2[1]]),
        ];
        Vector::apart(outward(edge_normal(edges, d), self.right_handed))
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
