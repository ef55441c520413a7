//! What a capture is asked to write.

use std::ffi::{OsStr, OsString};
use std::fmt::Display;
use std::io;
use std::num::NonZeroU16;
use std::ops::RangeInclusive;
use std::path::PathBuf;

use clap::ValueEnum;
use firsthit::image::Raster;
use firsthit::image::{Animation, Format};

use super::super::streams::{StandardOutput, is_standard};
use super::{Arguments, wrong};

/// The values of `--format`: what standard output gets.
#[derive(Clone, Copy, ValueEnum)]
pub(super) enum StreamFormat {
    /// A picture of 8 bits a sample, as displayed
    Png,
    /// A picture, every float bit for bit
    Exr,
    /// An animation of --frames
    Apng,
    /// Red, green and blue bytes as displayed and nothing else: rows from the top, one frame after
    /// the other
    Rgb24,
}

/// The frames a second of an animation, if nothing is said.
const FPS: NonZeroU16 = NonZeroU16::new(5).unwrap();

/// Writes a picture into standard output.
pub(super) type WritePicture = fn(&Raster, &mut StandardOutput) -> io::Result<()>;

/// What is to be written.
pub(super) enum Job {
    Picture {
        alpha: f64,
        path: PathBuf,
    },
    /// Each frame into a file of its own, named by `pattern` with the frame's number for `{}`.
    Pictures {
        frames: RangeInclusive<u64>,
        pattern: OsString,
    },
    Animation {
        frames: RangeInclusive<u64>,
        fps: NonZeroU16,
        path: PathBuf,
    },
    Stream(Stream),
}

/// What standard output is to get.
pub(super) enum Stream {
    Picture {
        alpha: f64,
        write: WritePicture,
    },
    Animation {
        frames: RangeInclusive<u64>,
        fps: NonZeroU16,
    },
    /// The bytes of each frame.
    Bytes {
        frames: RangeInclusive<u64>,
    },
}

impl Job {
    /// What the arguments ask for; wrong usage where they do not fit each other.
    pub(super) fn new(arguments: &Arguments) -> Result<Job, clap::Error> {
        let job = Job::of_output(arguments)?;
        let is_animation = matches!(
            job,
            Job::Animation { .. } | Job::Stream(Stream::Animation { .. })
        );
        if arguments.fps.is_some() && !is_animation {
            return Err(wrong(
                "--fps: only an animation plays at a speed: leave --fps out, or choose .apng",
            ));
        }
        let is_exr = match arguments.format {
            Some(format) => matches!(format, StreamFormat::Exr),
            None => matches!(Format::of(&arguments.output), Ok(Format::Exr)),
        };
        if arguments.linear && !is_exr {
            return Err(wrong(
                "--linear: only an EXR holds light: leave --linear out, or choose .exr",
            ));
        }
        Ok(job)
    }

    /// The same, whether or not `--fps` and `--linear` fit it.
    fn of_output(arguments: &Arguments) -> Result<Job, clap::Error> {
        let path = arguments.output.clone();
        if is_standard(&path) {
            return Ok(Job::Stream(Stream::new(arguments)?));
        }
        if arguments.format.is_some() {
            return Err(wrong(format!(
                "{}: the extension of a file says its format: leave --format out, or write to standard output, -o -",
                path.display()
            )));
        }
        let format = Format::of(&path).map_err(wrong)?;
        let bytes = path.as_os_str().as_encoded_bytes();
        let has_place = bytes.windows(2).any(|two| two == b"{}");
        let shown = path.display();
        match (format, arguments.frames.clone()) {
            (Format::Apng, None) => Err(wrong(format!(
                "{shown}: an .apng holds an animation: give --frames A..B, or choose .png or .exr"
            ))),
            (Format::Apng, Some(_)) if has_place => Err(wrong(format!(
                "{shown}: an .apng holds all frames: leave {{}} out of its name"
            ))),
            (Format::Apng, Some(frames)) => {
                check_count(&frames, shown)?;
                let fps = arguments.fps.unwrap_or(FPS);
                Ok(Job::Animation { frames, fps, path })
            }
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
            (Format::Png | Format::Exr, Some(frames)) => Ok(Job::Pictures {
                frames,
                pattern: path.into_os_string(),
            }),
        }
    }
}

impl Stream {
    /// What standard output is to get; wrong usage where the arguments do not fit each other.
    fn new(arguments: &Arguments) -> Result<Stream, clap::Error> {
        let Some(format) = arguments.format else {
            return Err(wrong(
                "-o -: standard output has no extension: give --format png, exr, apng or rgb24",
            ));
        };
        let write: WritePicture = match (format, arguments.frames.clone()) {
            (StreamFormat::Apng, None) => {
                return Err(wrong(
                    "--format apng: this is an animation: give --frames A..B, or choose png or exr",
                ));
            }
            (StreamFormat::Apng, Some(frames)) => {
                check_count(&frames, "--format apng")?;
                let fps = arguments.fps.unwrap_or(FPS);
                return Ok(Stream::Animation { frames, fps });
            }
            (StreamFormat::Rgb24, Some(frames)) => return Ok(Stream::Bytes { frames }),
            (StreamFormat::Png | StreamFormat::Exr, Some(_)) => {
                return Err(wrong(
                    "-o -: standard output holds one png or exr: choose --format apng or rgb24, or write files, as in -o frame-{}.png",
                ));
            }
            (StreamFormat::Png, None) => Raster::write_png,
            (StreamFormat::Exr, None) => Raster::write_exr,
            (StreamFormat::Rgb24, None) => Raster::write_rgb24,
        };
        let alpha = arguments.angle.alpha();
        Ok(Stream::Picture { alpha, write })
    }
}

/// Wrong usage where an animation cannot have so many frames; `what` begins the message.
fn check_count(frames: &RangeInclusive<u64>, what: impl Display) -> Result<(), clap::Error> {
    if count(frames) <= Animation::MAX_FRAMES {
        return Ok(());
    }
    Err(wrong(format!(
        "{what}: an animation holds at most {} frames: give fewer, or choose another format",
        Animation::MAX_FRAMES
    )))
}

/// The number of frames, or the largest number where that is one less.
pub(super) fn count(frames: &RangeInclusive<u64>) -> u64 {
    (frames.end() - frames.start()).saturating_add(1)
}

/// `pattern` with `number` for each `{}`; the rest need not be text.
#[cfg(unix)]
pub(super) fn numbered(pattern: &OsStr, number: &str) -> OsString {
    use std::os::unix::ffi::{OsStrExt as _, OsStringExt as _};
    let name = replaced(pattern.as_bytes(), b"{}", number.as_bytes());
    OsString::from_vec(name)
}

/// The same in the units of Windows.
#[cfg(windows)]
pub(super) fn numbered(pattern: &OsStr, number: &str) -> OsString {
    use std::os::windows::ffi::{OsStrExt as _, OsStringExt as _};
    let wide = |text: &OsStr| text.encode_wide().collect::<Vec<u16>>();
    let place = wide("{}".as_ref());
    let name = replaced(&wide(pattern), &place, &wide(number.as_ref()));
    OsString::from_wide(&name)
}

/// `name` with `number` for each `place`.
fn replaced<Unit: Copy + PartialEq>(name: &[Unit], place: &[Unit], number: &[Unit]) -> Vec<Unit> {
    let (mut replaced, mut rest) = (Vec::new(), name);
    while let Some((first, after)) = rest.split_first() {
        if let Some(after) = rest.strip_prefix(place) {
            replaced.extend(number);
            rest = after;
        } else {
            replaced.push(*first);
            rest = after;
        }
    }
    replaced
}
