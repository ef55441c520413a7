//! Libraries of the system that a window needs.

use libloading::Library;

/// A library, if it is there. It stays loaded until the process ends: unloaded, it would only be
/// read and bound again by whoever needs it next.
pub(super) fn load(library: &str) -> Option<&'static Library> {
    // SAFETY: a library of the system whose initialisation asks nothing of its loader; winit and
    // glutin load the same ones the same way.
    let library = unsafe { Library::new(library) }.ok()?;
    Some(Box::leak(Box::new(library)))
}
