//! The built program, and what it needs of the system.

use std::fmt::Display;
use std::io::Write as _;
use std::process::{Command, Output};
#[cfg(target_os = "linux")]
use std::sync::LazyLock;

use firsthit::screen::{Backend, Offscreen, ScreenError};
use tempfile::TempDir;

/// Says that a test leaves something out for want of a library, which CI must have: there it fails.
#[expect(
    clippy::explicit_write,
    reason = "the test harness hides what `eprintln!` says in a test that passes"
)]
pub(crate) fn skipped(error: &dyn Display) {
    assert!(std::env::var_os("CI").is_none(), "{error}");
    writeln!(std::io::stderr(), "skipped: {error}").unwrap();
}

/// An offscreen for pictures of this size, or `None` where its library is not installed: never so
/// in CI.
pub(crate) fn open(backend: Backend, size: u32) -> Option<Offscreen> {
    match Offscreen::open(backend, size) {
        Ok(offscreen) => Some(offscreen),
        Err(error @ ScreenError::Missing { .. }) => {
            skipped(&error);
            None
        }
        Err(error) => panic!("{}: {error}", backend.name()),
    }
}

/// The names of the backends that are installed here. To see which takes as long as a test.
#[cfg(target_os = "linux")]
pub(crate) fn backends() -> &'static [&'static str] {
    static INSTALLED: LazyLock<Vec<&str>> = LazyLock::new(|| {
        let all = [Backend::Egl, Backend::OsMesa].into_iter();
        let installed = all.filter(|&backend| open(backend, 8).is_some());
        installed.map(Backend::name).collect()
    });
    &INSTALLED
}

/// The names in `folder`, hidden ones too, in order.
pub(crate) fn names(folder: &TempDir) -> Vec<String> {
    let mut names: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

pub(crate) const PROGRAM: &str = env!("CARGO_BIN_EXE_firsthit");

/// The words of `line` as arguments; an empty line has none.
pub(crate) fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(' ').filter(|_| !line.is_empty())
}

/// The program with the words of `line`, to be run in `folder`.
pub(crate) fn program(folder: &TempDir, line: &str) -> Command {
    let mut command = Command::new(PROGRAM);
    command.current_dir(folder).args(words(line));
    command
}

/// The program under `sh`, after `setup`.
#[cfg(unix)]
pub(crate) fn program_after(setup: &str, folder: &TempDir, line: &str) -> Command {
    let mut command = Command::new("sh");
    command
        .args(["-c", &format!("{setup}; exec \"$0\" \"$@\""), PROGRAM])
        .args(words(line))
        .current_dir(folder);
    command
}

/// What is set up for a report so that it loads no driver of OpenGL: each may need a GiB.
#[cfg(target_os = "linux")]
pub(crate) const NO_DRIVERS: &str = "ulimit -v 1000000";

/// The program with the words of `line`, which need no drivers of OpenGL. To load them takes most of
/// the time of a report of small pictures: on Linux it does not.
pub(crate) fn without_drivers(folder: &TempDir, line: &str) -> Command {
    #[cfg(target_os = "linux")]
    return program_after(NO_DRIVERS, folder, line);
    #[cfg(not(target_os = "linux"))]
    return program(folder, line);
}

/// What the program prints; it must succeed and say nothing on standard error.
pub(crate) fn printed(folder: &TempDir, line: &str) -> String {
    succeeded(&program(folder, line).output().unwrap(), line)
}

/// What the program printed; it must have succeeded and said nothing on standard error.
pub(crate) fn succeeded(output: &Output, what: &str) -> String {
    assert_eq!(errors(output), "", "{what}");
    assert_eq!(output.status.code(), Some(0), "{what}");
    text(&output.stdout)
}

/// What the program said on standard error; it must have failed with this status, and in one line
/// where that is not 2, which is for wrong usage.
pub(crate) fn failed(output: &Output, status: i32, what: &str) -> String {
    let message = errors(output);
    assert_eq!(output.status.code(), Some(status), "{what}: {message}");
    if status != 2 {
        assert_eq!(message.lines().count(), 1, "{what}: {message}");
        assert!(message.ends_with('\n'), "{what}: {message}");
    }
    message
}

/// What the program said on standard error, but for that a driver takes its time: on a machine with
/// much else to do that may be said of any.
fn errors(output: &Output) -> String {
    let message = text(&output.stderr);
    message.replace(
        "firsthit: waits for the OpenGL driver: Ctrl+C ends it\n",
        "",
    )
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}
