//! The clipboard of the desktop, for text.

#[cfg(all(unix, not(target_vendor = "apple")))]
use raw_window_handle::{HasDisplayHandle as _, RawDisplayHandle};
use winit::window::Window;

/// The clipboard: other programs can paste its text as long as this lives, and longer where the
/// desktop keeps it.
pub(super) struct Clipboard {
    /// Under Wayland only the window that has the keyboard may copy, over its own connection.
    #[cfg(all(unix, not(target_vendor = "apple")))]
    wayland: Option<smithay_clipboard::Clipboard>,
    /// Elsewhere; connected to when the first text is copied.
    desktop: Option<arboard::Clipboard>,
}

impl Clipboard {
    /// The clipboard beside `window`, which must not outlive the display that the window is on.
    pub(super) fn beside(window: &Window) -> Clipboard {
        #[cfg(not(all(unix, not(target_vendor = "apple"))))]
        let _ = window;
        Clipboard {
            #[cfg(all(unix, not(target_vendor = "apple")))]
            wayland: window
                .display_handle()
                .ok()
                .and_then(|handle| match handle.as_raw() {
                    RawDisplayHandle::Wayland(wayland) => {
                        // SAFETY: the event loop keeps the display open; window and clipboard go
                        // before it.
                        Some(unsafe { smithay_clipboard::Clipboard::new(wayland.display.as_ptr()) })
                    }
                    _ => None,
                }),
            desktop: None,
        }
    }

    /// Copies `text`, without waiting for a program that pastes it.
    ///
    /// # Errors
    /// Where there is no clipboard, or another program keeps it.
    pub(super) fn copy(&mut self, text: String) -> Result<(), arboard::Error> {
        #[cfg(all(unix, not(target_vendor = "apple")))]
        if let Some(wayland) = &self.wayland {
            wayland.store(text);
            return Ok(());
        }
        let desktop = match self.desktop.take() {
            Some(desktop) => desktop,
            None => arboard::Clipboard::new()?,
        };
        self.desktop.insert(desktop).set_text(text)
    }
}
