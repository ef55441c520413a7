//! `compare --show`: two pictures and their difference in a window.

use std::fs;

use firsthit::difference::{error_color, steps};
use firsthit::image::Raster;
use firsthit::{Image, Stage};
use tempfile::TempDir;

use super::pixels::{letterboxed, traced};
use super::program::{Program, wait_for};
use super::session::{ESCAPE, LEFT_BUTTON, PANEL_WIDTH, Session, WHEEL_UP};
use super::xvfb::Xvfb;

const TAB: u32 = 0xff09;

/// Pixels along a side of the pictures; the window shows each twice as wide and high.
const SIZE: u32 = 200;
const SIDE: usize = 400;

/// The pixel, column and row from the bottom, that is far off.
const OFF: [u32; 2] = [120, 30];

/// Two pictures of the animation's scene, the latter with a pixel that is off in red, as a.exr and
/// b.exr in a folder.
fn pictures() -> (TempDir, [Image; 2]) {
    let folder = tempfile::tempdir().unwrap();
    let a = traced(SIZE, Stage::Reflection, 0.0);
    let mut b = traced(SIZE, Stage::Reflection, 0.0);
    let first = 3 * (OFF[1] * SIZE + OFF[0]) as usize;
    b.samples_mut()[first] += 0.25;
    a.save(folder.path().join("a.exr")).unwrap();
    b.save(folder.path().join("b.exr")).unwrap();
    (folder, [a, b])
}

/// `compare` in the folder, with its window, on `xvfb`.
fn show(xvfb: Xvfb, folder: TempDir, more: &[&str]) -> Session {
    let arguments = [&["compare", "a.exr", "b.exr", "--show"], more].concat();
    Session::starting(xvfb, folder, &arguments, &[]).opened()
}

/// Waits until the part of the window that is left of the panel shows `picture`, but for what lies
/// near `ringed`, from the left and the top.
#[track_caller]
fn shows(session: &Session, picture: &Image, ringed: Option<[usize; 2]>) {
    let expected = letterboxed(picture, SIDE, SIDE);
    wait_for("the picture", || {
        let part = session.pixels()?.part([0, 0], [SIDE, SIDE]);
        let pairs = part.bytes.iter().zip(&expected.bytes).enumerate();
        let wrong = pairs.filter(|(place, (shown, expected))| {
            let [x, y] = [place % SIDE, place / SIDE];
            let far = ringed.is_none_or(|[left, top]| x.abs_diff(left).max(y.abs_diff(top)) > 8);
            far && shown != expected
        });
        let same_size = part.bytes.len() == expected.bytes.len();
        (same_size && wrong.count() == 0).then_some(())
    });
}

/// The difference in false colours, pixel by pixel.
fn difference([a, b]: &[Image; 2]) -> Image {
    let mut colors = Image::new(SIZE).unwrap();
    let errors: Vec<_> = a.samples().iter().zip(b.samples()).collect();
    let pixels = colors.samples_mut().chunks_exact_mut(3);
    for (color, errors) in pixels.zip(errors.chunks_exact(3)) {
        let errors = errors.iter().map(|(a, b)| steps(**a, **b).unwrap());
        let worst = error_color(errors.max());
        color.copy_from_slice(&worst.map(|byte| f32::from(byte) / 255.0));
    }
    colors
}

/// What keys and the mouse show: each promise begins and ends with A alone.
#[test]
fn two_pictures_are_shown_beside_the_panel() {
    let Some(xvfb) = Xvfb::lent() else {
        return;
    };
    let (folder, pictures) = pictures();
    let mut session = show(xvfb, folder, &[]);
    session.becomes(SIDE + PANEL_WIDTH, SIDE);
    a_click_keeps_both_values_of_a_pixel_and_how_far_they_are_apart(&session, &pictures);
    keys_show_two_pictures_and_their_difference_in_one_zoom(&session, &pictures);
    session.press(ESCAPE);
    let (status, errors) = session.program.ended();
    assert_eq!((status.code(), errors.as_str()), (Some(0), ""));
}

fn keys_show_two_pictures_and_their_difference_in_one_zoom(
    session: &Session,
    pictures: &[Image; 2],
) {
    let difference = difference(pictures);
    let [a, b] = pictures;
    session.titled(&["firsthit — A: a.exr"]);
    shows(session, a, None);
    session.screenshot("viewer-compare-a.png");
    for (keys, title, picture) in [
        ("2", "B: b.exr", b),
        ("3", "difference of a.exr and b.exr", &difference),
        ("1", "A: a.exr", a),
        ("3", "difference of a.exr and b.exr", &difference),
    ] {
        session.type_keys(keys);
        session.titled(&[title]);
        shows(session, picture, None);
    }
    session.screenshot("viewer-compare-difference.png");
    for (title, picture) in [("A: ", a), ("B: ", b), ("difference ", &difference)] {
        session.press(TAB);
        session.titled(&[&format!("firsthit — {title}")]);
        shows(session, picture, None);
    }
    // What was zoomed to stays from one to the next.
    session.point(240, 340);
    session.click(WHEEL_UP);
    let zoomed = |picture: &Image| {
        let shown = session.pixels()?.part([0, 0], [SIDE, SIDE]);
        (shown.differences(&letterboxed(picture, SIDE, SIDE), 0..SIDE) > 10).then_some(shown)
    };
    let before = wait_for("the zoom", || zoomed(&difference));
    let off = error_color(steps(
        a.pixel(OFF[0], OFF[1]).unwrap()[0],
        b.pixel(OFF[0], OFF[1]).unwrap()[0],
    ));
    assert!(before.count(off) > 4, "the pixel is off, and larger");
    session.type_keys("1");
    session.titled(&["A: "]);
    session.type_keys("3");
    session.titled(&["difference "]);
    wait_for("the zoom again", || {
        let shown = session.pixels()?.part([0, 0], [SIDE, SIDE]);
        (shown.differences(&before, 0..SIDE) == 0).then_some(())
    });
    session.type_keys("z");
    shows(session, &difference, None);
    session.program.sleeps();
    session.type_keys("1");
    shows(session, a, None);
}

fn a_click_keeps_both_values_of_a_pixel_and_how_far_they_are_apart(
    session: &Session,
    [a, b]: &[Image; 2],
) {
    shows(session, a, None);
    let panel = || {
        let shown = session.pixels()?;
        Some(shown.part([SIDE, 0], [PANEL_WIDTH, SIDE]))
    };
    let before = panel().unwrap();
    let [column, row] = OFF.map(|place| place as usize);
    let place = [2 * column, SIDE - 1 - 2 * row];
    session.point(place[0] as i16, place[1] as i16);
    wait_for("the pixel's values", || {
        (panel()?.differences(&before, 0..SIDE) > 500).then_some(())
    });
    session.screenshot("viewer-compare-pointed.png");
    session.click(LEFT_BUTTON);
    shows(session, a, Some(place));
    session.press_ctrl(u32::from('c'));
    let [of_a, of_b] = [a, b].map(|image| image.pixel(OFF[0], OFF[1]).unwrap());
    let bytes = |color: [f32; 3]| {
        color
            .map(firsthit::image::display_byte)
            .map(|byte| byte.to_string())
    };
    let floats = |color: [f32; 3]| color.map(|float| float.to_string());
    let values = |color| [floats(color).join(" "), bytes(color).join(" ")];
    let ([floats_a, bytes_a], [floats_b, bytes_b]) = (values(of_a), values(of_b));
    let apart = steps(of_a[0], of_b[0]).unwrap();
    assert_eq!(
        session.clipboard(),
        format!(
            "column       120\n\
             row          169 from the top, 30 from the bottom\n\
             A            {floats_a}\n\
             B            {floats_b}\n\
             in bytes     {bytes_a} and {bytes_b}\n\
             difference   {apart} 0 0 f32 steps\n"
        )
    );
    session.screenshot("viewer-compare-clicked.png");
    // Esc closes what was clicked on, and the panel stays.
    session.press(ESCAPE);
    shows(session, a, None);
    assert_eq!(session.size(), (SIDE + PANEL_WIDTH, SIDE));
}

#[test]
fn the_menu_and_the_keys_are_those_of_pictures() {
    let Some(xvfb) = Xvfb::lent() else {
        return;
    };
    let (folder, [a, b]) = pictures();
    let mut session = show(xvfb, folder, &[]);
    shows(&session, &a, None);
    // Keys that a scene has do nothing.
    session.type_keys("67ek i.+");
    session.type_keys("h");
    wait_for("the keys", || {
        let shown = session.pixels()?.part([SIDE, 0], [PANEL_WIDTH, SIDE]);
        let ink = shown.bytes.iter().filter(|[red, ..]| *red > 150).count();
        (ink > 3000).then_some(())
    });
    session.screenshot("viewer-compare-keys.png");
    session.point(20, 20);
    session.type_keys("hm");
    wait_for("the menu", || {
        let shown = session.pixels()?.part([0, 0], [SIDE, SIDE]);
        let clean = letterboxed(&a, SIDE, SIDE);
        (shown.differences(&clean, 0..SIDE) > 3000).then_some(())
    });
    // The second row of the menu.
    for _ in 0..2 {
        session.press(super::session::DOWN);
    }
    session.screenshot("viewer-compare-menu.png");
    session.press(super::session::ENTER);
    session.titled(&["B: b.exr"]);
    shows(&session, &b, None);
    assert_eq!(fs::read_dir(session.folder.path()).unwrap().count(), 2);
    session.close();
    let (status, errors) = session.program.ended();
    assert_eq!((status.code(), errors.as_str()), (Some(0), ""));
}

#[test]
fn what_is_printed_and_the_status_are_those_without_the_window() {
    let Some(xvfb) = Xvfb::lent() else {
        return;
    };
    let (folder, _) = pictures();
    let limit = ["--threshold", "5"];
    let printed = |arguments: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_firsthit"));
        command.args(["compare", "a.exr", "b.exr"]).args(arguments);
        command.current_dir(&folder).output().unwrap()
    };
    let without = printed(&limit);
    let lines = String::from_utf8(without.stdout).unwrap();
    let lines: Vec<String> = lines.lines().map(str::to_owned).collect();
    // Without a display it is as with any window.
    let arguments = ["compare", "a.exr", "b.exr", "--show", "--threshold", "5"];
    let mut program = Program::start(folder.path(), &arguments, &[]);
    let (status, errors) = program.ended();
    assert_eq!((status.code(), errors.lines().count()), (Some(1), 1));
    assert!(
        errors.contains("no display") && errors.contains("without --show"),
        "{errors}"
    );
    assert_eq!(program.first_lines(lines.len()), lines);
    let mut session = show(xvfb, folder, &limit);
    assert_eq!(session.program.first_lines(lines.len()), lines);
    session.point(50, 50);
    session.click(LEFT_BUTTON);
    session.type_keys("q");
    let (status, errors) = session.program.ended();
    assert_eq!(status.code(), without.status.code());
    assert_eq!(errors.as_bytes(), without.stderr);
    assert_eq!(session.program.all_lines(), lines);
}

#[test]
fn pictures_of_any_width_and_height_keep_their_aspect() {
    // Beside the panel, which is 378 pixels high: the picture's corner from the left and the top.
    for (size, window, corner) in [
        ([200, 100], [400 + PANEL_WIDTH, 378], [0, 89]),
        ([60, 200], [120 + PANEL_WIDTH, 400], [0, 0]),
    ] {
        let Some(xvfb) = Xvfb::lent() else {
            return;
        };
        let folder = tempfile::tempdir().unwrap();
        let [width, height] = size;
        let mut picture = Raster::new(width, height).unwrap();
        for (place, pixel) in (0..).zip(picture.samples_mut().chunks_exact_mut(3)) {
            let (column, row) = (place % width, place / width);
            pixel.copy_from_slice(&[column as f32 / 255.0, row as f32 / 255.0, 1.0]);
        }
        for name in ["a.exr", "b.exr"] {
            picture.save(folder.path().join(name)).unwrap();
        }
        let mut session = show(xvfb, folder, &[]);
        session.becomes(window[0], window[1]);
        let [width, height] = size.map(|side| 2 * side as usize);
        wait_for("the picture", || {
            let part = session.pixels()?.part(corner, [width, height]);
            let mut pixels = part.bytes.iter().zip(0..);
            let shown = pixels.all(|(pixel, place)| {
                let (x, y) = (place % width, height - 1 - place / width);
                *pixel == [x / 2, y / 2, 255].map(|byte| byte as u8)
            });
            shown.then_some(())
        });
        // The panel is there from the beginning.
        let whole = session.pixels().unwrap().bytes;
        let ink = whole
            .iter()
            .filter(|[red, _, blue]| *red > 150 && *blue < 255);
        assert!(ink.count() > 300);
        session.screenshot(&format!("viewer-compare-{width}x{height}.png"));
        session.point(20 + corner[0] as i16, 40 + corner[1] as i16);
        session.click(LEFT_BUTTON);
        session.press_ctrl(u32::from('c'));
        let pixel = format!(
            "column       10\nrow          20 from the top, {} from the bottom\n",
            size[1] - 21
        );
        let text = session.clipboard();
        assert!(text.starts_with(&pixel), "{text}");
        session.type_keys("q");
        let (status, errors) = session.program.ended();
        assert_eq!((status.code(), errors.as_str()), (Some(0), ""));
    }
}

#[test]
fn what_is_shown_is_saved_without_a_word_on_standard_output() {
    let Some(xvfb) = Xvfb::lent() else {
        return;
    };
    let (folder, pictures) = pictures();
    let [a, b] = &pictures;
    let difference = difference(&pictures);
    let mut session = show(xvfb, folder, &[]);
    shows(&session, a, None);
    session.type_keys("3ss2S");
    let folder = session.folder.path().to_owned();
    for (picture, name) in [
        (&difference, "firsthit-compare-0001.png"),
        (&difference, "firsthit-compare-0002.png"),
        (b, "firsthit-compare-0001.exr"),
    ] {
        let expected = folder
            .join("expected")
            .with_extension(&name[name.len() - 3..]);
        picture.save(&expected).unwrap();
        let expected = fs::read(expected).unwrap();
        wait_for(name, || {
            (fs::read(folder.join(name)).ok()? == expected).then_some(())
        });
    }
    session.screenshot("viewer-compare-saved.png");
    // One that is still to be written when the window closes is written.
    session.type_keys("1sq");
    let (status, errors) = session.program.ended();
    assert_eq!((status.code(), errors.as_str()), (Some(0), ""));
    assert!(folder.join("firsthit-compare-0003.png").exists());
    let lines = session.program.all_lines();
    assert!(
        !lines.iter().any(|line| line.contains("saved")),
        "{lines:?}"
    );
}
