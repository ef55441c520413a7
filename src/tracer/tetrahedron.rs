//! A line and a tetrahedron: equations 3-2 and 3-3 for a closed, watertight solid.
//!
//! A line meets a convex solid where it has entered every face that it enters before it leaves any that it leaves.
//! Equation 3-2 gives t = −f/g for a face, with f = n·(o − a) and g = n·d. To compare two faces i and j, the quotients
//! are not needed: f_i g_j − f_j g_i = −((n_i × n_j) × d)·(o − a) for a vertex a of both, and n_i × n_j is the edge that
//! they share, times six volumes. So every decision about a line is the sign of one number an edge, the *edge function*
//! of equation 3-3: on which side of the edge the line passes. The two faces beside an edge read the same number, and a
//! line cannot slip between them.

use std::cmp::Ordering;
use std::iter;

use super::line::{Direction, Hit, Line};
use super::number::{Real, all};
use super::vector::Vector;
use crate::scene::Support;

/// Face k is the one opposite vertex k; its vertices are listed counter-clockwise as seen from outside, for a tetrahedron
/// whose edges 0→1, 0→2, 0→3 are right-handed.
pub(super) const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The edge that faces i < j share, from its first to its last vertex along n_i × n_j.
const EDGES: [(usize, usize, [usize; 2]); 6] = [
    (0, 1, [2, 3]),
    (0, 2, [3, 1]),
    (0, 3, [1, 2]),
    (1, 2, [0, 3]),
    (1, 3, [2, 0]),
    (2, 3, [0, 1]),
];

/// A tetrahedron in view space.
pub(super) struct Tetrahedron<R> {
    vertices: [Vector<R>; 4],
    /// Outward, of length `normal_lengths`.
    normals: [Vector<R>; 4],
    normal_lengths: [R; 4],
    right_handed: bool,
    /// The plane of each face.
    supports: [Support; 4],
    /// The sign of n·l for each face.
    facing_light: [Ordering; 4],
}

/// A tetrahedron as lines of one direction meet it.
pub(super) struct Sight<R> {
    /// The sign of g = n·d of each face: negative where a line enters, positive where it leaves, 0 where it runs along.
    crossing: [Ordering; 4],
    /// g itself.
    speed: [R; 4],
    /// The moment of each of [`EDGES`]: (n_i × n_j) × d without its positive factor.
    moments: [Vector<R>; 6],
}

impl<R: Real> Tetrahedron<R> {
    /// `right_handed` (the edges 0→1, 0→2, 0→3 are), `supports` and `facing_light` are decided where the scene is read.
    pub(super) fn new(
        vertices: [Vector<R>; 4],
        right_handed: bool,
        supports: [Support; 4],
        facing_light: [Ordering; 4],
    ) -> Self {
        let normals = FACES.map(|[a, b, c]| {
            let normal = (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
            if right_handed { normal } else { -normal }
        });
        let normal_lengths = normals.map(Vector::length);
        Tetrahedron {
            vertices,
            normals,
            normal_lengths,
            right_handed,
            supports,
            facing_light,
        }
    }

    /// The sign of n·d for each face.
    pub(super) fn crossing(&self, direction: &Direction<R>) -> Result<[Ordering; 4], R::Doubt> {
        let mut crossing = [Ordering::Equal; 4];
        for (sign, normal) in crossing.iter_mut().zip(self.normals) {
            *sign = normal.dot(direction.vector).sign()?;
        }
        Ok(crossing)
    }

    /// What all lines of one direction share. `crossing` is that of [`Tetrahedron::crossing`].
    pub(super) fn sight(&self, direction: &Direction<R>, crossing: [Ordering; 4]) -> Sight<R> {
        let speed = self.normals.map(|normal| normal.dot(direction.vector));
        let moments = EDGES.map(|(_, _, [from, to])| {
            let moment = (self.vertices[to] - self.vertices[from]).cross(direction.vector);
            if self.right_handed { moment } else { -moment }
        });
        Sight {
            crossing,
            speed,
            moments,
        }
    }

    /// What all lines toward the light share.
    pub(super) fn sight_of_light(&self, to_light: &Direction<R>) -> Sight<R> {
        self.sight(to_light, self.facing_light)
    }

    /// f of a face: positive where `point` is outside of it, in units of the normal's length.
    fn outside(&self, face: usize, point: Vector<R>) -> R {
        self.normals[face].dot(point - self.vertices[FACES[face][0]])
    }

    /// The sign of f at the origin of a ray, which is 0 where the ray leaves the face's own plane.
    fn origin_outside(&self, face: usize, ray: &Line<R>) -> Result<Ordering, R::Doubt> {
        match ray.leaves {
            Some(plane) if plane == self.supports[face] => Ok(Ordering::Equal),
            _ => self.outside(face, ray.origin).sign(),
        }
    }

    /// The edge function of `EDGES[edge]`, for its faces i < j. Where the line enters i and leaves j it is not negative
    /// if and only if t_i ≤ t_j; where it enters both, if and only if t_i ≥ t_j.
    fn side(&self, edge: usize, sight: &Sight<R>, line: &Line<R>) -> Result<Ordering, R::Doubt> {
        sight.moments[edge]
            .dot(line.origin - self.vertices[EDGES[edge].2[0]])
            .sign()
    }

    /// Whether the line meets the solid: it enters no face after it has left one, and is outside of none that it runs along.
    fn meets(&self, sight: &Sight<R>, line: &Line<R>) -> Result<bool, R::Doubt> {
        let beside =
            faces(sight, Ordering::Equal).map(|face| Ok(self.origin_outside(face, line)?.is_le()));
        let pairs = EDGES.iter().enumerate().filter_map(|(edge, &(i, j, _))| {
            match (sight.crossing[i], sight.crossing[j]) {
                (Ordering::Less, Ordering::Greater) => {
                    Some(self.side(edge, sight, line).map(Ordering::is_ge))
                }
                (Ordering::Greater, Ordering::Less) => {
                    Some(self.side(edge, sight, line).map(Ordering::is_le))
                }
                _ => None,
            }
        });
        all(beside.chain(pairs))
    }

    /// The face that a line enters last, and so the solid; of several at once, the lowest. Every line enters one.
    fn entered_face(&self, sight: &Sight<R>, line: &Line<R>) -> Result<usize, R::Doubt> {
        let mut entering = faces(sight, Ordering::Less);
        let mut last = entering.next().unwrap_or(0);
        for face in entering {
            if self.side(edge_of(last, face), sight, line)?.is_lt() {
                last = face;
            }
        }
        Ok(last)
    }

    /// The first point of the whole line in the solid.
    pub(super) fn first_hit(
        &self,
        sight: &Sight<R>,
        line: &Line<R>,
    ) -> Result<Option<Hit<R>>, R::Doubt> {
        if !self.meets(sight, line)? {
            return Ok(None);
        }
        let face = self.entered_face(sight, line)?;
        let depth = -self.outside(face, line.origin) / sight.speed[face];
        Ok(Some(Hit {
            depth,
            point: line.at(depth),
            normal: self.normals[face],
            normal_length: self.normal_lengths[face],
            face: Some(face as u8),
            support: self.supports[face],
            facing_light: Some(self.facing_light[face]),
        }))
    }

    /// Whether the ray meets the solid at some t > 0: the line meets it, and every face that it leaves lies ahead.
    pub(super) fn is_ahead(&self, sight: &Sight<R>, ray: &Line<R>) -> Result<bool, R::Doubt> {
        let leaving = faces(sight, Ordering::Greater);
        let ahead = leaving.map(|face| Ok(self.origin_outside(face, ray)?.is_lt()));
        all(ahead.chain(iter::once_with(|| self.meets(sight, ray))))
    }
}

/// The faces that lines cross in one way.
fn faces<R>(sight: &Sight<R>, crossing: Ordering) -> impl Iterator<Item = usize> {
    sight
        .crossing
        .into_iter()
        .enumerate()
        .filter_map(move |(face, sign)| (sign == crossing).then_some(face))
}

/// The place in [`EDGES`] of the edge that faces i < j share.
fn edge_of(i: usize, j: usize) -> usize {
    match (i, j) {
        (0, j) => j - 1,
        (1, j) => j + 1,
        _ => 5,
    }
}
