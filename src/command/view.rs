//! `firsthit view`: the viewer's window.

use clap::Args;
use clap::value_parser;
use firsthit::viewer::{self, Event, Options, Pace};
use firsthit::{Render, Stage};

use super::arguments::{PictureArguments, ProgramsArguments, finite, stage};
use super::watchdog::Watchdog;
use super::{Failure, print};

#[derive(Args)]
pub(crate) struct Arguments {
    /// The stage to open on, 1 to 7
    #[arg(long, value_name = "STAGE", default_value = "7", value_parser = stage)]
    stage: Stage,
    #[command(flatten)]
    picture: PictureArguments,
    #[command(flatten)]
    programs: ProgramsArguments,
    #[command(flatten)]
    pace: PaceArguments,
    /// Leave after this many frames
    #[arg(long, value_name = "N", value_parser = value_parser!(u64).range(1..))]
    exit_after_frames: Option<u64>,
}

/// How α advances; one of the two at most.
#[derive(Args)]
#[group(multiple = false)]
struct PaceArguments {
    /// Turn by so much a second, whatever the number of frames; 1.5 if not given
    #[arg(long, value_name = "RAD_PER_S", allow_hyphen_values = true, value_parser = finite)]
    speed: Option<f64>,
    /// Turn by so much at each redisplay instead
    #[arg(long, value_name = "RAD", allow_hyphen_values = true, value_parser = finite)]
    step: Option<f64>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let pace = match (arguments.pace.step, arguments.pace.speed) {
        (Some(step), _) => Pace::Step(step),
        (None, Some(speed)) => Pace::Speed(speed),
        (None, None) => Pace::default(),
    };
    let picture = &arguments.picture;
    let options = Options {
        scene: picture.scene()?,
        scene_file: picture.scene_file(),
        stage: arguments.stage,
        size: picture.size,
        kernel: picture.kernel,
        threads: picture.threads(),
        pace,
        exit_after_frames: arguments.exit_after_frames,
    };
    let programs = arguments.programs.start()?.into_iter();
    let renderers = programs.map(|program| -> Box<dyn Render + Send> { Box::new(program) });
    let mut opening = Some(Watchdog::for_driver(options.size, options.size));
    viewer::run(options, renderers.collect(), &mut |event| match event {
        Event::Opened => opening = None,
        Event::NotSaved(_)
        | Event::Differs { .. }
        | Event::NotRendered { .. }
        | Event::SceneRefused(_) => super::say(&event.to_string()),
        // A person who closed the terminal still has the window.
        Event::FirstFrame { .. } => drop(print(&format!("{}{event}\n", viewer::key_table()))),
        _ => drop(print(&format!("{event}\n"))),
    })?;
    Ok(())
}
