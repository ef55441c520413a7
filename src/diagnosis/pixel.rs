//! One pixel of somebody's picture, beside the truth.

use std::fmt;

use super::verdict::Verdict;
use crate::difference::steps;
use crate::image::display_byte;
use crate::tracer::{Decision, say};

/// What is wrong with one pixel. Its display is a few lines of text, laid out as those of
/// [`Tracer::explain`](crate::Tracer::explain).
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PixelDiagnosis {
    /// The samples of the picture.
    pub samples: [f32; 3],
    /// The true samples.
    pub true_samples: [f32; 3],
    /// The true decision.
    pub true_decision: Decision,
    /// What is wrong.
    pub verdict: Verdict,
    /// The wrong decisions whose colour is within the tolerance of the samples; none where the
    /// pixel is right or a rounding.
    pub explanations: Vec<Decision>,
    /// The verdict in words, one line: a sentence whose subject is the pixel.
    pub words: String,
}

impl fmt::Display for PixelDiagnosis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = String::new();
        let channels = [0, 1, 2];
        let samples = |samples: [f32; 3]| {
            let [r, g, b] = samples;
            let bytes = samples.map(|sample| display_byte(sample).to_string());
            format!("{r:?} {g:?} {b:?}  (bytes {})", bytes.join(" "))
        };
        let steps = channels.map(|channel| {
            match steps(self.samples[channel], self.true_samples[channel]) {
                Some(steps) => steps.to_string(),
                None => "NaN".to_owned(),
            }
        });
        let bytes = channels.map(|channel| {
            let byte = |samples: [f32; 3]| display_byte(samples[channel]);
            byte(self.samples)
                .abs_diff(byte(self.true_samples))
                .to_string()
        });
        say(&mut text, "yours", samples(self.samples));
        say(&mut text, "ours", samples(self.true_samples));
        let apart = format!("{} f32 steps, {} bytes", steps.join(" "), bytes.join(" "));
        say(&mut text, "apart", apart);
        say(&mut text, "verdict", &self.words);
        f.write_str(&text)
    }
}
