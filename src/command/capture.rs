//! `firsthit capture`: pictures into files, without a window.

mod job;

use std::num::NonZeroU16;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use clap::Args;
use firsthit::camera::frame_angle;
use firsthit::image::{Animation, AnimationWriter};
use firsthit::tracer::Progress;
use firsthit::{Image, Scene, Stage};
use indicatif::{ProgressBar, ProgressFinish};

use super::Failure;
use super::arguments::{AngleArguments, PictureArguments, ProgramArguments, frames, stage};
use super::renderer::Renderer;
use super::round_trip::{RoundTrip, Through};
use super::streams::{StandardOutput, refuse_terminal};
use job::{Job, Stream, StreamFormat, count, numbered};

/// How ffmpeg makes a film of the frames.
const EXAMPLE: &str = "A film, by another program:
  firsthit capture --stage 7 --frames 0..20 -o - --format rgb24 |
  ffmpeg -f rawvideo -pix_fmt rgb24 -s 500x500 -r 5 -i - \\
  -pix_fmt yuv420p film.mp4";

#[derive(Args)]
#[command(after_help = EXAMPLE)]
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
    /// animation of --frames), - for standard output; with --frames, {} in the name of a .png or
    /// .exr becomes the frame's number
    #[arg(short, long, value_name = "PATH")]
    output: PathBuf,
    /// What standard output gets with -o -
    #[arg(long, value_name = "FORMAT", value_enum)]
    format: Option<StreamFormat>,
    /// Write light instead of the floats as they are, for viewers of EXR files, which encode it for
    /// the display: each float decoded by the curve of sRGB and rounded correctly, so that the
    /// picture looks there as in this program's window. `compare` takes no EXR for such a one
    #[arg(long)]
    linear: bool,
    /// The frames a second of an animation; 5 if not given
    #[arg(long, value_name = "N")]
    fps: Option<NonZeroU16>,
}

fn wrong(message: impl std::fmt::Display) -> clap::Error {
    super::wrong::<Arguments>("firsthit capture", message)
}

/// What makes the picture of an angle that is written.
struct Capture {
    scene: Scene,
    stage: Stage,
    renderer: Renderer,
    image: Image,
    round_trip: RoundTrip,
    /// The picture is decoded by the curve of sRGB after its round trip.
    linear: bool,
}

impl Capture {
    fn make(&mut self, alpha: f64) -> Result<(), Failure> {
        self.renderer
            .make(&self.scene, self.stage, alpha, &mut self.image)
    }

    /// The picture that is written, after its round trip.
    fn sent(&mut self) -> Result<&Image, Failure> {
        self.round_trip.send(&self.image)?;
        if self.linear {
            self.image.decode_srgb();
        }
        Ok(&self.image)
    }

    /// The picture of a capture of one, after its round trip.
    fn single_picture(&mut self, alpha: f64) -> Result<&Image, Failure> {
        let size = self.image.size();
        while_watched(size, self.renderer.progress(), || self.make(alpha))?;
        self.renderer.finish()?;
        self.sent()
    }

    /// The picture of one frame after its round trip. With the last of all `frames` the renderer is
    /// finished.
    fn picture(&mut self, frame: u64, frames: &RangeInclusive<u64>) -> Result<&Image, Failure> {
        self.make(frame_angle(frame))?;
        if frame == *frames.end() {
            self.renderer.finish()?;
        }
        self.sent()
    }

    /// Writes pictures into standard output.
    fn stream(&mut self, stream: Stream, output: &mut StandardOutput) -> Result<(), Failure> {
        match stream {
            Stream::Picture { alpha, write } => {
                let picture = self.single_picture(alpha)?;
                write(picture, output).map_err(Failure::StandardOutput)?;
            }
            Stream::Animation { frames, fps } => {
                let (size, count) = (self.image.size(), count(&frames));
                let mut animation = AnimationWriter::new(output, size, count, fps)
                    .map_err(Failure::StandardOutput)?;
                for frame in with_progress(frames.clone()) {
                    let picture = self.picture(frame, &frames)?;
                    animation.push(picture).map_err(Failure::StandardOutput)?;
                }
                animation.finish().map_err(Failure::StandardOutput)?;
            }
            Stream::Bytes { frames } => {
                for frame in with_progress(frames.clone()) {
                    let picture = self.picture(frame, &frames)?;
                    let written = picture.write_rgb24(output);
                    written.map_err(Failure::StandardOutput)?;
                }
            }
        }
        Ok(())
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let job = Job::new(arguments)?;
    let picture = &arguments.picture;
    if arguments.program.is_given() && picture.kernel.is_some() {
        let message = "a picture is made by one of the two: give --kernel or --program";
        return Err(wrong(message).into());
    }
    if let Job::Stream(_) = job {
        // Before a minute of tracing rather than after it.
        refuse_terminal()?;
    }
    let size = picture.size;
    let mut capture = Capture {
        scene: picture.scene()?,
        stage: arguments.stage,
        renderer: Renderer::new(picture, &arguments.program)?,
        image: Image::new(size)?,
        round_trip: RoundTrip::open(arguments.through, size)?,
        linear: arguments.linear,
    };
    match job {
        Job::Picture { alpha, path } => capture.single_picture(alpha)?.save(path)?,
        Job::Pictures { frames, pattern } => {
            let digits = frames.end().to_string().len();
            for frame in with_progress(frames.clone()) {
                let path = numbered(&pattern, &format!("{frame:0digits$}"));
                capture.picture(frame, &frames)?.save(path)?;
            }
        }
        Job::Animation { frames, fps, path } => {
            let mut animation = Animation::create(path, size, count(&frames), fps)?;
            for frame in with_progress(frames.clone()) {
                animation.push(capture.picture(frame, &frames)?)?;
            }
            animation.finish()?;
        }
        Job::Stream(stream) => {
            let mut output = StandardOutput::new();
            let written = capture.stream(stream, &mut output);
            output.finish(written)?;
        }
    }
    // Said last: where the capture fails, one line says why, and no other.
    let notes = [capture.renderer.note(), capture.round_trip.note()];
    for note in notes.into_iter().flatten() {
        super::say(&note);
    }
    Ok(())
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
