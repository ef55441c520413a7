//! What is typed on the command line, and what then appears: files, lines, exit statuses.

#[cfg(unix)]
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{BufReader, Write as _};
use std::path::Path;
use std::process::{Command, Output, Stdio};

use exr::prelude::Compression;
use firsthit::camera::frame_angle;
use firsthit::image::{decode_srgb, display_byte};
use firsthit::screen::{Backend, Offscreen};
use firsthit::{Image, Kernel, Scene, Stage, Tracer, scene};
use tempfile::TempDir;

use crate::helpers::{
    self, bits, exr_bits, names, open, printed, program, program_after, succeeded, text, trace,
    without_drivers,
};

/// Runs the program in `folder` with the words of `line`; it must succeed and say nothing.
fn done(folder: &TempDir, line: &str) {
    assert_eq!(printed(folder, line), "", "{line}");
}

/// What it said on standard error; it must have failed in one line, with nothing on standard
/// output.
fn failed(output: &Output, what: &str) -> String {
    assert_eq!(text(&output.stdout), "", "{what}");
    helpers::failed(output, 1, what)
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn bytes(folder: &TempDir, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).unwrap()
}

/// What the library itself traces.
fn traced(stage: u8, alpha: f64, size: u32) -> Image {
    let stage = Stage::from_number(stage).unwrap();
    trace(Kernel::default(), &Scene::builtin(), stage, alpha, size)
}

/// The bytes of an 8-bit file of `image`: rows from the top.
fn displayed(image: &Image) -> Vec<u8> {
    let (size, mut bytes) = (image.size(), Vec::new());
    for row in (0..size).rev() {
        for column in 0..size {
            bytes.extend(image.pixel(column, row).unwrap().map(display_byte));
        }
    }
    bytes
}

fn png_reader(path: &Path) -> png::Reader<BufReader<File>> {
    let decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
    let reader = decoder.read_info().unwrap();
    let kind = (reader.info().color_type, reader.info().bit_depth);
    assert_eq!(kind, (png::ColorType::Rgb, png::BitDepth::Eight));
    reader
}

fn next_frame(reader: &mut png::Reader<BufReader<File>>) -> Vec<u8> {
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    bytes
}

#[test]
fn a_png_holds_what_the_display_shows() {
    let folder = folder();
    done(
        &folder,
        "capture --stage 6 --frame 4 --size 33 --threads 1 --through none -o a.PNG",
    );
    let mut reader = png_reader(&folder.path().join("a.PNG"));
    assert_eq!(reader.info().size(), (33, 33));
    assert!(!reader.info().is_animated());
    assert_eq!(
        next_frame(&mut reader),
        displayed(&traced(6, frame_angle(4), 33))
    );
    assert_eq!(names(&folder), ["a.PNG"]);
}

#[test]
fn an_exr_holds_every_sample() {
    let folder = folder();
    done(
        &folder,
        "capture --stage 5 --frame 13 --size 37 --threads 2 --through none -o a.exr",
    );
    let path = folder.path().join("a.exr");
    assert_eq!(exr_bits(&path), bits(&traced(5, frame_angle(13), 37)));
    let meta = exr::meta::MetaData::read_from_file(&path, true).unwrap();
    assert_eq!(meta.headers.len(), 1);
    assert!(!meta.headers[0].blocks.has_tiles());
    assert!(!matches!(
        meta.headers[0].compression,
        Compression::Uncompressed
    ));
    assert_eq!(names(&folder), ["a.exr"]);
}

#[test]
fn a_linear_exr_holds_what_srgb_stands_for() {
    let folder = folder();
    let line = "capture --stage 6 --size 37 --through none --linear";
    done(&folder, &format!("{line} --frames 3..4 -o {{}}.exr"));
    done(&folder, &format!("{line} --frame 3 -o a.exr"));
    for (name, frame) in [("3.exr", 3), ("4.exr", 4), ("a.exr", 3)] {
        let samples = traced(6, frame_angle(frame), 37);
        let decoded = samples.samples().iter().copied().map(decode_srgb);
        let expected: Vec<u32> = decoded.map(f32::to_bits).collect();
        assert_eq!(exr_bits(&folder.path().join(name)), expected, "{name}");
    }
    assert!(printed(&folder, "capture --help").contains("--linear"));
}

#[test]
fn an_apng_plays_its_frames_without_end() {
    let folder = folder();
    done(
        &folder,
        "capture --stage 7 --frames 19..22 --size 21 --threads 8 --through none -o a.apng",
    );
    let mut reader = png_reader(&folder.path().join("a.apng"));
    let animation = reader.info().animation_control.unwrap();
    assert_eq!((animation.num_frames, animation.num_plays), (4, 0));
    for frame in 19..=22 {
        assert_eq!(
            next_frame(&mut reader),
            displayed(&traced(7, frame_angle(frame), 21)),
            "frame {frame}"
        );
        let control = reader.info().frame_control.unwrap();
        let delay = u32::from(control.delay_num) * 1000 / u32::from(control.delay_den);
        assert_eq!(delay, 200);
        assert_eq!((control.width, control.height), (21, 21));
    }
    assert_eq!(names(&folder), ["a.apng"]);
}

#[test]
fn an_apng_plays_as_many_frames_a_second_as_asked_for() {
    let folder = folder();
    for fps in [1, 24, 65535] {
        let line = format!("--stage 2 --frames 0..1 --size 5 --through none --fps {fps}");
        done(&folder, &format!("capture {line} -o a.apng"));
        let mut reader = png_reader(&folder.path().join("a.apng"));
        for _ in 0..2 {
            next_frame(&mut reader);
            let control = reader.info().frame_control.unwrap();
            assert_eq!((control.delay_num, control.delay_den), (1, fps));
        }
        let line = format!("capture {line} -o - --format apng");
        let output = program(&folder, &line).output().unwrap();
        assert!(output.stdout == bytes(&folder, "a.apng"), "{fps}");
    }
}

#[test]
fn each_frame_is_named_with_as_many_digits_as_the_last() {
    let folder = folder();
    let line = "capture --stage 6 --size 9 --through none --frames";
    done(&folder, &format!("{line} 8..11 -o {{}}-f{{}}.exr"));
    assert_eq!(
        names(&folder),
        ["08-f08.exr", "09-f09.exr", "10-f10.exr", "11-f11.exr"]
    );
    for frame in 8..=11 {
        let path = folder.path().join(format!("{frame:02}-f{frame:02}.exr"));
        assert_eq!(exr_bits(&path), bits(&traced(6, frame_angle(frame), 9)));
    }

    let folder = self::folder();
    let (first, last) = (u64::MAX - 1, u64::MAX);
    done(&folder, &format!("{line} {first}..{last} -o {{}}.png"));
    assert_eq!(names(&folder), [first, last].map(|k| format!("{k}.png")));
    let mut reader = png_reader(&folder.path().join(format!("{last}.png")));
    // 2⁶⁴ − 1 is 15 more than a multiple of 21.
    assert_eq!(
        next_frame(&mut reader),
        displayed(&traced(6, frame_angle(15), 9))
    );
}

#[test]
fn no_threads_are_one_a_core() {
    let folder = folder();
    let options = "--stage 6 --size 8 --threads 0";
    done(
        &folder,
        &format!("capture {options} --through none -o a.exr"),
    );
    assert_eq!(
        exr_bits(&folder.path().join("a.exr")),
        bits(&traced(6, 0.0, 8))
    );
    let line = "report --size 2 --frames 0..0 --kernel double";
    let titles = |line: &str| {
        let output = without_drivers(&folder, line).output().unwrap();
        let table = succeeded(&output, line);
        let mut lines = table.lines().map(str::split_whitespace);
        let titles = lines.find(|words| words.clone().take(3).eq(["│", "1", "thread"]));
        titles.map(|words| words.collect::<String>())
    };
    let given = titles(&format!("{line} --threads 0"));
    assert!(given.is_some());
    assert_eq!(given, titles(line));
}

#[test]
fn alpha_is_any_finite_number() {
    let folder = folder();
    let line = "capture --stage 4 --size 8 --through none -o a.exr";
    for (option, alpha) in [
        ("", 0.0),
        (" --alpha 0", 0.0),
        (" --alpha 0.3", 0.3),
        (" --alpha -1.5", -1.5),
        (" --alpha=-.5", -0.5),
        (" --alpha 1e300", 1e300),
        (" --alpha -1e-5", -1e-5),
        (" --alpha 5e-324", 5e-324),
        (" --frame 0", 0.0),
        (" --frame 20", 6.0),
        (" --frame 21", 0.0),
        // 15 more than a multiple of 21.
        (" --frame 18446744073709551615", 4.5),
    ] {
        done(&folder, &format!("{line}{option}"));
        assert_eq!(
            exr_bits(&folder.path().join("a.exr")),
            bits(&traced(4, alpha, 8)),
            "{option}"
        );
    }
}

#[test]
fn wrong_usage_is_status_2_and_writes_nothing() {
    let folder = folder();
    for line in [
        "capture --stage 6",
        "capture -o a.png",
        "capture --stage 0 -o a.png",
        "capture --stage 8 -o a.png",
        "capture --stage six -o a.png",
        "capture --stage 6 --size 0 -o a.png",
        "capture --stage 6 --size 16385 -o a.png",
        "capture --stage 6 --size 1.5 -o a.png",
        "capture --stage 6 --threads -1 -o a.png",
        "capture --stage 6 --kernel none -o a.png",
        "capture --stage 6 --through glx -o a.png",
        "capture --stage 6 --program cat --kernel exact -o a.png",
        "capture --stage 6 --program cat --program-timeout 0 -o a.png",
        "capture --stage 6 --program cat --program-timeout -1 -o a.png",
        "capture --stage 6 --program cat --program-timeout inf -o a.png",
        "capture --stage 6 --program cat --program-timeout 1e99 -o a.png",
        "capture --stage 6 --program cat --program-timeout x -o a.png",
        "capture --stage 6 --program-timeout 1 -o a.png",
        "capture --stage 6 --alpha inf -o a.png",
        "capture --stage 6 --alpha NaN -o a.png",
        "capture --stage 6 --alpha 1e999 -o a.png",
        "capture --stage 6 --alpha x -o a.png",
        "capture --stage 6 --alpha -o a.png",
        "capture --stage 6 --frame -1 -o a.png",
        "capture --stage 6 --frame 18446744073709551616 -o a.png",
        "capture --stage 6 --alpha 1 --frame 1 -o a.png",
        "capture --stage 6 --alpha 1 --frames 1..2 -o a{}.png",
        "capture --stage 6 --frame 1 --frames 1..2 -o a{}.png",
        "capture --stage 6 --frames 2..1 -o a{}.png",
        "capture --stage 6 --frames 2 -o a{}.png",
        "capture --stage 6 --frames 0.. -o a{}.png",
        "capture --stage 6 --frames -1..2 -o a{}.png",
        "capture --stage 6 --frames 1..2 -o a.png",
        "capture --stage 6 --frames 1..2 -o a.exr",
        "capture --stage 6 --frames 1..2 -o a{}.apng",
        "capture --stage 6 --frames 0..1073741824 -o missing/a.apng",
        "capture --stage 6 --frame 1 -o a.apng",
        "capture --stage 6 --frame 1 -o a{}.png",
        "capture --stage 6 -o a.jpeg",
        "capture --stage 6 -o png",
        "capture --stage 6 -o .png",
        "capture --stage 6 -o ",
        "capture --stage 6 --linear -o a.png",
        "capture --stage 6 --linear --frames 0..1 -o a.apng",
        "capture --stage 6 --linear -o - --format rgb24",
        "capture --stage 6 --fps 5 -o a.png",
        "capture --stage 6 --fps 5 --frames 0..1 -o a{}.png",
        "capture --stage 6 --fps 5 --frames 0..1 -o - --format rgb24",
        "capture --stage 6 --fps 0 --frames 0..1 -o a.apng",
        "capture --stage 6 --fps 65536 --frames 0..1 -o a.apng",
        "capture --stage 6 -o -",
        "capture --stage 6 -o - --format jpeg",
        "capture --stage 6 -o - --format apng",
        "capture --stage 6 -o - --format png --frames 0..1",
        "capture --stage 6 -o - --format exr --frames 0..1",
        "capture --stage 6 -o - --format apng --frames 0..1073741824",
        "capture --stage 6 -o a.png --format png",
        // Told before the scene is looked for.
        "capture --stage 6 --scene missing.toml -o a.jpeg",
        "view --speed 1 --step 1",
        "view --speed inf",
        "view --stage 8",
        "view --exit-after-frames 0",
        "--stage 8",
        "--stage 3 scene",
        "scene 1",
        "draw",
    ] {
        let output = program(&folder, line).output().unwrap();
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        assert!(message.starts_with("error: "), "{line}: {message}");
        assert_eq!(text(&output.stdout), "", "{line}");
        assert_eq!(names(&folder), [""; 0], "{line}");
    }
}

#[test]
fn wrong_usage_shows_no_control_character() {
    let folder = folder();
    for (line, word, said) in [
        (
            "capture -o a.png --stage",
            "6\x1b[2J\r\n",
            "6\\u{1b}[2J\\r\\n",
        ),
        ("", "dr\naw", "dr\\naw"),
        ("capture --stage 6 -o", "a\t.jpeg", "a\\t.jpeg"),
        ("compare a.png b.png -o", "\x07.exr", "\\u{7}.exr"),
        ("report --json a --plot", "a\n", "a\\n"),
    ] {
        let output = program(&folder, line).arg(word).output().unwrap();
        let message = helpers::failed(&output, 2, line);
        assert!(message.contains(said), "{message}");
        let is_control = |c: char| c.is_control() && c != '\n';
        assert!(!message.contains(is_control), "{message:?}");
        assert!(!message.contains(word), "{message:?}");
    }
}

#[test]
fn a_scene_that_cannot_be_had_is_status_1_and_writes_nothing() {
    let folder = folder();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    fs::create_dir(folder.path().join("folder.toml")).unwrap();
    write("latin.toml", b"# first\n# caf\xe9\n");
    write("unknown.toml", b"background = [0.8, 0.8, 0.8]\nfog = 1\n");
    let before = names(&folder);
    for (scene, said) in [
        ("missing.toml", "missing.toml: cannot be read: "),
        ("folder.toml", "folder.toml: cannot be read: "),
        (
            "latin.toml",
            "latin.toml: cannot be read: line 2 is not UTF-8",
        ),
        ("unknown.toml", "unknown.toml: line 2: fog: "),
    ] {
        for line in ["view --scene", "capture --stage 6 -o a.png --scene"] {
            let output = program(&folder, line).arg(scene).output().unwrap();
            let message = failed(&output, scene);
            assert!(message.contains(said), "{message}");
            assert_eq!(names(&folder), before, "{line} {scene}");
        }
    }
}

#[test]
fn a_scene_file_is_what_is_traced() {
    let folder = folder();
    let text = "[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = 0.5\ncolor = [1.0, 0.0, 0.0]\n";
    fs::write(folder.path().join("ball.toml"), text).unwrap();
    done(
        &folder,
        "capture --stage 2 --size 16 --scene ball.toml --through none -o a.exr",
    );
    let scene = Scene::from_toml(text).unwrap();
    let image = trace(Kernel::default(), &scene, Stage::Spheres, 0.0, 16);
    assert_eq!(exr_bits(&folder.path().join("a.exr")), bits(&image));
}

#[test]
fn a_scene_may_come_from_standard_input() {
    let folder = folder();
    // No file of that name is read, and none is watched.
    fs::write(folder.path().join("-"), "fog = 1").unwrap();
    let run = |line: &str, scene: &str| {
        let mut command = without_drivers(&folder, line);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        // Who refuses its arguments reads no scene.
        let _ = child.stdin.take().unwrap().write_all(scene.as_bytes());
        child.wait_with_output().unwrap()
    };
    let ball = "[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = 0.5\ncolor = [1.0, 0.0, 0.0]\n";
    let scene = Scene::from_toml(ball).unwrap();
    let line = "capture --stage 2 --size 16 --scene - --through none -o a.exr";
    assert_eq!(succeeded(&run(line, ball), line), "");
    let image = trace(Kernel::default(), &scene, Stage::Spheres, 0.0, 16);
    assert_eq!(exr_bits(&folder.path().join("a.exr")), bits(&image));

    let tracer = Tracer::new(Kernel::default(), 1).unwrap();
    let text = tracer.explain(&scene, Stage::Spheres, 0.0, 16, (8, 8));
    let line = "explain 8 8 --stage 2 --size 16 --scene -";
    assert_eq!(succeeded(&run(line, ball), line), text.unwrap());

    let line = "report --size 2 --frames 0..0 --kernel double --scene -";
    let table = succeeded(&run(line, ball), line);
    assert!(table.contains("\nstandard input  6 "), "{table}");
    let line = "report --scene - --scene -";
    let message = helpers::failed(&run(line, ball), 2, line);
    assert!(message.contains("can be read once"), "{message}");

    for line in ["view --scene -", "capture --stage 6 -o b.png --scene -"] {
        for (scene, said) in [
            ("\nfog = 1", "firsthit: standard input: line 2: fog: "),
            (
                "background = 1",
                "firsthit: standard input: line 1: background: ",
            ),
        ] {
            let message = failed(&run(line, scene), line);
            assert!(message.starts_with(said), "{message}");
        }
    }
    assert_eq!(names(&folder), ["-", "a.exr"]);
}

#[test]
fn an_output_that_cannot_be_written_is_status_1_and_one_line() {
    let folder = folder();
    fs::create_dir(folder.path().join("folder.png")).unwrap();
    fs::write(folder.path().join("kept.png"), "old").unwrap();
    let mut permissions = fs::metadata(folder.path().join("kept.png"))
        .unwrap()
        .permissions();
    permissions.set_readonly(true);
    fs::set_permissions(folder.path().join("kept.png"), permissions).unwrap();
    let before = names(&folder);
    let options = "capture --stage 6 --size 8 -o";
    for (output, said) in [
        ("missing/a.png", "missing/a.png: cannot be written: "),
        ("missing\nline/a.png", "missing\\nline/a.png: "),
        ("folder.png", "folder.png: this is a folder or a device"),
        ("kept.png", "kept.png: this file is read-only"),
        (&format!("{}.png", "n".repeat(300)), "cannot be written: "),
    ] {
        let output = program(&folder, options).arg(output).output().unwrap();
        let message = failed(&output, said);
        assert!(message.contains(said), "{message}");
        assert_eq!(names(&folder), before, "{said}");
    }
    assert_eq!(bytes(&folder, "kept.png"), b"old");

    // The first of very many frames fails: none but it was ever thought of.
    let line = format!("{options} missing/{{}}.png --frames 0..{}", u64::MAX);
    failed(&program(&folder, &line).output().unwrap(), &line);
    let line = format!("{options} missing/a.apng --frames 0..9");
    failed(&program(&folder, &line).output().unwrap(), &line);
}

#[cfg(unix)]
#[test]
fn a_new_file_has_the_permissions_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    for (umask, mode) in [("000", 0o666), ("022", 0o644), ("077", 0o600)] {
        let folder = folder();
        for (name, frames) in [("a.png", ""), ("a.exr", ""), ("a.apng", " --frames 0..1")] {
            let line = format!("capture --stage 1 --size 4 --through none -o {name}{frames}");
            let output = program_after(&format!("umask {umask}"), &folder, &line)
                .output()
                .unwrap();
            assert_eq!(succeeded(&output, name), "");
            let metadata = fs::metadata(folder.path().join(name)).unwrap();
            assert_eq!(metadata.permissions().mode() & 0o777, mode, "{name}");
        }
    }
}

#[test]
fn standard_output_gets_the_bytes_of_the_file() {
    let folder = folder();
    let run = |line: &str| {
        let line = format!("capture --stage 7 --size 33 --through none {line}");
        let output = program(&folder, &line).output().unwrap();
        assert_eq!(text(&output.stderr), "", "{line}");
        assert_eq!(output.status.code(), Some(0), "{line}");
        output.stdout
    };
    for (format, frames) in [
        ("png", "--frame 4"),
        ("exr", "--alpha -0.5"),
        ("apng", "--frames 9..11"),
    ] {
        let bytes = run(&format!("{frames} -o - --format {format}"));
        run(&format!("{frames} -o a.{format}"));
        assert!(
            bytes == self::bytes(&folder, &format!("a.{format}")),
            "{format}"
        );
    }
    let one = run("--frame 4 -o - --format rgb24");
    assert!(one == displayed(&traced(7, frame_angle(4), 33)));
    let frames = run("--frames 19..22 -o - --format rgb24");
    let expected = (19..=22).flat_map(|frame| displayed(&traced(7, frame_angle(frame), 33)));
    assert!(frames.into_iter().eq(expected));
    assert_eq!(names(&folder), ["a.apng", "a.exr", "a.png"]);
}

/// How standard output is sent pictures.
const STREAMS: [&str; 4] = [
    "--format png",
    "--format exr",
    "--frames 0..999999 --format apng",
    "--frames 0..999999 --format rgb24",
];

#[test]
fn a_capture_into_a_closed_pipe_ends() {
    for stream in STREAMS {
        let line = format!("capture --stage 7 --size 200 --through none -o - {stream}");
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = program(&folder(), &line).stdout(writer).output().unwrap();
        assert_eq!(succeeded(&output, &line), "");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_picture_that_standard_output_cannot_take_is_a_failure() {
    let full = File::options().write(true).open("/dev/full").unwrap();
    let (_screen, terminal) = helpers::terminal();
    for stream in STREAMS {
        for (device, said) in [
            (&full, "standard output cannot be written: "),
            (&terminal, "a terminal shows no pictures: "),
        ] {
            let device = device.try_clone().unwrap();
            let line = format!("capture --stage 7 --size 200 --through none -o - {stream}");
            let output = program(&folder(), &line).stdout(device).output().unwrap();
            let message = failed(&output, &line);
            assert!(message.contains(said), "{message}");
        }
    }
}

#[test]
fn a_file_that_is_there_is_replaced_whole() {
    let folder = folder();
    let line = "capture --stage 6 --size 8 --through none -o";
    done(&folder, &format!("{line} new.png"));
    fs::write(folder.path().join("old.png"), [7; 100_000]).unwrap();
    done(&folder, &format!("{line} old.png"));
    assert_eq!(bytes(&folder, "old.png"), bytes(&folder, "new.png"));
    assert_eq!(names(&folder), ["new.png", "old.png"]);
}

#[cfg(unix)]
#[test]
fn a_replaced_file_keeps_its_mode() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    for mode in [0o600, 0o640, 0o666, 0o755] {
        for (name, frames) in [("a.png", ""), ("a.exr", ""), ("a.apng", " --frames 0..1")] {
            let path = folder.path().join(name);
            fs::write(&path, "old").unwrap();
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
            done(
                &folder,
                &format!("capture --stage 1 --size 4 --through none -o {name}{frames}"),
            );
            assert_ne!(bytes(&folder, name), b"old");
            let metadata = fs::metadata(&path).unwrap();
            assert_eq!(metadata.permissions().mode() & 0o7777, mode, "{name}");
        }
    }
}

#[cfg(unix)]
#[test]
fn a_link_to_nothing_is_followed_too() {
    use std::os::unix::fs::symlink;
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("elsewhere")).unwrap();
    symlink("elsewhere/link.png", at("link.png")).unwrap();
    symlink("new.png", at("elsewhere/link.png")).unwrap();
    symlink("missing/a.png", at("lost.png")).unwrap();
    symlink("loop.png", at("loop.png")).unwrap();
    let line = "capture --stage 6 --size 8 --through none -o";
    done(&folder, &format!("{line} link.png"));
    assert!(fs::metadata(at("elsewhere/new.png")).unwrap().is_file());
    for (name, said) in [
        ("lost.png", "lost.png: cannot be written: "),
        ("loop.png", "loop.png: cannot be written: "),
    ] {
        let line = format!("{line} {name}");
        let message = failed(&program(&folder, &line).output().unwrap(), name);
        assert!(message.contains(said), "{message}");
    }
    for name in ["link.png", "elsewhere/link.png", "lost.png", "loop.png"] {
        assert!(
            fs::symlink_metadata(at(name)).unwrap().is_symlink(),
            "{name}"
        );
    }
    assert_eq!(
        names(&folder),
        ["elsewhere", "link.png", "loop.png", "lost.png"]
    );
}

#[cfg(unix)]
#[test]
fn a_link_is_followed_but_what_is_no_file_stays() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    use std::os::unix::net::UnixListener;
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("elsewhere")).unwrap();
    fs::write(at("elsewhere/old"), "old").unwrap();
    symlink("elsewhere/old", at("link.png")).unwrap();
    // In place of a device: where this fails for an administrator, it must not be at the cost of a
    // real one.
    let _socket = UnixListener::bind(at("elsewhere/socket")).unwrap();
    symlink("elsewhere/socket", at("socket.png")).unwrap();
    let line = "capture --stage 6 --size 8 --through none -o";
    done(&folder, &format!("{line} new.png"));
    done(&folder, &format!("{line} link.png"));
    assert!(fs::symlink_metadata(at("link.png")).unwrap().is_symlink());
    assert_eq!(bytes(&folder, "elsewhere/old"), bytes(&folder, "new.png"));

    let line = format!("{line} socket.png");
    let message = failed(&program(&folder, &line).output().unwrap(), &line);
    assert!(message.contains("a folder or a device"), "{message}");
    let kept = fs::metadata(at("elsewhere/socket")).unwrap();
    assert!(kept.file_type().is_socket());
    assert_eq!(
        names(&folder),
        ["elsewhere", "link.png", "new.png", "socket.png"]
    );
}

#[test]
fn every_way_gives_the_same_bytes() {
    for (name, backend) in [("egl", Backend::Egl), ("osmesa", Backend::OsMesa)] {
        if open(backend, 8).is_none() {
            continue;
        }
        for (output, frames) in [
            ("a.png", ""),
            ("a.exr", ""),
            ("a.apng", " --frames 5..6"),
            ("{}.exr", " --frames 5..6"),
        ] {
            let folders = [name, "none"].map(|way| {
                let folder = folder();
                let line =
                    format!("capture --stage 6 --size 65 --through {way} -o {output}{frames}");
                let output = program(&folder, &line).output().unwrap();
                assert_eq!(
                    output.status.code(),
                    Some(0),
                    "{line}: {}",
                    text(&output.stderr)
                );
                folder
            });
            let written = names(&folders[0]);
            assert_eq!(written, names(&folders[1]));
            assert!(!written.is_empty());
            for file in written {
                assert_eq!(
                    bytes(&folders[0], &file),
                    bytes(&folders[1], &file),
                    "{name}: {file}"
                );
            }
        }
    }
}

#[test]
fn without_a_way_standard_error_says_which_was_taken() {
    let folder = folder();
    let line = "capture --stage 6 --size 65 -o a.exr";
    let output = program(&folder, line).output().unwrap();
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{message}");
    let line = message
        .lines()
        .find(|line| line.starts_with("firsthit: captured through "))
        .unwrap();
    let works = |backend| Offscreen::open(backend, 65).is_ok();
    let way = if works(Backend::Egl) {
        "egl"
    } else if works(Backend::OsMesa) {
        "osmesa"
    } else {
        "none"
    };
    assert!(line.contains(&format!("through {way}, ")), "{line}");
    assert_eq!(
        exr_bits(&folder.path().join("a.exr")),
        bits(&traced(6, 0.0, 65))
    );
}

#[test]
fn scene_prints_the_built_in_scene() {
    let text = printed(&folder(), "scene");
    assert_eq!(text, scene::BUILTIN_TOML);
    assert_eq!(Scene::from_toml(&text).unwrap(), Scene::builtin());
}

/// The commands, each with its own arguments.
const COMMANDS: [&str; 8] = [
    "view",
    "capture",
    "explain",
    "report",
    "compare",
    "scene",
    "completions",
    "man",
];

#[test]
fn shells_complete_the_command_line() {
    let folder = folder();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = printed(&folder, &format!("completions {shell}"));
        for word in COMMANDS.iter().chain(&["kernel", "linear"]) {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    let script = printed(&folder, "completions bash");
    let complete = "COMP_WORDS=(firsthit capture --kernel re); COMP_CWORD=3; \
                    _firsthit firsthit re --kernel; echo ${COMPREPLY[@]}";
    let output = Command::new("bash")
        .args(["-c", &format!("{script}\n{complete}")])
        .output()
        .unwrap();
    assert_eq!(succeeded(&output, "bash"), "reference\n");
    helpers::failed(
        &program(&folder, "completions sh").output().unwrap(),
        2,
        "sh",
    );
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = folder();
    let page = printed(&folder, "man");
    assert!(page.contains(".TH firsthit 1"), "{page}");
    for command in COMMANDS {
        assert!(page.contains(&format!("firsthit\\-{command}(1)")), "{page}");
        let page = printed(&folder, &format!("man {command}"));
        assert!(
            page.contains(&format!(".TH firsthit-{command} 1")),
            "{page}"
        );
    }
    let page = printed(&folder, "man capture");
    assert!(page.contains("\\-\\-linear"), "{page}");
    let output = program(&folder, "man draw").output().unwrap();
    helpers::failed(&output, 2, "man draw");
}

#[test]
fn a_pipe_that_is_closed_is_no_failure() {
    for line in ["scene", "--help", "capture --help", "--version"] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = program(&folder(), line).stdout(writer).output().unwrap();
        assert_eq!(succeeded(&output, line), "");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_standard_output_that_is_full_is_a_failure() {
    for line in ["scene", "--help", "capture --help", "--version"] {
        let output = program(&folder(), line)
            .stdout(File::create("/dev/full").unwrap())
            .output()
            .unwrap();
        let message = failed(&output, line);
        assert!(
            message.contains("standard output cannot be written"),
            "{message}"
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_command_it_is_the_viewer() {
    let run = |line: &str| {
        let output = program(&folder(), line)
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .output()
            .unwrap();
        failed(&output, line)
    };
    assert_eq!(run(""), run("view"));
    assert_eq!(
        run("--stage 3 --step -0.3"),
        run("view --stage 3 --step -0.3")
    );
}

#[cfg(unix)]
#[test]
fn names_need_not_be_text() {
    use std::os::unix::ffi::OsStrExt;
    let folder = folder();
    let name = OsStr::from_bytes(b"caf\xe9.png");
    let line = "capture --stage 1 --size 4 --through none -o";
    let output = program(&folder, line).arg(name).output().unwrap();
    assert_eq!(succeeded(&output, line), "");
    assert!(folder.path().join(name).is_file());

    let output = program(&folder, line)
        .arg(OsStr::from_bytes(b"\xe9{}\xff{}.png"))
        .args(["--frames", "9..10"])
        .output()
        .unwrap();
    assert_eq!(succeeded(&output, line), "");
    for name in [&b"\xe909\xff09.png"[..], b"\xe910\xff10.png"] {
        assert!(folder.path().join(OsStr::from_bytes(name)).is_file());
    }

    let scene = folder.path().join(OsStr::from_bytes(b"\xe9.toml"));
    fs::write(&scene, "").unwrap();
    let line = "capture --stage 1 --size 4 --through none -o a.png --scene";
    let output = program(&folder, line).arg(&scene).output().unwrap();
    assert_eq!(succeeded(&output, line), "");

    let json = folder.path().join(OsStr::from_bytes(b"\xe9.json"));
    let line = "report --size 2 --frames 0..0 --threads 1 --kernel double --json";
    let mut report = without_drivers(&folder, line);
    let output = report.arg(&json).output().unwrap();
    succeeded(&output, line);
    assert!(json.is_file());
}
