//! OpenGL on a display: its functions and its configuration.

use glutin::config::{ColorBufferType, Config, ConfigTemplateBuilder};
use glutin::display::{Display, DisplayApiPreference};
use glutin::prelude::*;
use raw_window_handle::{HasDisplayHandle as _, RawDisplayHandle, RawWindowHandle};
use winit::event_loop::ActiveEventLoop;
use winit::window::WindowAttributes;

use crate::screen;
use crate::viewer::ViewerError;
use crate::viewer::error::reason;

/// The functions of OpenGL in the context that is current, one of `display`.
pub(super) fn functions(display: &Display) -> Result<glow::Context, Failure> {
    // SAFETY: the context is current, and the functions come from its own display.
    let functions = unsafe { screen::functions(|name| display.get_proc_address(name)) };
    functions.map_err(|error| Failure::OpenGl(error.to_string()))
}

/// Opens OpenGL on the display of `event_loop`; on Windows through `window`.
pub(super) fn display(
    event_loop: &ActiveEventLoop,
    window: Option<RawWindowHandle>,
    prefer_egl: bool,
) -> Result<Display, Failure> {
    let handle = event_loop.display_handle()?.as_raw();
    let preference = preference(handle, window, prefer_egl);
    // SAFETY: the event loop keeps the display open until the window and its context are gone.
    Ok(unsafe { Display::new(handle, preference) }?)
}

#[cfg(all(unix, not(target_vendor = "apple")))]
fn preference(
    display: RawDisplayHandle,
    _window: Option<RawWindowHandle>,
    prefer_egl: bool,
) -> DisplayApiPreference {
    match display {
        RawDisplayHandle::Xlib(_) if !prefer_egl => {
            DisplayApiPreference::Glx(Box::new(winit::platform::x11::register_xlib_error_hook))
        }
        _ => DisplayApiPreference::Egl,
    }
}

#[cfg(windows)]
fn preference(
    _display: RawDisplayHandle,
    window: Option<RawWindowHandle>,
    prefer_egl: bool,
) -> DisplayApiPreference {
    if prefer_egl {
        DisplayApiPreference::Egl
    } else {
        DisplayApiPreference::Wgl(window)
    }
}

#[cfg(target_vendor = "apple")]
fn preference(
    _display: RawDisplayHandle,
    _window: Option<RawWindowHandle>,
    _prefer_egl: bool,
) -> DisplayApiPreference {
    DisplayApiPreference::Cgl
}

/// The colour depth of a usual display.
pub(super) const EIGHT_BITS: ColorBufferType = ColorBufferType::Rgb {
    r_size: 8,
    g_size: 8,
    b_size: 8,
};

/// The simplest configuration for a window: 8 bits a colour, and no alpha through which the desktop
/// could shine.
pub(super) fn config(display: &Display) -> Result<Config, Failure> {
    let template = ConfigTemplateBuilder::new()
        .with_alpha_size(0)
        .with_depth_size(0)
        .with_stencil_size(0)
        .build();
    // SAFETY: the template names no native window that could have gone.
    let configs = unsafe { display.find_configs(template) }?;
    configs
        .min_by_key(|config| {
            (
                config.color_buffer_type() != Some(EIGHT_BITS),
                config.supports_transparency() == Some(true),
                config.alpha_size(),
                config.num_samples(),
                !config.hardware_accelerated(),
                config.depth_size(),
                config.stencil_size(),
                config.srgb_capable(),
            )
        })
        .ok_or_else(|| {
            Failure::OpenGl("the display offers no configuration for a window".to_owned())
        })
}

/// `attributes` of a window that `config` can draw in: on X11 it must have the visual of `config`.
#[cfg(all(unix, not(target_vendor = "apple")))]
pub(super) fn fitting(attributes: WindowAttributes, config: &Config) -> WindowAttributes {
    use glutin::platform::x11::X11GlConfigExt as _;
    use winit::platform::x11::WindowAttributesExtX11 as _;

    match config.x11_visual() {
        Some(visual) => attributes.with_x11_visual(visual.visual_id() as u32),
        None => attributes,
    }
}

#[cfg(not(all(unix, not(target_vendor = "apple"))))]
pub(super) fn fitting(attributes: WindowAttributes, _config: &Config) -> WindowAttributes {
    attributes
}

/// Why a window or what is in it could not be made.
pub(super) enum Failure {
    /// OpenGL fails by this API of the display; another may work.
    OpenGl(String),
    /// An error that no other API avoids.
    Viewer(ViewerError),
}

impl From<glutin::error::Error> for Failure {
    fn from(error: glutin::error::Error) -> Failure {
        Failure::OpenGl(error.to_string())
    }
}

impl From<winit::error::OsError> for Failure {
    fn from(error: winit::error::OsError) -> Failure {
        Failure::OpenGl(reason(&error))
    }
}

impl From<raw_window_handle::HandleError> for Failure {
    fn from(error: raw_window_handle::HandleError) -> Failure {
        Failure::OpenGl(error.to_string())
    }
}

impl From<ViewerError> for Failure {
    fn from(error: ViewerError) -> Failure {
        Failure::Viewer(error)
    }
}
