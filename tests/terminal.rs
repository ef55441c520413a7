//! Promise: what is said fits into the terminal, and is text alone where that is all it can show.

use std::fs;
use std::io::Read as _;

use firsthit::Image;
use rustix::termios::{Winsize, tcsetwinsize};
use tempfile::TempDir;

use crate::helpers::{program, terminal, text};

/// What a terminal of so many columns gets from the program, which has it for all its streams.
fn shown(folder: &TempDir, columns: u16, environment: (&str, &str), line: &str) -> String {
    let (screen, device) = terminal();
    let size = Winsize {
        ws_row: 24,
        ws_col: columns,
        ws_xpixel: 0,
        ws_ypixel: 0,
    };
    tcsetwinsize(&screen, size).unwrap();
    let mut command = program(folder, line);
    let (name, value) = environment;
    command.env("TERM", "xterm-256color").env(name, value);
    command.stdin(device.try_clone().unwrap());
    command.stdout(device.try_clone().unwrap()).stderr(device);
    let mut child = command.spawn().unwrap();
    // Its copies of the device would keep the reader waiting.
    drop(command);
    let mut bytes = Vec::new();
    // At its end a terminal without programs gives an error.
    let _ = fs::File::from(screen).read_to_end(&mut bytes);
    child.wait().unwrap();
    text(&bytes)
}

const COMMANDS: [&str; 8] = [
    "--help",
    "view --help",
    "capture --help",
    "explain --help",
    "report --help",
    "compare --help",
    "completions --help",
    "man --help",
];

#[test]
fn help_fits_into_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    for command in COMMANDS {
        for columns in [40, 80, 300] {
            let help = shown(&folder, columns, ("LANG", "C"), command);
            assert!(help.contains("Usage: firsthit"), "{help}");
            let lines = help.lines().map(str::trim_end);
            // The usage is a command, which is not broken.
            for line in lines.filter(|line| !line.starts_with("Usage: ")) {
                // Where the terminal is wide, lines are still short enough to be read.
                let most = usize::from(columns.min(100));
                assert!(line.chars().count() <= most, "{columns}: {line}");
            }
        }
    }
}

#[test]
fn a_comparison_is_text_alone() {
    let folder = tempfile::tempdir().unwrap();
    Image::new(4)
        .unwrap()
        .save(folder.path().join("a.png"))
        .unwrap();
    for environment in [
        ("TERM", "xterm-256color"),
        ("TERM", "dumb"),
        ("NO_COLOR", "1"),
        ("CLICOLOR_FORCE", "1"),
    ] {
        for (line, says) in [
            ("compare a.png a.png --flip", "FLIP"),
            ("compare a.png b.png", "firsthit: b.png: cannot be read"),
            ("compare a.png", "Usage: firsthit compare"),
            ("compare --help", "Usage: firsthit compare"),
            ("compare a.png a.png --threshold x", "--threshold"),
        ] {
            let shown = shown(&folder, 80, environment, line);
            assert!(shown.contains(says), "{environment:?} {line}: {shown}");
            assert!(!shown.contains('\u{1b}'), "{environment:?} {line}: {shown}");
        }
    }
}

#[test]
fn a_progress_bar_is_drawn_only_where_it_can_be_drawn_over() {
    let folder = tempfile::tempdir().unwrap();
    let line = "capture --stage 6 --frames 0..20 --size 120 --through none -o a.apng";
    for columns in [40, 80] {
        let bar = shown(&folder, columns, ("LANG", "C"), line);
        let frames = bar
            .split(['\r', '\n'])
            .filter(|frame| frame.contains("/21"));
        let mut count = 0;
        for frame in frames {
            let frame = frame.replace("\u{1b}[2K", "").replace("\u{1b}[1A", "");
            assert!(!frame.contains('\u{1b}'), "{frame:?}");
            assert!(frame.chars().count() <= columns.into(), "{frame:?}");
            count += 1;
        }
        assert!(count > 0, "{bar:?}");
    }
    assert_eq!(shown(&folder, 80, ("TERM", "dumb"), line), "");
    let (_screen, device) = terminal();
    let mut command = program(&folder, line);
    let output = command
        .env("TERM", "xterm")
        .stdout(device)
        .output()
        .unwrap();
    assert_eq!(text(&output.stderr), "");
}
