//! Speed against error: how fast each kernel is, and how far from the truth.
//!
//! Errors are measured against [`Kernel::Reference`], decisions as decisions and samples as
//! samples, over all frames. An error in f32 steps counts the floats from a sample to the true
//! value correctly rounded, so 0 is a correctly rounded sample, whose distance from the real number
//! itself is at most ½; the largest and the mean are over pixels whose decision is right, since a
//! wrong decision is an error of another kind. Absolute errors and 8-bit differences are over all
//! pixels.
//!
//! A sample of time is a whole round of frames, divided by filling the same picture with one colour
//! as often, by the fastest stores there are; both alternate, so that a slow moment of the machine
//! hits both.
//!
//! How time grows with the number of spheres is measured on crowds, scenes that are made for that.

mod crowd;
mod errors;
mod fill;
mod hard;
mod json;
mod machine;
mod measure;
mod pipeline;
mod plot;
mod renderers;
mod scaling;
mod table;

use std::ops::RangeInclusive;
use std::path::Path;

use crate::camera::frame_angle;
use crate::diagnosis::ExaminationError;
use crate::image::whole_file::WholeFile;
use crate::image::{ImageError, SaveError};
use crate::scene::SceneError;
use crate::tracer::{Decision, TraceError};
use crate::{Image, Kernel, Render, Scene, Stage, Tracer};
pub use crowd::MAX_CROWD;
use errors::Errors;
use hard::HARD_SCENES;
use machine::{Machine, cores};
use measure::{Filler, MIN_SAMPLES, Spread, Timing};
use pipeline::{Frames, Pipeline};
pub use plot::PlotError;
use renderers::RendererRow;
pub use scaling::CROWD_KERNELS;
use scaling::{Scaling, Series};

/// Where a scene comes from; the plot has a panel for each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Group {
    /// The document's scene.
    Builtin,
    /// A scene file.
    File,
    /// The stability suite.
    Hard,
}

/// A scene with the name that the report gives it.
#[derive(Clone, Debug)]
pub struct NamedScene {
    name: String,
    group: Group,
    scene: Scene,
}

impl NamedScene {
    /// The built-in scene, under the name "builtin".
    pub fn builtin() -> NamedScene {
        NamedScene {
            name: "builtin".to_owned(),
            group: Group::Builtin,
            scene: Scene::builtin(),
        }
    }

    /// The scene of a file, under the name `name`.
    pub fn of_file(name: String, scene: Scene) -> NamedScene {
        let group = Group::File;
        NamedScene { name, group, scene }
    }

    /// Every scene of the stability suite.
    pub fn hard() -> impl Iterator<Item = NamedScene> {
        HARD_SCENES.iter().filter_map(|&(name, text)| {
            // A test reads every one of them.
            let scene = Scene::from_toml(text).ok()?;
            let (name, group) = (name.to_owned(), Group::Hard);
            Some(NamedScene { name, group, scene })
        })
    }
}

/// What is to be measured: every kernel on every scene in every stage.
#[derive(Clone, Debug)]
pub struct Request {
    /// The scenes, in the order of the report. Where these, the stages or the kernels are none,
    /// nothing is measured.
    pub scenes: Vec<NamedScene>,
    /// The stages.
    pub stages: Vec<Stage>,
    /// The kernels.
    pub kernels: Vec<Kernel>,
    /// N, 1 to [`MAX_SIZE`](crate::image::MAX_SIZE).
    pub size: u32,
    /// The frames of the animation. Each takes 8 bytes while it is measured.
    pub frames: RangeInclusive<u64>,
    /// The number of threads to measure beside one; 0 is one a core.
    pub threads: usize,
    /// How many spheres each crowd has, 1 to [`MAX_CROWD`]. The kernels of [`CROWD_KERNELS`] are
    /// timed on the crowds and on the built-in scene, in the first of the stages.
    pub crowds: Vec<u16>,
    /// How far a sample of another renderer may be from the one that a decision gives,
    /// [`TOLERANCE`](crate::diagnosis::TOLERANCE) mostly.
    pub tolerance: f32,
}

/// How far the measuring is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress<'a> {
    /// Done of [`Progress::of`], about in proportion to time.
    pub done: u64,
    /// All there is to be done.
    pub of: u64,
    /// What comes next.
    pub next: &'a str,
}

/// What was measured.
#[derive(Clone, Debug)]
pub struct Report {
    machine: Machine,
    /// N.
    size: u32,
    /// The frames of the animation.
    frames: RangeInclusive<u64>,
    /// The most threads.
    threads: usize,
    /// How the picture was filled, with one thread and with the most, for people.
    fills: Vec<String>,
    /// Each kernel on each scene in each stage.
    rows: Vec<KernelRow>,
    /// Each other renderer on each scene in each stage.
    renderers: Vec<RendererRow>,
    /// How far a sample of theirs may be from the one that a decision gives.
    tolerance: f32,
    /// Each kernel on the built-in scene and on each crowd; empty without crowds.
    scalings: Vec<Scaling>,
    /// What it costs to display a frame, once that is measured.
    pipelines: Vec<Pipeline>,
}

/// A kernel on a scene in a stage.
#[derive(Clone, Debug)]
struct KernelRow {
    /// The scene's name.
    scene: String,
    group: Group,
    stage: Stage,
    kernel: Kernel,
    /// What was measured, or why the kernel refuses the scene.
    measured: Result<Measured, String>,
}

/// Times and errors.
#[derive(Clone, Debug)]
struct Measured {
    /// With one thread, then with the most, if they are more.
    timings: Vec<Timing>,
    /// Over all frames.
    errors: Errors,
}

/// How wrong a renderer is that is no kernel, on a scene in a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongOfRenderer<'a> {
    /// What the renderer is called.
    pub renderer: &'a str,
    /// The scene's name.
    pub scene: &'a str,
    /// The stage.
    pub stage: Stage,
    /// Pixels that are neither right nor a rounding, over all frames; or why a picture is missing.
    pub wrong: Result<u64, &'a str>,
}

/// A report that cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// There is no picture of that size.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// It cannot be traced, for another reason than that a kernel refuses a scene.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// A picture cannot be compared with the truth.
    #[error(transparent)]
    Examination(#[from] ExaminationError),
    /// There is no crowd of that many spheres.
    #[error("a crowd: {0}")]
    Crowd(#[from] SceneError),
}

/// Measures the kernels as requested, and then other renderers: each makes one picture of each
/// frame, on each scene in each stage. `progress` is told before each step.
///
/// What it costs to display a frame is measured by [`Report::measure_pipelines`], afterwards:
/// OpenGL drivers are not ours, and one that ends the process takes nothing along that was not
/// shown before.
///
/// # Errors
/// [`ReportError`] where there is no room for the pictures, or no threads, or a crowd is too large.
pub fn measure(
    request: &Request,
    renderers: &mut [&mut dyn Render],
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<Report, ReportError> {
    let threads = match request.threads {
        0 => cores(),
        threads => threads,
    };
    let mut counts = vec![1];
    if threads > 1 {
        counts.push(threads);
    }
    let angles: Vec<f64> = request.frames.clone().map(frame_angle).collect();
    let views = request.scenes.len() * request.stages.len();
    let crowds = match request.crowds.len() {
        0 => 0,
        crowds => crowd_kernels(request).count() * (1 + crowds) * MIN_SAMPLES * counts.len(),
    };
    let measurement = Measurement {
        request,
        threads,
        image: Image::new(request.size)?,
        truth: Image::new(request.size)?,
        // A frame traced for its errors is 1; a row of times takes at least three rounds for each
        // number of threads.
        steps: Steps {
            done: 0,
            of: (angles.len()
                * (crowds
                    + views
                        * (1 + request.kernels.len() * (1 + 3 * counts.len()) + renderers.len())))
                as u64,
            progress,
        },
        angles,
    };
    measurement.report(&counts, renderers)
}

/// The kernels among those requested that crowds are measured with.
fn crowd_kernels(request: &Request) -> impl Iterator<Item = Kernel> {
    let kernels = request.kernels.iter().copied();
    kernels.filter(|kernel| CROWD_KERNELS.contains(kernel))
}

/// A measurement in progress.
struct Measurement<'a> {
    request: &'a Request,
    threads: usize,
    angles: Vec<f64>,
    image: Image,
    truth: Image,
    steps: Steps<'a>,
}

struct Steps<'a> {
    done: u64,
    of: u64,
    progress: &'a mut dyn FnMut(Progress<'_>),
}

impl Steps<'_> {
    /// Says what comes `next`, then counts it as done.
    fn next(&mut self, next: &str, steps: usize) {
        let (done, of) = (self.done, self.of);
        (self.progress)(Progress { done, of, next });
        self.done += steps as u64;
    }
}

impl Measurement<'_> {
    fn report(
        mut self,
        counts: &[usize],
        renderers: &mut [&mut dyn Render],
    ) -> Result<Report, ReportError> {
        let mut fillers = Vec::new();
        for &threads in counts {
            fillers.push((threads, Filler::fastest(threads, &mut self.image)?));
        }
        let mut rows = Vec::new();
        for named in &self.request.scenes {
            for &stage in &self.request.stages {
                let errors = self.errors(named, stage)?;
                for (&kernel, errors) in self.request.kernels.iter().zip(errors) {
                    let measured = match errors {
                        Ok(errors) => {
                            let timings = self.timings(named, stage, kernel, &mut fillers)?;
                            Ok(Measured { timings, errors })
                        }
                        Err(refusal) => {
                            self.steps.done += (3 * self.angles.len() * counts.len()) as u64;
                            Err(refusal)
                        }
                    };
                    rows.push(KernelRow {
                        scene: named.name.clone(),
                        group: named.group,
                        stage,
                        kernel,
                        measured,
                    });
                }
            }
        }
        let renderers = self.renderers(renderers, &mut fillers)?;
        let scalings = self.scalings(counts)?;
        Ok(Report {
            machine: Machine::this(),
            size: self.request.size,
            frames: self.request.frames.clone(),
            threads: self.threads,
            fills: fillers.iter().map(|(_, filler)| filler.how()).collect(),
            rows,
            renderers,
            tolerance: self.request.tolerance,
            scalings,
            pipelines: Vec::new(),
        })
    }

    /// The errors of every kernel, or why it refuses the scene.
    fn errors(
        &mut self,
        named: &NamedScene,
        stage: Stage,
    ) -> Result<Vec<Result<Errors, String>>, ReportError> {
        let mut reference = Tracer::new(Kernel::Reference, self.threads)?;
        let mut tracers = Vec::new();
        for &kernel in &self.request.kernels {
            tracers.push((Tracer::new(kernel, self.threads)?, Ok(Errors::default())));
        }
        for &alpha in &self.angles {
            self.steps.next(&format!("{}, the truth", named.name), 1);
            let scene = &named.scene;
            let true_decisions =
                reference.trace_with_decisions(scene, stage, alpha, &mut self.truth)?;
            let truth = (&self.truth, &true_decisions[..]);
            for (tracer, errors) in &mut tracers {
                let name = tracer.kernel().name();
                self.steps
                    .next(&format!("{}, errors of {name}", named.name), 1);
                let Ok(sum) = errors else { continue };
                match decide(tracer, scene, stage, alpha, &mut self.image)? {
                    Ok(decisions) => {
                        sum.add((&self.image, &decisions), truth, tracer.tally());
                    }
                    Err(refusal) => *errors = Err(refusal),
                }
            }
        }
        Ok(tracers.into_iter().map(|(_, errors)| errors).collect())
    }

    /// The times of a kernel that does not refuse the scene.
    fn timings(
        &mut self,
        named: &NamedScene,
        stage: Stage,
        kernel: Kernel,
        fillers: &mut [(usize, Filler)],
    ) -> Result<Vec<Timing>, ReportError> {
        let mut timings = Vec::new();
        for (threads, filler) in fillers {
            let s = if *threads == 1 { "" } else { "s" };
            let next = format!(
                "{}, time of {}, {threads} thread{s}",
                named.name,
                kernel.name()
            );
            self.steps.next(&next, 3 * self.angles.len());
            let mut tracer = Tracer::new(kernel, *threads)?;
            let frames = (&named.scene, stage, &self.angles[..]);
            timings.extend(measure::time(
                &mut tracer,
                *threads,
                frames,
                &mut self.image,
                filler,
            )?);
        }
        Ok(timings)
    }

    /// The other renderers on all scenes in all stages.
    fn renderers(
        &mut self,
        renderers: &mut [&mut dyn Render],
        fillers: &mut [(usize, Filler)],
    ) -> Result<Vec<RendererRow>, ReportError> {
        let (request, mut rows) = (self.request, Vec::new());
        let names = renderers::names(renderers);
        let Some((_, filler)) = fillers.first_mut() else {
            return Ok(rows);
        };
        for named in &request.scenes {
            for &stage in &request.stages {
                let frames = renderers::Frames {
                    name: &named.name,
                    scene: &named.scene,
                    stage,
                    angles: &self.angles,
                    tolerance: request.tolerance,
                    threads: self.threads,
                };
                for (renderer, name) in renderers.iter_mut().zip(&names) {
                    let (named, image) = ((&mut **renderer, &name[..]), &mut self.image);
                    let mut next = |next: &str| self.steps.next(next, 1);
                    rows.push(renderers::measure(
                        named, &frames, image, filler, &mut next,
                    )?);
                }
            }
        }
        Ok(rows)
    }

    /// The times on the built-in scene and on the crowds; nothing where no crowd is requested.
    fn scalings(&mut self, counts: &[usize]) -> Result<Vec<Scaling>, ReportError> {
        let request = self.request;
        let (false, Some(&stage)) = (request.crowds.is_empty(), request.stages.first()) else {
            return Ok(Vec::new());
        };
        let mut scenes = vec![Scene::builtin()];
        for &spheres in &request.crowds {
            scenes.push(crowd::scene(spheres)?);
        }
        let series = Series {
            kernels: &crowd_kernels(request).collect::<Vec<_>>(),
            scenes: &scenes,
            stage,
            angles: &self.angles,
        };
        let (steps, frames) = (&mut self.steps, self.angles.len());
        let mut next = |next: &str| steps.next(next, frames);
        Ok(scaling::measure(
            &series,
            counts,
            &mut self.image,
            &mut next,
        )?)
    }
}

/// The decisions of a frame, or why the kernel refuses the scene.
fn decide(
    tracer: &mut Tracer,
    scene: &Scene,
    stage: Stage,
    alpha: f64,
    image: &mut Image,
) -> Result<Result<Vec<Decision>, String>, TraceError> {
    match tracer.trace_with_decisions(scene, stage, alpha, image) {
        Ok(decisions) => Ok(Ok(decisions)),
        Err(refusal @ TraceError::Listing { .. }) => Ok(Err(refusal.to_string())),
        Err(error) => Err(error),
    }
}

/// Writes `text` to `path`. The file appears whole or not at all.
///
/// # Errors
/// [`SaveError`] where it cannot be written.
pub fn save(text: &str, path: impl AsRef<Path>) -> Result<(), SaveError> {
    use std::io::Write as _;
    WholeFile::write(path.as_ref(), |output| output.write_all(text.as_bytes()))
}

/// Whether a file can be written at `path`: better known before hours of measuring than after.
/// Nothing is left there.
///
/// # Errors
/// As [`save`].
pub fn can_save(path: impl AsRef<Path>) -> Result<(), SaveError> {
    WholeFile::create(path.as_ref()).map(|_| ())
}

impl Report {
    /// Measures what it costs to display a frame, traced by the first kernel but
    /// [`Kernel::Listing`] on the first scene in the first stage; nothing where there is none.
    /// `watch` is called with `true` before each call of a driver that may hang,
    /// and with `false` after it.
    ///
    /// # Errors
    /// As [`measure`]; where no driver can be had, [`Report::pipeline_table`] says so.
    pub fn measure_pipelines(
        &mut self,
        request: &Request,
        watch: &mut dyn FnMut(bool),
    ) -> Result<(), ReportError> {
        let mut image = Image::new(self.size)?;
        let mut kernels = request.kernels.iter();
        if let (Some(named), Some(&stage), Some(&kernel)) = (
            request.scenes.first(),
            request.stages.first(),
            kernels.find(|&&kernel| kernel != Kernel::Listing),
        ) {
            let frames = Frames {
                tracer: Tracer::new(kernel, self.threads)?,
                scene: &named.scene,
                stage,
                image: &mut image,
            };
            self.pipelines = pipeline::measure(frames, watch)?;
        }
        Ok(())
    }

    /// The pixels that another renderer has wrong, over all frames.
    pub fn wrong_pixels(&self) -> impl Iterator<Item = WrongOfRenderer<'_>> {
        self.renderers.iter().map(|row| WrongOfRenderer {
            renderer: &row.renderer,
            scene: &row.scene,
            stage: row.stage,
            wrong: match &row.measured {
                Ok(measured) => Ok(measured.summary.wrong()),
                Err(reason) => Err(reason),
            },
        })
    }

    /// How many frames a round has.
    fn frame_count(&self) -> u64 {
        (self.frames.end() - self.frames.start()).saturating_add(1)
    }

    /// The mean of what was counted over the rows of all frames.
    fn per_row(&self, count: u64) -> f64 {
        count as f64 / (self.frame_count() as f64 * f64::from(self.size))
    }

    fn mpixel_per_s(&self, ms: Spread) -> f64 {
        f64::from(self.size).powi(2) / ms.median / 1e3
    }

    fn gb_per_s(&self, ms: Spread) -> f64 {
        12.0 * f64::from(self.size).powi(2) / ms.median / 1e6
    }
}
