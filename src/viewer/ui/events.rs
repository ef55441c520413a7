//! The events of the window: keys, the pointer, and what the display asks for.

use std::time::Instant;

use winit::event::{ElementState, KeyEvent, MouseButton, WindowEvent};
use winit::event_loop::ActiveEventLoop;
use winit::keyboard::{Key, NamedKey};

use super::{Ui, Wish};
use crate::viewer::action::Action;
use crate::viewer::key_press::KeyPress;
use crate::viewer::pointer::Gesture;

/// A notch of the wheel scrolls the panel by so many lines.
const SCROLLED: isize = 3;

impl Ui {
    /// Handles an event of the window; what it asks of what is shown, if anything.
    pub(in crate::viewer) fn window_event(
        &mut self,
        event_loop: &ActiveEventLoop,
        event: WindowEvent,
    ) -> Option<Wish> {
        match event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => event_loop.exit(),
            WindowEvent::RedrawRequested => return Some(Wish::Redraw),
            WindowEvent::ModifiersChanged(modifiers) => self.modifiers = modifiers.state(),
            WindowEvent::KeyboardInput {
                event,
                is_synthetic: false,
                ..
            } if event.state.is_pressed() => return self.key(event_loop, &event),
            WindowEvent::CursorMoved { position, .. } => {
                let place = self.gl_window.as_ref()?.window_pixel(position);
                let gesture = self.pointer.moved(place)?;
                return self.point(event_loop, gesture);
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
                let gesture = self.pointer.pressed(state.is_pressed())?;
                return self.point(event_loop, gesture);
            }
            WindowEvent::MouseInput {
                state: ElementState::Pressed,
                button: MouseButton::Right,
                ..
            } => self.toggle_menu(self.pointer.place()),
            WindowEvent::MouseWheel { delta, .. } => {
                let gesture = self.pointer.wheel(delta)?;
                return self.point(event_loop, gesture);
            }
            WindowEvent::Resized(size) => {
                if let Some(gl_window) = &mut self.gl_window {
                    gl_window.resize(size);
                    gl_window.window().request_redraw();
                }
            }
            WindowEvent::Occluded(occluded) => {
                self.occluded = occluded;
                if !occluded {
                    self.ask_for_redraw();
                }
            }
            _ => {}
        }
        None
    }

    /// Handles a key that goes down: the open menu's, the panel's, Esc, or a key of the table.
    fn key(&mut self, event_loop: &ActiveEventLoop, event: &KeyEvent) -> Option<Wish> {
        if self.hud.menu.is_some()
            && let Key::Named(key) = event.logical_key
            && let NamedKey::ArrowDown | NamedKey::ArrowUp | NamedKey::Enter = key
        {
            return self.menu_key(event_loop, key);
        }
        if self.panel_key(&event.logical_key)
            || event.logical_key == Key::Named(NamedKey::Escape) && self.escape()
        {
            return None;
        }
        let press = KeyPress {
            logical_key: &event.logical_key,
            physical_key: event.physical_key,
            location: event.location,
            modifiers: self.modifiers,
            repeat: event.repeat,
        };
        self.act(event_loop, press.action(self.hud.subject())?)
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
    fn point(&mut self, event_loop: &ActiveEventLoop, gesture: Gesture) -> Option<Wish> {
        if self.hud.menu.is_some() {
            return self.point_at_menu(event_loop, gesture);
        }
        let gl_window = self.gl_window.as_mut()?;
        match gesture {
            Gesture::Drag { from, .. } if gl_window.is_over_panel(from) => return None,
            Gesture::Drag { by, .. } => gl_window.drag(by),
            Gesture::Wheel { steps, at } if gl_window.is_over_panel(at) => {
                if !self.hud.scroll(-SCROLLED * steps as isize) {
                    return None;
                }
            }
            Gesture::Wheel { steps, at } => gl_window.zoom(steps, at),
            Gesture::Hover => {
                // The first picture does not wait for what lies over it.
                if self.pointed_pixel().is_some() && self.counts.draws > 0 {
                    self.hud.point(Instant::now());
                } else if !self.hud.names_pixels() {
                    return None;
                }
            }
            Gesture::Click { at } => return gl_window.picture_pixel(at).map(Wish::Explain),
        }
        self.touch();
        None
    }

    /// Handles a key of the open menu.
    fn menu_key(&mut self, event_loop: &ActiveEventLoop, key: NamedKey) -> Option<Wish> {
        let menu = self.hud.menu.as_mut()?;
        let chosen = match key {
            NamedKey::ArrowDown => {
                menu.step(1);
                None
            }
            NamedKey::ArrowUp => {
                menu.step(-1);
                None
            }
            _ => {
                let chosen = menu.chosen();
                self.hud.menu = None;
                chosen
            }
        };
        self.touch();
        self.choose(event_loop, chosen?)
    }

    /// Does what a row of the menu says.
    fn choose(&mut self, event_loop: &ActiveEventLoop, action: Action) -> Option<Wish> {
        // The menu has just been closed.
        if action == Action::Menu {
            return None;
        }
        self.act(event_loop, action)
    }

    /// Handles a gesture of the pointer while the menu is open.
    fn point_at_menu(&mut self, event_loop: &ActiveEventLoop, gesture: Gesture) -> Option<Wish> {
        let (gl_window, menu) = (self.gl_window.as_ref()?, self.hud.menu.as_mut()?);
        let (surface, cell) = (gl_window.surface(), gl_window.cell());
        let mut chosen = None;
        match gesture {
            Gesture::Hover => {
                let under = self.pointer.place().map(|place| gl_window.place_of(place));
                if !under.is_some_and(|place| menu.hover(place, surface, cell)) {
                    return None;
                }
            }
            Gesture::Wheel { steps, .. } => menu.step(-steps as isize),
            Gesture::Drag { .. } => return None,
            Gesture::Click { at } => {
                chosen = menu.click(gl_window.place_of(at), surface, cell);
                self.hud.menu = None;
            }
        }
        self.touch();
        self.choose(event_loop, chosen?)
    }
}
