//! The events of the window: keys, the pointer, and what the display asks for.

use std::time::Instant;

use glam::IVec2;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, MouseButton, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::keyboard::{Key, NamedKey};
use winit::window::WindowId;

use super::App;
use crate::viewer::action::Action;
use crate::viewer::key_press::KeyPress;
use crate::viewer::menu::Menu;
use crate::viewer::pointer::Gesture;

/// A notch of the wheel scrolls the panel by so many lines.
const SCROLLED: isize = 3;

impl ApplicationHandler for App<'_> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.gl_window.is_none() {
            let opened = self.open(event_loop);
            self.check(event_loop, opened);
        }
    }

    fn suspended(&mut self, _event_loop: &ActiveEventLoop) {
        self.clipboard = None;
        self.gl_window = None;
    }

    fn exiting(&mut self, _event_loop: &ActiveEventLoop) {
        // While the display is still open.
        self.clipboard = None;
        self.gl_window = None;
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if let StartCause::ResumeTimeReached { .. } = cause {
            event_loop.set_control_flow(ControlFlow::Wait);
            self.overdue = true;
            self.ask_for_redraw();
        }
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, (): ()) {
        let received = self.receive(event_loop);
        self.check(event_loop, received);
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => event_loop.exit(),
            WindowEvent::RedrawRequested => {
                let drawn = self.redraw(event_loop);
                self.check(event_loop, drawn);
            }
            WindowEvent::ModifiersChanged(modifiers) => self.modifiers = modifiers.state(),
            WindowEvent::KeyboardInput {
                event,
                is_synthetic: false,
                ..
            } if event.state.is_pressed() => {
                if self.menu_key(event_loop, &event.logical_key)
                    || self.panel_key(&event.logical_key)
                    || event.logical_key == Key::Named(NamedKey::Escape) && self.escape()
                {
                } else if let Some(action) = self.pressed(&event) {
                    self.act(event_loop, action);
                }
            }
            WindowEvent::CursorMoved { position, .. } => {
                if let Some(gl_window) = &self.gl_window
                    && let Some(gesture) = self.pointer.moved(gl_window.window_pixel(position))
                {
                    self.point(event_loop, gesture);
                }
            }
            WindowEvent::CursorLeft { .. } => {
                self.pointer.left();
                if self.hud.names_pixels() {
                    self.hud.unpoint();
                    self.touch();
                }
            }
            WindowEvent::MouseInput {
                state,
                button: MouseButton::Left,
                ..
            } => {
                if let Some(gesture) = self.pointer.pressed(state.is_pressed()) {
                    self.point(event_loop, gesture);
                }
            }
            WindowEvent::MouseInput {
                state: ElementState::Pressed,
                button: MouseButton::Right,
                ..
            } => self.toggle_menu(self.pointer.place()),
            WindowEvent::MouseWheel { delta, .. } => {
                if let Some(gesture) = self.pointer.wheel(delta) {
                    self.point(event_loop, gesture);
                }
            }
            WindowEvent::Resized(size) => {
                if let Some(gl_window) = &mut self.gl_window {
                    gl_window.resize(size);
                    gl_window.window().request_redraw();
                }
            }
            WindowEvent::Occluded(occluded) => {
                self.occluded = occluded;
                if let Some(gl_window) = self.gl_window.as_ref().filter(|_| !occluded) {
                    gl_window.window().request_redraw();
                }
            }
            _ => {}
        }
    }
}

impl App<'_> {
    fn pressed(&self, event: &KeyEvent) -> Option<Action> {
        let press = KeyPress {
            logical_key: &event.logical_key,
            physical_key: event.physical_key,
            location: event.location,
            modifiers: self.modifiers,
            repeat: event.repeat,
        };
        press.action()
    }

    /// Closes what is open, else leaves full screen; whether there was either.
    fn escape(&mut self) -> bool {
        if self.hud.close() {
            self.touch();
            return true;
        }
        let full_screen = self
            .gl_window
            .as_ref()
            .filter(|gl_window| gl_window.is_full_screen());
        if let Some(gl_window) = full_screen {
            gl_window.toggle_full_screen();
        }
        full_screen.is_some()
    }

    /// Handles a key of the panel; whether it was one.
    fn panel_key(&mut self, key: &Key) -> bool {
        let forward = match key {
            Key::Named(NamedKey::PageDown) => true,
            Key::Named(NamedKey::PageUp) => false,
            _ => return false,
        };
        let turned = self.hud.turn_page(forward);
        if turned {
            self.touch();
        }
        turned
    }

    /// Handles a gesture of the pointer.
    fn point(&mut self, event_loop: &ActiveEventLoop, gesture: Gesture) {
        if self.hud.menu.is_some() {
            self.point_at_menu(event_loop, gesture);
            return;
        }
        let Some(gl_window) = &mut self.gl_window else {
            return;
        };
        match gesture {
            Gesture::Drag { from, .. } if gl_window.is_over_panel(from) => return,
            Gesture::Drag { by, .. } => gl_window.drag(by),
            Gesture::Wheel { steps, at } if gl_window.is_over_panel(at) => {
                if !self.hud.scroll(-SCROLLED * steps as isize) {
                    return;
                }
            }
            Gesture::Wheel { steps, at } => gl_window.zoom(steps, at),
            Gesture::Hover => {
                let place = self.pointer.place();
                let over = place.and_then(|place| gl_window.picture_pixel(place));
                // The first picture does not wait for what lies over it.
                if over.is_some() && self.counts.draws > 0 {
                    self.hud.point(Instant::now());
                } else if !self.hud.names_pixels() {
                    return;
                }
            }
            Gesture::Click { at } => {
                if let (Some(pixel), Some((traced, image))) =
                    (gl_window.picture_pixel(at), self.content.shown())
                {
                    self.tracing
                        .explain(traced.frame.clone(), pixel, image.cloned());
                }
                return;
            }
        }
        self.touch();
    }

    /// Opens the menu at a pixel of the window, or at the corner, or closes it.
    pub(super) fn toggle_menu(&mut self, place: Option<IVec2>) {
        if self.hud.menu.take().is_none()
            && let Some(gl_window) = &self.gl_window
        {
            let place = place.map_or(IVec2::ZERO, |place| gl_window.place_of(place));
            self.hud.menu = Some(Menu::open(place));
        }
        self.touch();
    }

    /// Handles a key of the open menu; whether it was one.
    fn menu_key(&mut self, event_loop: &ActiveEventLoop, key: &Key) -> bool {
        let Some(menu) = &mut self.hud.menu else {
            return false;
        };
        match key {
            Key::Named(NamedKey::ArrowDown) => menu.step(1),
            Key::Named(NamedKey::ArrowUp) => menu.step(-1),
            Key::Named(NamedKey::Enter) => {
                let chosen = menu.chosen();
                self.hud.menu = None;
                if let Some(action) = chosen {
                    self.choose(event_loop, action);
                }
            }
            _ => return false,
        }
        self.touch();
        true
    }

    /// Does what a row of the menu says.
    fn choose(&mut self, event_loop: &ActiveEventLoop, action: Action) {
        // The menu has just been closed.
        if action != Action::Menu {
            self.act(event_loop, action);
        }
    }

    /// Handles a gesture of the pointer while the menu is open.
    fn point_at_menu(&mut self, event_loop: &ActiveEventLoop, gesture: Gesture) {
        let (Some(gl_window), Some(menu)) = (&self.gl_window, &mut self.hud.menu) else {
            return;
        };
        let (surface, cell) = (gl_window.surface(), gl_window.cell());
        match gesture {
            Gesture::Hover => {
                let under = self.pointer.place().map(|place| gl_window.place_of(place));
                if !under.is_some_and(|place| menu.hover(place, surface, cell)) {
                    return;
                }
            }
            Gesture::Wheel { steps, .. } => menu.step(-steps as isize),
            Gesture::Drag { .. } => return,
            Gesture::Click { at } => {
                let action = menu.click(gl_window.place_of(at), surface, cell);
                self.hud.menu = None;
                if let Some(action) = action {
                    self.choose(event_loop, action);
                }
            }
        }
        self.touch();
    }
}
