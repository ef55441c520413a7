//! Promise: another program makes pictures as a kernel does. What it does wrong is one line, and of
//! what it has started nothing goes on running.

use std::fs;
use std::os::unix::process::ExitStatusExt as _;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use firsthit::program::Program;
use firsthit::{Image, Kernel, Scene, Stage};
use rustix::process::{Pid, kill_process};
use tempfile::TempDir;

use crate::helpers::{
    PROGRAM, compiled, exr_bits, failed, hard_scene, interpreted, names, succeeded, text, trace,
};
use crate::whole_files::{caught, memory};

/// A folder with `p.sh`, which holds `script`.
fn folder(script: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("p.sh"), script).unwrap();
    folder
}

/// A picture of 8 × 8 pixels by the program `command`, to be captured in `folder`, with temporary
/// files in a folder there.
fn capture(folder: &TempDir, command: &str, seconds: &str) -> Command {
    let temporary = folder.path().join("tmp");
    let _ = fs::create_dir(&temporary);
    let mut capture = Command::new(PROGRAM);
    capture
        .current_dir(folder)
        .env("TMPDIR", temporary)
        .args(["capture", "--stage", "6", "--alpha", "0.3", "--size", "8"])
        .args(["--through", "none", "-o", "a.exr"])
        .args(["--program", command, "--program-timeout", seconds]);
    capture
}

/// The processes that were started with the temporary files of `folder`, but for those that have
/// ended.
fn running(folder: &TempDir) -> Vec<String> {
    let mark = format!("TMPDIR={}", folder.path().join("tmp").display());
    let processes = fs::read_dir("/proc").unwrap().flatten();
    let mine = processes.filter(|process| {
        let environment = fs::read(process.path().join("environ")).unwrap_or_default();
        environment
            .split(|byte| *byte == 0)
            .any(|variable| variable == mark.as_bytes())
    });
    mine.map(|process| fs::read_to_string(process.path().join("cmdline")).unwrap_or_default())
        .collect()
}

/// That nothing runs any more, and no temporary file is left.
fn assert_gone(folder: &TempDir, what: &str) {
    // A process that was killed may take its time to end.
    let patience = Instant::now() + Duration::from_secs(5);
    while !running(folder).is_empty() && Instant::now() < patience {
        thread::sleep(Duration::from_millis(10));
    }
    assert_eq!(running(folder), [""; 0], "{what}");
    let left = fs::read_dir(folder.path().join("tmp")).unwrap().count();
    assert_eq!(left, 0, "{what}");
}

/// How many pixels of two pictures differ by more than 1/255 in a sample.
fn wrong_pixels(one: &Image, other: &Image) -> usize {
    let pixels = one
        .samples()
        .chunks(3)
        .zip(other.samples().chunks(3))
        .filter(|(one, other)| {
            let mut pairs = one.iter().zip(*other);
            !pairs.all(|(a, b)| (a - b).abs() <= 1.0 / 255.0)
        });
    pixels.count()
}

/// How many pixels of each picture by the program `command` are not those of `kernel`.
fn compare(command: &str, kernel: Kernel, pictures: &[(&Scene, Stage, f64, u32)]) -> Vec<usize> {
    let no_word = |line: &str| panic!("{line}");
    let mut program = Program::start(command, Duration::from_secs(60), no_word).unwrap();
    let wrong = pictures.iter().map(|&(scene, stage, alpha, size)| {
        let mut image = Image::new(size).unwrap();
        program.ask(scene, stage, alpha, &mut image).unwrap();
        wrong_pixels(&image, &trace(kernel, scene, stage, alpha, size))
    });
    let wrong = wrong.collect();
    program.finish().unwrap();
    wrong
}

/// Every stage at these angles.
fn frames<'a>(scene: &'a Scene, size: u32, angles: &[f64]) -> Vec<(&'a Scene, Stage, f64, u32)> {
    let stages = Stage::ALL.into_iter();
    stages
        .flat_map(|stage| angles.iter().map(move |alpha| (scene, stage, *alpha, size)))
        .collect()
}

#[test]
fn the_homework_in_c_makes_the_pictures_of_listing() {
    let Some(command) = compiled("homework.c") else {
        return;
    };
    let scene = Scene::builtin();
    let pictures = frames(&scene, 160, &[0.0, 0.3, 2.1, -4.2]);
    let wrong = compare(&command, Kernel::Listing, &pictures);
    assert!(wrong.iter().all(|count| *count == 0), "{wrong:?}");
}

#[test]
fn a_correct_tracer_in_c_makes_exact_pictures_but_for_what_doubles_round() {
    let Some(command) = compiled("correct.c") else {
        return;
    };
    let [scene, crowd] = [Scene::builtin(), hard_scene("crowd")];
    let mut pictures = frames(&scene, 160, &[0.0, 0.3, 2.1, -4.2]);
    pictures.extend(frames(&crowd, 64, &[0.9]));
    let wrong = compare(&command, Kernel::Exact, &pictures);
    assert!(wrong.iter().all(|count| *count <= 5), "{wrong:?}");
}

#[test]
fn a_tracer_in_python_makes_exact_pictures_but_for_what_doubles_round() {
    let Some(command) = interpreted("tracer.py") else {
        return;
    };
    let scene = Scene::builtin();
    let wrong = compare(&command, Kernel::Exact, &frames(&scene, 48, &[0.9]));
    assert!(wrong.iter().all(|count| *count <= 5), "{wrong:?}");
}

#[test]
fn its_frames_are_files_and_animations() {
    let folder = tempfile::tempdir().unwrap();
    let Some(command) = compiled("correct.c") else {
        return;
    };
    let capture = |more: &[&str]| {
        let mut capture = Command::new(PROGRAM);
        capture
            .current_dir(&folder)
            .args([
                "capture",
                "--stage",
                "6",
                "--size",
                "40",
                "--through",
                "none",
            ])
            .args(["--frames", "1..3"])
            .args(more);
        assert_eq!(succeeded(&capture.output().unwrap(), &command), "");
    };
    capture(&["-o", "ours{}.exr"]);
    capture(&["-o", "theirs{}.exr", "--program", &command]);
    capture(&["-o", "ours.apng"]);
    capture(&["-o", "theirs.apng", "--program", &command]);
    for frame in 1..=3 {
        let [ours, theirs] = ["ours", "theirs"].map(|name| {
            let path = folder.path().join(format!("{name}{frame}.exr"));
            exr_bits(&path).into_iter().map(f32::from_bits)
        });
        let far = ours
            .zip(theirs)
            .filter(|(a, b)| (a - b).abs() > 1.0 / 255.0);
        assert!(far.count() <= 15, "{frame}");
    }
    let [ours, theirs] = ["ours", "theirs"]
        .map(|name| fs::read(folder.path().join(format!("{name}.apng"))).unwrap());
    assert!(ours == theirs);
}

/// What programs do wrong, in how many seconds, and what is said of it.
const FAULTS: [(&str, &str, &str); 16] = [
    (
        "read line; exit 3",
        "10",
        "ended with status 3 after 0 of 768 bytes: let it answer every line of its input, and leave only when that ends",
    ),
    (
        "read line; echo 'usage: p'; exit 0",
        "10",
        r#"ended with status 0 after 9 of 768 bytes ("usage: p\n"): let it answer every line of its input, and leave only when that ends"#,
    ),
    (
        "read line; head -c 700 /dev/zero; kill -SEGV $$",
        "10",
        "ended by signal 11 (SIGSEGV) after 700 of 768 bytes: let it answer every line of its input, and leave only when that ends",
    ),
    (
        // The pipe is held by a process that goes on running.
        "read line; sleep 1000 & exit 3",
        "10",
        "ended with status 3 after 0 of 768 bytes: let it answer every line of its input, and leave only when that ends",
    ),
    (
        "read line; exec >&-; sleep 1000",
        "10",
        "closed its standard output after 0 of 768 bytes: let it answer every line of its input",
    ),
    (
        "sleep 1000",
        "0.2",
        "wrote 0 of 768 bytes in 0.2 s: let it call fflush(stdout) after every picture, or give it more time by `--program-timeout`",
    ),
    (
        "read line; head -c 700 /dev/zero; sleep 1000",
        "2",
        "wrote 700 of 768 bytes in 2 s: let it call fflush(stdout) after every picture, or give it more time by `--program-timeout`",
    ),
    (
        "read line; while true; do printf 0; sleep 10; done",
        "2",
        r#"wrote 1 of 768 bytes ("0") in 2 s: let it call fflush(stdout) after every picture, or give it more time by `--program-timeout`"#,
    ),
    (
        "read line; echo tracing; head -c 768 /dev/zero; read line",
        "10",
        r#"wrote more to its standard output than the picture's 768 bytes: "tracing\n": let it write N × N × 3 floats of 4 bytes there, and messages to standard error"#,
    ),
    (
        // The last bytes of the picture are no message, though they are a text.
        "read line; echo tracing; yes fff? | tr -d '\\n' | head -c 768; read line",
        "10",
        r#"wrote more to its standard output than the picture's 768 bytes: "tracing\n": let it write N × N × 3 floats of 4 bytes there, and messages to standard error"#,
    ),
    (
        "read line; printf 50%%; head -c 768 /dev/zero; read line",
        "10",
        r#"wrote more to its standard output than the picture's 768 bytes: "50%": let it write N × N × 3 floats of 4 bytes there, and messages to standard error"#,
    ),
    (
        "read line; head -c 768 /dev/zero; echo done; read line",
        "10",
        r#"wrote more to its standard output than the picture's 768 bytes: "done\n": let it write N × N × 3 floats of 4 bytes there, and messages to standard error"#,
    ),
    (
        // At its end.
        "read line; head -c 768 /dev/zero; read line; printf bye",
        "10",
        r#"wrote more to its standard output than the picture's 768 bytes: "bye": let it write N × N × 3 floats of 4 bytes there, and messages to standard error"#,
    ),
    (
        // Before it is asked, or while it is.
        "echo hello; sleep 1; read line; head -c 768 /dev/zero; read line",
        "10",
        r#"wrote more to its standard output than the picture's 768 bytes: "hello\n": let it write N × N × 3 floats of 4 bytes there, and messages to standard error"#,
    ),
    (
        r"read line; head -c 768 /dev/zero; printf '\377\001\002'; read line",
        "10",
        r#"wrote more to its standard output than the picture's 768 bytes: "\xff\x01\x02": let it write N × N × 3 floats of 4 bytes there, and messages to standard error"#,
    ),
    (
        "read line; head -c 1000000000 /dev/zero | tr '\\000' x; read line",
        "10",
        r#"wrote more to its standard output than the picture's 768 bytes: "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx": let it write N × N × 3 floats of 4 bytes there, and messages to standard error"#,
    ),
];

#[test]
fn what_it_does_wrong_is_one_line_and_ends_it() {
    for (script, seconds, said) in FAULTS {
        let folder = folder(script);
        let begin = Instant::now();
        let output = capture(&folder, "sh p.sh", seconds).output().unwrap();
        let line = failed(&output, 1, script);
        let expected = format!("firsthit: sh p.sh: stage 6, α = 0.3, 8 × 8: {said}\n");
        assert_eq!(line, expected, "{script}");
        assert!(begin.elapsed() < Duration::from_secs(9), "{script}");
        assert_gone(&folder, script);
        assert_eq!(names(&folder), ["p.sh", "tmp"], "{script}");
    }
}

#[test]
fn what_cannot_be_started_is_one_line() {
    let folder = folder("");
    let advice = "let TMPDIR name a folder that can be written to";
    for (command, said) in [
        (
            "./nothing -x",
            "nothing -x: cannot be started: No such file or directory (os error 2): give its path, as in ./homework, or its name in PATH",
        ),
        (
            "./p.sh",
            "p.sh: cannot be started: Permission denied (os error 13): allow it to be run, as by chmod +x",
        ),
        (
            "sh 'p.sh",
            "sh 'p.sh: a quote or a backslash is left open: close it",
        ),
        (
            " ",
            "the command of a program is empty: give its path, or its name in PATH",
        ),
    ] {
        let output = capture(&folder, command, "10").output().unwrap();
        assert_eq!(failed(&output, 1, command), format!("firsthit: {said}\n"));
        assert_gone(&folder, command);
    }
    let mut command = capture(&folder, "sh p.sh", "10");
    let missing = folder.path().join("missing");
    let output = command.env("TMPDIR", &missing).output().unwrap();
    let line = failed(&output, 1, "TMPDIR");
    let start = format!(
        "firsthit: sh p.sh: no scene can be written for it in {}: ",
        missing.display()
    );
    assert!(
        line.starts_with(&start) && line.ends_with(&format!(": {advice}\n")),
        "{line}"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_program_that_is_still_being_written_is_waited_for() {
    let folder = folder("");
    let path = folder.path().join("linked");
    fs::copy("/bin/cat", &path).unwrap();
    let linker = fs::File::options().append(true).open(&path).unwrap();
    let output = capture(&folder, "./linked", "10").output().unwrap();
    let line = failed(&output, 1, "for ever");
    let end = ": let whatever writes it finish, and start it then\n";
    assert!(line.ends_with(end), "{line}");
    let command = path.display().to_string();
    thread::spawn(move || {
        thread::sleep(Duration::from_millis(300));
        drop(linker);
    });
    Program::start(&command, Duration::from_secs(10), |_| {}).unwrap();
}

#[test]
fn a_picture_may_come_in_single_bytes_and_from_a_command_in_quotes() {
    let folder = folder("");
    let script = "while read line; do dd if=/dev/zero bs=1 count=768 2>/dev/null; done";
    fs::write(folder.path().join("a script"), script).unwrap();
    let output = capture(&folder, "sh 'a script'", "10").output().unwrap();
    assert_eq!(succeeded(&output, script), "");
    assert_eq!(exr_bits(&folder.path().join("a.exr")), [0; 192]);
    assert_gone(&folder, script);
}

#[test]
fn a_program_that_does_not_leave_is_ended() {
    for script in [
        "read line; head -c 768 /dev/zero; sleep 1000",
        "read line; head -c 768 /dev/zero; read line; sleep 1000 & exit",
        "trap '' TERM INT HUP; read line; head -c 768 /dev/zero; sleep 1000",
    ] {
        let folder = folder(script);
        let begin = Instant::now();
        let output = capture(&folder, "sh p.sh", "10").output().unwrap();
        assert_eq!(succeeded(&output, script), "", "{script}");
        assert!(begin.elapsed() < Duration::from_secs(5), "{script}");
        assert_gone(&folder, script);
    }
}

#[test]
fn a_signal_leaves_nothing_running() {
    let script = "trap '' TERM INT HUP; read line; sleep 1000 & sleep 1000";
    for signal in caught() {
        let folder = folder(script);
        let mut command = capture(&folder, "sh p.sh", "1000");
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        let patience = Instant::now() + Duration::from_secs(20);
        // This program, the shell and what that has started.
        while running(&folder).len() < 4 && Instant::now() < patience {
            thread::sleep(Duration::from_millis(10));
        }
        assert_eq!(running(&folder).len(), 4);
        kill_process(Pid::from_child(&child), signal).unwrap();
        let status = child.wait().unwrap();
        assert_eq!(status.signal(), Some(signal.as_raw()));
        assert_gone(&folder, "a signal");
        let said = std::io::read_to_string(child.stderr.take().unwrap()).unwrap();
        assert_eq!(said, "");
    }
}

#[test]
fn samples_that_are_no_numbers_are_kept_and_counted() {
    let folder = folder(
        r"while read line; do printf '\377\377\377\377\000\000\200\177\000\000\200\377'; head -c 756 /dev/zero; done",
    );
    let output = capture(&folder, "sh p.sh", "10").output().unwrap();
    assert_eq!(
        text(&output.stderr),
        "firsthit: sh p.sh: samples that are no numbers: 1 NaN, 2 infinite: an EXR file keeps them, a PNG shows NaN as 0\n"
    );
    assert!(output.status.success());
    let bits = exr_bits(&folder.path().join("a.exr"));
    assert_eq!(bits[..4], [0xffff_ffff, 0x7f80_0000, 0xff80_0000, 0]);
}

#[test]
fn its_standard_error_passes_line_by_line() {
    let folder = folder(
        r"while read line; do printf 'one\ntwo \033[1m\n\n' >&2; head -c 768 /dev/zero; done; head -c 5000 /dev/zero | tr '\000' x >&2",
    );
    let output = capture(&folder, "sh p.sh", "10").output().unwrap();
    let [long, rest] = [4096, 904].map(|length| "x".repeat(length));
    let lines = ["one", r"two \u{1b}[1m", "", &long, &rest];
    let lines = lines.map(|line| format!("firsthit: sh p.sh: {line}\n"));
    assert_eq!(text(&output.stderr), lines.concat());
    assert!(output.status.success());
}

#[test]
fn what_is_not_to_be_kept_takes_no_memory() {
    for script in [
        // More than twice what the program may have.
        "read line; head -c 150000000 /dev/zero",
        // In memory that grows by doubling it would take 32 MiB. The program itself takes 28.
        "read line; head -c 20000000 /dev/zero | tr '\\000' x >&2; exit 3",
    ] {
        let folder = folder(script);
        let mut capture = capture(&folder, "sh p.sh", "60");
        capture.args(["--threads", "1"]);
        let mut limited = Command::new("sh");
        limited
            .current_dir(&folder)
            .args(["-c", r#"ulimit -v 60000; exec "$0" "$@""#])
            .arg(capture.get_program())
            .args(capture.get_args());
        let output = limited.stderr(Stdio::piped()).output().unwrap();
        let said = text(&output.stderr);
        let line = said.lines().last().unwrap();
        assert!(line.contains("stage 6, α = 0.3, 8 × 8: "), "{line}");
        assert_eq!(output.status.code(), Some(1), "{script}");
    }
}

/// A library's program, by a script in `folder`.
fn start(folder: &TempDir) -> Program {
    let command = format!("sh '{}'", folder.path().join("p.sh").display());
    Program::start(&command, Duration::from_secs(20), |_| {}).unwrap()
}

#[test]
fn nobody_reads_what_nobody_asks_for() {
    let folder = folder(r#"head -c 100000000 /dev/zero; touch "$0.written""#);
    let mut program = start(&folder);
    // Long enough for a hundred times as much.
    thread::sleep(Duration::from_secs(1));
    assert_eq!(names(&folder), ["p.sh"]);
    let mut image = Image::new(8).unwrap();
    let asked = program.ask(&Scene::builtin(), Stage::Image, 0.0, &mut image);
    assert!(asked.is_err());
}

#[test]
fn it_is_asked_in_lines_of_json() {
    let script = r#"while read -r line; do echo "$line" >> "$0.lines"; head -c 12 /dev/zero; done; echo end >> "$0.lines""#;
    let folder = folder(script);
    let mut program = start(&folder);
    let mut image = Image::new(1).unwrap();
    let [builtin, crowd] = [Scene::builtin(), hard_scene("crowd")];
    let mut files = Vec::new();
    let asked = [
        (&builtin, Stage::Image, 0.0),
        (&builtin, Stage::Animation, 0.1 + 0.2),
        (&crowd, Stage::Spheres, -1e300),
        (&builtin, Stage::Spheres, 5e-324),
    ];
    let lines = || fs::read_to_string(folder.path().join("p.sh.lines")).unwrap();
    for (scene, stage, alpha) in asked {
        program.ask(scene, stage, alpha, &mut image).unwrap();
        let line = lines().lines().last().unwrap().to_owned();
        let request: serde_json::Value = serde_json::from_str(&line).unwrap();
        let path = request["scene"].as_str().unwrap().to_owned();
        assert_eq!(Scene::from_file(&path).unwrap(), *scene);
        let number = stage.number();
        let expected =
            format!(r#"{{"scene": "{path}", "stage": {number}, "alpha": {alpha:?}, "size": 1}}"#);
        assert_eq!(line, expected);
        assert_eq!(request["alpha"].as_f64(), Some(alpha));
        files.push(path);
    }
    assert!(lines().contains(r#""alpha": 0.30000000000000004,"#));
    // A scene keeps its file, and another has another.
    assert_eq!(files[0], files[1]);
    assert!(files[1] != files[2] && files[2] != files[3] && files[3] != files[0]);
    assert!(
        program
            .ask(&builtin, Stage::Image, f64::NAN, &mut image)
            .is_err()
    );
    program.finish().unwrap();
    assert_eq!(lines().lines().count(), 5);
    assert!(lines().ends_with("end\n"));
    program
        .ask(&builtin, Stage::Image, 0.0, &mut image)
        .unwrap();
    drop(program);
    assert!(lines().ends_with("end\n"));
    assert!(
        files
            .iter()
            .all(|path| !std::path::Path::new(path).exists())
    );
}

#[test]
fn after_a_fault_it_is_started_anew() {
    let script = r#"[ -e "$0.once" ] || { touch "$0.once"; exit 3; }; while read line; do head -c 12 /dev/zero; done"#;
    let folder = folder(script);
    let mut program = start(&folder);
    let mut image = Image::new(1).unwrap();
    let mut ask = || program.ask(&Scene::builtin(), Stage::Image, 0.0, &mut image);
    let error = ask().unwrap_err().to_string();
    assert!(error.contains("ended with status 3"), "{error}");
    ask().unwrap();
    program.finish().unwrap();
}

#[test]
fn what_comes_after_a_picture_is_told_of_that_picture() {
    let script = r#"while read line; do head -c 12 /dev/zero; sleep 0.1; printf hello; done"#;
    let folder = folder(script);
    let mut program = start(&folder);
    let mut image = Image::new(1).unwrap();
    let scene = Scene::builtin();
    program
        .ask(&scene, Stage::Reflection, 0.5, &mut image)
        .unwrap();
    // Ten times as long as it takes.
    thread::sleep(Duration::from_secs(1));
    let mut larger = Image::new(2).unwrap();
    let error = program.ask(&scene, Stage::Shadow, 0.0, &mut larger);
    let error = error.unwrap_err().to_string();
    let start = "sh p.sh: stage 6, α = 0.5, 1 × 1: wrote more to its standard output than the picture's 12 bytes: \"hello\"";
    assert!(error.starts_with(start), "{error}");
    // Before another one is asked for, if it is looked for.
    program
        .ask(&scene, Stage::Reflection, 0.5, &mut image)
        .unwrap();
    thread::sleep(Duration::from_secs(1));
    let error = program.recheck().unwrap_err().to_string();
    assert!(error.starts_with(start), "{error}");
    // It is told once, and the next picture is that of a new process.
    program.recheck().unwrap();
    program.ask(&scene, Stage::Shadow, 0.0, &mut image).unwrap();
}

#[test]
fn many_pictures_take_no_more_memory_than_some() {
    // 48 KiB each: 12 MiB more in the second half if none were given back. The shell writes them
    // itself: to start a process for each takes longer than all else here.
    let folder =
        folder("picture=$(printf %049152d 0); while read line; do printf %s $picture; done");
    let mut command = Command::new(PROGRAM);
    command
        .current_dir(&folder)
        .args([
            "capture",
            "--stage",
            "7",
            "--size",
            "64",
            "--through",
            "none",
        ])
        .args(["--frames", "0..499", "-o", "a.apng", "--program", "sh p.sh"]);
    let mut child = command.spawn().unwrap();
    let mut used = Vec::new();
    while child.try_wait().unwrap().is_none() {
        used.extend(memory(&child));
        thread::sleep(Duration::from_millis(20));
    }
    assert!(child.wait().unwrap().success());
    let (first, second) = used.split_at(used.len() / 2);
    let [before, after] = [first, second].map(|half| half.iter().max().unwrap());
    assert!(*after <= before + 2048, "{before}, then {after} KiB");
}

#[test]
#[ignore = "takes 3 GB of memory, and a minute: .ci/soak runs it"]
fn the_largest_picture_takes_its_memory_once() {
    let folder = folder("while read line; do head -c 3221225472 /dev/zero; done");
    let mut command = Command::new(PROGRAM);
    command
        .current_dir(&folder)
        .args([
            "capture",
            "--stage",
            "6",
            "--size",
            "16384",
            "--through",
            "none",
        ])
        .args([
            "-o",
            "a.png",
            "--program",
            "sh p.sh",
            "--program-timeout",
            "60",
        ]);
    let mut child = command.spawn().unwrap();
    let mut most = 0;
    while child.try_wait().unwrap().is_none() {
        most = most.max(memory(&child).unwrap_or(0));
        thread::sleep(Duration::from_millis(100));
    }
    assert!(child.wait().unwrap().success());
    assert!(most >> 10 < 3100, "{most} KiB");
}

#[test]
fn the_readmes_smallest_program_works() {
    let readme = include_str!("../README.md");
    let (_, rest) = readme.split_once("```c\n").unwrap();
    let (source, _) = rest.split_once("```").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("smallest.c");
    std::fs::write(&path, source).unwrap();
    let Some(command) = compiled(path.to_str().unwrap()) else {
        return;
    };
    let mut program = Program::start(&command, Duration::from_secs(10), |_| ()).unwrap();
    let mut image = Image::new(30).unwrap();
    for (stage, alpha) in [(Stage::Shading, -0.3), (Stage::Animation, 1e-300)] {
        image.samples_mut().fill(0.0);
        program
            .ask(&Scene::builtin(), stage, alpha, &mut image)
            .unwrap();
        assert!(image.samples().iter().all(|&sample| sample == 0.8));
    }
    program.finish().unwrap();
}
