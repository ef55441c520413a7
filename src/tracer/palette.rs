//! The colours that many pixels of a frame share.

use std::sync::OnceLock;

use bumpalo_herd::Member;

use super::decision::{Decision, Seen};
use crate::scene::Scene;

/// A slot for the samples of each decision, except those of spheres in the light.
pub(super) struct Palette<'f> {
    /// Without solids first, then those of each solid, then those of its mirror image.
    slots: &'f [OnceLock<[f32; 3]>],
    spheres: usize,
    tetrahedra: usize,
}

/// Four quadrants, the background, the surface and its shadow.
const WITHOUT_SOLIDS: usize = 7;

/// A sphere in shadow, and in flat colour.
const OF_A_SPHERE: usize = 2;

/// A tetrahedron in shadow, and its four faces in the light.
const OF_A_TETRAHEDRON: usize = 5;

impl<'f> Palette<'f> {
    /// An empty one.
    pub(super) fn new(scene: &Scene, memory: &Member<'f>) -> Self {
        let (spheres, tetrahedra) = (scene.spheres().len(), scene.tetrahedra().len());
        let of_a_view = spheres * OF_A_SPHERE + tetrahedra * OF_A_TETRAHEDRON;
        let count = WITHOUT_SOLIDS + 2 * of_a_view;
        Palette {
            slots: memory.alloc_slice_fill_with(count, |_| OnceLock::new()),
            spheres,
            tetrahedra,
        }
    }

    /// The slot of a decision.
    pub(super) fn get(&self, decision: Decision) -> &OnceLock<[f32; 3]> {
        let of_solid = |mirrored: usize, seen: Seen| {
            let slot = match seen.face {
                _ if seen.in_shadow => 0,
                None => 1,
                Some(face) => 1 + usize::from(face),
            };
            let solid = usize::from(seen.solid);
            let spheres = mirrored * self.spheres + solid.min(self.spheres);
            let tetrahedra = mirrored * self.tetrahedra + solid.saturating_sub(self.spheres);
            WITHOUT_SOLIDS + spheres * OF_A_SPHERE + tetrahedra * OF_A_TETRAHEDRON + slot
        };
        &self.slots[match decision {
            Decision::Quadrant(number) => usize::from(number),
            Decision::Background => 4,
            Decision::Surface => 5,
            Decision::SurfaceInShadow => 6,
            Decision::Solid(seen) => of_solid(0, seen),
            Decision::Mirrored(seen) => of_solid(1, seen),
        }]
    }
}
