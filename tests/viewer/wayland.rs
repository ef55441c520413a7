//! The viewer on Wayland, for real: the built program under sway without a screen, keys typed by
//! wtype, the display's pixels taken by grim and compared byte for byte with the traced picture.
//! `.ci/wayland` brings these tools and runs this.

use firsthit::{Kernel, Scene, Stage, Tracer};

use super::mouse::Mouse;
use super::pixels::{letterboxed, traced, wait_to_show};
use super::program::wait_for;
use super::sway::{HEIGHT, Sway, WIDTH};

#[test]
#[ignore = "needs sway, wtype and grim"]
fn shows_stage_after_stage_as_traced() {
    let sway = Sway::start();
    let mut viewer = sway.open(&["view", "--stage", "6"]);
    sway.shows(Stage::Reflection);
    for stage in &Stage::ALL[..6] {
        sway.type_keys(&stage.number().to_string());
        sway.shows(*stage);
    }
    viewer.sleeps();
    sway.type_keys("q");
    let [traces, uploads, _] = viewer.left();
    assert_eq!([traces, uploads], [7, 7]);
}

#[test]
#[ignore = "needs sway, wtype and grim"]
fn a_dense_display_gets_the_same_pixels() {
    let sway = Sway::start();
    let mut viewer = sway.open(&["view", "--stage", "6"]);
    sway.order("output * scale 2");
    sway.shows(Stage::Reflection);
    sway.type_keys("q");
    viewer.left();
}

#[test]
#[ignore = "needs sway, wtype and grim"]
fn a_floating_window_grows_for_its_panel_and_shrinks_again() {
    let sway = Sway::start();
    sway.order("output * resolution 1200x700");
    sway.order("for_window [title=firsthit] floating enable");
    let mut viewer = sway.open(&["view", "--stage", "6"]);
    let becomes = |width: usize| {
        let wanted = format!("\"width\": {width},");
        wait_for(&format!("a window {width} pixels wide"), || {
            let tree = sway.printed("swaymsg", &["-t", "get_tree"]);
            String::from_utf8(tree)
                .unwrap()
                .contains(&wanted)
                .then_some(())
        });
    };
    becomes(500);
    sway.type_keys("h");
    becomes(500 + 56 * 7);
    sway.type_keys("h");
    becomes(500);
    viewer.sleeps();
    sway.type_keys("q");
    viewer.left();
}

#[test]
#[ignore = "needs sway, wtype and grim"]
fn a_hidden_window_answers_once_it_is_seen_again() {
    let sway = Sway::start();
    let mut viewer = sway.open(&["view"]);
    for _ in 0..2 {
        sway.order("workspace 2");
        sway.order("workspace 1");
        sway.type_keys("5");
        sway.shows(Stage::Shadow);
        sway.type_keys("7");
    }
    sway.order("workspace 2");
    sway.order("[title=firsthit] kill");
    viewer.left();
}

#[test]
#[ignore = "needs sway, wtype, grim and wl-clipboard"]
fn the_text_of_a_clicked_pixel_can_be_pasted() {
    let sway = Sway::start();
    let size = [WIDTH, HEIGHT].map(|length| length as u32);
    let mut mouse = Mouse::new(&sway.display(), size);
    let mut viewer = sway.open(&["view", "--stage", "6"]);
    sway.shows(Stage::Reflection);
    let [left, top] = size.map(|length| (length - 500) / 2);
    mouse.point(left + 255, top + 499 - 202);
    mouse.click();
    let tracer = Tracer::new(Kernel::default(), 1).unwrap();
    let text = tracer.explain(&Scene::builtin(), Stage::Reflection, 0.0, 500, (255, 202));
    let text = text.unwrap();
    viewer.line(text.lines().last().unwrap());
    sway.printed("wtype", &["-M", "ctrl", "c", "-m", "ctrl"]);
    let pasted = wait_for("text on the clipboard", || sway.pasted());
    assert_eq!(pasted, text);
    sway.type_keys("q");
    viewer.left();
}

#[test]
#[ignore = "needs sway, wtype and grim"]
fn the_death_of_the_compositor_is_one_line() {
    for stage in ["6", "7"] {
        let mut sway = Sway::start();
        let mut viewer = sway.open(&["view", "--stage", stage]);
        sway.crash();
        let (status, errors) = viewer.ended();
        assert_eq!(status.code(), Some(1), "{errors}");
        assert_eq!(errors.lines().count(), 1, "{errors}");
        assert!(errors.contains("the display went away"), "{errors}");
    }
}

#[test]
#[ignore = "needs sway, wtype and grim"]
fn two_pictures_are_shown_beside_the_panel() {
    let sway = Sway::start();
    let pictures = [Stage::Shadow, Stage::Reflection].map(|stage| traced(100, stage, 0.0));
    for (picture, name) in pictures.iter().zip(["a.exr", "b.exr"]) {
        picture.save(sway.folder().join(name)).unwrap();
    }
    let mut compare = sway.begin(&["compare", "a.exr", "b.exr", "--show"]);
    // What the panel leaves of the display.
    let width = WIDTH - 56 * 7;
    let shows = |picture| {
        wait_to_show(
            || Some(sway.pixels().part([0, 0], [width, HEIGHT])),
            |width, height| letterboxed(picture, width, height),
        );
    };
    let [a, b] = &pictures;
    shows(a);
    sway.type_keys("2");
    shows(b);
    compare.sleeps();
    sway.type_keys("q");
    let (status, errors) = compare.ended();
    assert_eq!((status.code(), errors.as_str()), (Some(0), ""));
}
