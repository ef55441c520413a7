//! The error view: the shown picture against the truth, on a thread of its own.

use std::sync::{Arc, Mutex};
use std::time::Instant;

use glam::UVec2;

use crate::diagnosis::{Examination, Hint, TOLERANCE};
use crate::difference::{error_color, steps};
use crate::tracer::{Decision, Progress, TraceError};
use crate::{Image, Kernel, Scene, Stage, Tracer};

use super::renderer::Renderer;
use super::tracing::{Frame, lock};
use super::worker::Worker;
use super::wrong::Wrong;
use super::{Options, ViewerError};

/// Wrong pixels are ringed one by one in tiles of so many pixels a side, as long as a tile has few
/// of them.
const TILE: usize = 16;
const MAX_RINGED: usize = 4;

/// Rings are for single pixels; where there are more than this, nobody looks for one.
const MAX_RINGS: usize = 512;

/// How far a picture is from the truth.
pub(super) struct Compared {
    pub(super) frame: Frame,
    /// In false colours.
    pub(super) image: Arc<Image>,
    /// Wrong pixels, column and row, that could be missed.
    pub(super) rings: Vec<(UVec2, Wrong)>,
    /// The kinds of wrong pixels that there are, and how many of each.
    pub(super) wrong: Vec<(Wrong, usize)>,
    /// Samples that are not the true ones, to the last bit.
    pub(super) misrounded: usize,
    /// The largest error in f32 steps of pixels that are not wrong.
    pub(super) largest: u32,
    /// What the picture looks like a mistake of, one a line.
    pub(super) hints: Vec<String>,
}

/// What the thread answers.
pub(super) enum Reply {
    /// It traces the picture of this kernel now.
    Begun(Kernel, Progress),
    Done(Compared),
    Failed(ViewerError),
}

/// The error view, while it is shown.
pub(super) struct ErrorView {
    /// Since when those of the present frame are to be shown.
    pub(super) since: Instant,
    /// The kernel whose picture was traced last for a comparison, and how far that is.
    pub(super) tracing: Option<(Kernel, Progress)>,
    /// The comparison that was done last, which the window shows.
    pub(super) done: Option<Compared>,
}

impl ErrorView {
    /// None yet, and awaited from now on.
    pub(super) fn since(now: Instant) -> ErrorView {
        ErrorView {
            since: now,
            tracing: None,
            done: None,
        }
    }

    /// Whether those of `frame` are not there yet.
    pub(super) fn are_awaited(&self, frame: &Frame) -> bool {
        self.done.as_ref().map(|compared| &compared.frame) != Some(frame)
    }

    /// What is seen, and how far the comparison of `frame` is, of pictures of `size` × `size`
    /// pixels.
    pub(super) fn text(&self, frame: &Frame, size: u32) -> String {
        let mut lines = Vec::new();
        if let Some(compared) = &self.done {
            let wrong: usize = compared.wrong.iter().map(|(_, count)| count).sum();
            let ringed = if compared.rings.is_empty() {
                ""
            } else {
                ", single ones ringed"
            };
            lines.push(format!(
                "{} against the truth\n\
                 wrong pixels: {wrong}{ringed}\n\
                 misrounded samples: {}, at most {} f32 steps off",
                compared.frame.renderer.name(),
                compared.misrounded,
                compared.largest,
            ));
            lines.extend(compared.hints.iter().map(|hint| format!("hint: {hint}")));
        }
        if self.are_awaited(frame) {
            let tracing = self.tracing.as_ref().map(|(kernel, progress)| {
                let percent = 100 * u64::from(progress.rows()) / u64::from(size.max(1));
                format!(", tracing {} {percent} %", kernel.name())
            });
            lines.push(format!(
                "comparing {}{} … {:.1} s",
                frame.renderer.name(),
                tracing.unwrap_or_default(),
                self.since.elapsed().as_secs_f64()
            ));
        }
        lines.join("\n")
    }
}

/// The thread that compares.
pub(super) struct Comparing {
    worker: Worker<Task, Reply>,
    requested: Option<Frame>,
    /// How far the picture is that is traced now, or was traced last.
    progress: Arc<Mutex<Progress>>,
}

/// A frame, and its picture where a renderer made it that does not tell its decisions.
struct Task(Frame, Option<Arc<Image>>);

impl Comparing {
    /// Starts the thread; `wake` is called there when there is a reply.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub(super) fn start(
        options: &Options,
        wake: impl Fn() + Send + 'static,
    ) -> Result<Comparing, ViewerError> {
        let (size, threads) = (options.size, options.threads);
        let progress = Arc::<Mutex<Progress>>::default();
        let theirs = progress.clone();
        let worker = Worker::start("comparing", wake, move |task, reply| {
            let Some(Task(frame, image)) = task else {
                return;
            };
            let (scene, stage, alpha) = (&*frame.scene, frame.stage, frame.alpha);
            let mut trace = |kernel| {
                let mut image = Image::new(size)?;
                let mut tracer = Tracer::new(kernel, threads)?;
                *lock(&theirs) = tracer.progress();
                reply(Reply::Begun(kernel, tracer.progress()));
                let decisions = tracer.trace_with_decisions(scene, stage, alpha, &mut image)?;
                Ok((image, decisions))
            };
            let answer = match (&frame.renderer, image) {
                (Renderer::Kernel(kernel), _) => compare_kernel(*kernel, &mut trace),
                (Renderer::Given(_), None) => return,
                (Renderer::Given(_), Some(image)) => {
                    examine(&image, threads, (scene, stage, alpha))
                }
            };
            match answer {
                Ok(errors) => reply(Reply::Done(errors.compared(frame))),
                Err(ViewerError::Trace(TraceError::Cancelled)) => {}
                Err(error) => reply(Reply::Failed(error)),
            }
        })
        .map_err(ViewerError::Thread)?;
        Ok(Comparing {
            worker,
            requested: None,
            progress,
        })
    }

    /// Requests the errors of `frame`, unless they were requested last.
    pub(super) fn request(&mut self, frame: &Frame, image: Option<&Arc<Image>>) {
        let image = match frame.renderer {
            Renderer::Kernel(_) => None,
            // The next picture comes with its samples.
            Renderer::Given(_) if image.is_none() => return,
            Renderer::Given(_) => image.cloned(),
        };
        let last = self.requested.as_ref();
        if last != Some(frame) {
            if last.is_some_and(|last| !last.differs_in_angle(frame)) {
                self.cancel();
            }
            self.requested = Some(frame.clone());
            self.worker.request(Task(frame.clone(), image));
        }
    }

    /// Forgets the last request, which nobody waits for any more.
    pub(super) fn forget(&mut self) {
        self.requested = None;
        self.cancel();
    }

    fn cancel(&self) {
        lock(&self.progress).cancel();
    }

    pub(super) fn reply(&self) -> Option<Reply> {
        self.worker.reply()
    }
}

/// A picture, the true one, and what is wrong with each pixel, rows from the bottom.
struct Errors {
    image: Image,
    truth: Image,
    wrong: Vec<Option<Wrong>>,
    hints: Vec<String>,
}

/// The errors of a kernel, whose decisions tell what is wrong; `trace` gives the picture of a
/// kernel, and what was decided for each pixel.
fn compare_kernel(
    kernel: Kernel,
    mut trace: impl FnMut(Kernel) -> Result<(Image, Vec<Decision>), ViewerError>,
) -> Result<Errors, ViewerError> {
    let (image, decisions) = trace(kernel)?;
    let (truth, true_decisions) = trace(Kernel::Reference)?;
    let pairs = decisions.into_iter().zip(true_decisions);
    Ok(Errors {
        image,
        truth,
        wrong: pairs
            .map(|(decision, truth)| Wrong::of_decision(decision, truth))
            .collect(),
        hints: Vec::new(),
    })
}

/// The errors of a picture of which nothing is known but its samples.
fn examine(
    image: &Image,
    threads: usize,
    (scene, stage, alpha): (&Scene, Stage, f64),
) -> Result<Errors, ViewerError> {
    let examination = Examination::new(scene, stage, alpha, image, TOLERANCE, threads)?;
    let diagnosis = examination.diagnosis()?;
    let pairs = diagnosis.verdicts.iter().zip(examination.decisions());
    Ok(Errors {
        wrong: pairs
            .map(|(&verdict, &truth)| Wrong::of_verdict(verdict, truth))
            .collect(),
        hints: examination
            .hints(&diagnosis)
            .iter()
            .map(Hint::to_string)
            .collect(),
        truth: examination.truth().clone(),
        image: image.clone(),
    })
}

impl Errors {
    /// In false colours, and counted.
    fn compared(mut self, frame: Frame) -> Compared {
        let (mut misrounded, mut largest) = (0, 0);
        let pixels = self.image.samples_mut().chunks_exact_mut(3);
        let true_pixels = self.truth.samples().chunks_exact(3);
        for ((samples, truth), wrong) in pixels.zip(true_pixels).zip(&self.wrong) {
            let errors = [0, 1, 2].map(|channel| steps(samples[channel], truth[channel]));
            misrounded += errors.iter().filter(|&&error| error != Some(0)).count();
            // A NaN in the place of a number is worse than any number.
            let worst = match errors {
                [Some(red), Some(green), Some(blue)] => Some(red.max(green).max(blue)),
                _ => None,
            };
            let color = wrong.map_or_else(
                || {
                    largest = largest.max(worst.unwrap_or(u32::MAX));
                    error_color(worst)
                },
                Wrong::color,
            );
            for (sample, byte) in samples.iter_mut().zip(color) {
                *sample = f32::from(byte) / 255.0;
            }
        }
        let count = |kind| self.wrong.iter().filter(|&&one| one == Some(kind)).count();
        let counts = Wrong::ALL.map(|kind| (kind, count(kind)));
        Compared {
            frame,
            rings: rings(&self.wrong, self.image.size() as usize),
            image: Arc::new(self.image),
            wrong: counts.into_iter().filter(|(_, count)| *count > 0).collect(),
            misrounded,
            largest,
            hints: self.hints,
        }
    }
}

/// The pixels of `wrong`, rows of `size`, that are few in their tile.
fn rings(wrong: &[Option<Wrong>], size: usize) -> Vec<(UVec2, Wrong)> {
    let tiles = size.div_ceil(TILE);
    let mut found = vec![Vec::new(); tiles * tiles];
    for (number, wrong) in wrong.iter().enumerate() {
        let Some(wrong) = *wrong else { continue };
        let (column, row) = (number % size, number / size);
        let tile = &mut found[row / TILE * tiles + column / TILE];
        if tile.len() <= MAX_RINGED {
            tile.push((UVec2::new(column as u32, row as u32), wrong));
        }
    }
    let few = found.into_iter().filter(|tile| tile.len() <= MAX_RINGED);
    few.flatten().take(MAX_RINGS).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;
    use crate::Stage;

    #[test]
    fn a_comparison_says_how_far_it_is() {
        let frame = Frame {
            scene: Arc::new(Scene::builtin()),
            stage: Stage::Reflection,
            alpha: 0.0,
            renderer: Renderer::Kernel(Kernel::Fast),
        };
        let mut errors = ErrorView::since(Instant::now());
        let mut begun = Vec::new();
        let compared = compare_kernel(Kernel::Fast, |kernel| {
            let progress = Progress::default();
            errors.tracing = Some((kernel, progress.clone()));
            begun.push(errors.text(&frame, 40));
            progress.add(40);
            let (mut image, mut decisions) = (Image::new(40)?, vec![Decision::Background; 1600]);
            // One pixel that is decided wrongly, and one that is three steps off.
            if kernel == Kernel::Fast {
                decisions[5] = Decision::Surface;
                image.samples_mut()[3 * 5] = 0.5;
                image.samples_mut()[3 * 7] = f32::from_bits(3);
            }
            Ok((image, decisions))
        });
        let compared = compared.unwrap().compared(frame.clone());
        assert!(begun[0].starts_with("comparing fast, tracing fast 0 % … "));
        assert!(begun[1].starts_with("comparing fast, tracing reference 0 % … "));
        assert!(
            errors
                .text(&frame, 40)
                .starts_with("comparing fast, tracing reference 100 % … ")
        );
        assert_eq!(compared.wrong, [(Wrong::Solid, 1)]);
        assert_eq!(compared.rings, [(UVec2::new(5, 0), Wrong::Solid)]);
        errors.done = Some(compared);
        assert_eq!(
            errors.text(&frame, 40),
            "fast against the truth\n\
             wrong pixels: 1, single ones ringed\n\
             misrounded samples: 2, at most 3 f32 steps off"
        );
    }

    #[test]
    fn single_wrong_pixels_are_ringed_and_crowds_are_not() {
        let size = 40;
        let mut wrong = vec![None; size * size];
        wrong[3 * size + 39] = Some(Wrong::Face);
        for column in 0..12 {
            wrong[20 * size + column] = Some(Wrong::Solid);
        }
        assert_eq!(rings(&wrong, size), [(UVec2::new(39, 3), Wrong::Face)]);
        assert!(rings(&[], 0).is_empty());
    }
}
