//! Scaling: the time of a frame against the number of spheres.
//!
//! The scenes are the built-in one and crowds. A sample is a whole round of frames, as elsewhere;
//! all kernels trace a round of all scenes in turn, so that a slow moment of the machine hits all.

use std::time::Instant;

use super::measure::{MIN_SAMPLES, Spread, is_enough, time_round};
use crate::tracer::TraceError;
use crate::{Image, Kernel, Scene, Stage, Tracer};

/// The kernels that crowds are measured with: the document's listings know one scene only, and to
/// ask every solid about every pixel in double-doubles takes hours.
pub const CROWD_KERNELS: [Kernel; 3] = [Kernel::Exact, Kernel::Fast, Kernel::Double];

/// A kernel on one of the scenes.
#[derive(Clone, Debug)]
pub(super) struct Scaling {
    /// Whether the scene is a crowd, and not the built-in one.
    pub(super) is_crowd: bool,
    /// How many spheres the scene has.
    pub(super) spheres: usize,
    pub(super) stage: Stage,
    pub(super) kernel: Kernel,
    /// With one thread, then with the most, if they are more.
    pub(super) timings: Vec<ScalingTiming>,
}

/// How fast the kernel traces the scene, with one number of threads.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScalingTiming {
    /// Threads that traced.
    pub(super) threads: usize,
    /// Rounds measured.
    pub(super) samples: usize,
    /// Milliseconds a frame.
    pub(super) ms: Spread,
    /// The median time by that of the built-in scene.
    pub(super) ratio: f64,
}

impl Scaling {
    /// The scene's name.
    pub(super) fn scene(&self) -> &'static str {
        if self.is_crowd { "crowd" } else { "builtin" }
    }
}

/// What is to be measured: every kernel on every scene.
pub(super) struct Series<'s> {
    pub(super) kernels: &'s [Kernel],
    /// The built-in scene, and then the crowds.
    pub(super) scenes: &'s [Scene],
    pub(super) stage: Stage,
    pub(super) angles: &'s [f64],
}

/// Measures a series with each of these numbers of threads. Tells `next` before each of the rounds
/// that are measured at least, of which there are [`MIN_SAMPLES`] for each kernel, scene and number
/// of threads.
pub(super) fn measure(
    series: &Series<'_>,
    counts: &[usize],
    image: &mut Image,
    next: &mut dyn FnMut(&str),
) -> Result<Vec<Scaling>, TraceError> {
    let mut scalings = Vec::new();
    for &kernel in series.kernels {
        let scenes = series.scenes.iter().enumerate();
        scalings.extend(scenes.map(|(index, scene)| Scaling {
            is_crowd: index > 0,
            spheres: scene.spheres().len(),
            stage: series.stage,
            kernel,
            timings: Vec::new(),
        }));
    }
    for &threads in counts {
        let times = times_in_turn(series, threads, image, next)?;
        let mut builtin_ms = 0.0;
        for (scaling, times) in scalings.iter_mut().zip(times) {
            let samples = times.len();
            let Some(ms) = Spread::of(times) else {
                continue;
            };
            if !scaling.is_crowd {
                builtin_ms = ms.median;
            }
            scaling.timings.push(ScalingTiming {
                threads,
                samples,
                ms,
                ratio: ms.median / builtin_ms,
            });
        }
    }
    Ok(scalings)
}

/// Milliseconds a frame in each round: of each kernel on each scene.
fn times_in_turn(
    series: &Series<'_>,
    threads: usize,
    image: &mut Image,
    next: &mut dyn FnMut(&str),
) -> Result<Vec<Vec<f64>>, TraceError> {
    let mut tracers = Vec::new();
    for &kernel in series.kernels {
        tracers.push(Tracer::new(kernel, threads)?);
    }
    let mut times = vec![Vec::new(); tracers.len() * series.scenes.len()];
    let (begin, mut samples) = (Instant::now(), 0);
    while !is_enough(samples, begin, times.len()) {
        let mut rows = times.iter_mut();
        for tracer in &mut tracers {
            for (scene, times) in series.scenes.iter().zip(rows.by_ref()) {
                if samples < MIN_SAMPLES {
                    let (spheres, kernel) = (scene.spheres().len(), tracer.kernel().name());
                    next(&format!("{spheres} spheres, time of {kernel}"));
                }
                let seconds = time_round(series.angles, |alpha| {
                    tracer.trace(scene, series.stage, alpha, image)
                })?;
                std::hint::black_box(image.samples());
                times.push(1e3 * seconds / series.angles.len() as f64);
            }
        }
        samples += 1;
    }
    Ok(times)
}
