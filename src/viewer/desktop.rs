//! The event loop on whatever display there is.

#[cfg(all(unix, not(target_vendor = "apple")))]
pub(super) use super::server::event_loop;

/// An event loop on the only display that there is.
///
/// # Errors
/// Where it cannot be used.
#[cfg(not(all(unix, not(target_vendor = "apple"))))]
pub(super) fn event_loop() -> Result<winit::event_loop::EventLoop<()>, super::ViewerError> {
    winit::event_loop::EventLoop::new().map_err(|error| super::ViewerError::Display {
        server: "the desktop".to_owned(),
        reason: super::error::reason(&error),
    })
}
