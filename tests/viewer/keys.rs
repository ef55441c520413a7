//! What the keys do to the picture.

use std::f64::consts::TAU;
use std::fs;
use std::thread;

use firsthit::Stage;
use firsthit::camera::{ROUND, frame_angle};
use x11rb::protocol::xproto::ConnectionExt as _;

use super::WATCH;
use super::pixels::traced;
use super::program::{Program, wait_for};
use super::session::{HOME, LEFT, RIGHT, SPACE, Session};
use super::xvfb::Xvfb;

#[test]
fn opens_on_the_animation_and_shows_stage_after_stage_as_traced() {
    let Some(mut session) = Session::start(&[]) else {
        return;
    };
    assert_eq!(session.size(), (500, 500));
    session.titled(&["firsthit — 7 Animation — ", " fps"]);
    let title = session.title();
    wait_for("α to move", || (session.title() != title).then_some(()));
    session.press(SPACE);
    session.titled(&["paused"]);
    session.type_keys("0");
    session.titled(&["α = 0.000"]);
    session.shows(500, Stage::Animation, 0.0);
    for stage in Stage::ALL.into_iter().rev() {
        session.type_keys(&stage.number().to_string());
        session.titled(&[&stage.to_string(), "α = 0.000"]);
        session.shows(500, stage, 0.0);
        session.screenshot(&format!("viewer-stage{}.png", stage.number()));
    }
    session.type_keys("q");
    session.program.left();
}

/// What keys do to a static stage: each promise begins and ends in stage 6 at α = 0.
#[test]
fn keys_choose_the_stage_the_angle_and_the_kernel() {
    let Some(mut session) = Session::start(&["view", "--stage", "6", "--size", "40"]) else {
        return;
    };
    the_keys_are_said_at_the_start(&session);
    session.shows(40, Stage::Reflection, 0.0);
    keys_turn_the_picture_to_the_angle_they_name(&session);
    k_goes_through_the_kernels(&session);
    digits_of_the_keypad_choose_the_stage_without_num_lock_too(&session);
    digits_choose_the_stage_where_the_digit_row_is_shifted(&session);
    session.type_keys("q");
    session.program.left();
}

fn the_keys_are_said_at_the_start(session: &Session) {
    let table = firsthit::viewer::key_table();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(session.program.first_lines(lines.len()), lines);
}

fn digits_of_the_keypad_choose_the_stage_without_num_lock_too(session: &Session) {
    // KP_End, KP_Down, … as they lie around the keypad.
    let keypad = [0xff9c, 0xff99, 0xff9b, 0xff96, 0xff9d, 0xff98];
    for (stage, keysym) in Stage::ALL.into_iter().zip(keypad) {
        let (keycode, _) = session.keycode(keysym);
        session.press_code(keycode);
        session.shows(40, stage, 0.0);
        session.type_keys("6");
        session.shows(40, Stage::Reflection, 0.0);
    }
}

fn digits_choose_the_stage_where_the_digit_row_is_shifted(session: &Session) {
    // As on a French keyboard: & é " ' ( - without Shift, the digits with it.
    let french = [0x26, 0xe9, 0x22, 0x27, 0x28, 0x2d];
    for (digit, symbol) in (u32::from('1')..).zip(french) {
        let (keycode, _) = session.keycode(digit);
        session
            .connection
            .change_keyboard_mapping(1, keycode, 2, &[symbol, digit])
            .unwrap()
            .check()
            .unwrap();
    }
    for (stage, symbol) in Stage::ALL.into_iter().zip(french) {
        let (keycode, _) = session.keycode(symbol);
        session.press_code(keycode);
        session.shows(40, stage, 0.0);
        session.type_keys("6");
        session.shows(40, Stage::Reflection, 0.0);
        session.press_shifted(keycode);
        session.shows(40, stage, 0.0);
    }
}

fn keys_turn_the_picture_to_the_angle_they_name(session: &Session) {
    let stage = Stage::Reflection;
    session.type_keys(".");
    session.shows(40, stage, frame_angle(1));
    session.type_keys("..");
    session.shows(40, stage, frame_angle(3));
    session.press(RIGHT);
    session.shows(40, stage, frame_angle(3) + 0.05);
    session.type_keys(",");
    session.shows(40, stage, frame_angle(3));
    session.press(HOME);
    session.shows(40, stage, 0.0);
    session.type_keys(",");
    session.shows(40, stage, frame_angle(ROUND - 1));
    session.type_keys(".");
    session.shows(40, stage, 0.0);
    session.press(LEFT);
    session.shows(40, stage, TAU - 0.05);
    // An angle that was asked for stays from stage to stage.
    session.type_keys("5");
    session.shows(40, Stage::Shadow, TAU - 0.05);
    session.type_keys("0");
    session.shows(40, Stage::Shadow, 0.0);
    // In the animation they pause it.
    session.type_keys("7.");
    session.titled(&["7 Animation", "paused"]);
    session.type_keys("0.");
    session.shows(40, Stage::Animation, frame_angle(1));
    session.type_keys("60");
    session.shows(40, stage, 0.0);
}

#[test]
fn the_animation_plays_as_fast_as_it_is_told() {
    let moved = |session: &Session| {
        let before = session.alpha();
        thread::sleep(WATCH);
        (session.alpha() - before).abs()
    };
    let Some(mut slow) = Session::start(&["view", "--size", "40", "--speed", "0.0011"]) else {
        return;
    };
    slow.type_keys(&"+".repeat(60));
    wait_for("α to turn fast", || (moved(&slow) > 0.2).then_some(()));
    slow.type_keys(&"-".repeat(70));
    wait_for("α to turn slowly", || (moved(&slow) < 0.1).then_some(()));
    slow.type_keys("q");
    slow.program.left();
}

#[test]
fn stepping_shows_the_frames_of_the_document_and_starts_again() {
    let frames = (ROUND + 3).to_string();
    let arguments = [
        "view",
        "--step",
        "0.3",
        "--size",
        "40",
        "--exit-after-frames",
        &frames,
    ];
    let Some(mut session) = Session::start(&arguments[..5]) else {
        return;
    };
    session.press(SPACE);
    session.titled(&["paused"]);
    let title = session.title();
    let frame = (0..ROUND).find(|&k| title.contains(&format!("α = {:.3} ", frame_angle(k))));
    let angle = frame_angle(frame.expect("an angle of the grid"));
    session.shows(40, Stage::Animation, angle);
    session.type_keys("q");
    session.program.left();

    let Some(xvfb) = Xvfb::lent() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let environment = [("DISPLAY", xvfb.display.as_str())];
    let mut program = Program::start(folder.path(), &arguments, &environment);
    assert_eq!(program.left(), [ROUND + 3; 3]);
}

#[test]
fn a_static_stage_leaves_after_its_frames_too() {
    let Some(xvfb) = Xvfb::lent() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let arguments = [
        "view",
        "--stage",
        "6",
        "--size",
        "40",
        "--exit-after-frames",
        "5",
    ];
    let environment = [("DISPLAY", xvfb.display.as_str())];
    let mut program = Program::start(folder.path(), &arguments, &environment);
    assert_eq!(program.left(), [1, 1, 5]);
}

#[test]
fn saving_never_overwrites_and_what_cannot_be_saved_is_a_line() {
    let Some(mut session) = Session::start(&["view", "--stage", "6", "--size", "40"]) else {
        return;
    };
    let folder = session.folder.path().to_owned();
    let taken = folder.join("firsthit-stage6-0002.png");
    fs::write(&taken, "not ours").unwrap();
    session.type_keys("ss.sS3S");
    session.program.line("saved firsthit-stage3-0001.exr");
    let expected = |stage, alpha, name: &str| {
        let path = folder
            .join("expected")
            .with_extension(name.rsplit('.').next().unwrap());
        traced(40, stage, alpha).save(&path).unwrap();
        assert_eq!(
            fs::read(folder.join(name)).unwrap(),
            fs::read(path).unwrap(),
            "{name}"
        );
    };
    let six = Stage::Reflection;
    expected(six, 0.0, "firsthit-stage6-0001.png");
    expected(six, 0.0, "firsthit-stage6-0003.png");
    expected(six, frame_angle(1), "firsthit-stage6-0004.png");
    expected(six, frame_angle(1), "firsthit-stage6-0001.exr");
    expected(
        Stage::Tetrahedron,
        frame_angle(1),
        "firsthit-stage3-0001.exr",
    );
    assert_eq!(fs::read(taken).unwrap(), b"not ours");
    for name in ["0001.png", "0003.png", "0004.png", "0001.exr"] {
        session
            .program
            .line(&format!("saved firsthit-stage6-{name}"));
    }
    // Five pictures, the one that was there, and two to compare with.
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 8);
    // What cannot be saved is a line, and no more.
    fs::remove_dir_all(folder).unwrap();
    session.type_keys("s5");
    session.shows(40, Stage::Shadow, frame_angle(1));
    session.type_keys("q");
    let (status, errors) = session.program.ended();
    assert_eq!(status.code(), Some(0));
    assert!(errors.contains("firsthit-stage3-0001.png: "), "{errors}");
    assert_eq!(errors.lines().count(), 1);
}

fn k_goes_through_the_kernels(session: &Session) {
    let kernels = ["fast", "double", "listing", "reference", "exact"];
    for kernel in kernels {
        session.type_keys("k");
        session.titled(&[&format!("— {kernel} —")]);
    }
    session.shows(40, Stage::Reflection, 0.0);
}

#[test]
fn a_kernel_that_refuses_the_scene_is_passed_over() {
    let scenes = tempfile::tempdir().unwrap();
    let path = scenes.path().join("empty.toml");
    fs::write(&path, "").unwrap();
    let arguments = ["view", "--stage", "6", "--size", "40", "--scene"];
    let arguments = [&arguments[..], &[path.to_str().unwrap()]].concat();
    let Some(mut session) = Session::start(&arguments) else {
        return;
    };
    for kernel in ["fast", "double", "reference", "exact"] {
        session.type_keys("k");
        session.titled(&[&format!("— {kernel} —")]);
    }
    session.type_keys("q");
    session.program.left();
}
