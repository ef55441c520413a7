//! The tetrahedra of a view, each computed when it is first asked for: of a crowd, the mirror shows
//! few.

use std::sync::OnceLock;

use fearless_simd::Level;

use super::arena::SliceAllocator;
use super::line::Direction;
use super::tetrahedron::{EdgeFunctions, Tetrahedron, outward_normals_at_once};
use super::view_signs::FaceSigns;
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
    computed: &'f [OnceLock<TetrahedronInView<R>>],
}

/// A tetrahedron with its edge functions for eye rays and for rays to the light.
pub(super) struct TetrahedronInView<R> {
    pub(super) solid: Tetrahedron<R>,
    pub(super) eye_edges: EdgeFunctions<R>,
    pub(super) light_edges: EdgeFunctions<R>,
}

impl<'f, R: Real> TetrahedraInView<'f, R> {
    /// None is computed yet. `face_signs` are those of this view.
    pub(super) fn new(
        scene: &'f Scene,
        transform: &ViewTransform<R>,
        mirror_height: Option<R>,
        face_signs: &'f [FaceSigns],
        to_light: Direction<R>,
        allocator: &impl SliceAllocator<'f>,
    ) -> Self {
        TetrahedraInView {
            scene,
            transform: *transform,
            mirror_height,
            face_signs,
            to_light,
            computed: allocator.slice_of(face_signs.iter().map(|_| OnceLock::new())),
        }
    }

    /// The number of tetrahedra.
    pub(super) fn count(&self) -> usize {
        self.computed.len()
    }

    /// All of them, by their indices in the scene.
    pub(super) fn all(&self) -> impl Iterator<Item = &'f TetrahedronInView<R>> {
        (0..self.count()).map(|index| self.get(index))
    }

    /// The tetrahedron of this index in the scene.
    pub(super) fn get(&self, index: usize) -> &'f TetrahedronInView<R> {
        self.computed[index].get_or_init(|| {
            let solid = self
                .transform
                .tetrahedron(self.scene, index, self.mirror_height);
            let eye_edges = solid.edge_functions(&eye_direction(), self.face_signs[index]);
            let light_edges = solid.edge_functions(&self.to_light, solid.facing_light);
            TetrahedronInView {
                solid,
                eye_edges,
                light_edges,
            }
        })
    }
}

impl TetrahedraInView<'_, Bounded> {
    /// Computes the tetrahedron of this index, unless it is computed: faster than
    /// [`TetrahedraInView::get`] does.
    pub(super) fn prepare(&self, index: usize, level: Level) {
        self.computed[index].get_or_init(|| {
            let normals =
                |vertices: &_, right_handed| outward_normals_at_once(vertices, right_handed, level);
            let (scene, height) = (self.scene, self.mirror_height);
            let solid = self
                .transform
                .tetrahedron_with(scene, index, height, normals);
            let (eye, signs) = (eye_direction(), self.face_signs[index]);
            TetrahedronInView {
                eye_edges: solid.edge_functions_at_once(&eye, signs, level),
                light_edges: solid.edge_functions_at_once(
                    &self.to_light,
                    solid.facing_light,
                    level,
                ),
                solid,
            }
        });
    }
}
