//! What is wrong with a picture that somebody else has made of a scene.
//!
//! A wrong pixel mostly has the colour of another decision, such as that of the surface in shadow
//! where the surface is lit. The tracer knows the colour of every decision, so each wrong pixel
//! gets a [`Verdict`], and verdicts are counted by kind.
//!
//! ```
//! use firsthit::diagnosis::{Examination, TOLERANCE, Verdict};
//! use firsthit::{Image, Kernel, Scene, Stage, Tracer};
//!
//! let scene = Scene::builtin();
//! let mut image = Image::new(64)?;
//! Tracer::new(Kernel::Exact, 1)?.trace(&scene, Stage::Shadow, 0.0, &mut image)?;
//! // The corner shows the background; somebody's tracer shows the surface there, in shadow.
//! image.samples_mut()[..3].fill(0.3);
//!
//! let examination = Examination::new(&scene, Stage::Shadow, 0.0, &image, TOLERANCE, 1)?;
//! let diagnosis = examination.diagnosis()?;
//! assert_eq!(diagnosis.summary.wrong_decisions.solid, 1);
//! let pixel = examination.pixel(0, 0).expect("a pixel of the picture");
//! assert_eq!(pixel.words, "shows the surface in shadow, where the background is seen");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Some mistakes of tracers are well known, and their pictures can be computed. Where such a
//! picture explains the given one, the given one earns a [`Hint`] at what to look at in the code.

mod decision_words;
mod fits;
mod hint;
mod hypotheses;
mod pixel;
mod verdict;
mod wrong_decision;

use crate::image::ImageError;
use crate::tracer::{Colors, Decision, TraceError, with_colors};
use crate::{Image, Kernel, Scene, Stage, Tracer, memory};
use decision_words::DecisionWords;
use fits::{Candidates, is_within};
pub use hint::Hint;
use hypotheses::{Sample, hints_of_known_mistakes, is_scattered_with_shadow};
pub use pixel::PixelDiagnosis;
pub use verdict::{Summary, Verdict};
pub use wrong_decision::{WrongDecision, WrongPixels};

/// The usual tolerance: the distance of two neighbouring bytes of a display. A sample may be as far
/// from that of a decision and still count as its sample.
pub const TOLERANCE: f32 = 1.0 / 255.0;

/// An examination that cannot be begun, for want of the true picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExaminationError {
    /// The true picture cannot be traced.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// There is no memory for the true picture.
    #[error(transparent)]
    Image(#[from] ImageError),
}

/// A picture that somebody has made, and the truth beside it.
pub struct Examination<'a> {
    scene: &'a Scene,
    stage: Stage,
    alpha: f64,
    image: &'a Image,
    tolerance: f32,
    truth: Image,
    decisions: Vec<Decision>,
}

/// The verdicts on all pixels of a picture.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// N² verdicts, rows from the bottom.
    pub verdicts: Vec<Verdict>,
    /// How many there are of each kind.
    pub summary: Summary,
}

impl<'a> Examination<'a> {
    /// Traces the truth: `scene` in `stage`, seen at angle `alpha` in radians, with `threads`
    /// threads, 0 being one a core. A pixel of `image` counts as that of a decision if every sample
    /// is at most `tolerance` from that decision's; [`TOLERANCE`] is the usual one. With a NaN or a
    /// negative number, every pixel is wrong.
    ///
    /// # Errors
    /// [`ExaminationError::Trace`] where `alpha` is not finite or there are no threads,
    /// [`ExaminationError::Image`] where there is no memory for another picture.
    pub fn new(
        scene: &'a Scene,
        stage: Stage,
        alpha: f64,
        image: &'a Image,
        tolerance: f32,
        threads: usize,
    ) -> Result<Examination<'a>, ExaminationError> {
        let mut truth = Image::new(image.size())?;
        let mut tracer = Tracer::new(Kernel::Exact, threads)?;
        let decisions = tracer.trace_with_decisions(scene, stage, alpha, &mut truth)?;
        Ok(Examination {
            scene,
            stage,
            alpha,
            image,
            tolerance,
            truth,
            decisions,
        })
    }

    /// The true picture.
    pub fn truth(&self) -> &Image {
        &self.truth
    }

    /// The true decisions: N² of them, rows from the bottom.
    pub fn decisions(&self) -> &[Decision] {
        &self.decisions
    }

    /// The verdicts on all pixels.
    ///
    /// # Errors
    /// [`ImageError::Memory`] where there is no memory for them.
    pub fn diagnosis(&self) -> Result<Diagnosis, ImageError> {
        let size = self.image.size();
        let mut verdicts = Vec::new();
        memory::reserve(&mut verdicts, self.decisions.len())
            .map_err(|_| ImageError::Memory(size, size))?;
        let mut summary = Summary::default();
        let mut largest = 0.0;
        self.with_candidates(|candidates| {
            let pixels = (0..size).flat_map(|row| (0..size).map(move |column| (column, row)));
            for (index, pixel) in pixels.enumerate() {
                let compared = self.compared(index);
                let verdict = compared.verdict(pixel, candidates);
                let error = compared.error();
                if verdict != Verdict::Right && (summary.worst.is_none() || error > largest) {
                    summary.worst = Some(pixel);
                    largest = error;
                }
                summary.add(verdict, compared.truth);
                verdicts.push(verdict);
            }
        });
        Ok(Diagnosis { verdicts, summary })
    }

    /// One pixel, with all decisions that explain it; `None` outside of the picture.
    pub fn pixel(&self, column: u32, row: u32) -> Option<PixelDiagnosis> {
        let samples = self.image.pixel(column, row)?;
        let compared = self.compared(row as usize * self.image.size() as usize + column as usize);
        let (pixel, truth) = ((column, row), compared.truth);
        let (verdict, explanations) = self.with_candidates(|candidates| {
            let verdict = compared.verdict(pixel, candidates);
            let explanations = match verdict {
                Verdict::Shows(_) | Verdict::Several => {
                    candidates.fitting(pixel, samples, truth, usize::MAX)
                }
                _ => Vec::new(),
            };
            (verdict, explanations)
        });
        let words = self.words(verdict, &explanations, truth);
        Some(PixelDiagnosis {
            samples,
            true_samples: compared.true_samples,
            true_decision: truth,
            verdict,
            explanations,
            words,
        })
    }

    /// Hints at the well-known mistakes that explain the picture, which has this `diagnosis`; none
    /// where no mistake explains the picture, and of several mistakes only those that explain it
    /// best.
    pub fn hints(&self, diagnosis: &Diagnosis) -> Vec<Hint> {
        if diagnosis.summary.wrong() == 0 {
            return Vec::new();
        }
        let frame = (self.scene, self.stage, self.alpha, self.image.size());
        let sample = Sample::new(self.image, &self.truth, self.tolerance, self.scene);
        let mut hints = hints_of_known_mistakes(frame, &self.truth, &sample);
        if is_scattered_with_shadow(&diagnosis.verdicts, &self.decisions, self.image.size()) {
            hints.push(Hint::ShadowAcne);
        }
        hints
    }

    fn words(&self, verdict: Verdict, explanations: &[Decision], truth: Decision) -> String {
        let words = DecisionWords {
            scene: self.scene,
            stage: self.stage,
        };
        let within = if self.tolerance.to_bits() == TOLERANCE.to_bits() {
            "within 1/255".to_owned()
        } else {
            format!("within {}", self.tolerance)
        };
        match verdict {
            Verdict::Right => "is right, bit for bit".to_owned(),
            Verdict::Rounding => format!("is right but for rounding: {within}"),
            Verdict::Shows(decision) => words.shown(decision, truth),
            Verdict::Several => format!(
                "is {within} of what {} decisions give: {}",
                explanations.len(),
                words.list(explanations)
            ),
            Verdict::AnotherColor => {
                format!("is another colour: what no decision gives {within}")
            }
            Verdict::NotANumber => "is not a number".to_owned(),
        }
    }

    fn with_candidates<T>(&self, work: impl FnOnce(&Candidates<'_, '_>) -> T) -> T {
        let frame = (self.scene, self.stage, self.alpha, self.image.size());
        with_colors(frame, |colors: &Colors<'_>| {
            work(&Candidates::new(colors, self.tolerance))
        })
    }

    /// The pixel of this number, rows from the bottom.
    fn compared(&self, index: usize) -> Compared {
        let at = |image: &Image| [0, 1, 2].map(|channel| image.samples()[3 * index + channel]);
        Compared {
            samples: at(self.image),
            true_samples: at(&self.truth),
            truth: self.decisions[index],
            tolerance: self.tolerance,
        }
    }
}

/// A pixel and the true one.
struct Compared {
    samples: [f32; 3],
    true_samples: [f32; 3],
    truth: Decision,
    tolerance: f32,
}

impl Compared {
    fn verdict(&self, pixel: (u32, u32), candidates: &Candidates<'_, '_>) -> Verdict {
        if self.samples.map(f32::to_bits) == self.true_samples.map(f32::to_bits) {
            return Verdict::Right;
        }
        if self.samples.iter().any(|sample| sample.is_nan()) {
            return Verdict::NotANumber;
        }
        if is_within(self.tolerance, self.samples, self.true_samples) {
            return Verdict::Rounding;
        }
        match candidates.fitting(pixel, self.samples, self.truth, 2)[..] {
            [] => Verdict::AnotherColor,
            [decision] => Verdict::Shows(decision),
            _ => Verdict::Several,
        }
    }

    /// The largest absolute error of a sample; infinite where a sample is a NaN or infinite.
    fn error(&self) -> f64 {
        let errors = [0, 1, 2].map(|channel| {
            let error = f64::from(self.samples[channel]) - f64::from(self.true_samples[channel]);
            if error.is_nan() {
                f64::INFINITY
            } else {
                error.abs()
            }
        });
        errors.into_iter().fold(0.0, f64::max)
    }
}
