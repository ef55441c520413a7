//! Pictures traced, saved and explained on a thread of their own.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::UVec2;

use crate::image::{Format, SaveError};
use crate::tracer::{InDoubt, TraceError};
use crate::{Image, Kernel, Scene, Stage, Tracer};

use super::snapshot;
use super::worker::Worker;
use super::{Options, ViewerError};

/// What a picture is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub(super) stage: Stage,
    pub(super) alpha: f64,
    pub(super) kernel: Kernel,
}

/// The metadata of a traced picture.
#[derive(Clone)]
pub(super) struct Traced {
    pub(super) frame: Frame,
    /// Pictures are numbered as they are traced.
    pub(super) number: u64,
    /// All rows, from the bottom, that are not as in the picture with the number before.
    pub(super) changed: Range<u32>,
    /// How long tracing it took.
    pub(super) time: Duration,
    pub(super) in_doubt: InDoubt,
}

/// What the thread is asked for.
enum Task {
    Trace(Frame),
    Save(Frame, Format),
    Explain(Frame, UVec2),
}

/// What it answers.
pub(super) enum Reply {
    /// A picture that was requested.
    Traced(Traced, Arc<Image>),
    /// What became of a picture that was to be saved.
    Saved(Result<PathBuf, SaveError>),
    /// A pixel, worked through.
    Explained(UVec2, String),
    /// The kernel does not trace such a scene.
    Refused(Frame, TraceError),
    /// A failure that no other picture would avoid.
    Failed(ViewerError),
}

/// A tracer of frames with a pool of pictures to trace them into.
pub(super) struct FrameTracer {
    scene: Scene,
    tracer: Tracer,
    threads: usize,
    size: u32,
    /// The pool: every picture that was handed out, the last one at the end. A picture that nobody
    /// else holds is traced over.
    pictures: Vec<Arc<Image>>,
    /// What the last picture shows; `None` where it was overwritten.
    last: Option<Traced>,
    traces: u64,
}

impl FrameTracer {
    /// # Errors
    /// Where there are no threads, or no memory for the picture.
    pub(super) fn new(options: &Options) -> Result<FrameTracer, ViewerError> {
        Ok(FrameTracer {
            scene: options.scene.clone(),
            tracer: Tracer::new(options.kernel, options.threads)?,
            threads: options.threads,
            size: options.size,
            pictures: vec![Arc::new(Image::new(options.size)?)],
            last: None,
            traces: 0,
        })
    }

    /// The picture of `frame`; the last one is not traced again.
    fn trace(&mut self, frame: Frame) -> Result<(Traced, Arc<Image>), ViewerError> {
        if let (Some(last), Some(image)) = (&self.last, self.pictures.last())
            && last.frame == frame
        {
            return Ok((last.clone(), image.clone()));
        }
        self.last = None;
        self.choose(frame.kernel)?;
        let mut image = self.free_picture()?;
        let start = Instant::now();
        // Over another picture than its last one, the tracer writes all rows.
        let changed = match Arc::get_mut(&mut image) {
            Some(image) => self
                .tracer
                .retrace(&self.scene, frame.stage, frame.alpha, image),
            None => Ok(0..0),
        };
        let time = start.elapsed();
        self.pictures.push(image.clone());
        let changed = changed?;
        self.traces += 1;
        let traced = Traced {
            frame,
            number: self.traces,
            changed,
            time,
            in_doubt: self.tracer.in_doubt(),
        };
        self.last = Some(traced.clone());
        Ok((traced, image))
    }

    fn explain(&mut self, frame: Frame, pixel: UVec2) -> Result<String, ViewerError> {
        self.choose(frame.kernel)?;
        let Frame { stage, alpha, .. } = frame;
        Ok(self
            .tracer
            .explain(&self.scene, stage, alpha, self.size, pixel.into())?)
    }

    fn choose(&mut self, kernel: Kernel) -> Result<(), ViewerError> {
        if self.tracer.kernel() != kernel {
            self.tracer = Tracer::new(kernel, self.threads)?;
        }
        Ok(())
    }

    /// A picture that nobody else holds, taken out of the pool: the last one if possible, or else a
    /// new one.
    fn free_picture(&mut self) -> Result<Arc<Image>, ViewerError> {
        let free = self
            .pictures
            .iter_mut()
            .rposition(|picture| Arc::get_mut(picture).is_some());
        Ok(match free {
            Some(free) => self.pictures.remove(free),
            None => Arc::new(Image::new(self.size)?),
        })
    }
}

/// The thread that traces.
pub(super) struct Tracing {
    worker: Worker<Task, (u64, Reply)>,
    /// The frame that was requested last.
    requested: Option<Frame>,
    /// Pictures traced so far.
    pub(super) traces: u64,
}

impl Tracing {
    /// Starts the thread; `wake` is called there when there is a reply.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub(super) fn start(
        mut frame_tracer: FrameTracer,
        wake: impl Fn() + Send + 'static,
    ) -> Result<Tracing, ViewerError> {
        let worker = Worker::start("tracing", wake, move |task, reply| {
            let (Task::Trace(frame) | Task::Save(frame, _) | Task::Explain(frame, _)) = task;
            let answer = match task {
                Task::Trace(_) => frame_tracer
                    .trace(frame)
                    .map(|(traced, image)| Reply::Traced(traced, image)),
                Task::Save(_, format) => frame_tracer
                    .trace(frame)
                    .map(|(_, image)| Reply::Saved(snapshot::save(&image, frame.stage, format))),
                Task::Explain(_, pixel) => frame_tracer
                    .explain(frame, pixel)
                    .map(|text| Reply::Explained(pixel, text)),
            };
            let answer = answer.unwrap_or_else(|error| match error {
                ViewerError::Trace(error @ TraceError::Listing { .. }) => {
                    Reply::Refused(frame, error)
                }
                error => Reply::Failed(error),
            });
            reply((frame_tracer.traces, answer));
        })
        .map_err(ViewerError::Thread)?;
        Ok(Tracing {
            worker,
            requested: None,
            traces: 0,
        })
    }

    /// Requests the picture of `frame`, unless it was requested last.
    pub(super) fn request(&mut self, frame: Frame) {
        if self.requested != Some(frame) {
            self.requested = Some(frame);
            self.worker.request(Task::Trace(frame));
        }
    }

    /// Whether a picture was requested that is not `shown`.
    pub(super) fn is_behind(&self, shown: Option<Frame>) -> bool {
        self.requested != shown
    }

    /// Has the picture of `frame` saved.
    pub(super) fn save(&self, frame: Frame, format: Format) {
        self.worker.enqueue(Task::Save(frame, format));
    }

    /// Has a pixel of `frame`, column and row, worked through.
    pub(super) fn explain(&self, frame: Frame, pixel: UVec2) {
        self.worker.enqueue(Task::Explain(frame, pixel));
    }

    pub(super) fn reply(&mut self) -> Option<Reply> {
        let (traces, reply) = self.worker.reply()?;
        self.traces = traces;
        Some(reply)
    }

    /// Waits for the queued tasks, and gives the last replies.
    pub(super) fn finish(self) -> impl Iterator<Item = Reply> {
        self.worker.finish().into_iter().map(|(_, reply)| reply)
    }
}
