//! What a kernel gets wrong: decisions as decisions, samples as samples.

use crate::Image;
use crate::difference::Difference;
use crate::tracer::{Decision, InDoubt, Seen};

/// Pixels with a wrong decision, each counted once: by the first thing that is wrong about it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct WrongPixels {
    /// Something else is seen: another solid, the surface, the background.
    pub(super) solid: u64,
    /// The right tetrahedron, but another of its faces.
    pub(super) face: u64,
    /// The right thing, but in shadow instead of in light, or the other way round.
    pub(super) shadow: u64,
    /// The surface in light, but it mirrors something else, or the same otherwise lit.
    pub(super) mirror: u64,
}

impl WrongPixels {
    /// All of them.
    pub(super) fn total(&self) -> u64 {
        self.solid + self.face + self.shadow + self.mirror
    }

    /// Counts a pixel, if `decision` is wrong.
    pub(super) fn add(&mut self, decision: Decision, truth: Decision) {
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
pub(super) struct Errors {
    /// Pixels with a wrong decision.
    pub(super) wrong_pixels: WrongPixels,
    /// The difference of all samples.
    pub(super) all: Difference,
    /// The difference of the samples of those pixels that are decided rightly: errors of
    /// arithmetic, not of decisions.
    pub(super) decided_rightly: Difference,
    /// Pixels that cheaper arithmetic left in doubt.
    pub(super) in_doubt: InDoubt,
}

impl Errors {
    /// Adds a frame: what a kernel made of it, and what it truly is. Pixels that one of the four
    /// lacks are left out.
    pub(super) fn add(
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;

    const SPHERE: Seen = Seen {
        solid: 0,
        face: None,
        in_shadow: false,
    };
    const FACE: Seen = Seen {
        solid: 2,
        face: Some(1),
        in_shadow: false,
    };

    #[test]
    fn a_wrong_pixel_is_counted_by_the_first_thing_that_is_wrong() {
        use Decision::{Background, Mirrored, Quadrant, Solid, Surface, SurfaceInShadow};
        let dark = |seen| Seen {
            in_shadow: true,
            ..seen
        };
        let face = |face| Seen {
            face: Some(face),
            ..FACE
        };
        let kinds = [
            // Right: not counted.
            (Solid(FACE), Solid(FACE), [0, 0, 0, 0]),
            (Mirrored(SPHERE), Mirrored(SPHERE), [0, 0, 0, 0]),
            // Another thing, whatever else is wrong with it.
            (Background, Solid(SPHERE), [1, 0, 0, 0]),
            (Solid(dark(FACE)), Solid(SPHERE), [1, 0, 0, 0]),
            (Surface, Solid(SPHERE), [1, 0, 0, 0]),
            (Mirrored(SPHERE), Solid(SPHERE), [1, 0, 0, 0]),
            (Background, SurfaceInShadow, [1, 0, 0, 0]),
            (Quadrant(0), Quadrant(1), [1, 0, 0, 0]),
            // Another face, in shadow or not.
            (Solid(face(3)), Solid(FACE), [0, 1, 0, 0]),
            (Solid(dark(face(3))), Solid(FACE), [0, 1, 0, 0]),
            // Shadows, on solids and on the surface.
            (Solid(dark(FACE)), Solid(FACE), [0, 0, 1, 0]),
            (SurfaceInShadow, Surface, [0, 0, 1, 0]),
            (Mirrored(SPHERE), SurfaceInShadow, [0, 0, 1, 0]),
            // What the surface mirrors.
            (Surface, Mirrored(SPHERE), [0, 0, 0, 1]),
            (Mirrored(FACE), Mirrored(SPHERE), [0, 0, 0, 1]),
            (Mirrored(face(0)), Mirrored(FACE), [0, 0, 0, 1]),
            (Mirrored(dark(SPHERE)), Mirrored(SPHERE), [0, 0, 0, 1]),
        ];
        for (decision, truth, expected) in kinds {
            for (decision, truth) in [(decision, truth), (truth, decision)] {
                let mut wrong = WrongPixels::default();
                wrong.add(decision, truth);
                let WrongPixels {
                    solid,
                    face,
                    shadow,
                    mirror,
                } = wrong;
                assert_eq!(
                    [solid, face, shadow, mirror],
                    expected,
                    "{decision:?} for {truth:?}"
                );
                assert_eq!(wrong.total(), expected.iter().sum::<u64>());
            }
        }
    }

    #[test]
    fn known_errors_are_counted_as_they_are() {
        let truth = Image::new(2).unwrap();
        let true_decisions = [Decision::Background; 4];
        let mut image = truth.clone();
        // Pixel 0: three floats off in one sample. Pixel 1: a wrong decision, with a large error.
        // Pixel 2: a NaN.
        image.samples_mut()[1] = f32::from_bits(3);
        image.samples_mut()[4] = 0.75;
        image.samples_mut()[8] = f32::NAN;
        let mut decisions = true_decisions;
        decisions[1] = Decision::Surface;
        let in_doubt = InDoubt {
            double_double: 5,
            arbitrary: 1,
        };
        let mut errors = Errors::default();
        for _ in 0..2 {
            errors.add((&image, &decisions), (&truth, &true_decisions), in_doubt);
        }
        // Two frames: everything twice, the largest and the means once.
        assert_eq!(errors.wrong_pixels.total(), 2);
        assert_eq!((errors.all.samples, errors.all.wrong), (24, 6));
        assert_eq!(errors.all.max_abs, 0.75);
        assert_eq!(errors.all.nans, [2, 0]);
        assert_eq!(errors.all.eight_bit, 2);
        let mean = (0.75 + f64::from(f32::from_bits(3))) / 11.0;
        assert!((errors.all.mean_abs() - mean).abs() < 1e-15);
        // Steps are counted where the decision is right.
        let rightly = &errors.decided_rightly;
        assert_eq!(
            (rightly.samples, rightly.wrong, rightly.max_steps),
            (18, 4, 3)
        );
        assert_eq!(rightly.mean_steps(), 3.0 / 8.0);
        assert_eq!(
            (errors.in_doubt.double_double, errors.in_doubt.arbitrary),
            (10, 2)
        );
    }
}
