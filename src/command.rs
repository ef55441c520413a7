//! The commands: what a person types, and what it makes the library do.

mod arguments;
mod capture;
mod compare;
mod explain;
mod manual;
mod renderer;
mod report;
mod round_trip;
mod streams;
mod view;
mod watchdog;

use std::ffi::{OsStr, OsString};
use std::io::{self, Write};
use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::{Args, Parser, Subcommand};
use firsthit::diagnosis::ExaminationError;
use firsthit::difference::{FlipError, HeatError, SizesDiffer};
use firsthit::image::{ImageError, LoadError, SaveError, Window};
use firsthit::program::ProgramError;
use firsthit::report::{PlotError, ReportError};
use firsthit::scene::{BUILTIN_TOML, SceneFileError};
use firsthit::screen::ScreenError;
use firsthit::tracer::TraceError;
use firsthit::viewer::ViewerError;

use streams::print;

/// Traces a scene of solids on a glazed surface, and shows it in a window or writes it to files.
///
/// Without a command: view.
#[derive(Parser)]
#[command(version, args_conflicts_with_subcommands = true, max_term_width = 100)]
struct CommandLine {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    view: view::Arguments,
}

#[derive(Subcommand)]
enum Command {
    /// Open the viewer
    View(view::Arguments),
    /// Write pictures to files, without a window
    Capture(capture::Arguments),
    /// Work one pixel through, term by term, and say what is wrong with another program's
    Explain(explain::Arguments),
    /// Measure speed against error: every kernel's times, and how far it is from the truth
    Report(report::Arguments),
    /// Say how far one picture is from another, sample by sample
    Compare(compare::Arguments),
    /// Print the built-in scene as TOML, to start one's own from
    Scene,
    /// Print the completions of this command line for a shell
    Completions(manual::CompletionsArguments),
    /// Print the manual page of the program or of one of its commands, for man
    Man(manual::ManArguments),
}

/// Why a command did not do what it was asked to. All but wrong usage are one line.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    #[error(transparent)]
    Usage(#[from] clap::Error),
    #[error(transparent)]
    Scene(#[from] SceneFileError),
    #[error(transparent)]
    Image(#[from] ImageError),
    #[error(transparent)]
    Trace(#[from] TraceError),
    #[error(transparent)]
    Program(#[from] ProgramError),
    #[error(transparent)]
    Examination(#[from] ExaminationError),
    #[error(transparent)]
    Screen(#[from] ScreenError),
    #[error(transparent)]
    Save(#[from] SaveError),
    #[error(transparent)]
    Viewer(#[from] ViewerError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Plot(#[from] PlotError),
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error("{} and {}: {reason}", a.display(), b.display())]
    Sizes {
        a: PathBuf,
        b: PathBuf,
        reason: SizesDiffer,
    },
    #[error(
        "{} and {}: show pixels {} and {} of a scene, by their data windows: render both with one window",
        a.display(), b.display(), windows[0], windows[1]
    )]
    Windows {
        a: PathBuf,
        b: PathBuf,
        windows: [Window; 2],
    },
    #[error(
        "{} and {}: neither has a layer {layer}, nor any with a name: leave out --layer",
        a.display(), b.display()
    )]
    NoLayers {
        a: PathBuf,
        b: PathBuf,
        layer: String,
    },
    #[error(transparent)]
    Flip(#[from] FlipError),
    #[error(transparent)]
    Heat(#[from] HeatError),
    #[error(
        "{} and {}: up to {found} and {nans} NaNs against a number, beyond the {limit}: see where with -o HEAT.png",
        a.display(), b.display()
    )]
    BeyondLimit {
        a: PathBuf,
        b: PathBuf,
        /// The largest error.
        found: String,
        nans: u64,
        /// The largest error that passes, and what it is.
        limit: String,
    },
    #[error("{0}")]
    TooManyWrong(String),
    #[error("standard output cannot be written: {0}: send it elsewhere")]
    StandardOutput(io::Error),
    #[error("a terminal shows no pictures: send standard output to a file or to a program")]
    Terminal,
}

/// Does what the words of a command line say, of which the first is the program's name.
pub(crate) fn run(words: impl IntoIterator<Item = OsString>) -> Result<(), Failure> {
    let words: Vec<OsString> = words.into_iter().collect();
    let line = match CommandLine::try_parse_from(&words) {
        Ok(line) => line,
        // Help and version come this way too.
        Err(answer) if !answer.use_stderr() => return print(&answer.render().to_string()),
        Err(error) => {
            // The message is of several lines and holds the words: wrong as they are, they are
            // wrong without control characters too.
            let again = CommandLine::try_parse_from(words.iter().map(|word| escaped_word(word)));
            return Err(again.err().unwrap_or(error).into());
        }
    };
    match line.command.unwrap_or(Command::View(line.view)) {
        Command::View(arguments) => view::run(&arguments),
        Command::Capture(arguments) => capture::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Report(arguments) => report::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Scene => print(BUILTIN_TOML),
        Command::Completions(arguments) => manual::completions(&arguments),
        Command::Man(arguments) => manual::man(&arguments),
    }
}

/// One line on standard error, whatever is in `message`: a file's name may hold line breaks.
pub(crate) fn say(message: &str) {
    let line = format!("firsthit: {}\n", escaped(message));
    let _ = io::stderr().write_all(line.as_bytes());
}

/// A text without control characters, which a terminal would obey.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        if character.is_control() {
            escaped.extend(character.escape_default());
        } else {
            escaped.push(character);
        }
    }
    escaped
}

/// The same of a word that need not be text.
fn escaped_word(word: &OsStr) -> OsString {
    match word.to_string_lossy() {
        text if text.contains(char::is_control) => escaped(&text).into(),
        _ => word.to_owned(),
    }
}

/// Wrong usage, with the usage of the command that has the arguments `A` below the message.
fn wrong<A: Args>(command: &'static str, message: impl std::fmt::Display) -> clap::Error {
    A::augment_args(clap::Command::new(command))
        .error(ErrorKind::ValueValidation, escaped(&message.to_string()))
}
