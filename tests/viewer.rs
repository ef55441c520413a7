//! The viewer, for real: the built program in a window under Xvfb, keys through XTEST, and the
//! pixels of the window compared byte for byte with the traced picture.

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

#[path = "viewer/compare.rs"]
mod compare;
#[path = "viewer/displays.rs"]
mod displays;
#[path = "helpers/fault.rs"]
mod fault;
#[path = "viewer/keys.rs"]
mod keys;
#[path = "viewer/mouse.rs"]
mod mouse;
#[path = "viewer/overlay.rs"]
mod overlay;
#[path = "viewer/pixels.rs"]
mod pixels;
#[path = "viewer/program.rs"]
mod program;
#[path = "../src/random.rs"]
#[expect(dead_code, reason = "other tests choose fractions, too")]
mod random;
#[path = "viewer/renderers.rs"]
mod renderers;
#[path = "viewer/session.rs"]
mod session;
#[path = "viewer/shared_image.rs"]
mod shared_image;
#[path = "viewer/soak.rs"]
mod soak;
#[path = "viewer/sway.rs"]
mod sway;
#[path = "viewer/wayland.rs"]
mod wayland;
#[path = "viewer/window.rs"]
mod window;
#[path = "viewer/xvfb.rs"]
mod xvfb;

use std::time::Duration;

/// How long anything may take that is waited for.
const DEADLINE: Duration = Duration::from_secs(30);

/// How long something is watched that must stay as it is.
const WATCH: Duration = Duration::from_secs(2);
