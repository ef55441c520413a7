//! Libraries of the system that a window needs.

use libloading::Library;

/// A library, if it is there.
pub(super) fn load(library: &str) -> Option<Library> {
    // SAFETY: a library of the system whose initialisation asks nothing of its loader; winit and
    // glutin load the same ones the same way.
    unsafe { Library::new(library) }.ok()
}
