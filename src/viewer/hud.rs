//! The head-up display: what is written beside the picture and over it, in a panel, a menu and
//! notes.

use std::time::{Duration, Instant};

use glam::{IVec2, UVec2};

use crate::difference::error_color;

use super::action::{Action, DOES, Subject};
use super::canvas::TextBox;
use super::layout::Layout;
use super::lines::{DIM, HEADING, INK, Line, wrap};
use super::menu::Menu;
use super::panel::{Scroll, columns, note, panel};
use super::rect::Rect;
use super::wrong::Wrong;

/// How long a message stays, and the name of the pixel on which the pointer rests.
const READING_TIME: Duration = Duration::from_secs(4);

/// The column of an explanation, of the information and of a pixel of pictures in which the values
/// begin.
pub(super) const VALUES: usize = 13;

/// The head-up display.
#[derive(Debug, Default)]
pub(super) struct Hud {
    /// What the window shows.
    subject: Subject,
    pub(super) menu: Option<Menu>,
    pub(super) information: bool,
    /// Errors are shown, and what they are beside them.
    pub(super) errors: bool,
    text: PanelText,
    scroll: Scroll,
    /// The pixel under the pointer is named until then, for the pointer moved.
    pointed: Option<Instant>,
    message: Option<(String, Instant)>,
}

/// The longer text of the panel: one at a time.
#[derive(Debug, Default, PartialEq)]
enum PanelText {
    #[default]
    Nothing,
    Keys,
    /// A clicked pixel, column and row, and its text.
    Pixel(UVec2, String),
}

/// Lines of the panel under a heading.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) heading: &'static str,
    pub(super) text: String,
    /// The column under which a line that is too long goes on.
    pub(super) hanging: usize,
    /// Where false colours are shown: the kinds of wrong pixels that there are, and how many of
    /// each. The scale stands below them.
    pub(super) scale: Option<Vec<(Wrong, usize)>>,
}

/// What the head-up display says about the picture; each only where it is shown.
#[derive(Debug, Default)]
pub(super) struct HudValues {
    /// The panel, but for the longer text.
    pub(super) parts: Vec<Part>,
    /// The pixel under the pointer.
    pub(super) pixel: String,
    /// Where the pointer is.
    pub(super) pointer: Option<IVec2>,
    /// What is said as long as it is so.
    pub(super) notice: Option<String>,
    /// The wrong pixels, column and row, that are ringed.
    pub(super) rings: Vec<(UVec2, Wrong)>,
    /// The rows of the menu that stand for something that is on.
    pub(super) on: Vec<Action>,
}

impl Hud {
    /// That of a window that shows `subject`.
    pub(super) fn new(subject: Subject) -> Hud {
        Hud {
            subject,
            ..Hud::default()
        }
    }

    /// What the window shows.
    pub(super) fn subject(&self) -> Subject {
        self.subject
    }

    /// Whether anything stands beside the picture.
    pub(super) fn has_panel(&self) -> bool {
        self.subject == Subject::Pictures
            || self.information
            || self.errors
            || self.text != PanelText::Nothing
    }

    /// Whether the pixel under the pointer is named.
    pub(super) fn names_pixels(&self) -> bool {
        self.subject == Subject::Pictures
            || self.information
            || self.inspected().is_some()
            || self.pointed.is_some()
    }

    /// Names the pixel under the pointer, which moved at `now`, for a while.
    pub(super) fn point(&mut self, now: Instant) {
        self.pointed = Some(now + READING_TIME);
    }

    /// Nothing is pointed at any more.
    pub(super) fn unpoint(&mut self) {
        self.pointed = None;
    }

    /// Says `text` for a while.
    pub(super) fn say(&mut self, text: String) {
        self.message = Some((text, Instant::now() + READING_TIME));
    }

    /// Takes away what was there for a while; when the next of it goes.
    pub(super) fn expire(&mut self, now: Instant) -> Option<Instant> {
        self.message.take_if(|(_, end)| *end <= now);
        self.pointed.take_if(|end| *end <= now);
        let message = self.message.as_ref().map(|(_, end)| *end);
        message.into_iter().chain(self.pointed).min()
    }

    /// Shows the keys, or takes them away.
    pub(super) fn toggle_keys(&mut self) {
        self.show_text(match self.text {
            PanelText::Keys => PanelText::Nothing,
            PanelText::Nothing | PanelText::Pixel(..) => PanelText::Keys,
        });
    }

    /// Shows the text of a pixel that was clicked on.
    pub(super) fn inspect(&mut self, pixel: UVec2, text: String) {
        self.show_text(PanelText::Pixel(pixel, text));
    }

    fn show_text(&mut self, text: PanelText) {
        self.text = text;
        self.scroll = Scroll::default();
    }

    /// The pixel that was clicked on, and its text.
    pub(super) fn inspected(&self) -> Option<(UVec2, &str)> {
        match &self.text {
            PanelText::Pixel(pixel, text) => Some((*pixel, text)),
            PanelText::Nothing | PanelText::Keys => None,
        }
    }

    pub(super) fn keys_are_shown(&self) -> bool {
        self.text == PanelText::Keys
    }

    /// Closes the menu, else the text that is read; whether one was open.
    pub(super) fn close(&mut self) -> bool {
        if self.menu.take().is_some() {
            return true;
        }
        let open = self.text != PanelText::Nothing;
        self.show_text(PanelText::Nothing);
        open
    }

    /// Scrolls the panel by so many lines; whether that changes anything.
    pub(super) fn scroll(&mut self, lines: isize) -> bool {
        self.scroll.by(lines)
    }

    /// Scrolls the panel by almost a page; whether that changes anything.
    pub(super) fn turn_page(&mut self, forward: bool) -> bool {
        self.scroll.turn(forward)
    }

    /// Everything that is written in a window of `surface` pixels, with characters of `cell`
    /// pixels.
    pub(super) fn text_boxes(
        &mut self,
        (surface, layout): (UVec2, Layout),
        cell: UVec2,
        values: &HudValues,
    ) -> Vec<TextBox> {
        let mut text_boxes = Vec::new();
        let message = self.message.as_ref().map(|(text, _)| text.as_str());
        let message = message.or(values.notice.as_deref());
        let named = Some(values.pixel.as_str()).filter(|name| !name.is_empty());
        match layout.panel {
            Some(rect) => {
                let lines = self.lines(columns(rect, cell), values);
                let note = message.or(named);
                text_boxes.push(panel(rect, cell, &lines, note, &mut self.scroll));
            }
            None => {
                // Not over the pixel that it names.
                let high = |pointer: IVec2| pointer.y < 4 * cell.y as i32;
                let at_top = !values.pointer.is_some_and(high);
                let notes = [(named, at_top), (message, false)];
                // At the bottom there is room for one: a message, which goes sooner.
                let notes = notes
                    .into_iter()
                    .skip((message.is_some() && !at_top).into());
                let text_box = |(text, at_top): (Option<&str>, bool)| {
                    text.map(|text| note(text, layout.picture, cell, at_top))
                };
                text_boxes.extend(notes.filter_map(text_box));
            }
        }
        if let Some(menu) = &self.menu {
            text_boxes.push(menu.text_box(surface, cell, &values.on));
        }
        text_boxes
    }

    /// The lines of the panel.
    fn lines(&self, columns: usize, values: &HudValues) -> Vec<Line> {
        let mut lines = Vec::new();
        let mut part = |heading: &str, text: Vec<Line>| {
            if !lines.is_empty() {
                lines.push(Line::default());
            }
            lines.extend(wrap(heading, columns, 0, HEADING));
            lines.extend(text);
        };
        for given in &values.parts {
            let mut text = wrap(&given.text, columns, given.hanging, INK);
            text.extend(given.scale.iter().flat_map(|wrong| legend(wrong)));
            part(given.heading, text);
        }
        match &self.text {
            PanelText::Nothing => {}
            PanelText::Keys => {
                let mut text = wrap(&self.subject.key_table(), columns, DOES, INK);
                text.push(Line::default());
                text.extend(wrap(&self.subject.mouse_table(), columns, DOES, INK));
                part("Keys and mouse", text);
            }
            PanelText::Pixel(_, text) => {
                let mut text = wrap(text, columns, VALUES, INK);
                text.push(Line::default());
                text.extend(wrap("Ctrl+C copies this, Esc closes it", columns, 0, DIM));
                part("Pixel", text);
            }
        }
        lines
    }
}

/// The legend of the error view: the kinds of wrong pixels that there are; then the scale, a cell
/// for each octave from 1 f32 step to 2²⁴, and the colours of what has no error and of what is no
/// number.
fn legend(wrong: &[(Wrong, usize)]) -> Vec<Line> {
    let swatch = |color, meaning: &str| Line::default().swatch(0, color).text(2, meaning, INK);
    let kinds = wrong.iter().map(|&(kind, count)| {
        let meaning = format!("{}: {count}", kind.label());
        swatch(kind.color(), &meaning)
    });
    let strip = (0..=24).fold(Line::default(), |line, octave| {
        line.cell(octave, error_color(Some(1 << octave)))
    });
    let labels = [(0, "1"), (8, "2⁸"), (16, "2¹⁶"), (23, "2²⁴ f32 steps")];
    let labels = labels
        .into_iter()
        .fold(Line::default(), |line, (column, label)| {
            line.text(column, label, INK)
        });
    let mut lines: Vec<Line> = kinds.collect();
    lines.extend([strip, labels, swatch(error_color(Some(0)), "no error")]);
    if !wrong.iter().any(|(kind, _)| *kind == Wrong::NotANumber) {
        lines.push(swatch(error_color(None), "NaN"));
    }
    lines
}

/// The ring around a pixel of the picture that is drawn as `square`, `width` pixels wide and
/// `apart` from it: four bars.
pub(super) fn ring(square: Rect, apart: i32, width: i32) -> [Rect; 4] {
    let (inner, outer) = (square.grown(apart), square.grown(apart + width));
    let bar = |min: [i32; 2], max: [i32; 2]| Rect {
        min: min.into(),
        max: max.into(),
    };
    [
        bar([outer.min.x, outer.min.y], [outer.max.x, inner.min.y]),
        bar([outer.min.x, inner.max.y], [outer.max.x, outer.max.y]),
        bar([outer.min.x, inner.min.y], [inner.min.x, inner.max.y]),
        bar([inner.max.x, inner.min.y], [outer.max.x, inner.max.y]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_goes_all_around_and_leaves_the_square_free() {
        let square = Rect::new(IVec2::new(10, 20), UVec2::new(3, 5));
        let bars = ring(square, 1, 2);
        let area = |rect: &Rect| rect.size().element_product();
        assert_eq!(bars.iter().map(area).sum::<u32>(), 9 * 11 - 5 * 7);
        for bar in bars {
            assert!(bar.intersection(square.grown(1)).is_empty());
            assert_eq!(bar.intersection(square.grown(3)), bar);
        }
    }

    #[test]
    fn only_one_text_is_read_at_a_time_and_esc_closes_it() {
        let mut hud = Hud::default();
        hud.toggle_keys();
        hud.inspect(UVec2::new(3, 4), "pixel".to_owned());
        assert!(!hud.keys_are_shown() && hud.has_panel());
        assert_eq!(hud.inspected(), Some((UVec2::new(3, 4), "pixel")));
        hud.menu = Some(Menu::open(Subject::Scene, IVec2::ZERO));
        assert!(hud.close() && hud.inspected().is_some());
        assert!(hud.close() && !hud.has_panel());
        assert!(!hud.close());
    }
}
