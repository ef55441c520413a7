//! Promise: a file appears whole or not at all, and nothing else is left, however the program ends.

use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::sync::LazyLock;
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use tempfile::TempDir;

use crate::helpers::{NO_DRIVERS, Random, failed, program, program_after, succeeded, with_fault};

/// Every kind of output: what writes it, and the names that it gets.
const OUTPUTS: [(&str, &[&str]); 7] = [
    (
        "capture --stage 6 --size 200 --through none -o a.png",
        &["a.png"],
    ),
    (
        "capture --stage 6 --size 200 --through none -o a.exr",
        &["a.exr"],
    ),
    (
        "capture --stage 7 --size 120 --frames 0..3 --through none -o a.apng",
        &["a.apng"],
    ),
    (
        "capture --stage 7 --size 120 --frames 0..3 --through none -o a{}.exr",
        &["a0.exr", "a1.exr", "a2.exr", "a3.exr"],
    ),
    ("compare one.exr other.exr -o a.png", &["a.png"]),
    (
        "report --size 2 --frames 0..0 --kernel double --threads 1 --json a.json",
        &["a.json"],
    ),
    (
        "report --size 2 --frames 0..0 --kernel double --threads 1 --plot a.svg",
        &["a.svg"],
    ),
];

/// What `compare` compares: two files, and what they hold.
static COMPARED: LazyLock<[(&str, Vec<u8>); 2]> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    [("one.exr", 0), ("other.exr", 4)].map(|(name, frame)| {
        let line = format!("capture --stage 6 --size 120 --frame {frame} --through none -o {name}");
        let output = program(&folder, &line).output().unwrap();
        assert_eq!(succeeded(&output, &line), "");
        (name, fs::read(folder.path().join(name)).unwrap())
    })
});

/// A folder with what `compare` compares.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in &*COMPARED {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

/// The files in a folder that were not there before, and what they hold.
fn written(folder: &TempDir) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let mut files: Vec<_> = entries
        .filter(|entry| !COMPARED.iter().any(|(name, _)| entry.file_name() == *name))
        .map(|entry| {
            let name = entry.file_name().into_string().unwrap();
            (name, fs::read(entry.path()).unwrap())
        })
        .collect();
    files.sort();
    files
}

/// Whether a report's numbers, which differ each time, are all there.
fn is_whole(name: &str, bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    match Path::new(name).extension().unwrap().to_str() {
        Some("json") => serde_json::from_slice::<serde_json::Value>(bytes).is_ok(),
        _ => roxmltree::Document::parse(&text).is_ok(),
    }
}

/// The program on its way, after a shell's `setup`.
fn start(folder: &TempDir, line: &str, fault: &str, setup: &str) -> Option<Child> {
    let mut command = program_after(setup, folder, line);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    if !fault.is_empty() {
        with_fault(&mut command, fault)?;
    }
    Some(command.spawn().unwrap())
}

/// Kills the program `times` times while it writes each kind of output. `fault` is one of the
/// system, if any. Without `drivers` the reports are refused those of OpenGL, for want of memory:
/// they load them before they write anything, which takes most of their time.
fn kill(times: u32, signals: &[Signal], fault: &str, drivers: bool) {
    let mut random = Random::new();
    let mut killed = 0;
    for (line, names) in OUTPUTS {
        let folder = folder();
        let setup = match line.split_once(' ') {
            Some(("report", _)) if !drivers => NO_DRIVERS,
            _ => ":",
        };
        let begin = Instant::now();
        let Some(mut whole) = start(&folder, line, fault, setup) else {
            return;
        };
        assert!(whole.wait().unwrap().success(), "{line}");
        let time = begin.elapsed();
        let expected = written(&folder);
        assert!(
            expected
                .iter()
                .map(|(name, _)| &**name)
                .eq(names.iter().copied())
        );
        for number in 0..times {
            for name in names {
                let _ = fs::remove_file(folder.path().join(name));
            }
            let mut child = start(&folder, line, fault, setup).unwrap();
            thread::sleep(time.mul_f64(random.fraction()));
            let signal = signals[number as usize % signals.len()];
            let _ = kill_process(Pid::from_child(&child), signal);
            killed += u32::from(!child.wait().unwrap().success());
            for (name, bytes) in written(&folder) {
                let Some((_, whole)) = expected.iter().find(|(expected, _)| *expected == name)
                else {
                    panic!("{line}, {signal:?}: {name} is left");
                };
                let is_whole =
                    bytes == *whole || line.starts_with("report") && is_whole(&name, &bytes);
                assert!(is_whole, "{line}, {signal:?}: {name} is torn");
            }
        }
    }
    // Else nothing is tried. How many come in time depends on what else the machine does.
    assert!(killed > 0);
}

/// Whether files need no name where these tests write.
fn has_nameless_files() -> bool {
    use std::os::unix::fs::OpenOptionsExt as _;
    let folder = tempfile::tempdir().unwrap();
    let mut options = fs::OpenOptions::new();
    options.write(true);
    options.custom_flags(rustix::fs::OFlags::TMPFILE.bits().cast_signed());
    options.open(folder.path()).is_ok()
}

/// The signals that end the program as long as nobody wants them to be ignored: in the background
/// of a shell that is so of the first.
pub(crate) fn caught() -> Vec<Signal> {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = u64::from_str_radix(mask.unwrap().trim(), 16).unwrap();
    let signals = [Signal::INT, Signal::TERM, Signal::HUP].into_iter();
    signals
        .filter(|signal| ignored >> (signal.as_raw() - 1) & 1 == 0)
        .collect()
}

#[test]
fn a_killed_program_leaves_no_file() {
    if has_nameless_files() {
        kill(4, &[Signal::KILL, Signal::TERM], "", false);
    }
    kill(4, &caught(), "", false);
}

#[test]
fn where_every_file_has_a_name_signals_still_leave_none() {
    kill(4, &caught(), "names", false);
}

#[test]
#[ignore = "takes a minute: .ci/soak runs it"]
fn killed_fifty_times_it_leaves_no_file() {
    assert!(has_nameless_files());
    kill(50, &[Signal::KILL], "", true);
    kill(50, &caught(), "", true);
    kill(50, &caught(), "names", true);
}

/// The memory in use by a process, in KiB.
pub(crate) fn memory(child: &Child) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.split_whitespace().next()?.parse().ok()
}

#[test]
#[ignore = "takes a minute: .ci/soak runs it"]
fn a_hundred_thousand_frames_take_no_more_memory_than_a_thousand() {
    let folder = folder();
    for through in ["none", "egl"] {
        let line =
            format!("capture --stage 7 --size 16 --frames 0..99999 --through {through} -o a.apng");
        let mut child = start(&folder, &line, "", ":").unwrap();
        let mut used = Vec::new();
        while child.try_wait().unwrap().is_none() {
            used.extend(memory(&child));
            thread::sleep(Duration::from_millis(100));
        }
        assert!(child.wait().unwrap().success());
        // What a frame needs comes and goes; the last word may find the program half gone.
        let (first, second) = used[..used.len() - 1].split_at(used.len() / 2);
        let [before, after] = [first, second].map(|half| half.iter().max().unwrap());
        assert!(
            after * 100 <= before * 101,
            "{through}: {before}, then {after} KiB"
        );
    }
}

#[test]
fn a_signal_ends_the_program_as_it_ends_any() {
    use std::os::unix::process::ExitStatusExt as _;
    let folder = folder();
    for signal in caught() {
        let line = "capture --stage 7 --size 500 --frames 0..9999 --through none -o a.apng";
        let mut child = start(&folder, line, "", ":").unwrap();
        thread::sleep(Duration::from_millis(30));
        kill_process(Pid::from_child(&child), signal).unwrap();
        assert_eq!(child.wait().unwrap().signal(), Some(signal.as_raw()));
    }
}

#[test]
fn a_signal_that_is_to_be_ignored_is_ignored() {
    let folder = folder();
    let line = "capture --stage 7 --size 200 --frames 0..199 --through none -o a.apng";
    let mut command = program_after("trap '' HUP", &folder, line);
    let mut child = command.spawn().unwrap();
    thread::sleep(Duration::from_millis(100));
    kill_process(Pid::from_child(&child), Signal::HUP).unwrap();
    assert!(child.wait().unwrap().success());
    assert_eq!(written(&folder).len(), 1);
}

#[test]
fn a_file_that_grows_too_large_is_a_line_and_no_death() {
    for fault in ["", "names"] {
        for (line, names) in OUTPUTS {
            let folder = folder();
            let old = line.starts_with("capture").then_some(names[0]);
            if let Some(name) = old {
                fs::write(folder.path().join(name), "old").unwrap();
            }
            // Files may grow to a block of 512 or 1024 bytes.
            let setup = format!("ulimit -f 1; {NO_DRIVERS}");
            let mut command = program_after(&setup, &folder, line);
            command.stdout(Stdio::null());
            if !fault.is_empty() && with_fault(&mut command, fault).is_none() {
                return;
            }
            let message = failed(&command.output().unwrap(), 1, line);
            let said = format!("{}: cannot be written: File too large", names[0]);
            assert!(message.contains(&said), "{line}: {message}");
            assert!(message.contains("make room"), "{line}: {message}");
            let kept = old.map(|name| (name.to_owned(), b"old".to_vec()));
            assert!(written(&folder).into_iter().eq(kept), "{line}");
        }
    }
}
