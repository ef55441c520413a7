//! What can go wrong with another program.

use std::fmt;
use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;
use std::time::Duration;

use super::request::Request;
use crate::Stage;
use crate::tracer::TraceError;

/// A program that cannot be started, or a picture that it does not answer with. Each message is one
/// line that names the program.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProgramError {
    /// The command cannot be split into words.
    #[error("{0}: a quote or a backslash is left open: close it")]
    CommandWords(String),
    /// The command has no words.
    #[error("the command of a program is empty: give its path, or its name in PATH")]
    Empty,
    /// The program cannot be started.
    #[error("{program}: cannot be started: {reason}: {}", advice(reason))]
    Start {
        /// The program's name.
        program: String,
        /// What the system said.
        reason: io::Error,
    },
    /// The scene cannot be written to a file for the program.
    #[error(
        "{program}: no scene can be written for it in {}: {reason}: let TMPDIR name a folder that can be written to",
        folder.display()
    )]
    Folder {
        /// The program's name.
        program: String,
        /// The folder of temporary files.
        folder: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// α is a NaN or an infinity.
    #[error("{program}: {}", TraceError::Angle(*alpha))]
    Angle {
        /// The program's name.
        program: String,
        /// α.
        alpha: f64,
    },
    /// The program answered with no picture.
    #[error(
        "{program}: {}: {fault}",
        Request { stage: *stage, alpha: *alpha, size: *size }
    )]
    Picture {
        /// The program's name.
        program: String,
        /// The picture's stage.
        stage: Stage,
        /// The picture's angle, in radians.
        alpha: f64,
        /// N, the picture's pixels along a side.
        size: u32,
        /// What the program did instead.
        fault: Fault,
    },
}

fn advice(reason: &io::Error) -> &'static str {
    #[cfg(unix)]
    if reason.raw_os_error() == Some(rustix::io::Errno::NOEXEC.raw_os_error()) {
        return "let a script begin with a line such as #!/usr/bin/env python3";
    }
    match reason.kind() {
        io::ErrorKind::NotFound => "give its path, as in ./homework, or its name in PATH",
        io::ErrorKind::PermissionDenied => "allow it to be run, as by chmod +x",
        io::ErrorKind::ExecutableFileBusy => "let whatever writes it finish, and start it then",
        io::ErrorKind::WouldBlock | io::ErrorKind::OutOfMemory => {
            "end other programs, or raise `ulimit -u` or `ulimit -v`"
        }
        _ => "see what a shell says to it",
    }
}

/// What a program did instead of answering with a picture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// It ended.
    #[error(
        "{} after {answer}: let it answer every line of its input, and leave only when that ends",
        how(status)
    )]
    Ended {
        /// With what status, or by which signal.
        status: ExitStatus,
        /// What it had written.
        answer: Partial,
    },
    /// It closed its standard output, and did not end.
    #[error("closed its standard output after {answer}: let it answer every line of its input")]
    Closed {
        /// What it had written.
        answer: Partial,
    },
    /// It took too long.
    #[error(
        "wrote {answer} in {} s: let it call fflush(stdout) after every picture, or give it more time by `--program-timeout`",
        timeout.as_secs_f64()
    )]
    Late {
        /// The time that it was given.
        timeout: Duration,
        /// What it had written.
        answer: Partial,
    },
    /// Nobody waits for the picture any more.
    #[error("was ended, because nobody waits for the picture any more")]
    Cancelled,
    /// It wrote to its standard output what belongs to no picture.
    #[error(
        "wrote more to its standard output than the picture's {expected} bytes: \"{}\": let it write N × N × 3 floats of 4 bytes there, and messages to standard error",
        shown(bytes)
    )]
    Surplus {
        /// The bytes of the picture.
        expected: u64,
        /// What was too much, or how it begins.
        bytes: Vec<u8>,
    },
}

/// Bytes as a text on one line.
fn shown(bytes: &[u8]) -> String {
    match str::from_utf8(bytes) {
        Ok(text) => text.escape_debug().to_string(),
        Err(_) => bytes.escape_ascii().to_string(),
    }
}

/// How a process ended.
fn how(status: &ExitStatus) -> String {
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt as _;
        if let Some(signal) = status.signal() {
            let name = signal_hook::low_level::signal_name(signal);
            let name = name.map_or_else(String::new, |name| format!(" ({name})"));
            return format!("ended by signal {signal}{name}");
        }
    }
    match status.code() {
        Some(code) => format!("ended with status {code}"),
        None => format!("ended ({status})"),
    }
}

/// A part of an answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Partial {
    /// The bytes that came.
    pub received: u64,
    /// The bytes of the picture.
    pub expected: u64,
    /// How they begin, if that is a text.
    pub text: Option<String>,
}

impl fmt::Display for Partial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {} bytes", self.received, self.expected)?;
        match &self.text {
            Some(text) => write!(f, " ({text:?})"),
            None => Ok(()),
        }
    }
}
