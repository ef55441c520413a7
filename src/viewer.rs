//! The window: one picture, redrawn when the angle moves or the window asks.
//!
//! [`run`] opens a window on X11 or Wayland and stays until it is closed. Each thing has a place:
//! the keys are one table ([`key_table`]), α is a clock of its own that knows no window, the window
//! knows no scene, pictures are made on threads of their own, and the application between them
//! asks for one only when stage or α changed. [`compare`] has the same window, with pictures that
//! are there already in the place of a scene.

mod action;
mod app;
mod canvas;
mod clipboard;
mod comparison;
mod content;
mod desktop;
mod error;
mod frame_rate;
mod hud;
mod icon;
mod information;
mod key_press;
mod layout;
#[cfg(all(unix, not(target_vendor = "apple")))]
mod library;
mod lines;
mod menu;
mod overlay;
mod panel;
mod pictures;
mod playback;
mod pointer;
mod rect;
mod renderer;
#[cfg(all(unix, not(target_vendor = "apple")))]
mod server;
mod snapshot;
mod tracing;
mod ui;
mod watch;
mod window;
mod worker;
mod wrong;
#[cfg(all(unix, not(target_vendor = "apple")))]
mod x11;
#[cfg(all(unix, not(target_vendor = "apple")))]
mod x11_window;
mod zoom;

use std::fmt;
use std::path::PathBuf;
use std::time::Duration;

use crate::image::SaveError;
use crate::scene::SceneFileError;
use crate::screen::Differs;
use crate::{Kernel, Render, Scene, Stage};

pub use action::key_table;
pub use error::ViewerError;
pub use pictures::Picture;
pub use playback::Pace;

/// What the viewer shows and how it starts.
#[derive(Clone, Debug)]
pub struct Options {
    /// What is seen.
    pub scene: Scene,
    /// The file that the scene was read from: where it changes while the viewer is seen, it is read
    /// again, and shown unless it is refused.
    pub scene_file: Option<PathBuf>,
    /// The stage it opens on.
    pub stage: Stage,
    /// N: pictures are N × N pixels, 1 to [`MAX_SIZE`](crate::image::MAX_SIZE).
    pub size: u32,
    /// The kernel that the viewer opens on; if there is none, the first of the renderers that it is
    /// given, else the default kernel.
    pub kernel: Option<Kernel>,
    /// Threads that trace; 0 for one a core.
    pub threads: usize,
    /// How stage 7 advances.
    pub pace: Pace,
    /// Leave after so many frames, 0 counting as 1; a static stage is then drawn again and again
    /// until it has had them.
    pub exit_after_frames: Option<u64>,
}

/// Something that a person at the terminal may want to know, as a line of text, or some, by
/// [`fmt::Display`].
#[derive(Debug)]
#[non_exhaustive]
pub enum Event {
    /// The window is open and has an OpenGL context: the driver did not hang.
    Opened,
    /// The first frame is on its way to the display.
    FirstFrame {
        /// Since [`run`] was called.
        after: Duration,
        /// The name that OpenGL gives what drew it.
        renderer: String,
    },
    /// The window does not show what was drawn: the driver is wrong, and other pixels may be, too.
    Differs {
        /// The name that OpenGL gives what drew it.
        renderer: String,
        /// The first such pixel.
        differs: Differs,
    },
    /// The shown picture is in a new file.
    Saved(PathBuf),
    /// The shown picture could not be saved.
    NotSaved(SaveError),
    /// There is no picture, and the last one stays.
    NotRendered {
        /// What should have made it.
        renderer: String,
        /// Why it did not, in one line.
        reason: String,
    },
    /// The scene file has changed, and was read again.
    SceneRead(PathBuf),
    /// The scene file has changed, and the last scene stays.
    SceneRefused(SceneFileError),
    /// A pixel that was clicked on, worked through: lines of text.
    Inspected(String),
    /// The window is closed.
    Left(Counts),
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Event::FirstFrame { after, renderer } => {
                write!(
                    f,
                    "first frame after {} ms, drawn by {renderer}",
                    after.as_millis()
                )
            }
            Event::Opened => f.write_str("opened a window"),
            Event::Differs {
                renderer,
                differs:
                    Differs {
                        pixel,
                        drawn,
                        shown,
                    },
            } => write!(
                f,
                "{renderer} does not show what was drawn: at column {}, row {} from the bottom {shown:?} instead of {drawn:?}: try another driver",
                pixel.x, pixel.y
            ),
            Event::Saved(path) => write!(f, "saved {}", path.display()),
            Event::NotSaved(error) => write!(f, "not saved: {error}"),
            Event::NotRendered { renderer, reason } if reason.starts_with(renderer) => {
                f.write_str(reason)
            }
            Event::NotRendered { renderer, reason } => write!(f, "{renderer}: {reason}"),
            Event::SceneRead(path) => write!(f, "read {} again", path.display()),
            Event::SceneRefused(error) => error.fmt(f),
            Event::Inspected(text) => f.write_str(text.trim_end()),
            Event::Left(counts) => counts.fmt(f),
        }
    }
}

/// What it took to show all that was shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Pictures traced.
    pub traces: u64,
    /// Pictures brought to the texture.
    pub uploads: u64,
    /// Frames drawn.
    pub draws: u64,
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Counts {
            traces,
            uploads,
            draws,
        } = self;
        write!(
            f,
            "traced {traces}, uploaded {uploads}, drew {draws} frames"
        )
    }
}

/// Opens the viewer and stays until it is left. `renderers` are shown like kernels, each on a
/// thread of its own, however slow it is; where one of its files changes while the viewer is seen,
/// it is reloaded, and its picture comes anew. `report` is told what happens, on the calling
/// thread.
///
/// A process can do this once. On macOS and Windows it must be the main thread that does.
///
/// # Errors
/// [`ViewerError`] where no window can be opened, or the display goes away. Where an X server does,
/// Xlib leaves no way back: a line on standard error, every [`Program`](crate::program::Program) is
/// ended, and so is the process, with status 1.
///
/// # Panics
/// On macOS and Windows, where the calling thread is not the main thread.
pub fn run(
    options: Options,
    renderers: Vec<Box<dyn Render + Send>>,
    report: &mut dyn FnMut(Event),
) -> Result<(), ViewerError> {
    app::run(options, renderers, report)
}

/// Opens a window with two pictures and their difference in the false colours of
/// [`error_color`](crate::difference::error_color), one of the three at a time, and stays until it
/// is left. `report` is told what happens, on the calling thread.
///
/// A process can open one window, this or that of [`run`].
///
/// # Errors
/// As [`run`]; [`ViewerError::Sizes`] unless both pictures have one size.
///
/// # Panics
/// As [`run`].
pub fn compare(pictures: [Picture; 2], report: &mut dyn FnMut(Event)) -> Result<(), ViewerError> {
    pictures::compare(pictures, report)
}
