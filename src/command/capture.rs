//! `firsthit capture`: pictures into files, without a window.

use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use clap::Args;
use firsthit::camera::frame_angle;
use firsthit::image::{Animation, Format};
use firsthit::tracer::Progress;
use firsthit::{Image, Scene, Stage};
use indicatif::{ProgressBar, ProgressFinish};

use super::Failure;
use super::arguments::{AngleArguments, PictureArguments, ProgramArguments, frames, stage};
use super::maker::Maker;
use super::round_trip::{RoundTrip, Through};

#[derive(Args)]
pub(crate) struct Arguments {
    /// The stage, 1 to 7
    #[arg(long, value_name = "STAGE", value_parser = stage)]
    stage: Stage,
    #[command(flatten)]
    angle: AngleArguments,
    /// All frames from A to B, both included
    #[arg(long, value_name = "A..B", value_parser = frames, conflicts_with_all = ["alpha", "frame"])]
    frames: Option<RangeInclusive<u64>>,
    #[command(flatten)]
    picture: PictureArguments,
    #[command(flatten)]
    program: ProgramArguments,
    /// What the pixels pass through before they are written; egl if not given, else osmesa, else
    /// none, whichever works first
    #[arg(long, value_name = "WAY", value_enum)]
    through: Option<Through>,
    /// The file to write: .png (8 bits, as displayed), .exr (every float bit for bit), .apng (an
    /// animation of --frames); with --frames, {} in the name of a .png or .exr becomes the
    /// frame's number
    #[arg(short, long, value_name = "PATH")]
    output: PathBuf,
}

/// What is to be written.
enum Job {
    Picture {
        alpha: f64,
        path: PathBuf,
    },
    /// Each frame into a file of its own, named by `pattern` with the frame's number for `{}`.
    Pictures {
        frames: RangeInclusive<u64>,
        pattern: String,
    },
    Animation {
        frames: RangeInclusive<u64>,
        path: PathBuf,
    },
}

impl Job {
    /// What the arguments ask for; wrong usage where they do not fit each other.
    fn new(arguments: &Arguments) -> Result<Job, clap::Error> {
        let path = arguments.output.clone();
        let format = Format::of(&path).map_err(wrong)?;
        let has_place = path
            .as_os_str()
            .as_encoded_bytes()
            .windows(2)
            .any(|two| two == b"{}");
        let shown = path.display();
        match (format, arguments.frames.clone()) {
            (Format::Apng, None) => Err(wrong(format!(
                "{shown}: an .apng holds an animation: give --frames A..B, or choose .png or .exr"
            ))),
            (Format::Apng, Some(_)) if has_place => Err(wrong(format!(
                "{shown}: an .apng holds all frames: leave {{}} out of its name"
            ))),
            (Format::Apng, Some(frames)) if count(&frames) > Animation::MAX_FRAMES => {
                Err(wrong(format!(
                    "{shown}: an .apng holds at most {} frames: give fewer, or choose .png or .exr",
                    Animation::MAX_FRAMES
                )))
            }
            (Format::Apng, Some(frames)) => Ok(Job::Animation { frames, path }),
            (Format::Png | Format::Exr, None) if has_place => Err(wrong(format!(
                "{shown}: {{}} stands for the number of one frame of many: give --frames A..B, or leave {{}} out"
            ))),
            (Format::Png | Format::Exr, None) => {
                let alpha = arguments.angle.alpha();
                Ok(Job::Picture { alpha, path })
            }
            (Format::Png | Format::Exr, Some(_)) if !has_place => Err(wrong(format!(
                "{shown}: with --frames the name needs {{}}, which becomes the frame's number, as in frame-{{}}.png"
            ))),
            (Format::Png | Format::Exr, Some(frames)) => {
                match path.into_os_string().into_string() {
                    Ok(pattern) => Ok(Job::Pictures { frames, pattern }),
                    Err(path) => Err(wrong(format!(
                        "{}: with --frames the name must be UTF-8",
                        path.display()
                    ))),
                }
            }
        }
    }
}

fn wrong(message: impl std::fmt::Display) -> clap::Error {
    super::wrong::<Arguments>("firsthit capture", message)
}

/// What makes the picture of an angle that is written.
struct Capture {
    scene: Scene,
    stage: Stage,
    maker: Maker,
    image: Image,
    round_trip: RoundTrip,
}

impl Capture {
    fn make(&mut self, alpha: f64) -> Result<(), Failure> {
        self.maker
            .make(&self.scene, self.stage, alpha, &mut self.image)
    }

    /// The picture after its round trip.
    fn sent(&mut self) -> Result<&Image, Failure> {
        self.round_trip.send(&self.image)?;
        Ok(&self.image)
    }

    /// The picture of one frame after its round trip. With the last of all `frames` the maker is
    /// finished.
    fn picture(&mut self, frame: u64, frames: &RangeInclusive<u64>) -> Result<&Image, Failure> {
        self.make(frame_angle(frame))?;
        if frame == *frames.end() {
            self.maker.finish()?;
        }
        self.sent()
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let job = Job::new(arguments)?;
    let picture = &arguments.picture;
    if arguments.program.is_given() && picture.kernel.is_some() {
        let message = "a picture is made by one of the two: give --kernel or --program";
        return Err(wrong(message).into());
    }
    let size = picture.size;
    let mut capture = Capture {
        scene: picture.scene()?,
        stage: arguments.stage,
        maker: Maker::new(picture, &arguments.program)?,
        image: Image::new(size)?,
        round_trip: RoundTrip::open(arguments.through, size)?,
    };
    match job {
        Job::Picture { alpha, path } => {
            while_watched(size, capture.maker.progress(), || capture.make(alpha))?;
            capture.maker.finish()?;
            capture.sent()?.save(path)?;
        }
        Job::Pictures { frames, pattern } => {
            let digits = frames.end().to_string().len();
            for frame in with_progress(frames.clone()) {
                let path = pattern.replace("{}", &format!("{frame:0digits$}"));
                capture.picture(frame, &frames)?.save(path)?;
            }
        }
        Job::Animation { frames, path } => {
            let mut animation = Animation::create(path, size, count(&frames))?;
            for frame in with_progress(frames.clone()) {
                animation.push(capture.picture(frame, &frames)?)?;
            }
            animation.finish()?;
        }
    }
    // Said last: where the capture fails, one line says why, and no other.
    let notes = [capture.maker.note(), capture.round_trip.note()];
    for note in notes.into_iter().flatten() {
        super::say(&note);
    }
    Ok(())
}

/// The number of frames, or the largest number where that is one less.
fn count(frames: &RangeInclusive<u64>) -> u64 {
    (frames.end() - frames.start()).saturating_add(1)
}

/// How often the progress bar of a picture is updated; most pictures are done before the first
/// time.
const UPDATE: Duration = Duration::from_millis(200);

/// Makes a picture, with a bar on standard error that grows with its rows, if standard error is a
/// terminal and the progress is known.
fn while_watched<T>(size: u32, progress: Option<Progress>, make: impl FnOnce() -> T) -> T {
    let Some(progress) = progress else {
        return make();
    };
    thread::scope(|scope| {
        let (traced, is_traced) = mpsc::channel::<()>();
        let watch = move || {
            let bar = ProgressBar::new(size.into()).with_finish(ProgressFinish::AndClear);
            while is_traced.recv_timeout(UPDATE) == Err(RecvTimeoutError::Timeout) {
                bar.set_position(progress.rows().into());
            }
        };
        // Where the system has no thread for it, nobody watches.
        let _watching = thread::Builder::new().spawn_scoped(scope, watch);
        let result = make();
        drop(traced);
        result
    })
}

/// The frames, with a bar on standard error that grows with them, if that is a terminal.
fn with_progress(frames: RangeInclusive<u64>) -> impl Iterator<Item = u64> {
    ProgressBar::new(count(&frames))
        .with_finish(ProgressFinish::AndClear)
        .wrap_iter(frames)
}
