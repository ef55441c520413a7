//! A window that grows for the panel beside its picture, and shrinks again.

use std::time::{Duration, Instant};

use glam::UVec2;
use winit::dpi::{PhysicalPosition, PhysicalSize};

use super::View;
use crate::viewer::layout::with_panel;
use crate::viewer::panel;

/// How long a window that was asked for another size is not drawn: a window manager may refuse.
const PATIENCE: Duration = Duration::from_millis(100);

/// What a window was asked to become.
#[derive(Clone, Copy, Default)]
pub(super) struct Growth {
    /// The sizes before and after it grew; `None` where it did not.
    grown: Option<[UVec2; 2]>,
    /// A new size is on its way, but nobody waits for it any longer than until then.
    awaited: Option<Instant>,
}

impl Growth {
    /// The window has a new size. The first one after it was asked to grow is as large as the window
    /// manager let it become.
    pub(super) fn came(&mut self, surface: UVec2) {
        if let (Some([_, after]), Some(_)) = (&mut self.grown, self.awaited.take()) {
            *after = surface;
        }
    }
}

impl View {
    /// Opens or closes the panel. A window that is neither maximised nor fills the screen grows by what
    /// the panel needs, and shrinks again unless it was given another size meanwhile.
    pub(in crate::viewer) fn show_panel(&mut self, open: bool) {
        if self.panel == open {
            return;
        }
        let extent = self.zoom_to_fit().extent;
        self.change(|view| view.panel = open);
        let fixed = self.window.fullscreen().is_some() || self.window.is_maximized();
        let grown = self.growth.grown.take();
        let size = if open {
            let most = self.window.current_monitor().map(|monitor| monitor.size());
            let most = most.map_or(UVec2::MAX, |size| UVec2::new(size.width, size.height));
            let size = with_panel(self.surface, extent, panel::wanted(self.cell()));
            size.min(most).max(self.surface)
        } else {
            match grown {
                Some([before, after]) if after == self.surface => before,
                _ => self.surface,
            }
        };
        if fixed || self.is_empty() || size == self.surface {
            return;
        }
        if open {
            self.growth.grown = Some([self.surface, size]);
            self.make_room(size.x - self.surface.x);
        }
        self.growth.awaited = Some(Instant::now() + PATIENCE);
        let asked = PhysicalSize::new(size.x, size.y);
        if let Some(size) = self.window.request_inner_size(asked) {
            self.resize(size);
        }
    }

    /// Moves the window to the left by as much as it would reach beyond its monitor when it is wider by
    /// `growth`, where the desktop says where it is.
    fn make_room(&self, growth: u32) {
        let (Ok(place), Some(monitor)) =
            (self.window.outer_position(), self.window.current_monitor())
        else {
            return;
        };
        let right = place.x + (self.window.outer_size().width + growth) as i32;
        let beyond = right - (monitor.position().x + monitor.size().width as i32);
        let left = (place.x - beyond.max(0)).max(monitor.position().x);
        if left < place.x {
            let place = PhysicalPosition::new(left, place.y);
            self.window.set_outer_position(place);
        }
    }

    /// Until when a new size of the window is waited for, if it is.
    pub(in crate::viewer) fn awaits_size(&mut self, now: Instant) -> Option<Instant> {
        self.growth.awaited.take_if(|until| *until <= now);
        self.growth.awaited
    }
}
