//! A line and a tetrahedron: equations 3-2 and 3-3 for a closed, watertight solid.
//!
//! A line meets a convex solid if it enters all faces that it enters before it leaves any other.
//! Equation 3-2 gives t = −f/g for a face, with f = n·(o − a) and g = n·d. To compare two faces i
//! and j, the quotients are not needed: f_i g_j − f_j g_i = −((n_i × n_j) × d)·(o − a) for a vertex
//! a of both, and n_i × n_j is the edge that they share, times six volumes. So every decision about
//! a line is the sign of one number an edge, the *edge function* of equation 3-3: on which side of
//! the edge the line passes. The two faces beside an edge read the same number, and a line cannot
//! slip between them.

mod at_once;
mod passage;

use std::cmp::Ordering;

use glam::DVec3;

pub(super) use at_once::outward_normals_at_once;
pub(super) use passage::{Passage, WALLS_AT_ONCE, Wall, Walls};

use super::half_space::HalfSpace;
use super::line::{Direction, Hit, Line, Normal};
use super::vector::Vector;
use crate::number::{Real, Ring, all};
use crate::scene::{EDGES, FACES, Support};

/// A tetrahedron in view space.
pub(super) struct Tetrahedron<R> {
    vertices: [Vector<R>; 4],
    /// Outward, of any length.
    normals: [Vector<R>; 4],
    /// Whether the edges 0→1, 0→2, 0→3 are right-handed.
    right_handed: bool,
    /// The plane of each face.
    supports: [Support; 4],
    /// The sign of n·l for each face.
    pub(super) facing_light: FaceSigns,
}

/// The sign of g = n·d of each face, for all lines of one direction d: negative where a line
/// enters, positive where it leaves, 0 where it runs along.
pub(super) type FaceSigns = [Ordering; 4];

/// The edge functions of a tetrahedron for all lines of one direction d.
pub(super) struct EdgeFunctions<R> {
    face_signs: FaceSigns,
    /// For each of [`EDGES`], the normal of the plane in which lines meet it: (n_i × n_j) × d
    /// without its positive factor. Edges between two faces that lines leave or run along are
    /// never asked for.
    edge_normals: [Vector<R>; 6],
}

impl<R: Real> Tetrahedron<R> {
    /// The normals are those that [`outward_normals`] gives. Exact arithmetic has decided
    /// `supports`, `facing_light`, and whether the edges 0→1, 0→2, 0→3 are `right_handed`.
    #[inline(always)]
    pub(super) fn new(
        vertices: [Vector<R>; 4],
        normals: [Vector<R>; 4],
        right_handed: bool,
        supports: [Support; 4],
        facing_light: FaceSigns,
    ) -> Self {
        Tetrahedron {
            vertices,
            normals,
            right_handed,
            supports,
            facing_light,
        }
    }

    /// The sign of n·d for each face.
    pub(super) fn face_signs(&self, direction: &Direction<R>) -> Result<FaceSigns, R::Doubt> {
        let mut face_signs = [Ordering::Equal; 4];
        for (sign, normal) in face_signs.iter_mut().zip(self.normals) {
            *sign = normal.dot(direction.vector).sign()?;
        }
        Ok(face_signs)
    }

    /// The edge functions for a direction, of which [`Tetrahedron::face_signs`] gave `face_signs`.
    pub(super) fn edge_functions(
        &self,
        direction: &Direction<R>,
        face_signs: FaceSigns,
    ) -> EdgeFunctions<R> {
        let edge_normals = [0, 1, 2, 3, 4, 5].map(|edge| {
            let (i, j, _) = EDGES[edge];
            if face_signs[i].is_ge() && face_signs[j].is_ge() {
                return Vector::exact(DVec3::ZERO);
            }
            self.edge_normal(edge, direction.vector)
        });
        EdgeFunctions {
            face_signs,
            edge_normals,
        }
    }

    /// The normal of the plane in which lines of direction `d` meet an edge, toward where its edge
    /// function is positive.
    fn edge_normal(&self, edge: usize, d: Vector<R>) -> Vector<R> {
        let (.., ends) = EDGES[edge];
        let ends = ends.map(|vertex| self.vertices[vertex]);
        outward(edge_normal(ends, d), self.right_handed)
    }

    /// The normal of a face, which is that of all its points.
    pub(super) fn normal(&self, face: usize) -> Normal<R> {
        Normal {
            vector: self.normals[face],
            length: self.normals[face].length(),
            facing_light: Some(self.facing_light[face]),
        }
    }

    pub(super) fn vertices(&self) -> &[Vector<R>; 4] {
        &self.vertices
    }

    /// The closed half-space of a face that holds the solid.
    pub(super) fn inner_half_space(&self, face: usize) -> HalfSpace<R> {
        HalfSpace {
            normal: -self.normals[face],
            at: self.vertices[FACES[face][0]],
            closed: true,
            support: Some(self.supports[face]),
        }
    }

    /// The half-space with a wall, for lines of direction `d`.
    pub(super) fn half_space(&self, wall: Wall, d: Vector<R>) -> HalfSpace<R> {
        self.half_space_with(wall, |edge| self.edge_normal(edge, d))
    }

    /// The same, for the direction of these edge functions.
    fn half_space_in(&self, wall: Wall, functions: &EdgeFunctions<R>) -> HalfSpace<R> {
        self.half_space_with(wall, |edge| functions.edge_normals[edge])
    }

    fn half_space_with(
        &self,
        wall: Wall,
        edge_normal: impl FnOnce(usize) -> Vector<R>,
    ) -> HalfSpace<R> {
        match wall {
            Wall::Face { face, .. } => HalfSpace {
                closed: wall.is_closed(),
                ..self.inner_half_space(face.into())
            },
            Wall::Edge { edge, opposite } => {
                let edge = usize::from(edge);
                let normal = edge_normal(edge);
                HalfSpace {
                    normal: if opposite { -normal } else { normal },
                    at: self.vertices[EDGES[edge].2[0]],
                    closed: wall.is_closed(),
                    support: None,
                }
            }
        }
    }

    /// Whether one of its faces lies in this plane.
    pub(super) fn has_face_in(&self, plane: Support) -> bool {
        self.supports.contains(&plane)
    }

    /// Whether n·l ≤ 0 for a face.
    pub(super) fn turned_away(&self, face: usize) -> bool {
        self.facing_light[face].is_le()
    }

    /// f of a face: positive where `point` is outside of it, in units of the normal's length.
    fn outside(&self, face: usize, point: Vector<R>) -> R {
        self.normals[face].dot(point - self.vertices[FACES[face][0]])
    }

    /// Whether the line meets the solid.
    fn meets(&self, functions: &EdgeFunctions<R>, line: &Line<R>) -> Result<bool, R::Doubt> {
        let walls = Passage::of(functions.face_signs).met.iter();
        all(walls.map(|wall| self.half_space_in(wall, functions).holds(line)))
    }

    /// The face through which a line enters the solid: the last that it enters, and of several at
    /// once, the lowest number. Every line enters one.
    fn entered_face(
        &self,
        functions: &EdgeFunctions<R>,
        line: &Line<R>,
    ) -> Result<usize, R::Doubt> {
        let passage = Passage::of(functions.face_signs);
        let pairs = passage.pairs().iter().copied().zip(passage.creases.iter());
        let last = last_entered(pairs, |wall| {
            self.half_space_in(wall, functions).holds(line)
        })?;
        Ok(passage.entered().nth(last).unwrap_or(0))
    }

    /// The first point of the whole line in the solid.
    pub(super) fn first_hit(
        &self,
        functions: &EdgeFunctions<R>,
        line: &Line<R>,
    ) -> Result<Option<Hit<R>>, R::Doubt> {
        if !self.meets(functions, line)? {
            return Ok(None);
        }
        let face = self.entered_face(functions, line)?;
        let g = self.normals[face].dot(line.direction.vector);
        let depth = -self.outside(face, line.origin) / g;
        Ok(Some(Hit {
            depth,
            point: line.at(depth),
            normal: self.normal(face),
            face: Some(face as u8),
            support: self.supports[face],
        }))
    }

    /// Whether the ray meets the solid at some t > 0: the line meets it, and every face that it
    /// leaves lies ahead.
    pub(super) fn is_ahead(
        &self,
        functions: &EdgeFunctions<R>,
        ray: &Line<R>,
    ) -> Result<bool, R::Doubt> {
        let walls = Passage::of(functions.face_signs).ahead.iter();
        all(walls.map(|wall| self.half_space_in(wall, functions).holds(ray)))
    }
}

/// The outward normals of the faces, of any length. `right_handed` is as for [`Tetrahedron::new`].
pub(super) fn outward_normals<R: Real>(
    vertices: &[Vector<R>; 4],
    right_handed: bool,
) -> [Vector<R>; 4] {
    FACES.map(|face| {
        let normal = plane_normal(face.map(|vertex| vertices[vertex]));
        outward(normal, right_handed)
    })
}

/// A normal of the plane through three points.
#[inline(always)]
fn plane_normal<R: Ring>([a, b, c]: [Vector<R>; 3]) -> Vector<R> {
    (b - a).cross(c - a)
}

/// A normal of the plane in which lines of direction `d` meet an edge.
#[inline(always)]
fn edge_normal<R: Ring>([from, to]: [Vector<R>; 2], d: Vector<R>) -> Vector<R> {
    (to - from).cross(d)
}

/// The normal of a tetrahedron, given that of a right-handed one.
#[inline(always)]
fn outward<R: Ring>(normal: Vector<R>, right_handed: bool) -> Vector<R> {
    if right_handed { normal } else { -normal }
}

/// The sign of n·d for each face of a tetrahedron of the scene, where plain f64 is certain of all
/// of them. `right_handed` is as for [`Tetrahedron::new`]; the components of `d` are known to a
/// relative error of 2u, and their magnitudes add up to less than 18.
pub(super) fn certain_face_signs(
    vertices: &[DVec3; 4],
    right_handed: bool,
    d: DVec3,
) -> Option<FaceSigns> {
    let largest = vertices.iter().map(|vertex| vertex.abs().max_element());
    let m = largest.fold(0.0, f64::max);
    // A component of a normal is at most 8 m², and wrong by at most 32u m²; products and sums round
    // by at most 5u of what they give: 18 · (32 + 5 · 8) u m² is less than 2⁻⁴² m².
    let error = m * m / (1_u64 << 42) as f64;
    let vertices = vertices.map(Vector::<f64>::exact);
    let mut face_signs = [Ordering::Equal; 4];
    for (sign, normal) in face_signs
        .iter_mut()
        .zip(outward_normals(&vertices, right_handed))
    {
        let n_dot_d = normal.dot(Vector::exact(d));
        let is_certain = n_dot_d.abs() > error;
        if !is_certain {
            return None;
        }
        *sign = n_dot_d.total_cmp(&0.0);
    }
    Some(face_signs)
}

/// The index of the face that a line enters last among those that it enters; of several at once, the
/// lowest. `pairs` are those of [`Passage::pairs`]; `is_first_last` tells whether the line enters
/// the first face of a pair last.
pub(super) fn last_entered<T, E>(
    pairs: impl Iterator<Item = ([u8; 2], T)>,
    is_first_last: impl Fn(T) -> Result<bool, E>,
) -> Result<usize, E> {
    let mut last = 0;
    for ([one, other], pair) in pairs {
        if one == last && !is_first_last(pair)? {
            last = other;
        }
    }
    Ok(last.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::DoubleDouble;
    use crate::random::Random;
    use crate::scene::Scene;
    use crate::tracer::view_space::eye_direction;
    use crate::tracer::view_transform::ViewTransform;

    #[test]
    #[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
    fn face_signs_of_which_f64_is_certain_are_right() {
        let mut random = Random::new();
        let (mut certain, mut all) = (0, 0);
        for round in 0..400 {
            let mut number = |max: f64| max * (2.0 * random.fraction() - 1.0);
            let mut vector = |max: f64| DVec3::new(number(max), number(max), number(max));
            let alpha = 3.0 * vector(1.0).x;
            let (sin, cos) = f64::sin_cos(alpha);
            let plain = ViewTransform::<f64>::new(sin, cos, 500);
            // In later rounds eye rays run nearly along an edge.
            let beside = 10_f64.powi(-round / 20);
            let along = plain.eye_direction_in_scene(round % 2 == 0) * 0.1;
            let [a, b, c] = [(); 3].map(|()| vector(1.0));
            let vertices = [a, b, c, a + along + vector(beside)].map(|v| v.to_array());
            let text = format!(
                "[surface]\nheight = -0.7\nhalf_width = 1.0\n\
                 [[tetrahedron]]\nvertices = {vertices:?}\ncolor = [0.5, 0.5, 0.5]\n"
            );
            let scene = Scene::from_toml(&text).unwrap();
            let solid = &scene.tetrahedra()[0];
            for mirrored in [false, true] {
                let transform = |(sin, cos)| ViewTransform::<DoubleDouble>::new(sin, cos, 500);
                let transform = transform(DoubleDouble::sin_cos(alpha));
                let mirror = transform.surface_height(&scene).filter(|_| mirrored);
                let truth = transform
                    .tetrahedron(&scene, 0, mirror)
                    .face_signs(&eye_direction());
                let d = plain.eye_direction_in_scene(mirrored);
                let right_handed = scene.facts().right_handed[0];
                if let Some(signs) = certain_face_signs(&solid.vertices, right_handed, d) {
                    assert_eq!(
                        signs,
                        truth.unwrap(),
                        "{vertices:?}, α = {alpha}, {mirrored}"
                    );
                    certain += 1;
                }
                all += 1;
            }
        }
        assert!(certain > all / 2 && certain < all, "{certain} of {all}");
    }
}
