//! A window that grows for the panel beside its picture, and shrinks again.

use std::time::{Duration, Instant};

use glam::UVec2;
use winit::dpi::{PhysicalPosition, PhysicalSize};
use winit::window::Window;

/// How long a window that was asked for another size is not drawn: a window manager may refuse.
const RESIZE_TIMEOUT: Duration = Duration::from_millis(100);

/// What a window was asked to become.
#[derive(Clone, Copy, Default)]
pub(super) struct Growth {
    /// The sizes before and after it grew; `None` where it did not.
    grown: Option<[UVec2; 2]>,
    /// Until when a new size is awaited, if one is.
    awaited: Option<Instant>,
}

impl Growth {
    /// The window has a new size. The first one after it was asked to grow is as large as the
    /// window manager let it become.
    pub(super) fn resized(&mut self, surface: UVec2) {
        if let (Some([_, after]), Some(_)) = (&mut self.grown, self.awaited.take()) {
            *after = surface;
        }
    }

    /// Asks a window that is neither maximised nor fills the screen to become as large as `wanted`
    /// for the panel, where the monitor has the room. Its new size, where it has that at once.
    pub(super) fn grow(
        &mut self,
        window: &Window,
        surface: UVec2,
        wanted: UVec2,
    ) -> Option<PhysicalSize<u32>> {
        let most = window.current_monitor().map(|monitor| monitor.size());
        let most = most.map_or(UVec2::MAX, |size| UVec2::new(size.width, size.height));
        let size = wanted.min(most).max(surface);
        self.grown = None;
        if is_fixed(window) || size == surface {
            return None;
        }
        self.grown = Some([surface, size]);
        make_room(window, size.x - surface.x);
        self.ask(window, size)
    }

    /// Asks a window that has grown to shrink again, unless it was given another size meanwhile.
    /// Its new size, where it has that at once.
    pub(super) fn shrink(&mut self, window: &Window, surface: UVec2) -> Option<PhysicalSize<u32>> {
        let [before, after] = self.grown.take()?;
        if is_fixed(window) || after != surface || before == surface {
            return None;
        }
        self.ask(window, before)
    }

    fn ask(&mut self, window: &Window, size: UVec2) -> Option<PhysicalSize<u32>> {
        self.awaited = Some(Instant::now() + RESIZE_TIMEOUT);
        window.request_inner_size(PhysicalSize::new(size.x, size.y))
    }

    /// Until when a new size of the window is awaited, if one is.
    pub(super) fn awaited(&mut self, now: Instant) -> Option<Instant> {
        self.awaited.take_if(|until| *until <= now);
        self.awaited
    }
}

fn is_fixed(window: &Window) -> bool {
    window.fullscreen().is_some() || window.is_maximized()
}

/// Moves the window to the left by as much as it would reach beyond its monitor when it is wider by
/// `growth`, where the desktop says where it is.
fn make_room(window: &Window, growth: u32) {
    let (Ok(place), Some(monitor)) = (window.outer_position(), window.current_monitor()) else {
        return;
    };
    let right = place.x + (window.outer_size().width + growth) as i32;
    let beyond = right - (monitor.position().x + monitor.size().width as i32);
    let left = (place.x - beyond.max(0)).max(monitor.position().x);
    if left < place.x {
        window.set_outer_position(PhysicalPosition::new(left, place.y));
    }
}
