//! Promise: what the system refuses is one line and status 1, and what does not come is waited for
//! aloud.

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use firsthit::image::Raster;
use tempfile::TempDir;

use crate::helpers::{
    PROGRAM, backends, failed, names, program, program_after, succeeded, text, with_fault,
    without_drivers, words,
};

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Whether the program can be loaded at all in so many KiB.
fn can_be_loaded(folder: &TempDir, kib: u32) -> bool {
    let line = format!("ulimit -v {kib}");
    let output = program_after(&line, folder, "--version").output().unwrap();
    output.status.success()
}

/// So many KiB in which it can be loaded; 1 MiB less is not enough.
fn least_memory(folder: &TempDir) -> u32 {
    let mut steps = (1..).map(|step| step << 10);
    steps.find(|&kib| can_be_loaded(folder, kib)).unwrap()
}

/// The main thread's stack grows, too, and threads that begin ask for memory.
#[test]
fn no_signal_ends_the_program_however_much_memory_is_refused() {
    let folder = folder();
    let line = "capture --stage 6 --size 500 --through none -o a.exr";
    for kib in (least_memory(&folder) + (1 << 10)..).step_by(80) {
        let limit = format!("ulimit -v {kib}");
        let status = program_after(&limit, &folder, line)
            .output()
            .unwrap()
            .status;
        match status.code() {
            Some(0) => break,
            code => assert_eq!(code, Some(1), "{kib} KiB: {status}"),
        }
    }
}

#[test]
fn memory_that_is_refused_is_one_line() {
    let folder = folder();
    for name in ["one.exr", "one.png"] {
        let line = format!("capture --stage 6 --size 500 --through none -o {name}");
        succeeded(&program(&folder, &line).output().unwrap(), &line);
    }
    let crowd = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/crowd.toml");
    let least = least_memory(&folder);
    let before = names(&folder);
    for line in [
        "capture --stage 6 --size 500 --through none -o a.exr",
        "capture --stage 6 --size 500 --through none -o a.png",
        "capture --stage 7 --size 500 --frames 0..1 --through none -o a.apng",
        "compare one.exr one.png -o a.png",
        "report --stage 1 --size 500 --frames 0..0 --kernel double --threads 1 --json a.json",
        &format!("capture --stage 6 --size 500 --scene {crowd} --through none -o a.exr"),
    ] {
        let (mut refused, mut done) = (0, 0);
        // Closer to where the program cannot be loaded, C's library ends it before it begins.
        for kib in (least + (1 << 10)..).step_by(1 << 11) {
            let limit = format!("export RUST_BACKTRACE=1; ulimit -v {kib}");
            let output = program_after(&limit, &folder, line).output().unwrap();
            let what = format!("{line}, {kib} KiB");
            if output.status.success() {
                done += 1;
                for name in names(&folder) {
                    if !before.contains(&name) {
                        fs::remove_file(folder.path().join(name)).unwrap();
                    }
                }
                // Threads and their heaps come in any order.
                if done > 1 {
                    break;
                }
                continue;
            }
            let message = failed(&output, 1, &what);
            let said = [
                "not enough memory",
                "out of memory",
                "Cannot allocate",
                "threads cannot be",
            ];
            assert!(
                said.iter().any(|said| message.contains(said)),
                "{what}: {message}"
            );
            assert!(!message.contains(" 0 threads"), "{what}: {message}");
            assert_eq!(names(&folder), before, "{what}");
            refused += 1;
        }
        assert!(refused > 0, "{line}");
    }
}

/// The pictures would take three gigabytes.
#[test]
fn what_a_short_file_says_of_its_size_takes_no_memory() {
    let folder = folder();
    for (name, text) in [
        ("a.ppm", "P6 16384 16384 255 abc"),
        ("b.ppm", "P3 16384 16384 255 1 2 3"),
        ("a.pfm", "PF 16384 16384 -1 abcd"),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
        let line = format!("compare {name} {name}");
        let mut limited = program_after("ulimit -v 300000", &folder, &line);
        let message = failed(&limited.output().unwrap(), 1, &line);
        assert!(message.contains("it ends before"), "{message}");
    }
}

#[test]
fn a_picture_that_there_is_no_memory_for_is_named() {
    let folder = folder();
    let path = folder.path().join("a.exr");
    Raster::new(1, 10000).unwrap().save(&path).unwrap();
    // As many rows of more pixels.
    let mut file = fs::read(&path).unwrap();
    let window = b"dataWindow\0box2i\0\x10\0\0\0";
    let mut places = file.windows(window.len());
    let place = places.position(|bytes| bytes == window).unwrap() + window.len();
    file[place + 8..][..4].copy_from_slice(&16383_i32.to_le_bytes());
    fs::write(&path, file).unwrap();
    let line = "compare a.exr a.exr";
    let mut limited = program_after("ulimit -v 1000000", &folder, line);
    let said = failed(&limited.output().unwrap(), 1, line);
    let expected =
        "firsthit: a.exr: not enough memory for 16384 × 10000 pixels: give a smaller picture\n";
    assert_eq!(said, expected);
}

#[test]
fn a_driver_that_could_not_have_its_memory_is_not_asked() {
    let folder = folder();
    for kib in [200_000, 400_000, 700_000, 1_000_000] {
        let limit = format!("ulimit -v {kib}");
        for through in backends() {
            let line = format!("capture --stage 6 --size 50 --through {through} -o a.png");
            let output = program_after(&limit, &folder, &line).output().unwrap();
            let message = failed(&output, 1, &line);
            assert!(message.contains("`ulimit -v`"), "{message}");
        }
        let line = "capture --stage 6 --size 50 -o a.png";
        let output = program_after(&limit, &folder, line).output().unwrap();
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{message}");
        assert!(message.contains("captured through none"), "{message}");
        // What was measured is shown, and the drivers are rows that say what they lack.
        let line = "report --size 8 --frames 0..0 --kernel double --threads 1";
        let output = program_after(&limit, &folder, line).output().unwrap();
        let table = succeeded(&output, line);
        assert!(table.contains("errors against reference"), "{table}");
        assert!(table.contains("`ulimit -v`"), "{table}");
    }
}

/// A user's threads are limited for all but the administrator.
#[test]
fn a_driver_that_could_not_have_its_threads_is_not_asked() {
    use std::os::unix::fs::PermissionsExt as _;
    // Where anybody may run it. Another process copies it: as long as a child that another test
    // starts has the file open for writing, too, it could not be run.
    let folder = folder();
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
    let copy = folder.path().join("firsthit");
    let copied = Command::new("cp").arg(PROGRAM).arg(&copy).status();
    assert!(copied.unwrap().success());
    let is_root = rustix::process::geteuid().is_root();
    for limit in 1..=5 {
        let run = |line: &str| {
            let mut command = Command::new("prlimit");
            command.arg(format!("--nproc={limit}"));
            if is_root {
                // As somebody who has no other processes.
                command.args([
                    "setpriv",
                    "--reuid=65534",
                    "--regid=65534",
                    "--clear-groups",
                ]);
            }
            command.arg(&copy).args(words(line)).current_dir("/");
            command.output().unwrap()
        };
        for through in backends() {
            // It is not written, so that it need not be a place where that somebody may.
            let line =
                format!("capture --stage 6 --size 50 --threads 1 --through {through} -o a.png");
            let start = Instant::now();
            let message = failed(&run(&line), 1, &line);
            assert!(message.contains("`ulimit -u`"), "{limit}: {message}");
            assert!(start.elapsed() < Duration::from_secs(10), "{limit}");
        }
    }
}

#[test]
fn a_fault_is_one_line_and_the_way_there_if_it_is_asked_for() {
    let folder = folder();
    for (name, backtrace) in [("0", false), ("1", true)] {
        let line = "report --size 2 --frames 0..0 --kernel double --threads 1";
        let mut command = program(&folder, line);
        command.env("RUST_BACKTRACE", name);
        let Some(command) = with_fault(&mut command, "has no clock") else {
            return;
        };
        let output = command.output().unwrap();
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        let version = env!("CARGO_PKG_VERSION");
        let said = format!("firsthit: a fault of version {version} at ");
        assert!(message.starts_with(&said), "{message}");
        let line = message.lines().next().unwrap();
        assert!(line.contains("please report"), "{message}");
        assert_eq!(message.lines().count() > 1, backtrace, "{message}");
    }
}

/// Makes a pipe that nobody writes to.
fn pipe(folder: &TempDir, name: &str) {
    let made = Command::new("mkfifo")
        .arg(folder.path().join(name))
        .status();
    assert!(made.unwrap().success());
}

#[test]
fn a_pipe_that_nobody_writes_to_is_waited_for_aloud() {
    let folder = folder();
    for (name, line) in [
        (
            "scene.toml",
            "capture --stage 6 --size 8 --through none -o a.png --scene scene.toml",
        ),
        ("a.exr", "compare a.exr a.exr"),
    ] {
        pipe(&folder, name);
        let mut child = program(&folder, line)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (said, lines) = mpsc::channel();
        let mut errors = BufReader::new(child.stderr.take().unwrap());
        thread::spawn(move || {
            errors
                .by_ref()
                .lines()
                .map_while(Result::ok)
                .try_for_each(|line| said.send(line))
        });
        let next = || {
            lines
                .recv_timeout(Duration::from_secs(20))
                .unwrap_or_default()
        };
        let said = next();
        assert!(said.contains(&format!("waits for {name}")), "{said}");
        // It still does.
        assert!(child.try_wait().unwrap().is_none());
        let mut pipe = fs::OpenOptions::new()
            .write(true)
            .open(folder.path().join(name))
            .unwrap();
        pipe.write_all(b"background = 1").unwrap();
        drop(pipe);
        let said = next();
        assert!(said.starts_with(&format!("firsthit: {name}: ")), "{said}");
        assert_eq!(child.wait().unwrap().code(), Some(1));
    }
}

#[test]
fn a_full_standard_output_takes_no_file_along() {
    let folder = folder();
    let line = "report --size 2 --frames 0..0 --kernel double --threads 1 --json a.json";
    let full = fs::File::create("/dev/full").unwrap();
    let mut report = without_drivers(&folder, line);
    let output = report.stdout(full).output().unwrap();
    let message = failed(&output, 1, line);
    assert!(
        message.contains("standard output cannot be written"),
        "{message}"
    );
    let text = fs::read(folder.path().join("a.json")).unwrap();
    let json: serde_json::Value = serde_json::from_slice(&text).unwrap();
    assert!(
        json["rows"].as_array().is_some_and(|rows| !rows.is_empty()),
        "{json}"
    );
}

#[test]
fn a_file_that_cannot_be_written_takes_no_table_along() {
    let folder = folder();
    let line = "report --size 2 --frames 0..0 --kernel double --threads 1 --json a.json";
    let output = program_after("ulimit -f 1", &folder, line)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    let table = text(&output.stdout);
    assert!(
        table.contains("errors against reference") && table.contains("read back"),
        "{table}"
    );
}
