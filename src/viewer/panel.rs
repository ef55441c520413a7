//! The panel beside the picture: lines that scroll, and a note below them that does not.

use glam::{IVec2, UVec2};

use super::canvas::{Color, TextBox};
use super::lines::{INK, Line, wrap};
use super::rect::Rect;

const BACKGROUND: Color = [24, 24, 30, 255];
const BAR: Color = [90, 90, 100, 255];
const NOTE: Color = [0, 0, 0, 200];

/// The width that a panel should have, in characters.
const COLUMNS: u32 = 54;

/// The height that a panel below the picture should have, in lines.
const ROWS: u32 = 26;

/// The lines at the bottom that are kept free for a note, so that nothing moves when one comes.
const NOTE_LINES: usize = 2;

/// The margin on each side, in characters' widths.
const MARGIN: u32 = 1;

/// The width and height in pixels that a panel with such characters should have.
pub(super) fn wanted(cell: UVec2) -> UVec2 {
    UVec2::new(COLUMNS, ROWS) * cell + 2 * MARGIN * cell.x
}

/// The columns of a panel.
pub(super) fn columns(rect: Rect, cell: UVec2) -> usize {
    (rect.size().x / cell.x).saturating_sub(2 * MARGIN) as usize
}

/// How far the lines of a panel are scrolled, in lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Scroll {
    first: usize,
    /// The lines that are seen at a time.
    page: usize,
    lines: usize,
}

impl Scroll {
    /// Scrolls by so many lines, back where they are negative; whether that changes anything.
    pub(super) fn by(&mut self, lines: isize) -> bool {
        let last = self.lines.saturating_sub(self.page);
        let before = self.first;
        self.first = before.saturating_add_signed(lines).min(last);
        self.first != before
    }

    /// Scrolls by almost a page, forward or back; whether that changes anything.
    pub(super) fn turn(&mut self, forward: bool) -> bool {
        let page = self.page.saturating_sub(2).max(1) as isize;
        self.by(if forward { page } else { -page })
    }

    /// Keeps the position within so many lines, of which a page is seen at a time.
    fn fit(&mut self, lines: usize, page: usize) {
        (self.lines, self.page) = (lines, page);
        self.by(0);
    }
}

/// The panel in `rect`: `lines` scrolled as `scroll` says, which learns how many there are, above
/// `note`.
pub(super) fn panel(
    rect: Rect,
    cell: UVec2,
    lines: &[Line],
    note: Option<&str>,
    scroll: &mut Scroll,
) -> TextBox {
    let mut text_box = TextBox::new(rect, BACKGROUND);
    let margin = (MARGIN * cell.x) as i32;
    let inner = rect.grown(-margin);
    let height = cell.y as i32;
    let note = note.map_or(Vec::new(), |note| wrap(note, columns(rect, cell), 0, INK));
    let note_top = inner.max.y - height * note.len().max(NOTE_LINES) as i32;
    let text = Rect {
        max: IVec2::new(inner.max.x, note_top - height / 2).max(inner.min),
        ..inner
    };
    let page = (text.size().y / cell.y) as usize;
    scroll.fit(lines.len(), page);
    let seen = lines.iter().skip(scroll.first).take(page);
    for (line, y) in seen.zip((text.min.y..).step_by(cell.y as usize)) {
        line.paint(&mut text_box, IVec2::new(text.min.x, y), cell, text);
    }
    for (line, y) in note.iter().zip((note_top..).step_by(cell.y as usize)) {
        line.paint(&mut text_box, IVec2::new(inner.min.x, y), cell, inner);
    }
    if lines.len() > page && page > 0 {
        // The thumb is to the edge what the page is to the lines.
        let length = text.size().y as usize;
        let top = length * scroll.first / lines.len();
        let thumb = (length * page / lines.len()).max(1);
        let width = (cell.x / 2).max(1);
        let corner = IVec2::new(rect.max.x - width as i32, text.min.y + top as i32);
        text_box.fill(Rect::new(corner, UVec2::new(width, thumb as u32)), BAR);
    }
    text_box
}

/// A note over the picture, where there is no panel for it: at the top of `within`, or at its
/// bottom.
pub(super) fn note(text: &str, within: Rect, cell: UVec2, at_top: bool) -> TextBox {
    let margin = MARGIN * cell.x;
    let columns = columns(within, cell);
    let lines = wrap(text, columns, 0, INK);
    let longest = text.lines().map(|line| line.chars().count()).max();
    let width = longest.unwrap_or(0).min(columns) as u32;
    let size = UVec2::new(width, lines.len() as u32) * cell + 2 * margin;
    let bottom = within.max.y.saturating_sub_unsigned(size.y);
    let top = if at_top { within.min.y } else { bottom };
    let rect = Rect::new(IVec2::new(within.min.x, top), size);
    let mut text_box = TextBox::new(rect.intersection(within), NOTE);
    let corner = rect.min + margin as i32;
    for (line, y) in lines.iter().zip((corner.y..).step_by(cell.y as usize)) {
        line.paint(&mut text_box, IVec2::new(corner.x, y), cell, rect);
    }
    text_box
}

#[cfg(test)]
mod tests {
    use super::super::canvas::Paint;
    use super::*;

    const CELL: UVec2 = UVec2::new(7, 14);

    fn texts(text_box: &TextBox) -> Vec<&str> {
        let texts = text_box.paint.iter().filter_map(|paint| match paint {
            Paint::Text(_, text, ..) => Some(text.as_str()),
            Paint::Fill(..) => None,
        });
        texts.collect()
    }

    #[test]
    fn every_line_is_seen_on_some_page_and_the_note_on_each() {
        let rect = Rect::new(IVec2::new(500, 0), UVec2::new(300, 200));
        let numbers: Vec<String> = (0..40).map(|number| number.to_string()).collect();
        let lines: Vec<Line> = numbers
            .iter()
            .flat_map(|text| wrap(text, 9, 0, INK))
            .collect();
        let mut scroll = Scroll::default();
        let mut seen = Vec::new();
        loop {
            let text_box = panel(rect, CELL, &lines, Some("saved"), &mut scroll);
            let shown = texts(&text_box);
            assert_eq!((shown.last(), shown.len()), (Some(&"saved"), 11));
            for text in &shown[..10] {
                if !seen.contains(&text.to_string()) {
                    seen.push(text.to_string());
                }
            }
            if !scroll.turn(true) {
                break;
            }
        }
        assert_eq!(seen, numbers);
        // Fewer lines: what is left fits on a page.
        panel(rect, CELL, &lines[..3], None, &mut scroll);
        assert_eq!(scroll.first, 0);
    }

    #[test]
    fn a_note_is_wrapped_into_the_window() {
        let window = Rect::new(IVec2::ZERO, UVec2::new(120, 400));
        let text = "not saved: firsthit.png cannot be written here: make room";
        for at_top in [true, false] {
            let text_box = note(text, window, CELL, at_top);
            assert_eq!(text_box.rect.intersection(window), text_box.rect);
            assert_eq!(texts(&text_box).join(" "), text);
            assert_eq!(text_box.rect.min.y == 0, at_top);
        }
    }

    #[test]
    fn a_panel_without_room_is_no_panic() {
        let lines = wrap("one\ntwo", 5, 0, INK);
        for side in 0..60 {
            let rect = Rect::new(IVec2::ZERO, UVec2::new(side, 60 - side));
            let mut scroll = Scroll::default();
            panel(rect, CELL, &lines, Some("note"), &mut scroll);
            note("note", rect, CELL, true);
        }
    }
}
