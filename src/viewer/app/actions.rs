//! What each action does.

use std::time::Instant;

use winit::event_loop::ActiveEventLoop;

use super::App;
use crate::Stage;
use crate::image::Format;
use crate::viewer::action::Action;

/// α turned by an arrow key, in radians.
const NUDGE: f64 = 0.05;

/// What + and − do to the speed.
const FASTER: f64 = 1.25;

impl App<'_> {
    pub(super) fn act(&mut self, event_loop: &ActiveEventLoop, action: Action) {
        match action {
            Action::Stage(stage) if stage == self.stage => {}
            Action::Stage(Stage::Animation) => self.stage = Stage::Animation,
            Action::Stage(stage) => {
                self.stage = stage;
                self.playback.settle();
            }
            Action::Pause if self.stage == Stage::Animation => self.playback.toggle(),
            Action::Pause => {}
            Action::NextFrame => {
                self.stop();
                self.playback.next_frame();
            }
            Action::PreviousFrame => {
                self.stop();
                self.playback.previous_frame();
            }
            Action::TurnLeft => self.playback.nudge(-NUDGE),
            Action::TurnRight => self.playback.nudge(NUDGE),
            Action::Faster => self.playback.scale(FASTER),
            Action::Slower => self.playback.scale(1.0 / FASTER),
            Action::Zero => self.playback.zero(),
            Action::SavePng => self.save(Format::Png),
            Action::SaveExr => self.save(Format::Exr),
            Action::Errors => self.toggle_errors(),
            Action::NextKernel => self.renderers.show_next(),
            Action::Information => {
                self.hud.information = !self.hud.information;
                self.touch();
            }
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
        }
        if !self.playing() {
            self.frame_rate.stop();
        }
        self.retitle();
        if self.playing() {
            self.ask_for_redraw();
        } else {
            self.request();
            // That a renderer is slow is written over the last picture.
            if self.waits_for_renderer() {
                self.ask_for_redraw();
            }
        }
    }

    /// Shows the errors of the picture, or the picture again.
    fn toggle_errors(&mut self) {
        self.content.toggle_errors(Instant::now());
        // Errors that are not shown are not kept.
        self.comparing.forget();
        self.compare();
        self.touch();
    }

    /// Pauses the animation if it is on.
    pub(super) fn stop(&mut self) {
        if self.stage == Stage::Animation {
            self.playback.pause();
        }
    }

    fn save(&self, format: Format) {
        let frame = match self.content.traced() {
            // What a person sees is what is saved, although the next picture is on its way.
            Some(traced) if self.playing() => traced.frame.clone(),
            _ => self.wanted(),
        };
        self.tracing.save(frame, format);
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
}
