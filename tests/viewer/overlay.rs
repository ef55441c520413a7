//! What is written beside the picture and over it: keys, information, a clicked pixel, the menu,
//! messages, and the error view.

use std::fs;

use firsthit::{Kernel, Scene, Stage, Tracer};
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{AtomEnum, PropMode};
use x11rb::wrapper::ConnectionExt as _;

use super::pixels::{letterboxed, traced};
use super::program::wait_for;
use super::session::{
    DOWN, ENTER, ESCAPE, F1, LEFT_BUTTON, PAGE_DOWN, PAGE_UP, PANEL_WIDTH, RIGHT_BUTTON, Session,
    UP, WHEEL_DOWN,
};
use super::xvfb::Xvfb;

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
    let shadow = (500, Stage::Shadow, 0.0);
    session.shows_beside_panel(500, shadow, None, "viewer-help.png");
    assert_eq!(session.size(), (500 + PANEL_WIDTH, 500));
    session.press(ESCAPE);
    session.becomes(500, 500);
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
    let image = (500, Stage::Image, 0.0);
    session.shows_beside_panel(500, image, None, "viewer-help.png");
    session.type_keys("h6");
    session.becomes(500, 500);
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
fn a_dense_display_gets_twice_the_pixels_and_a_menu_twice_as_large() {
    let Some(xvfb) = Xvfb::start(&[]) else {
        return;
    };
    // As a desktop says it: a resource of the X server.
    let (connection, screen) = x11rb::connect(Some(&xvfb.display)).unwrap();
    let root = connection.setup().roots[screen].root;
    let (resources, dense) = (AtomEnum::RESOURCE_MANAGER, b"Xft.dpi:\t192\n");
    let (mode, text) = (PropMode::REPLACE, AtomEnum::STRING);
    let changed = connection.change_property8(mode, root, resources, text, dense);
    changed.unwrap().check().unwrap();
    let session = Session::on(xvfb, &["view", "--stage", "6"], &[]);
    assert_eq!(session.size(), (1000, 1000));
    session.shows(500, Stage::Reflection, 0.0);
    session.point(20, 20);
    session.click(RIGHT_BUTTON);
    session.covers(500, Stage::Reflection, 0.0, 30, "viewer-menu-dense.png");
    // In the middle of the second row, 16 points below that of the first.
    session.point(100, 20 + 2 * (3 + 16 + 8));
    session.click(LEFT_BUTTON);
    session.shows(500, Stage::Spheres, 0.0);
}

#[test]
fn every_scale_factor_has_its_window_and_its_panel() {
    // N logical pixels a side; the picture in whole multiples, and what they leave is for the
    // panel.
    for (scale, side, extent, character) in [
        ("1", 300, 300, 7),
        ("1.5", 450, 300, 11),
        ("2", 600, 600, 14),
    ] {
        let Some(xvfb) = Xvfb::lent_with(&["-screen", "0", "1920x1080x24"]) else {
            return;
        };
        let arguments = ["view", "--stage", "6", "--size", "300"];
        let mut session = Session::on(xvfb, &arguments, &[("WINIT_X11_SCALE_FACTOR", scale)]);
        assert_eq!(session.size(), (side, side), "at scale {scale}");
        let picture = (300, Stage::Reflection, 0.0);
        session.shows(300, Stage::Reflection, 0.0);
        session.type_keys("h");
        let high = 26 * 2 * character + 2 * character;
        session.becomes(extent + 56 * character, side.max(high));
        session.shows_beside_panel(extent, picture, None, &format!("viewer-keys-{scale}.png"));
        session.type_keys("h");
        session.becomes(side, side);
        session.shows(300, Stage::Reflection, 0.0);
        session.type_keys("q");
        session.program.left();
    }
}

/// What is written for a while: each promise begins and ends with the picture alone.
#[test]
fn what_is_written_comes_and_goes() {
    let Some(mut session) = Session::start(&["view", "--stage", "6"]) else {
        return;
    };
    session.shows(500, Stage::Reflection, 0.0);
    information_and_the_pixel_under_the_pointer_come_and_go(&session);
    the_pixel_under_the_pointer_is_named_while_it_moves(&session);
    a_click_works_the_pixel_through_as_explain_does(&session);
    what_was_saved_is_said_in_the_window_for_a_while(&session);
    in_a_window_that_does_not_grow_the_panel_takes_half_and_scrolls(&session);
    session.type_keys("q");
    let [traces, uploads, _] = session.program.left();
    assert_eq!([traces, uploads], [1, 1], "one picture is enough for all");
}

fn in_a_window_that_does_not_grow_the_panel_takes_half_and_scrolls(session: &Session) {
    let picture = (500, Stage::Reflection, 0.0);
    session.type_keys("h");
    session.becomes(500 + PANEL_WIDTH, 500);
    session.resize(500, 500);
    session.shows_beside_panel(250, picture, None, "viewer-keys-500.png");
    let panel = || session.pixels().unwrap().part([250, 0], [250, 500]);
    let first = panel();
    for (name, scroll) in [("wheel", WHEEL_DOWN), ("page", 0)] {
        if scroll == 0 {
            session.press(PAGE_DOWN);
        } else {
            session.point(400, 300);
            session.click(scroll);
        }
        wait_for("other lines", || (panel() != first).then_some(()));
        session.screenshot(&format!("viewer-keys-scrolled-{name}.png"));
        session.press(PAGE_UP);
        session.point(100, 20);
        wait_for("the first lines", || (panel() == first).then_some(()));
    }
    // Below the picture, where the window is taller than wide.
    session.resize(400, 900);
    let below = || {
        let shown = session.pixels()?;
        let picture = letterboxed(&traced(500, Stage::Reflection, 0.0), 400, 400);
        let upper = shown.part([0, 0], [400, 400]);
        (upper.differences(&picture, 0..400) == 0).then_some(())
    };
    wait_for("the picture above the panel", below);
    session.screenshot("viewer-keys-below.png");
    // It was given another size: closing the panel changes it no more.
    session.type_keys("h");
    session.shows(500, Stage::Reflection, 0.0);
    assert_eq!(session.size(), (400, 900));
}

#[test]
fn esc_closes_what_is_open_then_leaves_full_screen_then_the_program() {
    let Some(mut session) = Session::start(&["view", "--stage", "6", "--size", "40"]) else {
        return;
    };
    session.resize(700, 400);
    session.type_keys("fh");
    let open = || {
        session
            .pixels()
            .map(|shown| shown.count([24, 24, 30]) > 5000)
    };
    wait_for("the keys", || open().filter(|open| *open));
    session.press(ESCAPE);
    session.shows(40, Stage::Reflection, 0.0);
    session.press(ESCAPE);
    session.type_keys("5");
    session.shows(40, Stage::Shadow, 0.0);
    session.press(ESCAPE);
    session.program.left();
}

fn information_and_the_pixel_under_the_pointer_come_and_go(session: &Session) {
    let picture = (500, Stage::Reflection, 0.0);
    session.type_keys("i");
    session.point(255, 297);
    session.shows_beside_panel(500, picture, None, "viewer-information.png");
    session.program.sleeps();
    session.type_keys("i");
    session.becomes(500, 500);
    session.shows(500, Stage::Reflection, 0.0);
}

fn the_pixel_under_the_pointer_is_named_while_it_moves(session: &Session) {
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
    session.program.sleeps();
    // Beside the picture there is no pixel to name, and none any more once the pointer has left it.
    session.point(20, 250);
    session.shows(500, Stage::Reflection, 0.0);
    session.resize(500, 500);
    session.shows(500, Stage::Reflection, 0.0);
}

fn a_click_works_the_pixel_through_as_explain_does(session: &Session) {
    session.point(255, 499 - 202);
    session.click(LEFT_BUTTON);
    let tracer = Tracer::new(Kernel::default(), 1).unwrap();
    let text = tracer.explain(&Scene::builtin(), Stage::Reflection, 0.0, 500, (255, 202));
    let text = text.unwrap();
    for line in text.lines() {
        assert_eq!(session.program.line(line), line);
    }
    let picture = (500, Stage::Reflection, 0.0);
    let ringed = Some([255, 499 - 202]);
    session.shows_beside_panel(500, picture, ringed, "viewer-inspected.png");
    session.press_ctrl(u32::from('c'));
    assert_eq!(session.clipboard(), text);
    session.screenshot("viewer-copied.png");
    session.press(ESCAPE);
    session.becomes(500, 500);
    session.shows(500, Stage::Reflection, 0.0);
    // Nothing is there to be copied: what was copied stays.
    session.press_ctrl(u32::from('c'));
    session.covers(500, Stage::Reflection, 0.0, 1, "viewer-nothing-to-copy.png");
    assert_eq!(session.clipboard(), text);
    session.shows(500, Stage::Reflection, 0.0);
}

fn what_was_saved_is_said_in_the_window_for_a_while(session: &Session) {
    session.type_keys("s");
    session.covers(500, Stage::Reflection, 0.0, 1, "viewer-saved.png");
    session.shows(500, Stage::Reflection, 0.0);
    session.program.sleeps();
}

#[test]
fn what_could_not_be_saved_is_said_to_its_end_in_a_narrow_window() {
    let Some(mut session) = Session::start(&["view", "--stage", "6"]) else {
        return;
    };
    session.shows(500, Stage::Reflection, 0.0);
    fs::remove_dir(session.folder.path()).unwrap();
    session.type_keys("s");
    session.covers(500, Stage::Reflection, 0.0, 5, "viewer-not-saved.png");
    let shown = session.pixels().unwrap();
    session.type_keys("q");
    let (_, error) = session.program.ended();
    // The note's rows, the lowest ones of the window: a margin, lines of 69 characters, a margin.
    let clean = letterboxed(&traced(500, Stage::Reflection, 0.0), 500, 500);
    let rows = (0..500).filter(|&row| shown.differences(&clean, row..row + 1) > 0);
    let lines = (rows.count() - 14) / 14;
    let (_, said) = error.trim_end().split_once("not saved: ").unwrap();
    let needed = ("not saved: ".len() + said.chars().count()).div_ceil(69);
    assert!(
        (needed..=needed + 1).contains(&lines),
        "{lines} lines for {error}"
    );
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
    // False colours, each pixel of the picture four of the window, beside the scale.
    session.becomes(600 + PANEL_WIDTH, 600);
    let count = |color| {
        let shown = session.pixels().unwrap();
        shown.part([0, 0], [600, 600]).count(color)
    };
    // Shadows that are missing in blue, mirror images that are not there in white.
    wait_for("wrong decisions", || {
        (count([0, 90, 255]) > 10_000 && count([255; 3]) > 100).then_some(())
    });
    session.screenshot("viewer-errors-listing.png");
    session.type_keys("kk");
    wait_for("no error at all", || {
        (count([0; 3]) == 600 * 600).then_some(())
    });
    session.screenshot("viewer-errors-exact.png");
    session.type_keys("e");
    session.shows(300, Stage::Reflection, 0.0);
    session.type_keys("q");
    session.program.left();
}

#[test]
fn the_error_view_comes_and_goes_as_often_as_it_is_asked_for() {
    // Of a static stage, and of an animation that plays on the spot.
    for arguments in [["--stage", "6"], ["--speed", "0"]] {
        let arguments = [&["view", "--size", "100"], &arguments[..]].concat();
        let Some(mut session) = Session::start(&arguments) else {
            return;
        };
        session.resize(600, 600);
        let picture = letterboxed(&traced(100, Stage::Reflection, 0.0), 600, 600);
        for _ in 0..3 {
            session.type_keys("e");
            session.becomes(600 + PANEL_WIDTH, 600);
            wait_for("no error at all", || {
                let shown = session.pixels()?.part([0, 0], [600, 600]);
                (shown.count([0; 3]) == 600 * 600).then_some(())
            });
            session.type_keys("e");
            session.becomes(600, 600);
            wait_for("the picture", || {
                (session.pixels()?.differences(&picture, 0..600) == 0).then_some(())
            });
        }
        session.type_keys("q");
        session.program.left();
    }
}

#[test]
fn a_single_wrong_pixel_is_ringed() {
    let Some(session) = Session::start(&["view", "--stage", "6", "--kernel", "fast"]) else {
        return;
    };
    session.type_keys("e");
    // Only the touching ray at column 255, row 202 is decided wrongly, and mirrors another thing:
    // a white ring around it.
    let mirror = [255; 3];
    let part = |place: [usize; 2], side: usize| {
        let pixels = session.pixels().unwrap();
        pixels.part(place, [side, side]).count(mirror)
    };
    wait_for("a ring", || {
        (part([255 - 8, 499 - 202 - 8], 17) > 12).then_some(())
    });
    assert_eq!(part([255, 499 - 202], 1), 1);
    // The ring of 11 × 11 pixels, a pixel wide, and the pixel itself.
    assert_eq!(part([0, 0], 500), 40 + 1);
    session.screenshot("viewer-errors-fast.png");
}
