//! The colours that many pixels of a frame share.

use std::sync::OnceLock;

use bumpalo::Bump;

use super::decision::{Decision, Seen};
use crate::scene::Scene;

/// A slot for the samples of each decision, except those of spheres in the light.
pub(super) struct Palette<'f> {
    /// Without solids first, then those of each solid, then those of its mirror image.
    slots: &'f [OnceLock<[f32; 3]>],
    solids: usize,
}

/// Four quadrants, the background, the surface and its shadow.
const WITHOUT_SOLIDS: usize = 7;

/// Four faces in the light, a sphere in flat colour, and either solid in shadow.
const OF_A_SOLID: usize = 6;

impl<'f> Palette<'f> {
    /// An empty one.
    pub(super) fn new(scene: &Scene, arena: &'f Bump) -> Self {
        let solids = scene.solid_count();
        let count = WITHOUT_SOLIDS + 2 * solids * OF_A_SOLID;
        Palette {
            slots: arena.alloc_slice_fill_with(count, |_| OnceLock::new()),
            solids,
        }
    }

    /// The slot of a decision.
    pub(super) fn get(&self, decision: Decision) -> &OnceLock<[f32; 3]> {
        let of_solid = |mirrored: usize, seen: Seen| {
            let slot = match seen.face {
                _ if seen.in_shadow => 5,
                None => 4,
                Some(face) => usize::from(face),
            };
            let solid = mirrored * self.solids + usize::from(seen.solid);
            WITHOUT_SOLIDS + solid * OF_A_SOLID + slot
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
