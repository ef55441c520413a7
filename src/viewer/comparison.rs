//! The error view: the shown kernel against `reference`, on a thread of its own.

use std::sync::Arc;
use std::time::Instant;

use glam::UVec2;

use crate::difference::{error_color, steps};
use crate::tracer::{Decision, Progress};
use crate::{Image, Kernel, Tracer};

use super::tracing::Frame;
use super::worker::Worker;
use super::{Options, ViewerError};

/// The colour of a pixel with a wrong decision: none of the scale's.
pub(super) const WRONG: [u8; 3] = [0, 255, 0];

/// Wrong pixels are ringed one by one in tiles of so many pixels a side, as long as a tile has few
/// of them.
const TILE: usize = 16;
const FEW: usize = 4;

/// Rings are for single pixels; where there are more than this, nobody looks for one.
const MAX_RINGS: usize = 512;

/// How far a picture is from the truth.
pub(super) struct Compared {
    pub(super) frame: Frame,
    /// In false colours.
    pub(super) image: Arc<Image>,
    /// Wrong pixels, column and row, that could be missed.
    pub(super) rings: Vec<UVec2>,
    /// Pixels with a wrong decision.
    pub(super) wrong: usize,
    /// Samples that are not those of `reference`.
    pub(super) misrounded: usize,
    /// The largest error in f32 steps of pixels that are decided rightly.
    pub(super) largest: u32,
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
    pub(super) fn are_awaited(&self, frame: Frame) -> bool {
        self.done.as_ref().map(|compared| compared.frame) != Some(frame)
    }

    /// What is seen, and how far the comparison of `frame` is, of pictures of `size` × `size`
    /// pixels.
    pub(super) fn text(&self, frame: Frame, size: u32) -> String {
        let mut lines = Vec::new();
        if let Some(compared) = &self.done {
            lines.push(format!(
                "{} against reference\n\
                 wrong pixels: {} (green, single ones ringed)\n\
                 misrounded samples: {}, at most {} f32 steps off",
                compared.frame.kernel.name(),
                compared.wrong,
                compared.misrounded,
                compared.largest,
            ));
        }
        if self.are_awaited(frame) {
            let tracing = self.tracing.as_ref().map(|(kernel, progress)| {
                let percent = 100 * u64::from(progress.rows()) / u64::from(size.max(1));
                format!(", tracing {} {percent} %", kernel.name())
            });
            lines.push(format!(
                "comparing {}{} … {:.1} s",
                frame.kernel.name(),
                tracing.unwrap_or_default(),
                self.since.elapsed().as_secs_f64()
            ));
        }
        lines.join("\n")
    }
}

/// The thread that compares.
pub(super) struct Comparing {
    worker: Worker<Frame, Reply>,
    requested: Option<Frame>,
}

impl Comparing {
    /// Starts the thread; `wake` is called there when there is a reply.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub(super) fn start(
        options: &Options,
        wake: impl Fn() + Send + 'static,
    ) -> Result<Comparing, ViewerError> {
        let (scene, size, threads) = (options.scene.clone(), options.size, options.threads);
        let worker = Worker::start("comparing", wake, move |frame, reply| {
            let answer = compare(frame, |kernel| {
                let mut image = Image::new(size)?;
                let mut tracer = Tracer::new(kernel, threads)?;
                reply(Reply::Begun(kernel, tracer.progress()));
                let Frame { stage, alpha, .. } = frame;
                let decisions = tracer.trace_with_decisions(&scene, stage, alpha, &mut image)?;
                Ok((image, decisions))
            });
            reply(answer.map_or_else(Reply::Failed, Reply::Done));
        })
        .map_err(ViewerError::Thread)?;
        Ok(Comparing {
            worker,
            requested: None,
        })
    }

    /// Requests the errors of `frame`, unless they were requested last.
    pub(super) fn request(&mut self, frame: Frame) {
        if self.requested != Some(frame) {
            self.requested = Some(frame);
            self.worker.request(frame);
        }
    }

    /// Forgets the last request, so that the same frame may be requested again.
    pub(super) fn forget(&mut self) {
        self.requested = None;
    }

    pub(super) fn reply(&self) -> Option<Reply> {
        self.worker.reply()
    }
}

/// How far `frame` is from the truth; `trace` gives the picture of a kernel, and what was decided
/// for each pixel.
fn compare(
    frame: Frame,
    mut trace: impl FnMut(Kernel) -> Result<(Image, Vec<Decision>), ViewerError>,
) -> Result<Compared, ViewerError> {
    let (mut image, decisions) = trace(frame.kernel)?;
    let (truth, true_decisions) = trace(Kernel::Reference)?;
    let wrong: Vec<bool> = decisions
        .iter()
        .zip(&true_decisions)
        .map(|(decision, truth)| decision != truth)
        .collect();
    let (mut misrounded, mut largest) = (0, 0);
    let pixels = image.samples_mut().chunks_exact_mut(3);
    for ((samples, truth), &wrong) in pixels.zip(truth.samples().chunks_exact(3)).zip(&wrong) {
        let errors = [0, 1, 2].map(|channel| steps(samples[channel], truth[channel]));
        misrounded += errors.iter().filter(|&&error| error != Some(0)).count();
        // A NaN in the place of a number is worse than any number.
        let worst = match errors {
            [Some(red), Some(green), Some(blue)] => Some(red.max(green).max(blue)),
            _ => None,
        };
        let color = if wrong {
            WRONG
        } else {
            largest = largest.max(worst.unwrap_or(u32::MAX));
            error_color(worst)
        };
        for (sample, byte) in samples.iter_mut().zip(color) {
            *sample = f32::from(byte) / 255.0;
        }
    }
    Ok(Compared {
        frame,
        image: Arc::new(image),
        rings: rings(&wrong, truth.size() as usize),
        wrong: wrong.iter().filter(|&&wrong| wrong).count(),
        misrounded,
        largest,
    })
}

/// The pixels of `wrong`, rows of `size`, that are few in their tile.
fn rings(wrong: &[bool], size: usize) -> Vec<UVec2> {
    let tiles = size.div_ceil(TILE);
    let mut found = vec![Vec::new(); tiles * tiles];
    for (number, _) in wrong.iter().enumerate().filter(|(_, wrong)| **wrong) {
        let (column, row) = (number % size, number / size);
        let tile = &mut found[row / TILE * tiles + column / TILE];
        if tile.len() <= FEW {
            tile.push(UVec2::new(column as u32, row as u32));
        }
    }
    let few = found.into_iter().filter(|tile| tile.len() <= FEW);
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
            stage: Stage::Reflection,
            alpha: 0.0,
            kernel: Kernel::Fast,
        };
        let mut errors = ErrorView::since(Instant::now());
        let mut begun = Vec::new();
        let compared = compare(frame, |kernel| {
            let progress = Progress::default();
            errors.tracing = Some((kernel, progress.clone()));
            begun.push(errors.text(frame, 40));
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
        let compared = compared.unwrap();
        assert!(begun[0].starts_with("comparing fast, tracing fast 0 % … "));
        assert!(begun[1].starts_with("comparing fast, tracing reference 0 % … "));
        assert!(
            errors
                .text(frame, 40)
                .starts_with("comparing fast, tracing reference 100 % … ")
        );
        errors.done = Some(compared);
        assert_eq!(
            errors.text(frame, 40),
            "fast against reference\n\
             wrong pixels: 1 (green, single ones ringed)\n\
             misrounded samples: 2, at most 3 f32 steps off"
        );
    }

    #[test]
    fn single_wrong_pixels_are_ringed_and_crowds_are_not() {
        let size = 40;
        let mut wrong = vec![false; size * size];
        wrong[3 * size + 39] = true;
        for column in 0..12 {
            wrong[20 * size + column] = true;
        }
        assert_eq!(rings(&wrong, size), [UVec2::new(39, 3)]);
        assert!(rings(&[], 0).is_empty());
    }
}
