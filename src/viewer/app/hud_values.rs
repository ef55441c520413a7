//! The values that the head-up display shows.

use super::App;
use crate::Stage;
use crate::viewer::action::Action;
use crate::viewer::content::Content;
use crate::viewer::hud::{HudValues, Part, VALUES};
use crate::viewer::information::{information, name_pixel};

impl App<'_> {
    /// What the head-up display says about the picture.
    pub(super) fn hud_values(&self) -> HudValues {
        let (Some(gl_window), Some(traced)) = (&self.ui.gl_window, self.content.traced()) else {
            return HudValues::default();
        };
        let mut values = HudValues {
            notice: self.notice(),
            ..HudValues::default()
        };
        if self.ui.hud.information {
            values.parts.push(Part {
                heading: "Information",
                text: information(traced, self.size, self.times),
                hanging: VALUES,
                scale: None,
            });
        }
        if self.ui.hud.names_pixels()
            && let Some(place) = self.ui.pointer.place()
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
            let mut wrong = Vec::new();
            if let Some(compared) = &errors.done {
                values.rings.extend(&compared.rings);
                wrong.extend(&compared.wrong);
            }
            values.parts.push(Part {
                heading: "Errors",
                text: errors.text(&traced.frame, self.size),
                hanging: 2,
                scale: Some(wrong),
            });
        }
        values.on.push(Action::Stage(self.stage));
        for (on, action) in [
            (
                self.stage == Stage::Animation && self.playback.paused(),
                Action::Pause,
            ),
            (self.content.shows_errors(), Action::Errors),
            (self.ui.hud.information, Action::Information),
            (self.ui.hud.keys_are_shown(), Action::Help),
        ] {
            values.on.extend(on.then_some(action));
        }
        values
    }
}
