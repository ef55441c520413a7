//! Promise: no OpenGL driver is trusted. What one gets wrong is an error that names the pixel, and
//! never a wrong file.

use std::fs;
use std::process::Output;
use std::time::{Duration, Instant};

use tempfile::TempDir;

use crate::helpers::{backends, failed, program, succeeded, text, with_fault};

/// What a driver does wrong, and what is said of it.
const FAULTS: [(&str, &str); 6] = [
    (
        "draws nothing",
        "does not give back what was drawn: at column 0, row 0 ",
    ),
    (
        "clears low bits",
        "does not give back what was drawn: at column 0, row 0 ",
    ),
    (
        "stores 8 bits",
        "does not give back what was drawn: at column ",
    ),
    (
        "does not read back",
        "does not give back what was drawn: at column 0, row 0 ",
    ),
    ("has no version", "refuses to say what it can"),
    ("has no eglGetProcAddress", "libEGL.so.1 cannot be used"),
];

/// A folder with the picture as it should be.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let line = "capture --stage 6 --size 50 --through none -o right.exr";
    succeeded(&program(&folder, line).output().unwrap(), line);
    folder
}

fn capture(folder: &TempDir, through: &str, fault: &str) -> Option<Output> {
    let line = format!("capture --stage 6 --size 50{through} -o a.exr");
    let mut command = program(folder, &line);
    Some(with_fault(&mut command, fault)?.output().unwrap())
}

#[test]
fn what_a_driver_gets_wrong_is_never_written() {
    let folder = folder();
    for (fault, said) in FAULTS {
        for &through in backends() {
            if fault == "has no eglGetProcAddress" && through != "egl" {
                continue;
            }
            let through = &format!(" --through {through}");
            let Some(output) = capture(&folder, through, fault) else {
                return;
            };
            let message = failed(&output, 1, fault);
            assert!(message.contains(said), "{fault}{through}: {message}");
            assert!(message.contains("`--through none`"), "{fault}: {message}");
            assert!(!folder.path().join("a.exr").exists(), "{fault}");
        }
    }
}

#[test]
fn the_next_way_is_taken_where_none_was_asked_for() {
    let folder = folder();
    let right = fs::read(folder.path().join("right.exr")).unwrap();
    for (fault, said) in FAULTS {
        let Some(output) = capture(&folder, "", fault) else {
            return;
        };
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{fault}: {message}");
        assert_eq!(message.lines().count(), 1, "{fault}: {message}");
        let way = match fault {
            "has no eglGetProcAddress" if backends().contains(&"osmesa") => "osmesa",
            _ => "none",
        };
        let taken = format!("captured through {way}, ");
        assert!(message.contains(&taken), "{fault}: {message}");
        assert!(message.contains(said), "{fault}: {message}");
        assert_eq!(fs::read(folder.path().join("a.exr")).unwrap(), right);
    }
}

#[test]
#[ignore = "waits for 20 s: .ci/soak runs it"]
fn a_driver_that_never_comes_back_is_given_up() {
    let folder = folder();
    let mut throughs: Vec<_> = backends()
        .iter()
        .map(|way| format!(" --through {way}"))
        .collect();
    throughs.push(String::new());
    for through in &throughs {
        let start = Instant::now();
        let Some(output) = capture(&folder, through, "waits") else {
            return;
        };
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        let lines: Vec<_> = message.lines().collect();
        assert_eq!(lines.len(), 2, "{message}");
        assert!(
            lines[0].contains("waits for the OpenGL driver"),
            "{message}"
        );
        assert!(lines[1].contains("--through none"), "{message}");
        assert!(start.elapsed() < Duration::from_secs(30));
        assert!(!folder.path().join("a.exr").exists());
    }
}
