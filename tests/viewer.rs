//! The viewer, for real: the built program in a window under Xvfb, keys through XTEST, and the pixels of the window compared byte for
//! byte with the traced picture.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    unreachable_pub,
    missing_docs,
    reason = "a test stops at the first surprise"
)]
#![cfg(target_os = "linux")]

#[path = "viewer/pixels.rs"]
mod pixels;
#[path = "viewer/program.rs"]
mod program;
#[path = "viewer/session.rs"]
mod session;
#[path = "viewer/xvfb.rs"]
mod xvfb;

use std::f64::consts::TAU;
use std::fs;
use std::thread;
use std::time::{Duration, Instant};

use firsthit::camera::{ROUND, frame_angle};
use firsthit::{Kernel, Scene, Stage, Tracer};
use pixels::{letterboxed, traced};
use program::{Program, wait_for};
use session::{
    DOWN, ENTER, ESCAPE, F1, HOME, LEFT, LEFT_BUTTON, RIGHT, RIGHT_BUTTON, SPACE, Session, UP,
    WHEEL_DOWN, WHEEL_UP,
};
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{ConnectionExt as _, CreateWindowAux, Window, WindowClass};
use xvfb::Xvfb;

/// How long anything may take that is waited for.
const DEADLINE: Duration = Duration::from_secs(30);

/// How long something is watched that must stay as it is.
const WATCH: Duration = Duration::from_secs(2);

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

#[test]
fn a_static_stage_after_the_playing_animation_starts_at_zero() {
    let Some(session) = Session::start(&["view", "--size", "50"]) else {
        return;
    };
    wait_for("α to move", || {
        (!session.title().contains("α = 0.000")).then_some(())
    });
    session.type_keys("6");
    session.shows(50, Stage::Reflection, 0.0);
}

#[test]
fn digits_of_the_keypad_choose_the_stage_without_num_lock_too() {
    let Some(session) = Session::start(&["view", "--stage", "6", "--size", "50"]) else {
        return;
    };
    // KP_End, KP_Down, … as they lie around the keypad.
    let keypad = [0xff9c, 0xff99, 0xff9b, 0xff96, 0xff9d, 0xff98];
    for (stage, keysym) in Stage::ALL.into_iter().zip(keypad) {
        let (keycode, _) = session.keycode(keysym);
        session.press_code(keycode);
        session.shows(50, stage, 0.0);
        session.type_keys("6");
        session.shows(50, Stage::Reflection, 0.0);
    }
}

#[test]
fn digits_choose_the_stage_where_the_digit_row_is_shifted() {
    let Some(session) = Session::start(&["view", "--stage", "6", "--size", "50"]) else {
        return;
    };
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
        session.shows(50, stage, 0.0);
        session.type_keys("6");
        session.shows(50, Stage::Reflection, 0.0);
        session.press_shifted(keycode);
        session.shows(50, stage, 0.0);
    }
}

#[test]
fn a_static_stage_is_traced_and_uploaded_once_and_then_sleeps() {
    let Some(mut session) = Session::start(&["view", "--stage", "4"]) else {
        return;
    };
    session.shows(500, Stage::Shading, 0.0);
    for stage in [Stage::Shadow, Stage::Reflection] {
        session.type_keys(&stage.number().to_string());
        session.shows(500, stage, 0.0);
        // Pressed again it is the same picture.
        session.type_keys(&stage.number().to_string());
    }
    sleeps(&session);
    session.press(ESCAPE);
    let [traces, uploads, draws] = session.program.left();
    assert_eq!([traces, uploads], [3, 3]);
    // One each, and a few that the window asked for when it appeared.
    assert!((3..=8).contains(&draws), "{draws} frames");
}

#[test]
fn a_picture_that_takes_long_keeps_the_window_from_nothing() {
    // Certified pictures of this size take many seconds; the first stage needs no arithmetic.
    let arguments = [
        "view",
        "--stage",
        "1",
        "--size",
        "3000",
        "--kernel",
        "reference",
    ];
    let Some(mut session) = Session::start(&arguments) else {
        return;
    };
    for stage in ["6", "5", "4", "6"] {
        session.type_keys(stage);
        session.titled(&[&format!("firsthit — {stage} ")]);
    }
    session.resize(300, 300);
    session.shows(3000, Stage::Image, 0.0);
    session.type_keys("q");
    let [traces, uploads, _] = session.program.left();
    assert_eq!(
        [traces, uploads],
        [1, 1],
        "the others were never waited for"
    );
}

#[test]
fn the_paused_animation_sleeps() {
    let Some(session) = Session::start(&["view", "--size", "50"]) else {
        return;
    };
    session.press(SPACE);
    session.titled(&["paused"]);
    sleeps(&session);
    let title = session.title();
    session.press(SPACE);
    wait_for("α to move on", || (session.title() != title).then_some(()));
}

#[test]
fn the_picture_keeps_its_aspect_in_any_window() {
    let Some(mut session) = Session::start(&["view", "--stage", "6", "--size", "120"]) else {
        return;
    };
    assert_eq!(session.size(), (120, 120));
    for (width, height) in [
        (500, 300), // twice, with bars left and right and below and above
        (360, 1000),
        (121, 122),
        (119, 700),
        (64, 48),
        (1, 1),
        (1, 300),
        (120, 120),
    ] {
        session.resize(width, height);
        session.shows(120, Stage::Reflection, 0.0);
        session.screenshot(&format!("viewer-{width}x{height}.png"));
    }
    session.type_keys("q");
    let [traces, uploads, _] = session.program.left();
    assert_eq!([traces, uploads], [1, 1], "a new size needs no new picture");
}

#[test]
fn a_picture_larger_than_the_monitor_opens_as_large_as_it_fits() {
    let Some(session) = Session::start(&["view", "--stage", "1", "--size", "1500"]) else {
        return;
    };
    assert_eq!(session.size(), (1024, 1024));
    session.shows(1500, Stage::Image, 0.0);
}

#[test]
fn a_window_made_an_icon_rests_and_comes_back() {
    let Some(session) = Session::start(&["view", "--size", "60"]) else {
        return;
    };
    session.titled(&["fps"]);
    session.iconify(true);
    rests(&session);
    let title = session.title();
    session.iconify(false);
    wait_for("α to move on", || (session.title() != title).then_some(()));
    session.type_keys("6");
    session.shows(60, Stage::Reflection, 0.0);
    session.iconify(true);
    session.iconify(false);
    session.shows(60, Stage::Reflection, 0.0);
}

#[test]
fn a_covered_window_rests_and_comes_back() {
    let Some(session) = Session::start(&["view", "--size", "60"]) else {
        return;
    };
    session.titled(&["fps"]);
    let cover = cover(&session);
    rests(&session);
    let title = session.title();
    session.connection.destroy_window(cover).unwrap();
    session.connection.flush().unwrap();
    wait_for("α to move on", || (session.title() != title).then_some(()));
}

/// Waits until the program does nothing at all.
fn sleeps(session: &Session) {
    wait_for("the program to sleep on", || {
        let before = session.program.activity();
        thread::sleep(WATCH);
        (session.program.activity() == before).then_some(())
    });
}

/// Waits until the animation stands still although it is not paused.
fn rests(session: &Session) {
    wait_for("the animation to rest", || {
        let title = session.title();
        thread::sleep(WATCH);
        (session.title() == title).then_some(())
    });
    assert!(!session.title().contains("paused"));
}

/// Puts a window over the whole screen.
fn cover(session: &Session) -> Window {
    let connection = &session.connection;
    let window = connection.generate_id().unwrap();
    let attributes = CreateWindowAux::new()
        .override_redirect(1)
        .background_pixel(0);
    connection
        .create_window(
            x11rb::COPY_DEPTH_FROM_PARENT,
            window,
            session.root,
            0,
            0,
            1280,
            1024,
            0,
            WindowClass::INPUT_OUTPUT,
            x11rb::COPY_FROM_PARENT,
            &attributes,
        )
        .unwrap();
    connection.map_window(window).unwrap().check().unwrap();
    window
}

#[test]
fn keys_turn_the_picture_to_the_angle_they_name() {
    let Some(mut session) = Session::start(&["view", "--stage", "6", "--size", "40"]) else {
        return;
    };
    let stage = Stage::Reflection;
    session.shows(40, stage, 0.0);
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
    session.type_keys("q");
    session.program.left();
}

#[test]
fn the_animation_plays_as_fast_as_it_is_told() {
    let moved = |session: &Session| {
        let before = session.alpha();
        thread::sleep(WATCH);
        (session.alpha() - before).abs()
    };
    let Some(slow) = Session::start(&["view", "--size", "40", "--speed", "0.0011"]) else {
        return;
    };
    slow.type_keys(&"+".repeat(60));
    wait_for("α to turn fast", || (moved(&slow) > 0.2).then_some(()));
    slow.type_keys(&"-".repeat(70));
    wait_for("α to turn slowly", || (moved(&slow) < 0.1).then_some(()));
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

    let Some(xvfb) = Xvfb::start(&[]) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let environment = [("DISPLAY", xvfb.display.as_str())];
    let mut program = Program::start(folder.path(), &arguments, &environment);
    assert_eq!(program.left(), [ROUND + 3; 3]);
}

#[test]
fn a_static_stage_leaves_after_its_frames_too() {
    let Some(xvfb) = Xvfb::start(&[]) else {
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
fn the_keys_are_said_at_the_start() {
    let Some(session) = Session::start(&["view", "--stage", "1", "--size", "40"]) else {
        return;
    };
    let table = firsthit::viewer::key_table();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(session.program.first_lines(lines.len()), lines);
}

#[test]
fn saving_never_overwrites() {
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
    session.type_keys("q");
    session.program.left();
}

#[test]
fn a_picture_that_cannot_be_saved_is_a_line_and_no_more() {
    let Some(mut session) = Session::start(&["view", "--stage", "6", "--size", "40"]) else {
        return;
    };
    fs::remove_dir(session.folder.path()).unwrap();
    session.type_keys("s5");
    session.shows(40, Stage::Shadow, 0.0);
    session.type_keys("q");
    let (status, errors) = session.program.ended();
    assert_eq!(status.code(), Some(0));
    assert!(errors.contains("firsthit-stage6-0001.png: "), "{errors}");
    assert_eq!(errors.lines().count(), 1);
}

#[test]
fn q_esc_and_the_window_manager_leave() {
    let leave: [fn(&Session); 3] = [
        |session| session.type_keys("q"),
        |session| session.press(ESCAPE),
        Session::close,
    ];
    for leave in leave {
        let Some(mut session) = Session::start(&["view", "--size", "40"]) else {
            return;
        };
        leave(&session);
        session.program.left();
    }
}

#[test]
fn the_wheel_zooms_around_the_pointer_and_dragging_moves() {
    let Some(mut session) = Session::start(&["view", "--stage", "6", "--size", "40"]) else {
        return;
    };
    session.resize(400, 300);
    session.shows(40, Stage::Reflection, 0.0);
    let picture = traced(40, Stage::Reflection, 0.0);
    // Seven times, and so 60 and 10 pixels from the window's corner; the pixel of the picture under the pointer stays.
    let pointer = [151, 300 - 1 - 82];
    session.point(151, 82);
    // winit counts a faked wheel's way back as well: two notches, 8 times and 10 times.
    session.click(WHEEL_UP);
    let kept = |pointer: i64, margin: i64| {
        let mut corner = margin;
        for [from, to] in [[7, 8], [8, 10]] {
            let (pixel, within) = ((pointer - corner) / from, (pointer - corner) % from);
            corner = pointer - (to * pixel + (2 * within + 1) * to / (2 * from));
        }
        corner
    };
    let corner = [kept(pointer[0], 60), kept(pointer[1], 10)];
    session.shows_placed(&picture, corner, 10 * 40);
    // Nine pixels to the right and twenty down.
    session.button(LEFT_BUTTON, true);
    for step in 1..=9 {
        session.point(151 + step, 82 + 2 * step);
    }
    session.point(160, 102);
    session.button(LEFT_BUTTON, false);
    session.point(200, 200);
    session.shows_placed(&picture, [corner[0] + 9, corner[1] - 20], 10 * 40);
    session.type_keys("z");
    session.shows(40, Stage::Reflection, 0.0);
    session.click(WHEEL_DOWN);
    session.shows(40, Stage::Reflection, 0.0);
    session.type_keys("q");
    let [traces, uploads, _] = session.program.left();
    assert_eq!([traces, uploads], [1, 1]);
}

#[test]
fn the_menu_is_for_keys_and_mouse_and_esc_closes_it_first() {
    let Some(mut session) = Session::start(&["view", "--stage", "6"]) else {
        return;
    };
    let six = Stage::Reflection;
    session.shows(500, six, 0.0);
    session.type_keys("m");
    session.covers(500, six, 0.0, 30, "viewer-menu.png");
    session.press(ESCAPE);
    session.shows(500, six, 0.0);
    // Five down: the fifth stage. Twice up from the top: around to the last but one.
    session.type_keys("m");
    for _ in 0..5 {
        session.press(DOWN);
    }
    session.press(ENTER);
    session.shows(500, Stage::Shadow, 0.0);
    session.type_keys("m");
    session.press(UP);
    session.press(UP);
    session.press(ENTER);
    session.covers(500, Stage::Shadow, 0.0, 30, "viewer-help.png");
    session.press(ESCAPE);
    session.shows(500, Stage::Shadow, 0.0);
    // The first row lies just below the pointer.
    session.point(20, 20);
    session.click(RIGHT_BUTTON);
    session.covers(500, Stage::Shadow, 0.0, 30, "viewer-menu-by-mouse.png");
    session.point(60, 34);
    session.click(LEFT_BUTTON);
    session.shows(500, Stage::Image, 0.0);
    // A click beside it takes nothing; a key does what it always does.
    session.click(RIGHT_BUTTON);
    session.covers(500, Stage::Image, 0.0, 30, "viewer-menu-by-mouse.png");
    session.point(490, 490);
    session.click(LEFT_BUTTON);
    session.shows(500, Stage::Image, 0.0);
    session.press(F1);
    session.covers(500, Stage::Image, 0.0, 30, "viewer-help.png");
    session.type_keys("h6");
    session.shows(500, six, 0.0);
    session.press(ESCAPE);
    let [traces, uploads, _] = session.program.left();
    assert_eq!(
        [traces, uploads],
        [4, 4],
        "what lies over a picture changes none"
    );
}

#[test]
fn information_and_the_pixel_under_the_pointer_come_and_go() {
    let Some(mut session) = Session::start(&["view", "--stage", "6"]) else {
        return;
    };
    session.type_keys("i");
    session.point(255, 297);
    session.covers(500, Stage::Reflection, 0.0, 10, "viewer-information.png");
    sleeps(&session);
    session.type_keys("i");
    session.shows(500, Stage::Reflection, 0.0);
    session.type_keys("q");
    let [traces, uploads, _] = session.program.left();
    assert_eq!([traces, uploads], [1, 1]);
}

#[test]
fn the_pixel_under_the_pointer_is_named_while_it_moves() {
    let Some(mut session) = Session::start(&["view", "--stage", "6"]) else {
        return;
    };
    session.resize(700, 500);
    let picture = traced(500, Stage::Reflection, 0.0);
    let clean = letterboxed(&picture, 700, 500);
    session.shows(500, Stage::Reflection, 0.0);
    // At the top, or at the bottom where the pointer is at the top: the pixel itself is not hidden.
    for (y, named, free) in [(297, 0..30, 30..500), (3, 470..500, 0..470)] {
        session.point(355, y);
        wait_for("the pixel's name", || {
            let shown = session.pixels()?;
            let far = shown.differences(&clean, free.clone());
            (far == 0 && shown.differences(&clean, named.clone()) > 4000).then_some(())
        });
        session.screenshot(&format!("viewer-named-{y}.png"));
    }
    session.shows(500, Stage::Reflection, 0.0);
    sleeps(&session);
    // Beside the picture there is no pixel to name, and none any more once the pointer has left it.
    session.point(20, 250);
    session.shows(500, Stage::Reflection, 0.0);
    session.type_keys("q");
    let [traces, uploads, _] = session.program.left();
    assert_eq!([traces, uploads], [1, 1]);
}

#[test]
fn a_click_works_the_pixel_through_as_explain_does() {
    let Some(mut session) = Session::start(&["view", "--stage", "6"]) else {
        return;
    };
    session.shows(500, Stage::Reflection, 0.0);
    session.point(255, 499 - 202);
    session.click(LEFT_BUTTON);
    let tracer = Tracer::new(Kernel::default(), 1).unwrap();
    let text = tracer.explain(&Scene::builtin(), Stage::Reflection, 0.0, 500, (255, 202));
    let text = text.unwrap();
    for line in text.lines() {
        assert_eq!(session.program.line(line), line);
    }
    session.covers(500, Stage::Reflection, 0.0, 30, "viewer-inspected.png");
    session.press_ctrl(u32::from('c'));
    assert_eq!(session.clipboard(), text);
    session.screenshot("viewer-copied.png");
    session.press(ESCAPE);
    session.shows(500, Stage::Reflection, 0.0);
    // Nothing is there to be copied: what was copied stays.
    session.press_ctrl(u32::from('c'));
    session.covers(500, Stage::Reflection, 0.0, 1, "viewer-nothing-to-copy.png");
    assert_eq!(session.clipboard(), text);
    session.type_keys("q");
    session.program.left();
}

#[test]
fn what_was_saved_is_said_in_the_window_for_a_while() {
    let Some(session) = Session::start(&["view", "--stage", "6"]) else {
        return;
    };
    session.shows(500, Stage::Reflection, 0.0);
    session.type_keys("s");
    session.covers(500, Stage::Reflection, 0.0, 1, "viewer-saved.png");
    session.shows(500, Stage::Reflection, 0.0);
    sleeps(&session);
}

#[test]
fn the_error_view_shows_where_a_kernel_is_wrong() {
    let arguments = [
        "view", "--stage", "6", "--size", "300", "--kernel", "listing",
    ];
    let Some(mut session) = Session::start(&arguments) else {
        return;
    };
    session.resize(600, 600);
    session.type_keys("e");
    // Away from the panel in the corner: false colours, each pixel of the picture four of the window.
    let counts = |session: &Session, color| {
        let pixels = session.pixels().unwrap();
        let upper = pixels.bytes.iter().take(600 * 400);
        upper.filter(|&&pixel| pixel == color).count()
    };
    let wrong = [0, 255, 0];
    wait_for("wrong decisions", || {
        (counts(&session, wrong) > 10_000).then_some(())
    });
    session.screenshot("viewer-errors-listing.png");
    session.type_keys("kk");
    wait_for("no error at all", || {
        (counts(&session, [0; 3]) == 600 * 400).then_some(())
    });
    session.screenshot("viewer-errors-exact.png");
    session.type_keys("e");
    session.shows(300, Stage::Reflection, 0.0);
    session.type_keys("q");
    session.program.left();
}

#[test]
fn a_storm_of_resizes_ends_in_the_right_picture() {
    let Some(mut session) = Session::start(&["view", "--stage", "6", "--size", "120"]) else {
        return;
    };
    session.type_keys("i");
    for step in 0..300_u32 {
        session.resize(1 + step * 37 % 900, 1 + step * 53 % 700);
    }
    session.type_keys("i");
    session.resize(377, 251);
    wait_for("the size", || (session.size() == (377, 251)).then_some(()));
    session.shows(120, Stage::Reflection, 0.0);
    session.type_keys("q");
    let [traces, uploads, _] = session.program.left();
    assert_eq!([traces, uploads], [1, 1]);
}

/// How long the viewer is used at random, in seconds: so many as this variable says.
const SOAK: &str = "FIRSTHIT_SOAK_SECONDS";

#[test]
fn used_at_random_it_stays_well_and_its_memory_bounded() {
    let Some(mut session) = Session::start(&["view", "--size", "200"]) else {
        return;
    };
    let seconds = std::env::var(SOAK).map_or(10, |seconds| seconds.parse().unwrap());
    let start = Instant::now();
    // Always the same choices: Knuth's generator in 64 bits.
    let mut state = 1_u64;
    let mut random = |below: u64| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % below
    };
    let keys = b"1234567 .,+-0ekimhz";
    let mut settled = None;
    while start.elapsed() < Duration::from_secs(seconds) {
        match random(12) {
            0 => session.resize(1 + random(700) as u32, 1 + random(700) as u32),
            1 => session.point(random(300) as i16, random(300) as i16),
            2 => session.click(if random(2) == 0 { WHEEL_UP } else { WHEEL_DOWN }),
            3 => session.click(RIGHT_BUTTON),
            4 => session.press(if random(2) == 0 { UP } else { DOWN }),
            5 => session.press(if random(2) == 0 { LEFT } else { RIGHT }),
            _ => session.press(u32::from(keys[random(keys.len() as u64) as usize])),
        }
        thread::sleep(Duration::from_millis(5));
        // By then everything has been open once.
        if settled.is_none() && start.elapsed() > Duration::from_secs(seconds / 2) {
            settled = Some(session.program.memory());
        }
    }
    let (settled, end) = (settled.unwrap(), session.program.memory());
    assert!(
        end < settled + 64 * 1024,
        "{settled} KiB, and then {end} KiB"
    );
    // It still does what it is told, whatever is open: Esc closes one thing after another, and then leaves.
    session.close();
    session.program.left();
}

#[test]
fn a_dense_display_gets_the_same_pixels_and_a_menu_twice_as_large() {
    let Some(xvfb) = Xvfb::start(&[]) else {
        return;
    };
    let dense = ("WINIT_X11_SCALE_FACTOR", "2");
    let session = Session::on(xvfb, &["view", "--stage", "6"], &[dense]);
    session.shows(500, Stage::Reflection, 0.0);
    session.point(20, 20);
    session.click(RIGHT_BUTTON);
    session.covers(500, Stage::Reflection, 0.0, 30, "viewer-menu-dense.png");
    // In the middle of the second row, 16 points below that of the first.
    session.point(100, 20 + 2 * (14 + 16));
    session.click(LEFT_BUTTON);
    session.shows(500, Stage::Spheres, 0.0);
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

#[test]
fn k_goes_through_the_kernels() {
    let Some(mut session) = Session::start(&["view", "--stage", "6", "--size", "40"]) else {
        return;
    };
    let kernels = ["fast", "double", "listing", "reference", "exact"];
    for kernel in kernels {
        session.type_keys("k");
        session.titled(&[&format!("— {kernel} —")]);
    }
    session.shows(40, Stage::Reflection, 0.0);
    session.type_keys("q");
    session.program.left();
}

/// The program, on a display that cannot be had, says so in one line and ends with status 1.
fn refused(environment: &[(&str, &str)], parts: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let mut viewer = Program::start(folder.path(), &["view"], environment);
    let (status, errors) = viewer.ended();
    assert_eq!(status.code(), Some(1), "{errors}");
    assert_eq!(errors.lines().count(), 1, "{errors}");
    for part in parts.iter().chain(&["firsthit capture"]) {
        assert!(errors.contains(part), "{part} is not in {errors}");
    }
}

#[test]
fn no_display_is_one_line() {
    refused(&[], &["WAYLAND_DISPLAY", "DISPLAY"]);
    refused(&[("DISPLAY", "")], &["WAYLAND_DISPLAY", "DISPLAY"]);
    refused(&[("DISPLAY", ":64000")], &["DISPLAY=:64000"]);
}

#[test]
fn no_wayland_display_is_one_line() {
    // Without Wayland's libraries that is the line, whatever the display.
    for library in ["libwayland-client.so.0", "libwayland-egl.so.1"] {
        // SAFETY: Wayland's libraries run no code of consequence when they are loaded.
        if let Err(error) = unsafe { libloading::Library::new(library) } {
            assert!(std::env::var_os("CI").is_none(), "{library}: {error}");
            eprintln!(
                "skipped: no {library} ({error}); Debian packages: libwayland-client0 libwayland-egl1"
            );
            return;
        }
    }
    let nowhere = "/nowhere/wayland-0";
    refused(
        &[("WAYLAND_DISPLAY", nowhere)],
        &[&format!("WAYLAND_DISPLAY={nowhere}")],
    );
}

#[test]
fn a_server_without_what_a_window_needs_is_one_line() {
    let Some(xvfb) = Xvfb::start(&["-extension", "RANDR"]) else {
        return;
    };
    refused(&[("DISPLAY", &xvfb.display)], &["RANDR"]);
}

#[test]
fn x11_serves_where_wayland_is_named_but_not_there() {
    let Some(xvfb) = Xvfb::start(&[]) else {
        return;
    };
    let nowhere = ("WAYLAND_DISPLAY", "/nowhere/wayland-0");
    let session = Session::on(xvfb, &["view", "--stage", "6", "--size", "40"], &[nowhere]);
    session.shows(40, Stage::Reflection, 0.0);
}

/// An X server on which OpenGL goes another way: EGL instead of GLX.
const WITHOUT_GLX: [&str; 2] = ["-extension", "GLX"];

#[test]
fn egl_serves_where_the_server_has_no_glx() {
    let Some(xvfb) = Xvfb::start(&WITHOUT_GLX) else {
        return;
    };
    let session = Session::on(xvfb, &["view", "--stage", "6", "--size", "120"], &[]);
    session.shows(120, Stage::Reflection, 0.0);
    session.resize(500, 300);
    session.shows(120, Stage::Reflection, 0.0);
    session.type_keys("5");
    session.shows(120, Stage::Shadow, 0.0);
}

#[test]
fn the_death_of_the_server_is_one_line() {
    for server in [&[][..], &WITHOUT_GLX] {
        for stage in ["6", "7"] {
            let Some(xvfb) = Xvfb::start(server) else {
                return;
            };
            // Large enough that Mesa sends it to the server in parts.
            let arguments = ["view", "--stage", stage, "--size", "300"];
            let mut session = Session::on(xvfb, &arguments, &[]);
            session.crash_server();
            let (status, errors) = session.program.ended();
            assert_eq!(status.code(), Some(1), "{errors}");
            assert_eq!(errors.lines().count(), 1, "{errors}");
            assert!(errors.contains("the display went away"), "{errors}");
        }
    }
}
