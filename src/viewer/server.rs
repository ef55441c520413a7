//! Which display the window goes to, X11 or Wayland, and whether everything it needs is there.
//!
//! winit and glutin panic where a library or an X extension is missing, so they are looked for
//! before.

use std::env;
use std::os::unix::net::UnixStream;
use std::path::PathBuf;

use winit::event_loop::EventLoop;
use winit::platform::wayland::EventLoopBuilderExtWayland as _;
use winit::platform::x11::EventLoopBuilderExtX11;

use super::ViewerError;
use super::error::reason;
use super::library::load;
use super::x11::Connection;
use crate::panics::caught;

/// A kind of display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Server {
    Wayland,
    X11,
}

/// A library to be loaded at run time, and the Debian packages that bring it.
type Needed = (&'static str, &'static str);

const WAYLAND: [Needed; 4] = [
    ("libwayland-client.so.0", "libwayland-client0"),
    ("libwayland-egl.so.1", "libwayland-egl1"),
    ("libxkbcommon.so.0", "libxkbcommon0"),
    ("libEGL.so.1", "libegl1 libegl-mesa0 libgl1-mesa-dri"),
];

const X11: [Needed; 6] = [
    ("libX11.so.6", "libx11-6"),
    ("libX11-xcb.so.1", "libx11-xcb1"),
    ("libXcursor.so.1", "libxcursor1"),
    ("libXi.so.6", "libxi6"),
    ("libxkbcommon.so.0", "libxkbcommon0"),
    ("libxkbcommon-x11.so.0", "libxkbcommon-x11-0"),
];

/// A display that answers.
enum Reached {
    Wayland,
    X11(Connection),
}

/// An event loop on the display that the environment names: Wayland before X11, as winit has it,
/// and the other one where the first cannot be used.
///
/// # Errors
/// [`ViewerError::NoDisplay`] where none is named, else what the first one named lacks.
pub(super) fn event_loop() -> Result<EventLoop<()>, ViewerError> {
    let mut first_error = None;
    for server in [Server::Wayland, Server::X11] {
        let Some(name) = server.name() else {
            continue;
        };
        match server.reach(&name) {
            Ok(reached) => return build(&name, reached),
            Err(error) => {
                first_error.get_or_insert(error);
            }
        }
    }
    Err(first_error.unwrap_or(ViewerError::NoDisplay))
}

fn build(name: &str, reached: Reached) -> Result<EventLoop<()>, ViewerError> {
    let mut builder = EventLoop::builder();
    match reached {
        Reached::Wayland => builder.with_wayland(),
        Reached::X11(_) => builder.with_x11(),
    };
    EventLoopBuilderExtX11::with_any_thread(&mut builder, true);
    // winit panics where the system refuses it a file or an event.
    let event_loop = caught(|| builder.build().map_err(|error| reason(&error)))
        .flatten()
        .map_err(|reason| ViewerError::Display {
            server: name.to_owned(),
            reason,
        })?;
    if let Reached::X11(connection) = reached {
        connection.watch();
    }
    Ok(event_loop)
}

impl Server {
    /// How the environment names it; `None` where it does not.
    fn name(self) -> Option<String> {
        let variables: &[&str] = match self {
            Server::Wayland => &["WAYLAND_DISPLAY", "WAYLAND_SOCKET"],
            Server::X11 => &["DISPLAY"],
        };
        variables.iter().find_map(|variable| {
            let value = env::var(variable).ok().filter(|value| !value.is_empty())?;
            Some(format!("{variable}={value}"))
        })
    }

    fn reach(self, name: &str) -> Result<Reached, ViewerError> {
        let reached = match self {
            Server::Wayland => {
                require("Wayland", &WAYLAND)?;
                reach_wayland().map(|()| Reached::Wayland)
            }
            Server::X11 => {
                require("X11", &X11)?;
                if load("libGL.so.1").is_none() && load("libEGL.so.1").is_none() {
                    let reason = "neither libGL.so.1 nor libEGL.so.1 is there".to_owned();
                    return Err(ViewerError::OpenGl(reason));
                }
                scale_factor().and_then(|()| Connection::open().map(Reached::X11))
            }
        };
        reached.map_err(|reason| ViewerError::Display {
            server: name.to_owned(),
            reason,
        })
    }
}

/// Checks that every library of `needed` can be loaded.
fn require(server: &'static str, needed: &[Needed]) -> Result<(), ViewerError> {
    let missing: Vec<&Needed> = needed
        .iter()
        .filter(|(library, _)| load(library).is_none())
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    let join = |part: fn(&Needed) -> &str, separator| {
        let parts: Vec<&str> = missing.iter().map(|needed| part(needed)).collect();
        parts.join(separator)
    };
    Err(ViewerError::Missing {
        server,
        libraries: join(|needed| needed.0, ", "),
        packages: join(|needed| needed.1, " "),
    })
}

/// winit panics where this variable is no scale factor.
const SCALE_FACTOR: &str = "WINIT_X11_SCALE_FACTOR";

/// Checks that the scale factor of the environment, if there is one, is one that winit takes.
fn scale_factor() -> Result<(), String> {
    let Ok(text) = env::var(SCALE_FACTOR) else {
        return Ok(());
    };
    let is_size = |factor: f64| factor.is_normal() && factor > 0.0;
    if text.is_empty() || text.eq_ignore_ascii_case("randr") || text.parse().is_ok_and(is_size) {
        return Ok(());
    }
    Err(format!(
        "{SCALE_FACTOR}={text} is neither a number above 0 nor randr"
    ))
}

/// Checks that a compositor listens at WAYLAND_DISPLAY. An inherited WAYLAND_SOCKET is a connection
/// already.
fn reach_wayland() -> Result<(), String> {
    let Some(display) = env::var_os("WAYLAND_DISPLAY").filter(|display| !display.is_empty()) else {
        return Ok(());
    };
    let folder = env::var_os("XDG_RUNTIME_DIR").unwrap_or_default();
    let socket = PathBuf::from(folder).join(display);
    UnixStream::connect(&socket)
        .map(drop)
        .map_err(|reason| format!("{}: {reason}", socket.display()))
}
