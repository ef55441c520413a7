//! The tetrahedra of a view, each computed when it is first asked for: of a crowd, the mirror shows
//! few.

use std::sync::OnceLock;

use fearless_simd::Level;
use glam::DVec3;

use super::arena::SliceAllocator;
use super::extent::ExtentsOfSolids;
use super::line::Direction;
use super::tetrahedron::{EdgeFunctions, FaceSigns, Tetrahedron, outward_normals_at_once};
use super::view_space::eye_direction;
use super::view_transform::ViewTransform;
use crate::number::{Bounded, Real};
use crate::scene::Scene;

/// The tetrahedra of a view.
pub(super) struct TetrahedraInView<'f, R> {
    scene: &'f Scene,
    transform: ViewTransform<R>,
    /// The height of the plane in which they are reflected, if they are.
    mirror_height: Option<R>,
    face_signs: &'f [FaceSigns],
    to_light: Direction<R>,
    /// By the index of a tetrahedron, its place in what follows: rows need one after the other.
    places: &'f [u16],
    computed: &'f [OnceLock<TetrahedronInView<R>>],
    edges: &'f [OnceLock<EdgesInView<R>>],
}

/// A tetrahedron, and how eye rays run through its faces.
pub(super) struct TetrahedronInView<R> {
    pub(super) solid: Tetrahedron<R>,
    pub(super) eye_signs: FaceSigns,
    /// The colour, beside what decides a pixel: so that the scene need not be read.
    pub(super) color: DVec3,
}

/// The edge functions of a tetrahedron: what single lines are tested by. Rows need each of them
/// once at most, and compute it there.
pub(super) struct EdgesInView<R> {
    /// For eye rays.
    pub(super) eye: EdgeFunctions<R>,
    /// For rays to the light.
    pub(super) light: EdgeFunctions<R>,
}

impl<'f, R: Real> TetrahedraInView<'f, R> {
    /// None is computed yet. `face_signs` are those of this view.
    pub(super) fn new(
        scene: &'f Scene,
        transform: &ViewTransform<R>,
        mirror_height: Option<R>,
        face_signs: &'f [FaceSigns],
        to_light: Direction<R>,
        extents: &ExtentsOfSolids<'f>,
        allocator: &impl SliceAllocator<'f>,
    ) -> Self {
        TetrahedraInView {
            scene,
            transform: *transform,
            mirror_height,
            face_signs,
            to_light,
            places: extents.places,
            computed: allocator.slice_of(face_signs.iter().map(|_| OnceLock::new())),
            edges: allocator.slice_of(face_signs.iter().map(|_| OnceLock::new())),
        }
    }

    /// The number of tetrahedra.
    pub(super) fn count(&self) -> usize {
        self.computed.len()
    }

    /// Computes all that can be asked for.
    pub(super) fn complete(&self) {
        for index in 0..self.count() {
            self.edges(index);
        }
    }

    /// The tetrahedron of this index in the scene.
    pub(super) fn get(&self, index: usize) -> &'f TetrahedronInView<R> {
        self.computed[self.place(index)].get_or_init(|| {
            let (scene, height) = (self.scene, self.mirror_height);
            self.in_view(index, self.transform.tetrahedron(scene, index, height))
        })
    }

    /// Its edge functions.
    pub(super) fn edges(&self, index: usize) -> &'f EdgesInView<R> {
        let TetrahedronInView {
            solid, eye_signs, ..
        } = self.get(index);
        self.edges[self.place(index)].get_or_init(|| EdgesInView {
            eye: solid.edge_functions(&eye_direction(), *eye_signs),
            light: solid.edge_functions(&self.to_light, solid.facing_light),
        })
    }

    fn place(&self, index: usize) -> usize {
        usize::from(self.places[index])
    }

    // Inlined, as what makes the solid is, so that it is made where it is kept: each copy would wait
    // for what was just written.
    #[inline(always)]
    fn in_view(&self, index: usize, solid: Tetrahedron<R>) -> TetrahedronInView<R> {
        TetrahedronInView {
            solid,
            eye_signs: self.face_signs[index],
            color: self.scene.tetrahedra()[index].color,
        }
    }
}

impl TetrahedraInView<'_, Bounded> {
    /// Computes the tetrahedron of this index, unless it is computed: faster than
    /// [`TetrahedraInView::get`] does.
    pub(super) fn prepare(&self, index: usize, level: Level) {
        self.computed[self.place(index)].get_or_init(|| {
            let normals =
                |vertices: &_, right_handed| outward_normals_at_once(vertices, right_handed, level);
            let (scene, height) = (self.scene, self.mirror_height);
            let transform = &self.transform;
            self.in_view(
                index,
                transform.tetrahedron_with(scene, index, height, normals),
            )
        });
    }
}
