//! An OpenGL context without a window, of any backend.

use std::ffi::{CStr, c_void};

use super::ScreenError;
use crate::panics::caught;

/// Which OpenGL a context has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Profile {
    /// Version 3.3 without deprecated functions.
    Core,
    /// With the deprecated functions that the document calls.
    #[cfg_attr(
        not(feature = "program"),
        expect(
            dead_code,
            reason = "only the program's report draws as the document does"
        )
    )]
    Compatibility,
}

/// An OpenGL context that needs no window. It is released when dropped.
pub(super) trait Context {
    /// Makes the context current on this thread.
    fn make_current(&self) -> Result<(), ScreenError>;
    /// Leaves this thread without a current context.
    fn release(&self);
    /// The address of an OpenGL function; the context is current.
    fn proc_address(&self, name: &CStr) -> *const c_void;
}

impl dyn Context + '_ {
    /// Its functions; it is current.
    pub(super) fn functions(&self) -> Result<glow::Context, ScreenError> {
        // SAFETY: the context is current and the addresses are its own functions'.
        unsafe { functions(|name| self.proc_address(name)) }
    }
}

/// The functions of OpenGL at the addresses that `address` knows.
///
/// # Safety
/// A context is current, and the addresses are of its functions.
pub(crate) unsafe fn functions(
    address: impl FnMut(&CStr) -> *const c_void,
) -> Result<glow::Context, ScreenError> {
    // glow panics where a driver does not say its version.
    // SAFETY: as the caller has promised.
    caught(|| unsafe { glow::Context::from_loader_function_cstr(address) })
        .map_err(|panic| ScreenError::refused("to say what it can", &panic))
}
