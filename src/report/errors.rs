//! What a kernel gets wrong: decisions as decisions, samples as samples.

use crate::Image;
use crate::diagnosis::WrongPixels;
use crate::difference::Difference;
use crate::tracer::{Decision, Tally};

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
    /// What the frames took.
    pub(super) tally: Tally,
}

impl Errors {
    /// Adds a frame: what a kernel made of it, and what it truly is. Pixels that one of the four
    /// lacks are left out.
    pub(super) fn add(
        &mut self,
        (image, decisions): (&Image, &[Decision]),
        (true_image, true_decisions): (&Image, &[Decision]),
        tally: Tally,
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
        self.tally = self.tally.and(tally);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;

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
        let tally = Tally {
            double_double: 5,
            arbitrary: 1,
            edges: 30,
            spans: 20,
        };
        let mut errors = Errors::default();
        for _ in 0..2 {
            errors.add((&image, &decisions), (&truth, &true_decisions), tally);
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
        assert_eq!(errors.tally, tally.and(tally));
    }
}
