//! A window on an X server, to ask what neither winit nor an event says.

use std::ffi::{c_int, c_long, c_ulong, c_void};
use std::mem::MaybeUninit;

use raw_window_handle::{
    HasDisplayHandle as _, HasWindowHandle as _, RawDisplayHandle, RawWindowHandle,
};
use winit::window::Window;

use super::library::load;

/// XWindowAttributes of X11/Xlib.h.
#[repr(C)]
struct Attributes {
    place_size_border_depth: [c_int; 6],
    visual: *mut c_void,
    root: c_ulong,
    class_gravity_store: [c_int; 4],
    backing: [c_ulong; 2],
    save_under: c_int,
    colormap: c_ulong,
    map_installed: c_int,
    map_state: c_int,
    event_masks: [c_long; 3],
    override_redirect: c_int,
    screen: *mut c_void,
}

/// IsViewable: the window and all that it lies in are mapped.
const VIEWABLE: c_int = 2;

type GetWindowAttributes = unsafe extern "C" fn(*mut c_void, c_ulong, *mut Attributes) -> c_int;

/// A window on an X server. It must not outlive the window that it was made of.
pub(super) struct X11Window {
    get_window_attributes: GetWindowAttributes,
    display: *mut c_void,
    window: c_ulong,
}

impl X11Window {
    /// `None` on another kind of display.
    pub(super) fn of(window: &Window) -> Option<X11Window> {
        let display = window.display_handle().ok()?.as_raw();
        let window = window.window_handle().ok()?.as_raw();
        let (RawDisplayHandle::Xlib(display), RawWindowHandle::Xlib(window)) = (display, window)
        else {
            return None;
        };
        let library = load("libX11.so.6")?;
        // SAFETY: this is the signature in X11/Xlib.h, and the library stays loaded.
        let get_window_attributes = unsafe { *library.get(b"XGetWindowAttributes\0").ok()? };
        Some(X11Window {
            get_window_attributes,
            display: display.display?.as_ptr(),
            window: window.window,
        })
    }

    /// Whether the window and all that it lies in are mapped, by a round trip: on another workspace
    /// many window managers unmap what a window lies in, of which the window gets no event. When it
    /// can be seen again it is exposed.
    pub(super) fn is_viewable(&self) -> bool {
        let mut attributes = MaybeUninit::<Attributes>::uninit();
        // SAFETY: winit keeps the display open, and its error handler returns where the window is
        // gone; what Xlib writes is an XWindowAttributes, all of it unless it returns 0.
        unsafe {
            let done =
                (self.get_window_attributes)(self.display, self.window, attributes.as_mut_ptr());
            done == 0 || attributes.assume_init().map_state == VIEWABLE
        }
    }
}
