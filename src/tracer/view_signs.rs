//! Signs that all pixels of a view share. Once decided, they serve every number.

use std::cmp::Ordering;

use bumpalo::Bump;

use super::tetrahedron::{FaceSigns, certain_face_signs};
use super::vector::Vector;
use super::view_space::eye_direction;
use super::view_transform::ViewTransform;
use crate::number::{Bounded, DoubleDouble, Real, all};
use crate::scene::Scene;

impl<R: Real> ViewTransform<R> {
    /// The signs that a view of this frame needs. `plain` is the same frame in f64.
    pub(super) fn signs<'f>(
        &self,
        scene: &Scene,
        plain: &ViewTransform<f64>,
        mirrored: bool,
        arena: &'f Bump,
    ) -> Result<ViewSigns<'f>, R::Doubt> {
        let mirror_height = self.surface_height(scene).filter(|_| mirrored);
        let eye_direction_in_scene = plain.eye_direction_in_scene(mirrored);
        let solids = scene.tetrahedra().iter().zip(&scene.facts().right_handed);
        let face_signs = solids.enumerate().map(|(index, (solid, &right_handed))| {
            match certain_face_signs(&solid.vertices, right_handed, eye_direction_in_scene) {
                Some(signs) => Ok(signs),
                None => self
                    .tetrahedron(scene, index, mirror_height)
                    .face_signs(&eye_direction()),
            }
        });
        let eye = eye_direction::<R>().vector;
        let to_light = self.direction_to_light(scene, mirrored).vector;
        let across = eye.cross(to_light);
        let beside = [across.x, across.y, across.z];
        let parallel = beside.map(|x| x.sign().map(Ordering::is_eq));
        let same_way = eye.dot(to_light).sign().map(Ordering::is_gt);
        Ok(ViewSigns {
            face_signs: arena.alloc_slice_try_fill_iter(face_signs)?,
            halfway: if all(parallel.into_iter().chain([same_way]))? {
                Halfway::None
            } else {
                Halfway::Computed
            },
        })
    }
}

/// Signs that all pixels of a view share. Once decided, they serve every number.
#[derive(Clone, Copy)]
pub(super) struct ViewSigns<'f> {
    /// The signs of each tetrahedron.
    pub(super) face_signs: &'f [FaceSigns],
    /// How h is found.
    pub(super) halfway: Halfway,
}

/// How the halfway vector h is found.
#[derive(Clone, Copy)]
pub(super) enum Halfway {
    /// There is none: v + l = 0, the light comes straight into the eye.
    None,
    /// Every number computes it well enough.
    Computed,
    /// v + l nearly cancels, so this h was computed in arbitrary precision.
    Given(Vector<DoubleDouble>),
}

impl ViewSigns<'_> {
    /// The same, with h computed by `refine` if `transform` computes it with too large an error.
    pub(super) fn refined(
        self,
        scene: &Scene,
        transform: &ViewTransform<Bounded>,
        mirrored: bool,
        refine: impl FnOnce() -> Vector<DoubleDouble>,
    ) -> Self {
        let halfway = match self.halfway {
            Halfway::None => Halfway::None,
            other => {
                let h = transform.halfway(scene, mirrored);
                // 15 bits more than an f32 has leave few pixels in doubt.
                const ENOUGH: f64 = f32::EPSILON as f64 * f32::EPSILON as f64 * 128.0;
                let is_good = [h.x, h.y, h.z].iter().all(|x| x.error() < ENOUGH);
                if is_good {
                    other
                } else {
                    Halfway::Given(refine())
                }
            }
        };
        ViewSigns { halfway, ..self }
    }
}

/// The signs of a frame: of the scene itself, and of its mirror image if there is one.
pub(super) struct FrameSigns<'f> {
    pub(super) direct: ViewSigns<'f>,
    pub(super) mirrored: Option<ViewSigns<'f>>,
}
