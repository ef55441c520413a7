//! A connection of our own to the X server: to ask what winit takes for granted, and to notice its
//! death.

use std::ffi::{CStr, c_char, c_int, c_long, c_void};
use std::io::{self, Write as _};
use std::ptr::{self, NonNull};
use std::sync::Once;
use std::thread;

use super::ViewerError;
use super::library::load;
use crate::image::abandon_unfinished;
use crate::program::end_all;

/// The X extensions that winit takes for granted.
const EXTENSIONS: [&CStr; 3] = [c"RANDR", c"XInputExtension", c"XKEYBOARD"];

/// The functions of Xlib that are called here.
struct Xlib {
    init_threads: unsafe extern "C" fn() -> c_int,
    set_io_error_handler:
        unsafe extern "C" fn(Option<unsafe extern "C" fn(*mut c_void) -> c_int>) -> *mut c_void,
    open_display: unsafe extern "C" fn(*const c_char) -> *mut c_void,
    query_extension: unsafe extern "C" fn(
        *mut c_void,
        *const c_char,
        *mut c_int,
        *mut c_int,
        *mut c_int,
    ) -> c_int,
    next_event: unsafe extern "C" fn(*mut c_void, *mut Event) -> c_int,
    close_display: unsafe extern "C" fn(*mut c_void) -> c_int,
}

/// XEvent: a union that Xlib pads to this.
type Event = [c_long; 24];

impl Xlib {
    fn load() -> Option<Xlib> {
        let library = load("libX11.so.6")?;
        // SAFETY: these are the signatures in X11/Xlib.h, a handler being a pointer to a function.
        // The pointers, and the handler that Xlib remembers, are valid as long as the library stays
        // loaded.
        unsafe {
            Some(Xlib {
                init_threads: *library.get(b"XInitThreads\0").ok()?,
                set_io_error_handler: *library.get(b"XSetIOErrorHandler\0").ok()?,
                open_display: *library.get(b"XOpenDisplay\0").ok()?,
                query_extension: *library.get(b"XQueryExtension\0").ok()?,
                next_event: *library.get(b"XNextEvent\0").ok()?,
                close_display: *library.get(b"XCloseDisplay\0").ok()?,
            })
        }
    }
}

/// A connection to the X server that DISPLAY names.
pub(super) struct Connection {
    xlib: Xlib,
    display: NonNull<c_void>,
}

// SAFETY: Xlib ties a display to no thread once XInitThreads was called, and only the owner of this
// one uses it.
unsafe impl Send for Connection {}

impl Connection {
    /// To a server that answers and has every extension in [`EXTENSIONS`]. It should stay open
    /// until winit has its own: the departure of its last client makes an X server start anew.
    /// From here on the death of a server is one line.
    ///
    /// # Errors
    /// What is missing.
    pub(super) fn open() -> Result<Connection, String> {
        let xlib = Xlib::load().ok_or("libX11.so.6 is not Xlib")?;
        // SAFETY: XInitThreads comes first; the handler has the signature that Xlib wants and lives
        // as long as the process; no name means DISPLAY.
        let display = unsafe {
            (xlib.init_threads)();
            (xlib.set_io_error_handler)(Some(server_died));
            (xlib.open_display)(ptr::null())
        };
        let display = NonNull::new(display).ok_or("no X server answers there")?;
        let connection = Connection { xlib, display };
        match EXTENSIONS.into_iter().find(|name| !connection.has(name)) {
            None => Ok(connection),
            Some(missing) => Err(format!(
                "the X server lacks the extension {}",
                missing.to_string_lossy()
            )),
        }
    }

    fn has(&self, extension: &CStr) -> bool {
        let [mut opcode, mut event, mut error] = [0; 3];
        let display = self.display.as_ptr();
        // SAFETY: the display is open; the name and the three numbers are not kept.
        let present = unsafe {
            (self.xlib.query_extension)(
                display,
                extension.as_ptr(),
                &mut opcode,
                &mut event,
                &mut error,
            )
        };
        present != 0
    }

    /// Watches over the server from a thread of its own until the process ends.
    ///
    /// The event loop alone would notice its death too late or not at all: winit panics where it
    /// meets it first, and Mesa's EGL then draws in software for ever.
    pub(super) fn watch(self) {
        // Where the system has no thread left, only the event loop notices.
        let _ = thread::Builder::new()
            .name("X server".to_owned())
            .spawn(move || self.wait());
    }

    fn wait(self) {
        let mut event: Event = [0; 24];
        loop {
            // SAFETY: the display is open, and an event is written to memory of its size.
            unsafe { (self.xlib.next_event)(self.display.as_ptr(), &mut event) };
        }
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        // SAFETY: opened by `open`, closed once.
        unsafe { (self.xlib.close_display)(self.display.as_ptr()) };
    }
}

// SAFETY: that is the type of POSIX's `_exit`, which is in every C library.
unsafe extern "C" {
    /// Ends the process without calling what was registered for its end.
    safe fn _exit(status: c_int) -> !;
}

/// Called by Xlib, on whatever thread, when a connection to the server broke. Xlib lets it neither
/// return nor unwind: it would end the process itself, after lines of its own. What OpenGL has
/// registered for the end must not run while another thread is drawing.
extern "C" fn server_died(_display: *mut c_void) -> c_int {
    static DYING: Once = Once::new();
    DYING.call_once(|| {
        // Standard error may have died with the display.
        let _ = writeln!(io::stderr(), "firsthit: {}", ViewerError::Lost);
        // The caller of `run`, who could see to it, is not returned to.
        abandon_unfinished();
        end_all();
        _exit(1)
    });
    0
}
