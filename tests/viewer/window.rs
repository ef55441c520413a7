//! The picture in its window: of any size, hidden, zoomed, and at rest while nothing changes.

use std::thread;

use firsthit::Stage;
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{AtomEnum, ConnectionExt as _, CreateWindowAux, Window, WindowClass};

use super::WATCH;
use super::pixels::{letterboxed, traced};
use super::program::wait_for;
use super::session::{ESCAPE, LEFT_BUTTON, SPACE, Session, WHEEL_DOWN, WHEEL_UP};

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
    session.program.sleeps();
    session.press(ESCAPE);
    let [traces, uploads, draws] = session.program.left();
    assert_eq!([traces, uploads], [3, 3]);
    // One each, and a few that the window asked for when it appeared.
    assert!((3..=8).contains(&draws), "{draws} frames");
}

#[test]
fn a_desktop_gets_the_name_and_the_icon_of_the_window() {
    let Some(session) = Session::start(&["view", "--stage", "1"]) else {
        return;
    };
    a_desktop_knows_the_window_by_the_name_of_the_program(&session);
    a_desktop_gets_a_small_picture_as_the_icon_of_the_window(&session);
}

fn a_desktop_knows_the_window_by_the_name_of_the_program(session: &Session) {
    let (class, text) = (AtomEnum::WM_CLASS, AtomEnum::STRING);
    let connection = &session.connection;
    let property = connection.get_property(false, session.window, class, text, 0, 100);
    let value = property.unwrap().reply().unwrap().value;
    assert_eq!(value, b"firsthit\0firsthit\0");
}

fn a_desktop_gets_a_small_picture_as_the_icon_of_the_window(session: &Session) {
    let connection = &session.connection;
    let name = connection.intern_atom(false, b"_NET_WM_ICON").unwrap();
    let (name, kind) = (name.reply().unwrap().atom, AtomEnum::CARDINAL);
    let property = connection.get_property(false, session.window, name, kind, 0, u32::MAX);
    let property = property.unwrap().reply().unwrap();
    let numbers: Vec<u32> = property.value32().unwrap().collect();
    // Width, height, and each pixel as ARGB, rows from the top.
    assert_eq!(numbers[..2], [64, 64]);
    let pixels = letterboxed(&traced(64, Stage::Reflection, 0.0), 64, 64).bytes;
    let expected = pixels.into_iter().map(|[r, g, b]| [0xff, r, g, b]);
    let expected: Vec<u32> = expected.map(u32::from_be_bytes).collect();
    assert_eq!(numbers[2..], expected);
}

#[test]
fn a_picture_that_takes_long_keeps_the_window_from_nothing() {
    // Certified pictures of this size take seconds; the first stage needs no arithmetic.
    let arguments = [
        "view",
        "--stage",
        "1",
        "--size",
        "2000",
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
    session.shows(2000, Stage::Image, 0.0);
    session.type_keys("q");
    let [traces, uploads, _] = session.program.left();
    assert_eq!(
        [traces, uploads],
        [1, 1],
        "the others were never waited for"
    );
}

/// Each promise begins with the animation playing, and all but the last end so.
#[test]
fn an_animation_that_is_paused_or_not_seen_rests_and_plays_on() {
    let Some(mut session) = Session::start(&["view", "--size", "60"]) else {
        return;
    };
    session.titled(&["fps"]);
    the_paused_animation_sleeps(&session);
    a_covered_window_rests_and_comes_back(&session);
    a_window_on_another_workspace_sleeps_and_comes_back(&session);
    a_window_made_an_icon_rests_and_comes_back(&session);
    session.close();
    session.program.left();
}

fn moves_on(session: &Session) {
    let title = session.title();
    wait_for("α to move on", || (session.title() != title).then_some(()));
}

fn the_paused_animation_sleeps(session: &Session) {
    session.press(SPACE);
    session.titled(&["paused"]);
    session.program.sleeps();
    session.press(SPACE);
    moves_on(session);
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
    a_storm_of_resizes_ends_in_the_right_picture(&session);
    session.type_keys("q");
    let [traces, uploads, _] = session.program.left();
    assert_eq!([traces, uploads], [1, 1], "a new size needs no new picture");
}

fn a_storm_of_resizes_ends_in_the_right_picture(session: &Session) {
    session.type_keys("i");
    for step in 0..300_u32 {
        session.resize(1 + step * 37 % 900, 1 + step * 53 % 700);
    }
    session.type_keys("i");
    session.resize(377, 251);
    wait_for("the size", || (session.size() == (377, 251)).then_some(()));
    session.shows(120, Stage::Reflection, 0.0);
}

#[test]
fn a_picture_larger_than_the_monitor_opens_as_large_as_it_fits() {
    let Some(session) = Session::start(&["view", "--stage", "1", "--size", "1500"]) else {
        return;
    };
    assert_eq!(session.size(), (1024, 1024));
    session.shows(1500, Stage::Image, 0.0);
}

fn a_window_made_an_icon_rests_and_comes_back(session: &Session) {
    session.iconify(true);
    rests(session);
    session.iconify(false);
    moves_on(session);
    // A static stage after the playing animation starts at 0.
    session.type_keys("6");
    session.shows(60, Stage::Reflection, 0.0);
    session.iconify(true);
    session.iconify(false);
    session.shows(60, Stage::Reflection, 0.0);
}

fn a_covered_window_rests_and_comes_back(session: &Session) {
    let cover = open_window(session, 1280, 1024);
    rests(session);
    session.connection.destroy_window(cover).unwrap();
    session.connection.flush().unwrap();
    moves_on(session);
}

fn a_window_on_another_workspace_sleeps_and_comes_back(session: &Session) {
    // A window manager's frame around the window, which it unmaps with its workspace.
    let frame = open_window(session, 300, 300);
    let (connection, window) = (&session.connection, session.window);
    let reparented = connection.reparent_window(window, frame, 10, 10);
    reparented.unwrap().check().unwrap();
    for _ in 0..2 {
        moves_on(session);
        connection.unmap_window(frame).unwrap().check().unwrap();
        rests(session);
        session.program.sleeps();
        connection.map_window(frame).unwrap().check().unwrap();
    }
    let reparented = connection.reparent_window(window, session.root, 0, 0);
    reparented.unwrap().check().unwrap();
    connection.destroy_window(frame).unwrap().check().unwrap();
    moves_on(session);
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

/// Opens a window of this size in the upper left corner of the screen, over all others.
fn open_window(session: &Session, width: u16, height: u16) -> Window {
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
            width,
            height,
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
fn the_wheel_zooms_around_the_pointer_and_dragging_moves() {
    let Some(mut session) = Session::start(&["view", "--stage", "6", "--size", "40"]) else {
        return;
    };
    session.resize(400, 300);
    session.shows(40, Stage::Reflection, 0.0);
    let picture = traced(40, Stage::Reflection, 0.0);
    // Seven times, and so 60 and 10 pixels from the window's corner; the pixel of the picture under
    // the pointer stays.
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
