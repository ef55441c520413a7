//! What it costs to display a frame: the retained texture against the document's `glDrawPixels`.

use std::ops::Range;
use std::time::{Duration, Instant};

use super::measure::Spread;
use crate::camera::{ROUND, frame_angle};
use crate::screen::{Backend, Cost, DrawMethod, ScreenError, TimedScreen};
use crate::tracer::TraceError;
use crate::{Image, Kernel, Scene, Stage, Tracer};

/// Rounds of frames in each benchmark, unless they take too long.
const ROUNDS: u64 = 2;

/// About as long as each benchmark may take in all.
const MAX_TIME: Duration = Duration::from_secs(1);

/// At least this many frames that count.
const MIN_FRAMES: usize = 3;

/// What it costs to send frames to a framebuffer of 8 bits a sample and back, in one context and by
/// one method.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pipeline {
    /// What made the context.
    pub(super) backend: Backend,
    /// How the pixels got in.
    pub(super) method: DrawMethod,
    /// The kernel that traced them.
    pub(super) kernel: Kernel,
    /// What it cost, or what is missing.
    pub(super) costs: Result<Costs, String>,
}

/// Milliseconds a frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Costs {
    /// To trace it over the frame before, on all threads.
    pub(super) trace_ms: Spread,
    /// To hand the rows that changed to OpenGL as a texture; 0 for `glDrawPixels`, which does that
    /// while it draws, at every redraw anew.
    pub(super) upload_ms: Spread,
    /// To draw it.
    pub(super) draw_ms: Spread,
    /// To read the bytes back, which a window need not.
    pub(super) read_back_ms: Spread,
}

/// Runs every benchmark in turn, on `frames`.
pub(super) fn measure(
    mut frames: Frames<'_>,
    watch: &mut dyn FnMut(bool),
) -> Result<Vec<Pipeline>, TraceError> {
    let (kernel, size) = (frames.tracer.kernel(), frames.image.size());
    let mut benchmarks = Vec::new();
    for backend in [Backend::Egl, Backend::OsMesa] {
        for method in DrawMethod::ALL {
            watch(true);
            benchmarks.push(Benchmark::open(backend, method, size));
            watch(false);
        }
    }
    for _ in 0..ROUNDS {
        for benchmark in &mut benchmarks {
            benchmark.round(&mut frames, watch)?;
        }
    }
    Ok(benchmarks
        .into_iter()
        .map(|benchmark| benchmark.pipeline(kernel))
        .collect())
}

/// Frames, each traced over the one before.
pub(super) struct Frames<'f> {
    pub(super) tracer: Tracer,
    pub(super) scene: &'f Scene,
    pub(super) stage: Stage,
    pub(super) image: &'f mut Image,
}

impl Frames<'_> {
    /// Traces one: how long that took, and the rows that changed.
    fn trace(&mut self, alpha: f64) -> Result<(Duration, Range<u32>), TraceError> {
        let start = Instant::now();
        let rows = self
            .tracer
            .retrace(self.scene, self.stage, alpha, self.image)?;
        Ok((start.elapsed(), rows))
    }
}

/// A [`Pipeline`] that is being measured.
struct Benchmark {
    backend: Backend,
    method: DrawMethod,
    screen: Result<TimedScreen, ScreenError>,
    traces: Vec<Duration>,
    costs: Vec<Cost>,
    /// How long it has taken so far.
    time: Duration,
}

impl Benchmark {
    fn open(backend: Backend, method: DrawMethod, size: u32) -> Benchmark {
        Benchmark {
            backend,
            method,
            screen: TimedScreen::open(backend, method, size),
            traces: Vec::new(),
            costs: Vec::new(),
            time: Duration::ZERO,
        }
    }

    /// Shows a round of frames.
    fn round(
        &mut self,
        frames: &mut Frames<'_>,
        watch: &mut dyn FnMut(bool),
    ) -> Result<(), TraceError> {
        let Ok(screen) = &mut self.screen else {
            return Ok(());
        };
        let begin = Instant::now();
        // The first frame finds another benchmark's picture in the texture, and pays for what is
        // made at first use: it is uploaded whole, and does not count.
        for frame in 0..=ROUND {
            let (time, changed) = frames.trace(frame_angle(frame))?;
            let image = &*frames.image;
            let rows = if frame == 0 { 0..image.size() } else { changed };
            if frame == 0 {
                watch(true);
            }
            let shown = screen.show(image, rows);
            if frame == 0 {
                watch(false);
            }
            match shown {
                Ok(_) if frame == 0 => {}
                Ok(cost) => {
                    self.traces.push(time);
                    self.costs.push(cost);
                }
                Err(error) => {
                    self.screen = Err(error);
                    break;
                }
            }
            if self.costs.len() >= MIN_FRAMES && self.time + begin.elapsed() > MAX_TIME {
                break;
            }
        }
        self.time += begin.elapsed();
        Ok(())
    }

    fn pipeline(self, kernel: Kernel) -> Pipeline {
        let spread = |times: &mut dyn Iterator<Item = Duration>| {
            Spread::of(times.map(|time| 1e3 * time.as_secs_f64()).collect())
        };
        let part = |part: fn(&Cost) -> Duration| spread(&mut self.costs.iter().map(part));
        let costs = || {
            Some(Costs {
                trace_ms: spread(&mut self.traces.iter().copied())?,
                upload_ms: part(|cost| cost.upload)?,
                draw_ms: part(|cost| cost.draw)?,
                read_back_ms: part(|cost| cost.read_back)?,
            })
        };
        Pipeline {
            backend: self.backend,
            method: self.method,
            kernel,
            costs: match &self.screen {
                Ok(_) => costs().ok_or_else(|| "nothing was shown".to_owned()),
                Err(error) => Err(missing(error)),
            },
        }
    }
}

fn missing(error: &ScreenError) -> String {
    match error {
        ScreenError::Missing {
            library, packages, ..
        } => {
            format!("{library} is missing (Debian packages: {packages})")
        }
        other => other.to_string(),
    }
}
