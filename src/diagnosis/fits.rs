//! Which decisions give the colour of a pixel.

use std::collections::HashSet;
use std::mem::{Discriminant, discriminant};

use super::WrongDecision;
use crate::tracer::{Colors, Decision, Seen};

/// Whether all samples of a pixel are at most `tolerance` from those of another one; a NaN is not.
pub(super) fn is_within(tolerance: f32, a: [f32; 3], b: [f32; 3]) -> bool {
    let tolerance = f64::from(tolerance);
    (0..3).all(|channel| (f64::from(a[channel]) - f64::from(b[channel])).abs() <= tolerance)
}

/// A decision and the samples of its pixels.
type Candidate = (Decision, [f32; 3]);

/// All decisions of a frame, by their colours.
pub(super) struct Candidates<'c, 'f> {
    colors: &'c Colors<'f>,
    tolerance: f32,
    /// The decisions whose colour all their pixels share, sorted by red. Of several solids of one
    /// colour the first stands for all.
    shared: Vec<Candidate>,
}

impl<'c, 'f> Candidates<'c, 'f> {
    pub(super) fn new(colors: &'c Colors<'f>, tolerance: f32) -> Self {
        let mut known: HashSet<(Discriminant<Decision>, [u32; 3])> = HashSet::new();
        let mut shared: Vec<Candidate> = colors
            .shared()
            .filter_map(|decision| Some((decision, colors.color(decision, (0, 0))?)))
            .filter(|(decision, color)| {
                known.insert((discriminant(decision), color.map(f32::to_bits)))
            })
            .collect();
        shared.sort_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]));
        Candidates {
            colors,
            tolerance,
            shared,
        }
    }

    /// The wrong decisions, `most` at most, whose colour is within the tolerance of `samples` in a
    /// pixel whose true decision is `truth`.
    ///
    /// Solids that the pixel's line cannot meet are looked at only where nothing else fits: of two
    /// solids of one colour, the one at this pixel is the likelier. Decisions of equal samples that
    /// are wrong in the same way count as one, the first.
    pub(super) fn fitting(
        &self,
        pixel: (u32, u32),
        samples: [f32; 3],
        truth: Decision,
        most: usize,
    ) -> Vec<Decision> {
        let mut fits: Vec<Candidate> = Vec::new();
        for decision in self.colors.near(pixel) {
            let Some(color) = self.colors.color(decision, pixel) else {
                continue;
            };
            let decision = with_face_of(decision, truth);
            let means_another = |(other, samples): &Candidate| {
                samples.map(f32::to_bits) != color.map(f32::to_bits)
                    || WrongDecision::of(*other, truth) != WrongDecision::of(decision, truth)
            };
            if is_within(self.tolerance, samples, color)
                && decision != truth
                && fits.iter().all(means_another)
            {
                fits.push((decision, color));
            }
            if fits.len() >= most {
                break;
            }
        }
        let near = fits.into_iter().map(|(decision, _)| decision);
        let near: Vec<Decision> = near.collect();
        if near.is_empty() {
            self.fitting_anywhere(samples).take(most).collect()
        } else {
            near
        }
    }

    /// The decisions of shared colour that give these samples within the tolerance.
    fn fitting_anywhere(&self, samples: [f32; 3]) -> impl Iterator<Item = Decision> {
        let red = f64::from(samples[0]);
        let tolerance = f64::from(self.tolerance);
        let first = self
            .shared
            .partition_point(|(_, color)| f64::from(color[0]) - red < -tolerance);
        self.shared[first..]
            .iter()
            .take_while(move |(_, color)| f64::from(color[0]) - red <= tolerance)
            .filter(move |(_, color)| is_within(self.tolerance, samples, *color))
            .map(|(decision, _)| *decision)
    }
}

/// The decision with the face of the true one, where both are of one solid, in shadow: the colour
/// of a solid in shadow does not tell its face.
fn with_face_of(decision: Decision, truth: Decision) -> Decision {
    let with_face = |seen: Seen, truth: Seen| Seen {
        face: if seen.in_shadow && seen.solid == truth.solid {
            truth.face
        } else {
            seen.face
        },
        ..seen
    };
    match (decision, truth) {
        (Decision::Solid(seen), Decision::Solid(truth)) => Decision::Solid(with_face(seen, truth)),
        (Decision::Mirrored(seen), Decision::Mirrored(truth)) => {
            Decision::Mirrored(with_face(seen, truth))
        }
        _ => decision,
    }
}
