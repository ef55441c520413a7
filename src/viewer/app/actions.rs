//! What each action does.

use std::time::Instant;

use glam::UVec2;

use super::App;
use crate::Stage;
use crate::image::Format;
use crate::viewer::action::Action;

/// α turned by an arrow key, in radians.
const NUDGE: f64 = 0.05;

/// What + and − do to the speed.
const FASTER: f64 = 1.25;

impl App<'_> {
    pub(super) fn act(&mut self, action: Action) {
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
                self.ui.hud.information = !self.ui.hud.information;
                self.ui.touch();
            }
            // Those of the window itself, and of another one.
            Action::Show(_)
            | Action::ShowNext
            | Action::Copy
            | Action::Menu
            | Action::Help
            | Action::Fit
            | Action::FullScreen
            | Action::Leave => return,
        }
        if !self.playing() {
            self.frame_rate.stop();
        }
        self.retitle();
        if self.playing() {
            self.ui.ask_for_redraw();
        } else {
            self.request();
            // That a renderer is slow is written over the last picture.
            if self.waits_for_renderer() {
                self.ui.ask_for_redraw();
            }
        }
    }

    /// Shows the errors of the picture, or the picture again.
    fn toggle_errors(&mut self) {
        self.content.toggle_errors(Instant::now());
        self.ui.hud.errors = self.content.shows_errors();
        // Errors that are not shown are not kept.
        self.comparing.forget();
        self.compare();
        self.ui.touch();
    }

    /// Pauses the animation if it is on.
    pub(super) fn stop(&mut self) {
        if self.stage == Stage::Animation {
            self.playback.pause();
        }
    }

    /// Has a pixel of the picture, column and row, worked through.
    pub(super) fn explain(&self, pixel: UVec2) {
        if let Some((traced, image)) = self.content.shown() {
            let image = image.cloned();
            self.tracing.explain(traced.frame.clone(), pixel, image);
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
}
