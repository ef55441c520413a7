//! Pictures made, saved and explained on threads of their own: one for the kernels, and one for
//! each renderer that the viewer was given, since that may take its time.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use glam::UVec2;

use crate::diagnosis::{Examination, TOLERANCE};
use crate::image::{Format, SaveError};
use crate::tracer::{Progress, Tally, TraceError};
use crate::{Canceller, Image, Kernel, Render, RenderError, Scene, Stage, Tracer};

use super::renderer::Renderer;
use super::snapshot;
use super::worker::Worker;
use super::{Options, ViewerError};

/// What a picture is of, and what makes it.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub(super) scene: Arc<Scene>,
    pub(super) stage: Stage,
    pub(super) alpha: f64,
    pub(super) renderer: Renderer,
}

impl PartialEq for Frame {
    /// Scenes that were read one after the other count as different.
    fn eq(&self, other: &Frame) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && (self.stage, self.alpha) == (other.stage, other.alpha)
            && self.renderer == other.renderer
    }
}

impl Frame {
    /// Whether nothing but α tells one frame from another.
    pub(super) fn differs_in_angle(&self, other: &Frame) -> bool {
        let alpha = self.alpha;
        *self
            == Frame {
                alpha,
                ..other.clone()
            }
    }
}

/// The metadata of a picture.
#[derive(Clone)]
pub(super) struct Traced {
    pub(super) frame: Frame,
    /// The pictures of a thread are numbered as they are made; between the numbers of two threads
    /// there are gaps.
    pub(super) number: u64,
    /// All rows, from the bottom, that are not as in the picture with the number before.
    pub(super) changed: Range<u32>,
    /// How long it took.
    pub(super) time: Duration,
    pub(super) tally: Tally,
}

/// What a thread is asked for.
enum Task {
    Trace(Frame),
    Save(Frame, Format),
    /// With the picture, where a renderer made it.
    Explain(Frame, UVec2, Option<Arc<Image>>),
}

/// What it answers.
pub(super) enum Reply {
    /// A picture that was requested.
    Traced(Traced, Arc<Image>),
    /// What became of a picture that was to be saved.
    Saved(Result<PathBuf, SaveError>),
    /// A pixel, worked through.
    Explained(UVec2, String),
    /// There is no such picture: the kernel does not trace such a scene, or the renderer failed.
    Refused(Frame, RenderError),
    /// A failure that no other picture would avoid.
    Failed(ViewerError),
}

/// Why there is no picture.
enum Failure {
    Refused(RenderError),
    /// Nobody wants it any more.
    Cancelled,
    Viewer(ViewerError),
}

impl<E: Into<ViewerError>> From<E> for Failure {
    fn from(error: E) -> Failure {
        match error.into() {
            ViewerError::Trace(error @ TraceError::Listing { .. }) => {
                Failure::Refused(error.into())
            }
            ViewerError::Trace(TraceError::Cancelled) => Failure::Cancelled,
            error => Failure::Viewer(error),
        }
    }
}

/// What makes the pictures of a thread.
enum ThreadRenderer {
    /// The tracer, with the kernel that was asked for last.
    Kernels {
        tracer: Tracer,
        threads: usize,
        progress: Arc<Mutex<Progress>>,
    },
    /// A renderer that the viewer was given, and the edition of its files that it was made with.
    Given {
        renderer: Box<dyn Render + Send>,
        edition: u64,
    },
}

/// The rows that were written, and what the frame took.
type Written = (Range<u32>, Tally);

impl ThreadRenderer {
    /// Makes the picture of `frame` in `image`; where nobody else holds the last picture, that is
    /// in `image`.
    fn render(&mut self, frame: &Frame, image: &mut Image) -> Result<Written, Failure> {
        let (scene, stage, alpha) = (&*frame.scene, frame.stage, frame.alpha);
        match (self, &frame.renderer) {
            (
                ThreadRenderer::Kernels {
                    tracer,
                    threads,
                    progress,
                },
                renderer,
            ) => {
                choose(tracer, kernel_of(renderer), *threads)?;
                *lock(progress) = tracer.progress();
                let rows = tracer.retrace(scene, stage, alpha, image)?;
                Ok((rows, tracer.tally()))
            }
            (ThreadRenderer::Given { renderer, edition }, wanted) => {
                if let Renderer::Given(given) = wanted
                    && given.edition != *edition
                {
                    *edition = given.edition;
                    renderer.reload();
                }
                let rendered = renderer.render(scene, stage, alpha, image);
                rendered.map_err(Failure::Refused)?;
                Ok((0..image.size(), Tally::default()))
            }
        }
    }
}

pub(super) fn lock(progress: &Mutex<Progress>) -> MutexGuard<'_, Progress> {
    // Nothing happens under the lock that could fail halfway.
    progress.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The kernel that explains the pixels of a renderer: that of the truth, if it is none itself.
fn kernel_of(renderer: &Renderer) -> Kernel {
    match renderer {
        Renderer::Kernel(kernel) => *kernel,
        Renderer::Given(_) => Kernel::Exact,
    }
}

/// Makes `tracer` one with this kernel.
fn choose(tracer: &mut Tracer, kernel: Kernel, threads: usize) -> Result<(), ViewerError> {
    if tracer.kernel() != kernel {
        *tracer = Tracer::new(kernel, threads)?;
    }
    Ok(())
}

/// What makes pictures of frames, with a pool of images to make them in.
pub(super) struct Pictures {
    renderer: ThreadRenderer,
    size: u32,
    /// The pool: every picture that was handed out, the last one at the end. A picture that nobody
    /// else holds is written over.
    pool: Vec<Arc<Image>>,
    /// What the last picture shows; `None` where it was overwritten.
    last: Option<Traced>,
    /// The number of the last picture.
    number: u64,
}

/// The first number of the pictures of the next thread.
const NUMBERS: u64 = 1 << 48;

impl Pictures {
    /// Those of the kernels.
    ///
    /// # Errors
    /// Where there are no threads, or no memory for the picture.
    pub(super) fn of_kernels(options: &Options) -> Result<Pictures, ViewerError> {
        let (kernel, threads) = (options.kernel.unwrap_or_default(), options.threads);
        let tracer = Tracer::new(kernel, threads)?;
        Ok(Pictures {
            renderer: ThreadRenderer::Kernels {
                progress: Arc::new(Mutex::new(tracer.progress())),
                tracer,
                threads,
            },
            size: options.size,
            // Whether there is memory for it shows before the window opens.
            pool: vec![Arc::new(Image::new(options.size)?)],
            last: None,
            number: 0,
        })
    }

    /// Those of the renderer with this number.
    fn of_renderer(number: usize, renderer: Box<dyn Render + Send>, size: u32) -> Pictures {
        Pictures {
            renderer: ThreadRenderer::Given {
                renderer,
                edition: 0,
            },
            size,
            pool: Vec::new(),
            last: None,
            number: NUMBERS * (number as u64 + 1),
        }
    }

    /// The picture of `frame`; the last one is not made again.
    fn picture(&mut self, frame: &Frame) -> Result<(Traced, Arc<Image>), Failure> {
        if let (Some(last), Some(image)) = (&self.last, self.pool.last())
            && last.frame == *frame
        {
            return Ok((last.clone(), image.clone()));
        }
        self.last = None;
        let mut image = self.free_picture()?;
        let start = Instant::now();
        // Over another picture than its last one, the tracer writes all rows.
        let written = match Arc::get_mut(&mut image) {
            Some(image) => self.renderer.render(frame, image),
            None => Ok((0..0, Tally::default())),
        };
        let time = start.elapsed();
        self.pool.push(image.clone());
        let (changed, tally) = written?;
        self.number += 1;
        let traced = Traced {
            frame: frame.clone(),
            number: self.number,
            changed,
            time,
            tally,
        };
        self.last = Some(traced.clone());
        Ok((traced, image))
    }

    /// What is wrong with the pixel in `image`, if a renderer made that; and the pixel, worked
    /// through by the kernel, or by that of the truth.
    fn explain(
        &mut self,
        frame: &Frame,
        pixel: UVec2,
        image: Option<&Image>,
    ) -> Result<String, Failure> {
        let ThreadRenderer::Kernels {
            tracer, threads, ..
        } = &mut self.renderer
        else {
            return Ok(String::new());
        };
        choose(tracer, kernel_of(&frame.renderer), *threads)?;
        let (scene, stage, alpha) = (&*frame.scene, frame.stage, frame.alpha);
        let mut text = String::new();
        if let Some(image) = image {
            let examination = Examination::new(scene, stage, alpha, image, TOLERANCE, *threads)?;
            if let Some(diagnosis) = examination.pixel(pixel.x, pixel.y) {
                text += &diagnosis.to_string();
            }
        }
        text += &tracer.explain(scene, stage, alpha, self.size, pixel.into())?;
        Ok(text)
    }

    /// The picture of `frame`, whatever is cancelled meanwhile: another request may be meant.
    fn picture_in_any_case(&mut self, frame: &Frame) -> Result<(Traced, Arc<Image>), Failure> {
        loop {
            match self.picture(frame) {
                Err(Failure::Cancelled) => {}
                picture => return picture,
            }
        }
    }

    /// The reply, if anybody still wants one.
    fn answer(&mut self, task: Task) -> Option<Reply> {
        let (Task::Trace(frame) | Task::Save(frame, _) | Task::Explain(frame, ..)) = &task;
        let answer = match &task {
            Task::Trace(_) => self
                .picture(frame)
                .map(|(traced, image)| Reply::Traced(traced, image)),
            Task::Save(_, format) => self.picture_in_any_case(frame).map(|(_, image)| {
                let what = format!("stage{}", frame.stage.number());
                Reply::Saved(snapshot::save(&image, &what, *format))
            }),
            Task::Explain(_, pixel, image) => self
                .explain(frame, *pixel, image.as_deref())
                .map(|text| Reply::Explained(*pixel, text)),
        };
        match answer {
            Ok(reply) => Some(reply),
            Err(Failure::Refused(reason)) => Some(Reply::Refused(frame.clone(), reason)),
            Err(Failure::Cancelled) => None,
            Err(Failure::Viewer(error)) => Some(Reply::Failed(error)),
        }
    }

    /// What has been found to be wrong with the last picture since it was made, if anything: it is
    /// made again where it is wanted again.
    fn recheck(&mut self) -> Option<Reply> {
        let ThreadRenderer::Given { renderer, .. } = &mut self.renderer else {
            return None;
        };
        let reason = renderer.recheck().err()?;
        Some(Reply::Refused(self.last.take()?.frame, reason))
    }

    /// A picture that nobody else holds, taken out of the pool: the last one if possible, or else a
    /// new one.
    fn free_picture(&mut self) -> Result<Arc<Image>, ViewerError> {
        let free = self
            .pool
            .iter_mut()
            .rposition(|picture| Arc::get_mut(picture).is_some());
        Ok(match free {
            Some(free) => self.pool.remove(free),
            None => Arc::new(Image::new(self.size)?),
        })
    }
}

/// The threads.
pub(super) struct Tracing {
    /// The kernels' thread, then those of the renderers. An answer comes with the number of
    /// pictures that the thread has made so far.
    workers: Vec<Worker<Task, (u64, Reply)>>,
    /// How many pictures each has made.
    made: Vec<u64>,
    /// The frame that was requested last, and when.
    requested: Option<(Frame, Instant)>,
    /// That there is no picture of it is known.
    is_refused: bool,
    /// How far the kernels' thread is.
    progress: Option<Arc<Mutex<Progress>>>,
    /// What ends the picture that each given renderer makes.
    cancellers: Vec<Option<Canceller>>,
}

impl Tracing {
    /// Starts the threads; `wake` is called there when there is a reply.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub(super) fn start(
        of_kernels: Pictures,
        renderers: Vec<Box<dyn Render + Send>>,
        wake: impl Fn() + Clone + Send + 'static,
    ) -> Result<Tracing, ViewerError> {
        let size = of_kernels.size;
        let progress = match &of_kernels.renderer {
            ThreadRenderer::Kernels { progress, .. } => Some(progress.clone()),
            ThreadRenderer::Given { .. } => None,
        };
        let cancellers = renderers.iter().map(|renderer| renderer.canceller());
        let cancellers = cancellers.collect();
        let mut all = vec![of_kernels];
        let given = renderers.into_iter().enumerate();
        all.extend(given.map(|(number, renderer)| Pictures::of_renderer(number, renderer, size)));
        let made = vec![0; all.len()];
        let workers = all.into_iter().map(|mut pictures| {
            let first = pictures.number;
            Worker::start("tracing", wake.clone(), move |task, reply| {
                let answer = match task {
                    Some(task) => pictures.answer(task),
                    None => pictures.recheck(),
                };
                if let Some(answer) = answer {
                    reply((pictures.number - first, answer));
                }
            })
        });
        let workers = workers.collect::<Result<_, _>>();
        Ok(Tracing {
            workers: workers.map_err(ViewerError::Thread)?,
            made,
            requested: None,
            is_refused: false,
            progress,
            cancellers,
        })
    }

    /// The thread that makes the pictures of `renderer`.
    fn worker(&self, renderer: &Renderer) -> &Worker<Task, (u64, Reply)> {
        match renderer {
            Renderer::Kernel(_) => &self.workers[0],
            Renderer::Given(given) => &self.workers[1 + given.number],
        }
    }

    /// Requests the picture of `frame`, unless it was requested last. A picture that a kernel still
    /// traces is cancelled, unless only α has changed: one that moves fast would never be seen.
    pub(super) fn request(&mut self, frame: Frame) {
        let last = self.requested.as_ref().map(|(last, _)| last);
        if last != Some(&frame) {
            if let (Some(last), Some(progress)) = (last, &self.progress)
                && !last.differs_in_angle(&frame)
            {
                lock(progress).cancel();
            }
            let task = Task::Trace(frame.clone());
            self.worker(&frame.renderer).request(task);
            self.requested = Some((frame, Instant::now()));
            self.is_refused = false;
        }
    }

    /// Ends the picture that the given renderer of this number makes: one in an endless loop would
    /// keep what has mended it waiting.
    pub(super) fn cancel(&self, number: usize) {
        if let Some(Some(canceller)) = self.cancellers.get(number) {
            canceller();
        }
    }

    /// There is no picture of `frame`; whether it was requested last.
    pub(super) fn refuse(&mut self, frame: &Frame) -> bool {
        let is_last = self.requested.as_ref().map(|(last, _)| last) == Some(frame);
        self.is_refused |= is_last;
        is_last
    }

    /// For how long a picture has been requested that is not `shown` and may still come.
    pub(super) fn behind(&self, shown: Option<&Frame>) -> Option<Duration> {
        let (frame, since) = self.requested.as_ref()?;
        (Some(frame) != shown && !self.is_refused).then(|| since.elapsed())
    }

    /// Has the picture of `frame` saved.
    pub(super) fn save(&self, frame: Frame, format: Format) {
        let worker = self.worker(&frame.renderer);
        worker.enqueue(Task::Save(frame, format));
    }

    /// Has a pixel of `frame`, column and row, worked through, by the kernels' thread, which no
    /// renderer keeps waiting; `image` is its picture.
    pub(super) fn explain(&self, frame: Frame, pixel: UVec2, image: Option<Arc<Image>>) {
        let image = image.filter(|_| matches!(frame.renderer, Renderer::Given(_)));
        self.workers[0].enqueue(Task::Explain(frame, pixel, image));
    }

    pub(super) fn reply(&mut self) -> Option<Reply> {
        let replies = self.workers.iter().map(Worker::reply);
        let (number, (made, reply)) = replies
            .enumerate()
            .find_map(|(number, reply)| Some((number, reply?)))?;
        self.made[number] = made;
        Some(reply)
    }

    /// How many pictures were made so far.
    pub(super) fn made(&self) -> u64 {
        self.made.iter().sum()
    }

    /// Waits for the queued tasks, and gives the last replies.
    pub(super) fn finish(self) -> impl Iterator<Item = Reply> {
        let answers = self.workers.into_iter().flat_map(Worker::finish);
        answers.map(|(_, reply)| reply)
    }
}
