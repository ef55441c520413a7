//! What there is to say about the picture that is shown.

use super::App;
use crate::Stage;
use crate::viewer::action::Action;
use crate::viewer::comparison::WRONG;
use crate::viewer::content::Content;
use crate::viewer::information::{information, name_pixel};
use crate::viewer::sheet::{Facts, ring};
use crate::viewer::window::Mark;

impl App<'_> {
    /// What the sheet says about the picture.
    pub(super) fn facts(&self) -> Facts {
        let (Some(view), Some(traced)) = (&self.view, self.content.traced()) else {
            return Facts::default();
        };
        let mut facts = Facts::default();
        if self.sheet.information {
            facts.information = information(traced, self.size, self.times);
        }
        if self.sheet.names_pixels()
            && let Some(place) = self.pointer.place()
            && let Some(pixel) = view.picture_pixel(place)
        {
            // One that was given back a moment ago is followed by another.
            if let Some(samples) = self.content.samples() {
                facts.pixel = name_pixel(samples, pixel);
            }
            facts.pointer = Some(view.place_of(place));
        }
        if let Content::Errors(_, errors) = &self.content {
            facts.errors = Some(errors.text(traced.frame, self.size));
            let rings = errors.done.iter().flat_map(|compared| &compared.rings);
            facts.rings.extend(rings);
        }
        facts.on.push(Action::Stage(self.stage));
        for (on, action) in [
            (
                self.stage == Stage::Animation && self.playback.paused(),
                Action::Pause,
            ),
            (self.content.shows_errors(), Action::Errors),
            (self.sheet.information, Action::Information),
            (self.sheet.keys_are_shown(), Action::Help),
        ] {
            facts.on.extend(on.then_some(action));
        }
        facts
    }

    /// What is drawn over the picture to show single pixels.
    pub(super) fn marks(&self, facts: &Facts) -> Vec<Mark> {
        let Some(view) = &self.view else {
            return Vec::new();
        };
        // A line, as wide as those of the characters.
        let line = (view.cell().x / 7).max(1) as i32;
        let rings = facts.rings.iter().flat_map(|&pixel| {
            let bars = ring(view.square(pixel), 4 * line, line);
            bars.map(|bar| (bar, WRONG))
        });
        let inspected = self.sheet.inspected().into_iter().flat_map(|(pixel, _)| {
            let square = view.square(pixel);
            let black = ring(square, 0, 3 * line).map(|bar| (bar, [0; 3]));
            let white = ring(square, line, line).map(|bar| (bar, [255; 3]));
            black.into_iter().chain(white)
        });
        rings.chain(inspected).collect()
    }
}
