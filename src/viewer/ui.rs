//! The window as a person has it: keyboard, pointer, clipboard, and what is written in it. It does
//! not know what the window shows.

mod events;

use std::time::Duration;

use winit::event_loop::ActiveEventLoop;
use winit::keyboard::ModifiersState;

use super::action::{Action, Subject};
use super::clipboard::Clipboard;
use super::hud::{Hud, HudValues, ring};
use super::menu::Menu;
use super::pointer::Pointer;
use super::window::{GlWindow, Mark, Opening};
use super::{Counts, ViewerError};
use glam::{IVec2, UVec2};

/// How often a window that nothing can be drawn on is polled: no event says when that ends.
pub(super) const POLL: Duration = Duration::from_millis(250);

/// The window and what it is handled with.
#[derive(Default)]
pub(super) struct Ui {
    /// `None` before the first `resumed`, and on systems that take the window away meanwhile.
    pub(super) gl_window: Option<GlWindow>,
    /// `None` without a window.
    clipboard: Option<Clipboard>,
    modifiers: ModifiersState,
    pub(super) pointer: Pointer,
    pub(super) hud: Hud,
    /// The next redisplay does not wait for the next picture: that took too long, or something else
    /// has changed.
    pub(super) overdue: bool,
    /// Other windows cover this one.
    occluded: bool,
    /// The window is an icon.
    minimized: bool,
    pub(super) counts: Counts,
}

/// What an event of the window asks of what is shown.
pub(super) enum Wish {
    Redraw,
    Act(Action),
    /// The pixel of the picture, column and row, is to be worked through.
    Explain(UVec2),
}

impl Ui {
    /// No window yet; it will show `subject`.
    pub(super) fn new(subject: Subject) -> Ui {
        Ui {
            hud: Hud::new(subject),
            ..Ui::default()
        }
    }

    /// Opens a window.
    pub(super) fn open(
        &mut self,
        event_loop: &ActiveEventLoop,
        opening: Opening,
    ) -> Result<&GlWindow, ViewerError> {
        let gl_window = GlWindow::open(event_loop, opening)?;
        gl_window.window().request_redraw();
        self.clipboard = Some(Clipboard::beside(gl_window.window()));
        Ok(self.gl_window.insert(gl_window))
    }

    /// Closes the window: while the display is still open.
    pub(super) fn close(&mut self) {
        self.clipboard = None;
        self.gl_window = None;
    }

    /// Whether the window can be drawn on and seen.
    pub(super) fn visible(&mut self) -> bool {
        let Some(gl_window) = &self.gl_window else {
            return false;
        };
        if self.minimized {
            self.minimized = gl_window.is_minimized();
        }
        !(self.occluded || self.minimized || gl_window.is_empty()) && gl_window.is_viewable()
    }

    /// Whether the window was an icon when the display was polled last.
    pub(super) fn is_minimized(&self) -> bool {
        self.minimized
    }

    /// Polls the display for the state of the window: only now and then, since each time is a round
    /// trip.
    pub(super) fn poll(&mut self) {
        if let Some(gl_window) = &self.gl_window {
            self.minimized = gl_window.is_minimized();
        }
    }

    /// Requests a redisplay at once, for something other than the picture has changed.
    pub(super) fn touch(&mut self) {
        if let Some(gl_window) = &mut self.gl_window {
            gl_window.show_panel(self.hud.has_panel());
        }
        self.overdue = true;
        self.ask_for_redraw();
    }

    pub(super) fn ask_for_redraw(&self) {
        if let Some(gl_window) = &self.gl_window {
            gl_window.window().request_redraw();
        }
    }

    /// Draws the picture, and over it and beside it what there is to say. What it took; where
    /// `waits`, until it is done. `None` where there is no window, or where the texture was lost
    /// and must be uploaded again.
    pub(super) fn draw(
        &mut self,
        values: &HudValues,
        waits: bool,
    ) -> Result<Option<Duration>, ViewerError> {
        let marks = self.marks(values);
        let Some(gl_window) = &mut self.gl_window else {
            return Ok(None);
        };
        let window = (gl_window.surface(), gl_window.layout());
        let text_boxes = self.hud.text_boxes(window, gl_window.cell(), values);
        let time = gl_window.draw((&marks, text_boxes), waits)?;
        self.counts.draws += u64::from(time.is_some());
        Ok(time)
    }

    /// Draws a window without a picture.
    pub(super) fn clear(&mut self) -> Result<(), ViewerError> {
        match &mut self.gl_window {
            Some(gl_window) => gl_window.clear(),
            None => Ok(()),
        }
    }

    /// The marks around single pixels of the picture.
    fn marks(&self, values: &HudValues) -> Vec<Mark> {
        let Some(gl_window) = &self.gl_window else {
            return Vec::new();
        };
        // As wide as a stroke of the characters.
        let line = (gl_window.cell().x / 7).max(1) as i32;
        let rings = values.rings.iter().flat_map(|&(pixel, wrong)| {
            let bars = ring(gl_window.rectangle(pixel), 4 * line, line);
            bars.map(|bar| (bar, wrong.color()))
        });
        let inspected = self.hud.inspected().into_iter().flat_map(|(pixel, _)| {
            let rectangle = gl_window.rectangle(pixel);
            let black = ring(rectangle, 0, 3 * line).map(|bar| (bar, [0; 3]));
            let white = ring(rectangle, line, line).map(|bar| (bar, [255; 3]));
            black.into_iter().chain(white)
        });
        rings.chain(inspected).collect()
    }

    /// The pixel of the picture under the pointer, column and row.
    pub(super) fn pointed_pixel(&self) -> Option<UVec2> {
        self.gl_window
            .as_ref()?
            .picture_pixel(self.pointer.place()?)
    }

    /// Does what an action asks of the window itself; the others are asked of what it shows.
    fn act(&mut self, event_loop: &ActiveEventLoop, action: Action) -> Option<Wish> {
        match action {
            Action::Copy => self.copy(),
            Action::Menu => {
                let place = self.pointer.place();
                self.toggle_menu(place);
            }
            Action::Help => {
                self.hud.toggle_keys();
                self.touch();
            }
            Action::Fit => {
                if let Some(gl_window) = &mut self.gl_window {
                    gl_window.fit();
                }
                self.touch();
            }
            Action::FullScreen => {
                if let Some(gl_window) = &self.gl_window {
                    gl_window.toggle_full_screen();
                }
            }
            Action::Leave => event_loop.exit(),
            action => return Some(Wish::Act(action)),
        }
        None
    }

    /// Copies the text of the pixel that was clicked on.
    fn copy(&mut self) {
        let (Some((_, text)), Some(clipboard)) = (self.hud.inspected(), &mut self.clipboard) else {
            self.hud
                .say("nothing to copy: click on a pixel first".to_owned());
            return self.touch();
        };
        let said = match clipboard.copy(text.to_owned()) {
            Ok(()) => "copied the text of the clicked pixel".to_owned(),
            Err(error) => format!("not copied: {error}"),
        };
        self.hud.say(said);
        self.touch();
    }

    /// Opens the menu at a pixel of the window, or at the corner, or closes it.
    fn toggle_menu(&mut self, place: Option<IVec2>) {
        if self.hud.menu.take().is_none()
            && let Some(gl_window) = &self.gl_window
        {
            let place = place.map_or(IVec2::ZERO, |place| gl_window.place_of(place));
            self.hud.menu = Some(Menu::open(self.hud.subject(), place));
        }
        self.touch();
    }
}
