//! What lies over the picture: menu, keys, information, a clicked pixel, messages, and the error view in its place.

use firsthit::{Kernel, Scene, Stage, Tracer};

use super::pixels::{letterboxed, traced};
use super::program::wait_for;
use super::session::{DOWN, ENTER, ESCAPE, F1, LEFT_BUTTON, RIGHT_BUTTON, Session, UP};
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
fn information_and_the_pixel_under_the_pointer_come_and_go() {
    let Some(mut session) = Session::start(&["view", "--stage", "6"]) else {
        return;
    };
    session.type_keys("i");
    session.point(255, 297);
    session.covers(500, Stage::Reflection, 0.0, 10, "viewer-information.png");
    session.program.sleeps();
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
    session.program.sleeps();
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
    session.program.sleeps();
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
fn a_single_wrong_pixel_is_seen() {
    let Some(session) = Session::start(&["view", "--stage", "6", "--kernel", "fast"]) else {
        return;
    };
    session.type_keys("e");
    // Only the touching ray at column 255, row 202 is decided wrongly: a ring around it.
    let green = |left: usize, top: usize, side: usize| {
        let pixels = session.pixels().unwrap();
        let rows = pixels.bytes.chunks(pixels.width).skip(top).take(side);
        let square = rows.flat_map(|row| &row[left..left + side]);
        square
            .filter(|&&[r, g, b]| g > 200 && r < 60 && b < 60)
            .count()
    };
    wait_for("a ring", || {
        (green(255 - 8, 499 - 202 - 8, 17) > 12).then_some(())
    });
    assert_eq!(green(255, 499 - 202, 1), 1);
    assert_eq!(green(0, 0, 280), 0);
    session.screenshot("viewer-errors-fast.png");
}
