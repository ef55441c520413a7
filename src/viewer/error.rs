//! What can keep the viewer from its window.

use crate::RenderError;
use crate::diagnosis::ExaminationError;
use crate::difference::SizesDiffer;
use crate::image::ImageError;
use crate::screen::ScreenError;
use crate::tracer::TraceError;

/// What else there is to do where no window can be had.
const WITHOUT: &str =
    "or use `firsthit capture`, or `firsthit compare` without --show, which need no window";

/// A viewer that cannot open or go on. Each message is one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewerError {
    /// Neither an X server nor a Wayland compositor is named.
    #[error(
        "no display: neither WAYLAND_DISPLAY nor DISPLAY is set: start the viewer in a graphical session, {WITHOUT}"
    )]
    NoDisplay,
    /// Libraries that a window needs are not there.
    #[error(
        "a window on {server} needs {libraries}: install them (Debian packages: {packages}), {WITHOUT}"
    )]
    Missing {
        /// The kind of display.
        server: &'static str,
        /// The files that were looked for.
        libraries: String,
        /// The Debian packages that bring them, separated by spaces.
        packages: String,
    },
    /// The display is named but does not answer as it should.
    #[error(
        "{server} cannot be used ({reason}): start the viewer in a graphical session, {WITHOUT}"
    )]
    Display {
        /// The display, as its environment variable names it.
        server: String,
        /// What it lacks.
        reason: String,
    },
    /// There is no window with OpenGL 3.3 core.
    #[error(
        "no window with OpenGL 3.3 core can be made ({0}): install a driver (Debian packages: libgl1 libglx-mesa0 libegl1 libegl-mesa0 libgl1-mesa-dri), {WITHOUT}"
    )]
    OpenGl(String),
    /// The display went away while the window was open.
    #[error("the display went away, and the window with it: start the viewer again, {WITHOUT}")]
    Lost,
    /// The texture and the quad cannot be made or used.
    #[error(transparent)]
    Screen(#[from] ScreenError),
    /// Two pictures are not of one size.
    #[error(transparent)]
    Sizes(#[from] SizesDiffer),
    /// There is no room for the picture.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The system has no thread left.
    #[error("no thread can be started to trace on ({0}): end other programs")]
    Thread(std::io::Error),
    /// The kernel that the viewer opens on does not trace such a scene.
    #[error("{0}")]
    Refused(RenderError),
    /// The picture cannot be traced.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// The picture cannot be compared with the truth.
    #[error(transparent)]
    Examination(#[from] ExaminationError),
}

/// What an error of winit says, without the place in winit's own source that it puts before it.
pub(super) fn reason(error: &dyn std::error::Error) -> String {
    let text = error.to_string();
    match text.split_once(": ") {
        Some((place, reason)) if place.starts_with("os error at ") => reason.to_owned(),
        _ => text,
    }
}
