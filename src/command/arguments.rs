//! Arguments that commands share.

use std::io;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::value_parser;
use firsthit::camera::frame_angle;
use firsthit::image::MAX_SIZE;
use firsthit::program::{Program, ProgramError};
use firsthit::{Kernel, Scene, Stage};

use super::Failure;
use super::streams::{INPUT, is_standard};
use super::watchdog::Watchdog;

/// What is pictured, and how.
#[derive(Args)]
pub(crate) struct PictureArguments {
    /// Pixels along a side of the picture
    #[arg(long, value_name = "N", default_value_t = 500, value_parser = value_parser!(u32).range(1..=i64::from(MAX_SIZE)))]
    pub(crate) size: u32,
    /// A scene in TOML, - for standard input; the built-in scene if not given
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// How numbers are computed; exact if not given
    #[arg(long, value_name = "NAME", value_parser = kernel())]
    pub(crate) kernel: Option<Kernel>,
    /// Threads to trace with; 0 for one a core
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
}

impl PictureArguments {
    /// The scene of `--scene`, else the built-in one.
    pub(crate) fn scene(&self) -> Result<Scene, Failure> {
        match &self.scene {
            Some(path) => read_scene(path),
            None => Ok(Scene::builtin()),
        }
    }

    /// The file of `--scene`; `None` where the scene comes from standard input.
    pub(crate) fn scene_file(&self) -> Option<PathBuf> {
        self.scene.clone().filter(|path| !is_standard(path))
    }

    /// The number of threads as the library takes it: 0 for one a core.
    pub(crate) fn threads(&self) -> usize {
        self.threads
    }
}

/// Another program to make the picture, if any.
#[derive(Args)]
pub(crate) struct ProgramArguments {
    /// A program to make the picture: its path and arguments, in one word of the shell
    #[arg(long, value_name = "COMMAND")]
    program: Option<String>,
    /// How long the program may take for a picture; 10 if not given
    #[arg(long, value_name = "SECONDS", requires = "program", value_parser = seconds)]
    program_timeout: Option<Duration>,
}

impl ProgramArguments {
    /// Whether there is one.
    pub(crate) fn is_given(&self) -> bool {
        self.program.is_some()
    }

    /// The program of `--program`, started. Its diagnostics are lines on standard error.
    pub(crate) fn start(&self) -> Result<Option<Program>, ProgramError> {
        let Some(command) = &self.program else {
            return Ok(None);
        };
        start(command, self.program_timeout).map(Some)
    }
}

/// Other programs that make pictures too.
#[derive(Args)]
pub(crate) struct ProgramsArguments {
    /// A program that makes pictures too: its path and arguments, in one word of the shell; may be
    /// given several times
    #[arg(long = "program", value_name = "COMMAND")]
    programs: Vec<String>,
    /// How long a program may take for a picture; 10 if not given
    #[arg(long, value_name = "SECONDS", requires = "programs", value_parser = seconds)]
    program_timeout: Option<Duration>,
}

impl ProgramsArguments {
    /// Whether there are none.
    pub(crate) fn is_empty(&self) -> bool {
        self.programs.is_empty()
    }

    /// The programs of `--program`, started.
    pub(crate) fn start(&self) -> Result<Vec<Program>, ProgramError> {
        let programs = self.programs.iter();
        let start = |command: &String| start(command, self.program_timeout);
        programs.map(start).collect()
    }
}

/// Starts a program; its diagnostics are lines on standard error.
fn start(command: &str, timeout: Option<Duration>) -> Result<Program, ProgramError> {
    let timeout = timeout.unwrap_or(Duration::from_secs(10));
    Program::start(command, timeout, super::say)
}

/// The scene in the file `path`, or in standard input.
pub(crate) fn read_scene(path: &Path) -> Result<Scene, Failure> {
    if is_standard(path) {
        let name = Path::new(INPUT);
        let _watchdog = Watchdog::for_input(name);
        return Ok(Scene::from_reader(io::stdin().lock(), name)?);
    }
    let _watchdog = Watchdog::for_input(path);
    Ok(Scene::from_file(path)?)
}

/// A stage by its number.
pub(crate) fn stage(text: &str) -> Result<Stage, &'static str> {
    text.parse()
        .ok()
        .and_then(Stage::from_number)
        .ok_or("the stages are 1 to 7")
}

/// Frames A..B, both ends included.
pub(crate) fn frames(text: &str) -> Result<RangeInclusive<u64>, &'static str> {
    let (first, last) = text
        .split_once("..")
        .ok_or("two whole numbers with .. between them are needed, as in 0..20")?;
    match (first.parse(), last.parse()) {
        (Ok(first), Ok(last)) if first <= last => Ok(first..=last),
        (Ok(_), Ok(_)) => Err("the first frame comes after the last"),
        _ => Err("both ends must be whole numbers from 0 to 18446744073709551615"),
    }
}

/// A number of radians, or of radians a second.
pub(crate) fn finite(text: &str) -> Result<f64, &'static str> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err("a finite number is needed"),
        Err(_) => Err("not a decimal number"),
    }
}

/// A number of seconds, as a time that may pass.
pub(crate) fn seconds(text: &str) -> Result<Duration, &'static str> {
    let seconds = finite(text)?;
    match Duration::try_from_secs_f64(seconds) {
        Ok(time) if !time.is_zero() => Ok(time),
        _ => Err("a positive number of seconds is needed"),
    }
}

/// The angle of one frame; one of the two at most, 0 if none.
#[derive(Args)]
#[group(multiple = false)]
pub(crate) struct AngleArguments {
    /// The angle α of the eye
    #[arg(long, value_name = "RADIANS", allow_hyphen_values = true, value_parser = finite)]
    alpha: Option<f64>,
    /// A frame of the animation; every 21 it starts again
    #[arg(long, value_name = "K")]
    frame: Option<u64>,
}

impl AngleArguments {
    pub(crate) fn alpha(&self) -> f64 {
        self.alpha.or(self.frame.map(frame_angle)).unwrap_or(0.0)
    }
}

/// A kernel by its name.
pub(crate) fn kernel() -> impl TypedValueParser<Value = Kernel> {
    PossibleValuesParser::new(Kernel::ALL.map(Kernel::name)).try_map(|name| {
        Kernel::ALL
            .into_iter()
            .find(|kernel| kernel.name() == name)
            .ok_or("no kernel has this name")
    })
}

/// How far a sample may be from another one.
pub(crate) fn tolerance(text: &str) -> Result<f32, &'static str> {
    match text.parse::<f32>() {
        Ok(tolerance) if tolerance >= 0.0 && tolerance.is_finite() => Ok(tolerance),
        Ok(_) => Err("a number from 0 on is needed"),
        Err(_) => Err("not a decimal number"),
    }
}
