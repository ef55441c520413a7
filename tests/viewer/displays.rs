//! Displays that serve, that lack something, and that go away.

use std::process::Command;

use firsthit::Stage;

use super::fault;
use super::program::{COMPOSE, Program};
use super::session::Session;
use super::xvfb::Xvfb;

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
    let Some(xvfb) = Xvfb::lent() else {
        return;
    };
    let nowhere = ("WAYLAND_DISPLAY", "/nowhere/wayland-0");
    let session = Session::on(xvfb, &["view", "--stage", "6", "--size", "40"], &[nowhere]);
    session.shows(40, Stage::Reflection, 0.0);
}

/// An X server on which OpenGL goes another way: EGL instead of GLX.
const WITHOUT_GLX: &[&str] = &["-extension", "GLX"];

/// One of either kind.
const SERVERS: [&[&str]; 2] = [&[], WITHOUT_GLX];

#[test]
fn egl_serves_where_the_server_has_no_glx() {
    let Some(xvfb) = Xvfb::lent_with(WITHOUT_GLX) else {
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
    let folder = tempfile::tempdir().unwrap();
    for server in SERVERS {
        let Some(xvfb) = Xvfb::start(server) else {
            return;
        };
        // A window that rests, and one that plays. Large enough that Mesa sends it to the server in
        // parts.
        let mut viewers = ["6", "7"].map(|stage| {
            let arguments = ["view", "--stage", stage, "--size", "300"];
            let environment = [("DISPLAY", &*xvfb.display)];
            let viewer = Program::start(folder.path(), &arguments, &environment);
            // Before the next one covers it.
            viewer.line("first frame");
            viewer
        });
        xvfb.crash();
        for viewer in &mut viewers {
            let (status, errors) = viewer.ended();
            assert_eq!(status.code(), Some(1), "{errors}");
            assert_eq!(errors.lines().count(), 1, "{errors}");
            assert!(errors.contains("the display went away"), "{errors}");
        }
    }
}

#[test]
fn a_scale_factor_that_is_none_is_one_line() {
    let Some(xvfb) = Xvfb::lent() else {
        return;
    };
    let display = ("DISPLAY", &*xvfb.display);
    for factor in ["0", "-1", "abc", "inf", "nan", "1e-320"] {
        let variable = ("WINIT_X11_SCALE_FACTOR", factor);
        refused(&[display, variable], &[&format!("{}={factor}", variable.0)]);
    }
}

#[test]
fn too_few_files_are_one_line() {
    let Some(xvfb) = Xvfb::lent() else {
        return;
    };
    let (mut refused, mut served) = (0, 0);
    for files in 4.. {
        let line = format!("ulimit -n {files}; exec \"$0\" view --exit-after-frames 1");
        let output = Command::new("sh")
            .args(["-c", &line, env!("CARGO_BIN_EXE_firsthit")])
            .env("DISPLAY", &xvfb.display)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .env("XCOMPOSEFILE", COMPOSE)
            .output()
            .unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        if output.status.success() {
            served += 1;
            // What is refused later than anything else was not far off.
            if served > 3 {
                break;
            }
            continue;
        }
        assert_eq!(output.status.code(), Some(1), "{files}: {message}");
        let ours = message
            .lines()
            .filter(|line| line.starts_with("firsthit: "));
        assert_eq!(ours.count(), 1, "{files}: {message}");
        assert!(!message.contains("fault"), "{files}: {message}");
        refused += 1;
    }
    assert!(refused > 0);
}

#[test]
fn a_driver_that_has_no_version_is_one_line() {
    let Some(environment) = fault::environment("has no version") else {
        return;
    };
    for server in SERVERS {
        let Some(xvfb) = Xvfb::lent_with(server) else {
            return;
        };
        let [library, fault] = environment;
        refused(
            &[("DISPLAY", &xvfb.display), library, fault],
            &["GL_VERSION"],
        );
    }
}

#[test]
fn a_window_that_shows_a_wrong_pixel_is_told() {
    let Some(environment) = fault::environment("shows a wrong pixel") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    for server in SERVERS {
        let Some(xvfb) = Xvfb::lent_with(server) else {
            return;
        };
        // It is looked at when some frames have been presented.
        let arguments = ["view", "--size", "40", "--exit-after-frames", "30"];
        let [library, fault] = environment;
        let environment = [("DISPLAY", &*xvfb.display), library, fault];
        let mut viewer = Program::start(folder.path(), &arguments, &environment);
        let (status, errors) = viewer.ended();
        assert_eq!(status.code(), Some(0), "{errors}");
        assert_eq!(errors.lines().count(), 1, "{errors}");
        assert!(errors.contains("does not show what was drawn"), "{errors}");
        assert!(errors.contains("column 5, row 7 "), "{errors}");
    }
}
