//! `firsthit report`: speed against error.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use clap::{Args, value_parser};
use firsthit::diagnosis::TOLERANCE;
use firsthit::image::MAX_SIZE;
use firsthit::program::Program;
use firsthit::report::{
    self, CROWD_KERNELS, MAX_CROWD, NamedScene, Progress, Report, Request, WrongOfRenderer,
};
use firsthit::{Kernel, Render, Stage};
use indicatif::{ProgressBar, ProgressStyle};

use super::arguments::{ProgramsArguments, frames, kernel, read_scene, stage, tolerance};
use super::streams::{INPUT, is_standard};
use super::watchdog::Watchdog;
use super::{Failure, print, wrong};

#[derive(Args)]
pub(crate) struct Arguments {
    /// A scene in TOML, - for standard input; may be given several times; the built-in scene if not
    /// given
    #[arg(long = "scene", value_name = "FILE")]
    scenes: Vec<PathBuf>,
    /// The hard scenes too: those that the kernels are tested on
    #[arg(long)]
    hard: bool,
    /// A stage, 1 to 7, or all from A to B; may be given several times; 6 if not given
    #[arg(long = "stage", value_name = "STAGE|A..B", value_parser = stages)]
    stages: Vec<Stages>,
    /// Pixels along a side of the picture
    #[arg(long, value_name = "N", default_value_t = 500, value_parser = value_parser!(u32).range(1..=i64::from(MAX_SIZE)))]
    size: u32,
    /// All frames from A to B, both included
    #[arg(long, value_name = "A..B", default_value = "0..20", value_parser = frames)]
    frames: RangeInclusive<u64>,
    /// A kernel; may be given several times; exact, fast, double and listing if not given, or with
    /// --program exact alone
    #[arg(long = "kernel", value_name = "NAME", value_parser = kernel())]
    kernels: Vec<Kernel>,
    #[command(flatten)]
    programs: ProgramsArguments,
    /// How many pixels a program may have wrong, over all frames of a stage; more are a failure
    #[arg(long, value_name = "N", requires = "programs")]
    max_wrong: Option<u64>,
    /// How far a program's sample may be from the true one, or from that of another decision; 1/255
    /// if not given
    #[arg(long, value_name = "ABS", requires = "programs", allow_hyphen_values = true, value_parser = tolerance)]
    tolerance: Option<f32>,
    /// The number of threads to measure beside one; 0 for one a core
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    /// The number of spheres of a crowd to be timed too; several with commas between them
    #[arg(long = "crowd", value_name = "N,...", value_delimiter = ',', value_parser = value_parser!(u16).range(1..=i64::from(MAX_CROWD)))]
    crowds: Vec<u16>,
    /// A file to write the report to, as JSON; - for standard output, in place of the tables
    #[arg(long, value_name = "PATH")]
    json: Option<PathBuf>,
    /// A file to draw error against time into, as SVG; - for standard output, in place of the
    /// tables
    #[arg(long, value_name = "PATH.svg")]
    plot: Option<PathBuf>,
}

/// What is measured where no kernel is chosen.
const KERNELS: [Kernel; 4] = [Kernel::Exact, Kernel::Fast, Kernel::Double, Kernel::Listing];

/// One stage or several.
#[derive(Clone)]
struct Stages(Vec<Stage>);

fn stages(text: &str) -> Result<Stages, &'static str> {
    let Some((first, last)) = text.split_once("..") else {
        return Ok(Stages(vec![stage(text)?]));
    };
    let (first, last) = (stage(first)?, stage(last)?);
    if first > last {
        return Err("the first stage comes after the last");
    }
    let all = Stage::ALL.into_iter();
    Ok(Stages(
        all.filter(|stage| (first..=last).contains(stage)).collect(),
    ))
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(path) = &arguments.plot {
        let is_svg = path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("svg"));
        let message = match &arguments.json {
            _ if !is_svg && !is_standard(path) => "the plot is an .svg",
            Some(json) if json == path => "the plot and the JSON need two files",
            _ => "",
        };
        if !message.is_empty() {
            let message = format!("{}: {message}", path.display());
            return Err(wrong::<Arguments>("firsthit report", message).into());
        }
    }
    let request = request(arguments)?;
    let paths = [&arguments.json, &arguments.plot];
    let paths = paths.into_iter().flatten();
    // Standard output holds either a file or the tables.
    let shows_tables = !paths.clone().any(|path| is_standard(path));
    paths
        .filter(|path| !is_standard(path))
        .try_for_each(report::can_save)?;
    let mut programs = arguments.programs.start()?;
    let renderers = programs.iter_mut();
    let mut renderers: Vec<_> = renderers
        .map(|program| -> &mut dyn Render { program })
        .collect();
    let bar = ProgressBar::new(0).with_style(style());
    let report = report::measure(
        &request,
        &mut renderers,
        &mut |Progress { done, of, next }| {
            bar.set_length(of);
            bar.set_position(done);
            bar.set_message(next.to_owned());
        },
    );
    bar.finish_and_clear();
    let finished = programs.iter_mut().try_for_each(Program::finish);
    let mut report = report?;
    let show = |table: &str| match shows_tables {
        true => print(table),
        false => Ok(()),
    };
    let save_json = |report: &Report| match &arguments.json {
        Some(path) => save(&report.json(), path),
        None => Ok(()),
    };
    // What cannot be shown in one place is still shown in the others.
    let shown = show(&report.table());
    let plotted = match &arguments.plot {
        Some(path) => plot(&report, path),
        None => Ok(()),
    };
    if let Some(most) = arguments.max_wrong {
        let saved = save_json(&report);
        shown?;
        plotted?;
        saved?;
        finished?;
        return grade(&report, most);
    }
    // A file has the report before drivers are called, which may hang; standard output gets it
    // once.
    let saved = match &arguments.json {
        Some(path) if is_standard(path) => Ok(()),
        _ => save_json(&report),
    };
    let mut watchdog = None;
    let measured = report.measure_pipelines(&request, &mut |waits| {
        watchdog = waits.then(|| Watchdog::for_driver(request.size, request.size));
    });
    shown?;
    let all_shown = show(&report.pipeline_table());
    plotted?;
    saved?;
    save_json(&report)?;
    measured?;
    finished?;
    all_shown
}

/// Fails where a program has more than `most` pixels wrong.
fn grade(report: &Report, most: u64) -> Result<(), Failure> {
    let fails = |row: &WrongOfRenderer<'_>| row.wrong.is_err() || row.wrong > Ok(most);
    let Some(first) = report.wrong_pixels().find(fails) else {
        return Ok(());
    };
    let WrongOfRenderer {
        renderer,
        scene,
        stage,
        wrong,
    } = first;
    Err(Failure::TooManyWrong(match wrong {
        Ok(wrong) => format!(
            "{renderer}: stage {stage} of {scene}: {wrong} wrong pixels, more than {most}: see them in `firsthit view --program`, on E"
        ),
        Err(reason) => reason.to_owned(),
    }))
}

fn plot(report: &Report, path: &Path) -> Result<(), Failure> {
    save(&report.plot()?, path)
}

/// Writes a text into the file `path`, or into standard output.
fn save(text: &str, path: &Path) -> Result<(), Failure> {
    match is_standard(path) {
        true => print(text),
        false => Ok(report::save(text, path)?),
    }
}

fn request(arguments: &Arguments) -> Result<Request, Failure> {
    let default = match arguments.programs.is_empty() {
        true => &KERNELS[..],
        false => &[Kernel::Exact],
    };
    let kernels = chosen(&arguments.kernels, default);
    let mut crowds = chosen(&arguments.crowds, &[]);
    crowds.sort_unstable();
    if !crowds.is_empty() && !CROWD_KERNELS.iter().any(|kernel| kernels.contains(kernel)) {
        let names = CROWD_KERNELS.map(Kernel::name).join(", ");
        let message = format!("--crowd needs one of the kernels {names}");
        return Err(wrong::<Arguments>("firsthit report", message).into());
    }
    let is_input = |path: &&PathBuf| is_standard(path);
    if arguments.scenes.iter().filter(is_input).count() > 1 {
        let message = "--scene -: standard input can be read once: give it once";
        return Err(wrong::<Arguments>("firsthit report", message).into());
    }
    let mut scenes = Vec::new();
    for path in &arguments.scenes {
        let name = match is_standard(path) {
            true => INPUT.to_owned(),
            false => path.display().to_string(),
        };
        scenes.push(NamedScene::of_file(name, read_scene(path)?));
    }
    if scenes.is_empty() {
        scenes.push(NamedScene::builtin());
    }
    if arguments.hard {
        scenes.extend(NamedScene::hard());
    }
    let stages = arguments.stages.iter().flat_map(|Stages(stages)| stages);
    let stages: Vec<Stage> = stages.copied().collect();
    Ok(Request {
        scenes,
        stages: chosen(&stages, &[Stage::Reflection]),
        kernels,
        size: arguments.size,
        frames: arguments.frames.clone(),
        threads: arguments.threads,
        crowds,
        tolerance: arguments.tolerance.unwrap_or(TOLERANCE),
    })
}

/// What was given, each once, or else what is measured by default.
fn chosen<T: Copy + PartialEq>(given: &[T], default: &[T]) -> Vec<T> {
    let mut chosen = Vec::new();
    for &one in if given.is_empty() { default } else { given } {
        if !chosen.contains(&one) {
            chosen.push(one);
        }
    }
    chosen
}

/// A bar with the time that is left and what is being done.
fn style() -> ProgressStyle {
    ProgressStyle::with_template("{wide_bar} {percent} %, {eta} left: {msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
}
