//! The events of the application.

use winit::application::ApplicationHandler;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::WindowId;

use super::App;
use crate::viewer::ui::Wish;

impl ApplicationHandler for App<'_> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.ui.gl_window.is_none() {
            let opened = self.open(event_loop);
            self.check(event_loop, opened);
        }
    }

    fn suspended(&mut self, _event_loop: &ActiveEventLoop) {
        self.ui.close();
    }

    fn exiting(&mut self, _event_loop: &ActiveEventLoop) {
        self.ui.close();
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if let StartCause::ResumeTimeReached { .. } = cause {
            event_loop.set_control_flow(ControlFlow::Wait);
            self.ui.overdue = true;
            self.ui.ask_for_redraw();
        }
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, (): ()) {
        let received = self.receive(event_loop);
        self.check(event_loop, received);
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match self.ui.window_event(event_loop, event) {
            None => {}
            Some(Wish::Redraw) => {
                let drawn = self.redraw(event_loop);
                self.check(event_loop, drawn);
            }
            Some(Wish::Act(action)) => self.act(action),
            Some(Wish::Explain(pixel)) => self.explain(pixel),
        }
    }
}
