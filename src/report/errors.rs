//! What a kernel gets wrong: decisions as decisions, samples as samples.

use crate::Image;
use crate::difference::Difference;
use crate::tracer::{Decision, InDoubt, Seen};

/// Pixels with a wrong decision, each counted once: by the first thing that is wrong about it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WrongPixels {
    /// Something else is seen: another solid, the surface, the background.
    pub solid: u64,
    /// The right tetrahedron, but another of its faces.
    pub face: u64,
    /// The right thing, but in shadow instead of in light, or the other way round.
    pub shadow: u64,
    /// The surface in light, but it mirrors something else, or the same otherwise lit.
    pub mirror: u64,
}

impl WrongPixels {
    /// All of them.
    pub fn total(&self) -> u64 {
        self.solid + self.face + self.shadow + self.mirror
    }

    /// Counts a pixel, if `decision` is wrong.
    pub fn add(&mut self, decision: Decision, truth: Decision) {
        use Decision::{Mirrored, Solid, Surface, SurfaceInShadow};
        match (decision, truth) {
            _ if decision == truth => {}
            (Solid(seen), Solid(truth)) => match (seen, truth) {
                (Seen { solid, .. }, truth) if solid != truth.solid => self.solid += 1,
                (Seen { face, .. }, truth) if face != truth.face => self.face += 1,
                _ => self.shadow += 1,
            },
            (SurfaceInShadow, Surface | Mirrored(_)) | (Surface | Mirrored(_), SurfaceInShadow) => {
                self.shadow += 1;
            }
            (Surface | Mirrored(_), Surface | Mirrored(_)) => self.mirror += 1,
            _ => self.solid += 1,
        }
    }
}

/// What a kernel gets wrong over some frames, and how many pixels were in doubt on the way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Errors {
    /// Pixels with a wrong decision.
    pub wrong_pixels: WrongPixels,
    /// The difference of all samples.
    pub all: Difference,
    /// The difference of the samples of those pixels that are decided rightly: errors of
    /// arithmetic, not of decisions.
    pub decided_rightly: Difference,
    /// Pixels that cheaper arithmetic left in doubt.
    pub in_doubt: InDoubt,
}

impl Errors {
    /// Adds a frame: what a kernel made of it, and what it truly is. Pixels that one of the four
    /// lacks are left out.
    pub fn add(
        &mut self,
        (image, decisions): (&Image, &[Decision]),
        (true_image, true_decisions): (&Image, &[Decision]),
        in_doubt: InDoubt,
    ) {
        let pixels = image.samples().chunks_exact(3).zip(decisions);
        let true_pixels = true_image.samples().chunks_exact(3).zip(true_decisions);
        for ((samples, &decision), (true_samples, &truth)) in pixels.zip(true_pixels) {
            self.wrong_pixels.add(decision, truth);
            for (&sample, &true_sample) in samples.iter().zip(true_samples) {
                self.all.add(sample, true_sample);
                if decision == truth {
                    self.decided_rightly.add(sample, true_sample);
                }
            }
        }
        self.in_doubt.double_double += in_doubt.double_double;
        self.in_doubt.arbitrary += in_doubt.arbitrary;
    }
}
