//! The values that the head-up display shows.

use super::App;
use crate::Stage;
use crate::viewer::action::Action;
use crate::viewer::content::Content;
use crate::viewer::hud::{HudValues, ring};
use crate::viewer::information::{information, name_pixel};
use crate::viewer::window::Mark;

impl App<'_> {
    /// What the head-up display says about the picture.
    pub(super) fn hud_values(&self) -> HudValues {
        let (Some(gl_window), Some(traced)) = (&self.gl_window, self.content.traced()) else {
            return HudValues::default();
        };
        let mut values = HudValues {
            notice: self.notice(),
            ..HudValues::default()
        };
        if self.hud.information {
            values.information = information(traced, self.size, self.times);
        }
        if self.hud.names_pixels()
            && let Some(place) = self.pointer.place()
            && let Some(pixel) = gl_window.picture_pixel(place)
        {
            // Where the samples were given back, the next picture's come soon.
            if let Some(samples) = self.content.samples() {
                values.pixel = name_pixel(samples, pixel);
            }
            values.pointer = Some(gl_window.place_of(place));
        }
        if let Content::Errors(_, errors) = &self.content
            && !self.content.is_stand_in()
        {
            values.errors = Some(errors.text(&traced.frame, self.size));
            if let Some(compared) = &errors.done {
                values.rings.extend(&compared.rings);
                values.wrong.extend(&compared.wrong);
            }
        }
        values.on.push(Action::Stage(self.stage));
        for (on, action) in [
            (
                self.stage == Stage::Animation && self.playback.paused(),
                Action::Pause,
            ),
            (self.content.shows_errors(), Action::Errors),
            (self.hud.information, Action::Information),
            (self.hud.keys_are_shown(), Action::Help),
        ] {
            values.on.extend(on.then_some(action));
        }
        values
    }

    /// The marks around single pixels of the picture.
    pub(super) fn marks(&self, values: &HudValues) -> Vec<Mark> {
        let Some(gl_window) = &self.gl_window else {
            return Vec::new();
        };
        // As wide as a stroke of the characters.
        let line = (gl_window.cell().x / 7).max(1) as i32;
        let rings = values.rings.iter().flat_map(|&(pixel, wrong)| {
            let bars = ring(gl_window.square(pixel), 4 * line, line);
            bars.map(|bar| (bar, wrong.color()))
        });
        let inspected = self.hud.inspected().into_iter().flat_map(|(pixel, _)| {
            let square = gl_window.square(pixel);
            let black = ring(square, 0, 3 * line).map(|bar| (bar, [0; 3]));
            let white = ring(square, line, line).map(|bar| (bar, [255; 3]));
            black.into_iter().chain(white)
        });
        rings.chain(inspected).collect()
    }
}
