//! Other programs in the place of a kernel, and files that change while the viewer is seen.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use firsthit::scene::BUILTIN_TOML;
use firsthit::{Image, Kernel, Scene, Stage, Tracer};
use tempfile::NamedTempFile;

use super::WATCH;
use super::pixels::{Expected, letterboxed, wait_to_show};
use super::program::wait_for;
use super::session::{SPACE, Session};
use super::xvfb::Xvfb;

const SIZE: u32 = 300;

/// A program that answers with pictures of one grey, each after what `before` says, and then does
/// what `after` says.
fn flat_and(grey: f32, before: &str, after: &str) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let samples = folder.join(format!("flat-{grey}.samples"));
    // In one piece: other tests may have the same picture written or read.
    let file = NamedTempFile::new_in(folder).unwrap();
    let count = 3 * SIZE as usize * SIZE as usize;
    fs::write(&file, grey.to_le_bytes().repeat(count)).unwrap();
    file.persist(&samples).unwrap();
    format!(
        "while read line; do\n    \
             {before}\n    \
             cat '{}'\n    \
             {after}\n\
         done; exit\n",
        samples.display()
    )
}

fn flat(grey: f32) -> String {
    flat_and(grey, ":", ":")
}

/// The same, each picture after some seconds.
fn slow(grey: f32, seconds: f64) -> String {
    flat_and(grey, &format!("sleep {seconds}"), ":")
}

/// The viewer with a shell's program of this text, which starts in no time, and its path.
fn view(text: &str, arguments: &[&str]) -> Option<(Session, PathBuf)> {
    let xvfb = Xvfb::lent()?;
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!(
        "flat-{}-{:?}.sh",
        std::process::id(),
        thread::current().id()
    ));
    fs::write(&path, text).unwrap();
    let command = format!("sh '{}'", path.display());
    let all = ["view", "--size", "300", "--program", &command];
    let session = Session::on(xvfb, &[&all, arguments].concat(), &[]);
    Some((session, path))
}

/// Waits until the window shows one grey, at least in the upper half.
#[track_caller]
fn shows_grey(session: &Session, grey: f32) {
    let mut picture = Image::new(SIZE).unwrap();
    picture.samples_mut().fill(grey);
    let mut expected = Expected::new(|width, height| letterboxed(&picture, width, height));
    wait_for(&format!("a grey of {grey}"), || {
        let shown = session.pixels()?;
        let expected = expected.of(shown.width, shown.height);
        (shown.differences(expected, 0..shown.height / 2) == 0).then_some(())
    });
}

#[test]
fn a_program_is_shown_like_a_kernel_and_started_anew_when_its_file_changes() {
    let Some((mut session, path)) = view(&flat(0.5), &["--stage", "6"]) else {
        return;
    };
    session.titled(&["firsthit — 6 Reflection — sh flat-"]);
    shows_grey(&session, 0.5);
    session.type_keys("k");
    session.titled(&["— exact —"]);
    session.shows(SIZE, Stage::Reflection, 0.0);
    for _ in Kernel::ALL {
        session.type_keys("k");
    }
    session.titled(&["— sh flat-"]);
    shows_grey(&session, 0.5);
    fs::write(&path, flat(0.25)).unwrap();
    shows_grey(&session, 0.25);
    // One that fails leaves the last picture, and says why, until it is mended.
    fs::write(&path, "exit 3").unwrap();
    thread::sleep(WATCH);
    shows_grey(&session, 0.25);
    session.screenshot("viewer-failed-program.png");
    // It is not started again and again.
    session.program.sleeps();
    fs::write(&path, flat(0.75)).unwrap();
    shows_grey(&session, 0.75);
    session.type_keys("q");
    let (status, errors) = session.program.ended();
    assert_eq!(status.code(), Some(0));
    let lines: Vec<&str> = errors.lines().collect();
    let [line] = lines[..] else {
        panic!("{errors}");
    };
    assert!(line.starts_with("firsthit: sh flat-"), "{line}");
    assert!(line.contains("ended with status 3"), "{line}");
}

#[test]
fn the_animation_of_a_program_that_failed_plays_on_once_it_is_mended() {
    let Some((mut session, path)) = view(&flat(0.5), &[]) else {
        return;
    };
    session.titled(&[" fps"]);
    fs::write(&path, "exit 3").unwrap();
    session.titled(&["paused"]);
    fs::write(&path, flat(0.75)).unwrap();
    session.titled(&[" fps"]);
    shows_grey(&session, 0.75);
    // One that a key has paused stays so.
    session.press(SPACE);
    session.titled(&["paused"]);
    fs::write(&path, "exit 4").unwrap();
    wait_for("a note", || {
        let shown = session.pixels()?;
        let [bottom, width] = [shown.height - 20, shown.width];
        let note = shown.part([0, bottom], [width, 20]);
        (note.count([191; 3]) < width).then_some(())
    });
    fs::write(&path, flat(0.25)).unwrap();
    shows_grey(&session, 0.25);
    thread::sleep(WATCH);
    session.titled(&["paused"]);
    session.type_keys("q");
    let (status, errors) = session.program.ended();
    assert_eq!(status.code(), Some(0));
    assert_eq!(errors.lines().count(), 2, "{errors}");
}

#[test]
fn what_a_program_writes_after_its_picture_is_told_though_nothing_else_is_asked_for() {
    let text = flat_and(0.5, ":", "sleep 0.1; echo done");
    let Some((mut session, _)) = view(&text, &["--stage", "6"]) else {
        return;
    };
    for stage in ["6", "5"] {
        session.type_keys(stage);
        session.titled(&[&format!("firsthit — {stage} ")]);
        shows_grey(&session, 0.5);
        wait_for("a note", || {
            let shown = session.pixels()?;
            let [bottom, width] = [shown.height - 20, shown.width];
            let note = shown.part([0, bottom], [width, 20]);
            (note.count([128; 3]) < width).then_some(())
        });
        // It is not started again and again.
        session.program.sleeps();
    }
    session.screenshot("viewer-surplus.png");
    session.type_keys("q");
    let (status, errors) = session.program.ended();
    assert_eq!(status.code(), Some(0));
    let lines: Vec<&str> = errors.lines().collect();
    let [first, second] = lines[..] else {
        panic!("{errors}");
    };
    for (line, stage) in [(first, "stage 6"), (second, "stage 5")] {
        assert!(line.contains(stage) && line.contains("\"done"), "{line}");
    }
}

#[test]
fn a_program_that_fails_from_the_start_is_shown_once_it_is_mended() {
    let Some((mut session, path)) = view("echo hello", &["--stage", "2"]) else {
        return;
    };
    shows_grey(&session, 0.0);
    // The black that stands in for a picture is not compared.
    session.type_keys("e");
    thread::sleep(WATCH);
    assert_eq!(session.pixels().unwrap().count([255, 60, 200]), 0);
    session.type_keys("e");
    fs::write(&path, flat(0.5)).unwrap();
    shows_grey(&session, 0.5);
    session.type_keys("q");
    let (status, _) = session.program.ended();
    assert_eq!(status.code(), Some(0));
}

#[test]
fn a_slow_program_keeps_nobody_waiting() {
    let Some((mut session, _)) = view(&slow(0.5, 3.0), &["--stage", "6", "--kernel", "exact"])
    else {
        return;
    };
    session.shows(SIZE, Stage::Reflection, 0.0);
    for _ in Kernel::ALL {
        session.type_keys("k");
    }
    // Title and stage change at once, although the last kernel's picture is all that there is.
    session.titled(&["6 Reflection — sh"]);
    let start = Instant::now();
    session.type_keys("5");
    session.titled(&["5 Shadow — sh"]);
    session.type_keys("k");
    session.titled(&["5 Shadow — exact"]);
    session.shows(SIZE, Stage::Shadow, 0.0);
    let time = start.elapsed();
    assert!(time < Duration::from_secs(3), "{time:?}");
    for _ in Kernel::ALL {
        session.type_keys("k");
    }
    // The picture of the stage that was left is not shown, or for no longer than the note.
    session.titled(&["5 Shadow — sh"]);
    shows_grey(&session, 0.5);
    // It is left at once, too.
    session.type_keys("4");
    session.titled(&["4 Shading — sh"]);
    let start = Instant::now();
    session.type_keys("q");
    session.program.left();
    let time = start.elapsed();
    assert!(time < Duration::from_secs(3), "{time:?}");
}

#[test]
fn a_slow_program_is_said_to_be_at_it() {
    let Some((mut session, _)) = view(&slow(0.5, 4.0), &["--stage", "6"]) else {
        return;
    };
    shows_grey(&session, 0.5);
    let picture = session.pixels().unwrap();
    session.type_keys("5");
    // The note counts the seconds, and goes with the wait.
    let noted = || {
        let shown = session.pixels()?;
        let noted = shown.differences(&picture, 0..shown.height) > 100;
        noted.then_some(shown)
    };
    let first = wait_for("a note", noted);
    session.screenshot("viewer-slow-program.png");
    wait_for("a later note", || {
        let later = noted()?;
        (later.differences(&first, 0..first.height) > 0).then_some(())
    });
    wait_for("the picture alone", || {
        let shown = session.pixels()?;
        (shown.differences(&picture, 0..shown.height) == 0).then_some(())
    });
    session.type_keys("q");
    let [_, _, draws] = session.program.left();
    // Ten times a second at most, while two pictures are awaited.
    assert!(draws < 110, "{draws}");
}

#[test]
fn the_frame_rate_of_a_slow_program_counts_its_pictures() {
    let Some((mut session, _)) = view(&slow(0.5, 0.8), &[]) else {
        return;
    };
    wait_for("a frame rate", || {
        let title = session.title();
        let (_, rate) = title.split_once(" — α = ")?.1.split_once(" — ")?;
        let rate: u32 = rate.strip_suffix(" fps")?.parse().ok()?;
        assert!(rate <= 1, "{title}");
        (rate == 1).then_some(())
    });
    session.type_keys("q");
    session.program.left();
}

#[test]
fn the_death_of_the_server_leaves_no_program_running() {
    let Some(xvfb) = Xvfb::lent() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let temporary = folder.path().join("tmp");
    fs::create_dir(&temporary).unwrap();
    let number = folder.path().join("number");
    let script = folder.path().join("deaf.sh");
    let text = format!("echo $$ > '{}'; exec sleep 1000", number.display());
    fs::write(&script, text).unwrap();
    let command = format!("sh '{}'", script.display());
    let arguments = ["view", "--kernel", "exact", "--size", "300", "--program"];
    let environment = [("TMPDIR", temporary.to_str().unwrap())];
    let mut session = Session::on(xvfb, &[&arguments[..], &[&command]].concat(), &environment);
    let number = wait_for("the program", || {
        let number = fs::read_to_string(&number).ok()?;
        number.trim().parse::<u32>().ok()
    });
    // The command line of what has ended is empty, or gone.
    let command_line = || fs::read(format!("/proc/{number}/cmdline")).unwrap_or_default();
    wait_for("it to sleep", || {
        command_line().starts_with(b"sleep").then_some(())
    });
    session.crash_server();
    let (status, _) = session.program.ended();
    assert_eq!(status.code(), Some(1));
    wait_for("its end", || command_line().is_empty().then_some(()));
    assert_eq!(fs::read_dir(&temporary).unwrap().count(), 0);
}

#[test]
fn the_error_view_and_the_inspector_say_what_a_program_shows() {
    // As the surface in shadow: the ambient light.
    let Some((mut session, _)) = view(&flat(0.3), &["--stage", "5"]) else {
        return;
    };
    shows_grey(&session, 0.3);
    // The corner shows the background, which is neither.
    session.point(1, 1);
    session.click(super::session::LEFT_BUTTON);
    let verdict = "verdict      shows the surface in shadow, where the background is seen";
    assert_eq!(session.program.line("verdict"), verdict);
    assert!(session.program.line("yours").contains("0.3 0.3 0.3"));
    session.type_keys("e");
    // Another thing is seen than there is: green.
    wait_for("wrong pixels", || {
        (session.pixels()?.count([0, 255, 0]) > 100).then_some(())
    });
    session.screenshot("viewer-program-errors.png");
    session.type_keys("q");
    session.program.left();
}

/// The built-in scene with spheres of another size.
fn scene(radius: &str) -> String {
    BUILTIN_TOML.replace("0.34375", radius)
}

#[track_caller]
fn shows_scene(session: &Session, text: &str) {
    let mut picture = Image::new(SIZE).unwrap();
    let mut tracer = Tracer::new(Kernel::Exact, 1).unwrap();
    let scene = Scene::from_toml(text).unwrap();
    tracer
        .trace(&scene, Stage::Shading, 0.0, &mut picture)
        .unwrap();
    wait_to_show(
        || session.pixels(),
        |width, height| letterboxed(&picture, width, height),
    );
}

#[test]
fn a_changed_scene_file_is_shown_and_a_refused_one_leaves_the_last_scene() {
    let Some(xvfb) = Xvfb::lent() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(&path, scene("0.34375")).unwrap();
    let file = path.to_str().unwrap();
    let arguments = ["view", "--size", "300", "--stage", "4", "--scene", file];
    let mut session = Session::on(xvfb, &arguments, &[]);
    shows_scene(&session, &scene("0.34375"));
    // Half a second is promised; a machine with much else to do is given more.
    fs::write(&path, scene("0.25")).unwrap();
    shows_scene(&session, &scene("0.25"));
    session.program.line("read ");
    // With a mistake: the picture stays, under the line that says where it is.
    fs::write(&path, scene("-1.0")).unwrap();
    thread::sleep(WATCH);
    session.screenshot("viewer-refused-scene.png");
    let shown = session.pixels().unwrap();
    // As some editors do it.
    let other = folder.path().join("other");
    fs::write(&other, scene("0.125")).unwrap();
    fs::rename(&other, &path).unwrap();
    shows_scene(&session, &scene("0.125"));
    // The note lay over the picture, and is gone.
    assert_ne!(
        shown.differences(&session.pixels().unwrap(), 0..shown.height),
        0
    );
    // An icon looks at nothing; what has changed meanwhile is shown afterwards.
    session.iconify(true);
    session.program.sleeps();
    fs::write(&path, scene("0.25")).unwrap();
    session.iconify(false);
    shows_scene(&session, &scene("0.25"));
    session.type_keys("q");
    let (status, errors) = session.program.ended();
    assert_eq!(status.code(), Some(0));
    let refusal = format!("firsthit: {file}: line 25: sphere[0].radius: -1.0 is out of range");
    assert!(errors.starts_with(&refusal), "{errors}");
    assert_eq!(errors.lines().count(), 1, "{errors}");
}

#[test]
fn a_program_that_never_answers_keeps_what_mends_it_waiting_for_nothing() {
    let silent = "exec sleep 1000";
    let Some((mut session, path)) = view(silent, &["--stage", "2"]) else {
        return;
    };
    // Black with a note, long before the program is given up.
    shows_grey(&session, 0.0);
    let start = Instant::now();
    fs::write(&path, flat(0.5)).unwrap();
    shows_grey(&session, 0.5);
    let time = start.elapsed();
    assert!(time < Duration::from_secs(8), "{time:?}");
    session.type_keys("q");
    session.program.left();
}
