//! Lines of text and coloured cells, wrapped to a number of columns.

use super::canvas::{Color, TextBox};
use super::rect::Rect;
use glam::{IVec2, UVec2};

pub(super) const INK: Color = [230, 230, 230, 255];
pub(super) const DIM: Color = [160, 160, 168, 255];
pub(super) const HEADING: Color = [252, 180, 60, 255];

/// Something in a line, from a column on; columns count characters.
#[derive(Clone, Debug, PartialEq)]
enum Part {
    Text(usize, String, Color),
    /// One cell, filled.
    Cell(usize, Color),
    /// The same with a frame, which also shows the colour of the background.
    Swatch(usize, Color),
}

/// A line on a grid of characters.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Line(Vec<Part>);

impl Line {
    pub(super) fn text(mut self, column: usize, text: impl Into<String>, color: Color) -> Line {
        self.0.push(Part::Text(column, text.into(), color));
        self
    }

    pub(super) fn cell(mut self, column: usize, [red, green, blue]: [u8; 3]) -> Line {
        self.0.push(Part::Cell(column, [red, green, blue, 255]));
        self
    }

    pub(super) fn swatch(mut self, column: usize, [red, green, blue]: [u8; 3]) -> Line {
        self.0.push(Part::Swatch(column, [red, green, blue, 255]));
        self
    }

    /// Paints it on `text_box`, its first cell's top left corner at `place`, inside `clip`.
    pub(super) fn paint(&self, text_box: &mut TextBox, place: IVec2, cell: UVec2, clip: Rect) {
        let at = |column: usize| IVec2::new(place.x + (column * cell.x as usize) as i32, place.y);
        for part in &self.0 {
            match part {
                Part::Text(column, text, color) => {
                    text_box.text_within(at(*column), text.as_str(), *color, clip);
                }
                Part::Cell(column, color) => {
                    text_box.fill(Rect::new(at(*column), cell).intersection(clip), *color);
                }
                Part::Swatch(column, color) => {
                    let whole = Rect::new(at(*column), cell);
                    let line = (cell.x / 7).max(1) as i32;
                    text_box.fill(whole.intersection(clip), DIM);
                    text_box.fill(whole.grown(-line).intersection(clip), *color);
                }
            }
        }
    }
}

/// The lines of `text`, none longer than `columns`. They are broken at spaces, inside a word only
/// where it has no line to itself, and go on under column `hanging`.
pub(super) fn wrap(text: &str, columns: usize, hanging: usize, color: Color) -> Vec<Line> {
    let lines = text.lines().flat_map(|line| broken(line, columns, hanging));
    lines
        .map(|(column, line)| Line::default().text(column, line, color))
        .collect()
}

/// The pieces of one line, each with its first column.
fn broken(line: &str, columns: usize, hanging: usize) -> Vec<(usize, String)> {
    let columns = columns.max(1);
    // Where little room would be left, lines go on further left.
    let hanging = if hanging > columns / 2 {
        columns / 8
    } else {
        hanging
    };
    let mut rest: Vec<char> = line.chars().collect();
    let mut pieces = Vec::new();
    let mut start = 0;
    loop {
        let room = columns - start;
        if rest.len() <= room {
            pieces.push((start, rest.into_iter().collect()));
            return pieces;
        }
        // The spaces at the beginning belong to the layout: a break there gains nothing.
        let first = rest.iter().take_while(|c| **c == ' ').count();
        let space = rest[..=room].iter().rposition(|c| *c == ' ');
        let end = space.filter(|&space| space > first).unwrap_or(room);
        let tail = rest.split_off(end);
        let piece: String = rest.into_iter().collect();
        pieces.push((start, piece.trim_end().to_owned()));
        rest = tail.into_iter().skip_while(|c| *c == ' ').collect();
        start = hanging;
        if rest.is_empty() {
            return pieces;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(line: &str, columns: usize, hanging: usize) -> Vec<String> {
        let pieces = broken(line, columns, hanging);
        let indent = |(column, text): (usize, String)| " ".repeat(column) + &text;
        pieces.into_iter().map(indent).collect()
    }

    #[test]
    fn lines_break_at_spaces_and_go_on_under_their_value() {
        let line = "meets    the plane at t = 1.07, in the square";
        assert_eq!(pieces(line, 80, 9), [line]);
        let broken = [
            "meets    the plane at t",
            "         = 1.07, in the",
            "         square",
        ];
        assert_eq!(pieces(line, 23, 9), broken);
        assert_eq!(pieces("a bc", 4, 0), ["a bc"]);
        assert_eq!(pieces("ab c ", 4, 0), ["ab c"]);
    }

    #[test]
    fn nothing_is_cut_off_however_narrow() {
        let line = "not saved: /a/very/long/path/without/a/space.png: no space left, α ≤ 2";
        let characters = |text: &str| text.chars().filter(|c| *c != ' ').count();
        for columns in 0..80 {
            for hanging in [0, 9, 40] {
                let pieces = pieces(line, columns, hanging);
                let written: usize = pieces.iter().map(|piece| characters(piece)).sum();
                assert_eq!(written, characters(line), "{columns} columns");
                let longest = pieces.iter().map(|piece| piece.chars().count()).max();
                assert!(longest <= Some(columns.max(1)), "{columns} columns");
            }
        }
    }

    #[test]
    fn an_empty_line_stays_a_line() {
        assert_eq!(wrap("a\n\nb", 10, 0, INK).len(), 3);
    }
}
