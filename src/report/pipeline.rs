//! What it costs to display a frame: the retained texture against the document's `glDrawPixels`.

use std::time::{Duration, Instant};

use super::{ReportError, Request, Spread};
use crate::camera::{ROUND, frame_angle};
use crate::screen::{Cost, Path, ScreenError, Through, TimedScreen};
use crate::{Image, Kernel, Tracer};

/// Frames for each way, unless they take too long.
const FRAMES: u64 = 2 * ROUND;

/// About as long as the slowest of them may take in all.
const TIME: Duration = Duration::from_secs(4);

/// At least this many frames.
const MIN_FRAMES: usize = 3;

/// One way of frames to a screen of 8 bits a sample, and back.
#[derive(Clone, Debug, PartialEq)]
pub struct Pipeline {
    /// What made the context.
    pub through: Through,
    /// How the pixels got in.
    pub path: Path,
    /// The kernel that traced them.
    pub kernel: Kernel,
    /// What it cost, or what is missing.
    pub costs: Result<Costs, String>,
}

/// Milliseconds a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Costs {
    /// To trace it, on all threads.
    pub trace_ms: Spread,
    /// To hand it to OpenGL as a texture; 0 for `glDrawPixels`, which does that while it draws, at every redraw anew.
    pub upload_ms: Spread,
    /// To draw it.
    pub draw_ms: Spread,
    /// To read the bytes back, which a window need not.
    pub read_back_ms: Spread,
}

/// Shows the frames of a round by every way in turn, traced by the first kernel on the first scene in the first stage.
pub(super) fn measure(
    request: &Request,
    threads: usize,
    image: &mut Image,
) -> Result<Vec<Pipeline>, ReportError> {
    let (Some(named), Some(&stage), Some(&kernel)) = (
        request.scenes.first(),
        request.stages.first(),
        request
            .kernels
            .iter()
            .find(|&&kernel| kernel != Kernel::Listing),
    ) else {
        return Ok(Vec::new());
    };
    let ways = [Through::Egl, Through::OsMesa]
        .into_iter()
        .flat_map(|through| Path::ALL.map(|path| (through, path)));
    let mut screens: Vec<_> = ways
        .map(|(through, path)| {
            let screen = TimedScreen::open(through, path, image.size());
            (through, path, screen, Vec::new())
        })
        .collect();
    let mut tracer = Tracer::new(kernel, threads)?;
    let mut traces = Vec::new();
    if screens.iter().any(|(_, _, screen, _)| screen.is_ok()) {
        let begin = Instant::now();
        for frame in 0..FRAMES {
            let start = Instant::now();
            tracer.trace(&named.scene, stage, frame_angle(frame), image)?;
            traces.push(start.elapsed());
            for (_, _, screen, costs) in &mut screens {
                let shown = match screen {
                    Ok(screen) => screen.show(image),
                    Err(_) => continue,
                };
                match shown {
                    Ok(cost) => costs.push(cost),
                    Err(error) => *screen = Err(error),
                }
            }
            if traces.len() > MIN_FRAMES && begin.elapsed() > TIME {
                break;
            }
        }
    }
    let pipelines = screens
        .into_iter()
        .map(|(through, path, screen, costs)| Pipeline {
            through,
            path,
            kernel,
            costs: match screen {
                Ok(_) => summary(&traces, &costs).ok_or_else(|| "nothing was shown".to_owned()),
                Err(error) => Err(missing(&error)),
            },
        });
    Ok(pipelines.collect())
}

/// The first frame makes what later ones find made: it does not count.
fn summary(traces: &[Duration], costs: &[Cost]) -> Option<Costs> {
    let ms = |time: &Duration| 1e3 * time.as_secs_f64();
    let spread = |part: fn(&Cost) -> Duration| {
        Spread::of(costs.iter().skip(1).map(|cost| ms(&part(cost))).collect())
    };
    Some(Costs {
        trace_ms: Spread::of(traces.iter().skip(1).map(ms).collect())?,
        upload_ms: spread(|cost| cost.upload)?,
        draw_ms: spread(|cost| cost.draw)?,
        read_back_ms: spread(|cost| cost.read_back)?,
    })
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
