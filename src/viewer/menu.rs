//! The main menu: the document's GLUT menu, made of the table of actions.

use glam::{IVec2, UVec2};

use super::action::{Action, MenuRow, Subject, rows};
use super::canvas::{Color, TextBox};
use super::lines::{DIM, INK};
use super::rect::Rect;

const BACKGROUND: Color = [40, 40, 48, 250];
const CHOSEN: Color = [70, 90, 150, 255];
const LINE: Color = [90, 90, 100, 255];

/// The open menu.
#[derive(Debug)]
pub(super) struct Menu {
    /// What the window shows.
    subject: Subject,
    /// Its top left corner, a pixel of the window, as far as it fits there.
    place: IVec2,
    /// The row that Enter or a click takes.
    selected: Option<usize>,
}

impl Menu {
    pub(super) fn open(subject: Subject, place: IVec2) -> Menu {
        Menu {
            subject,
            place,
            selected: None,
        }
    }

    fn rows(&self) -> impl Iterator<Item = MenuRow> {
        rows(self.subject)
    }

    /// Selects the row so many rows further, around the ends.
    pub(super) fn step(&mut self, by: isize) {
        let count = self.rows().count() as isize;
        let from = match self.selected {
            Some(row) => row as isize,
            None if by > 0 => -1,
            None => count,
        };
        self.selected = Some((from + by).rem_euclid(count) as usize);
    }

    /// The pointer is at `place`, in a window of `surface` pixels; whether that selects another
    /// row.
    pub(super) fn hover(&mut self, place: IVec2, surface: UVec2, cell: UVec2) -> bool {
        let under = self.row_at(place, surface, cell);
        let changed = under.is_some() && under != self.selected;
        if changed {
            self.selected = under;
        }
        changed
    }

    /// What a click at `place` asks for.
    pub(super) fn click(&self, place: IVec2, surface: UVec2, cell: UVec2) -> Option<Action> {
        let under = self.row_at(place, surface, cell)?;
        self.rows().nth(under).map(|row| row.action)
    }

    /// What the selected row asks for.
    pub(super) fn chosen(&self) -> Option<Action> {
        self.rows().nth(self.selected?).map(|row| row.action)
    }

    fn row_at(&self, place: IVec2, surface: UVec2, cell: UVec2) -> Option<usize> {
        let (rect, rows) = self.layout(surface, cell);
        let mut rows = rows.iter();
        rows.position(|row| row.intersection(rect).contains(place))
    }

    /// Where the menu and its rows lie in a window of `surface` pixels. A menu that is higher than
    /// the window is moved so that the selected row is seen.
    fn layout(&self, surface: UVec2, cell: UVec2) -> (Rect, Vec<Rect>) {
        let border = (cell.x / 2) as i32;
        let width = (self.columns() * cell.x) as i32 + 2 * border;
        let mut y = border;
        let mut places: Vec<Rect> = Vec::new();
        for row in self.rows() {
            y += if row.opens_group { cell.x as i32 } else { 0 };
            let size = UVec2::new(width as u32, cell.y + cell.y / 7);
            places.push(Rect::new(IVec2::new(0, y), size));
            y += size.y as i32;
        }
        let window = Rect::new(IVec2::ZERO, surface);
        let size = UVec2::new(width as u32, (y + border) as u32);
        let mut corner = Rect::new(self.place, size).moved_into(window).min;
        if let Some(row) = self.selected.and_then(|selected| places.get(selected)) {
            let hidden = corner.y + row.max.y + border - surface.y as i32;
            corner.y -= hidden.max(0);
        }
        for row in &mut places {
            *row = Rect::new(corner + row.min, row.size());
        }
        (Rect::new(corner, size).intersection(window), places)
    }

    /// The menu in a window of `surface` pixels, with a mark before the rows of `on`.
    pub(super) fn text_box(&self, surface: UVec2, cell: UVec2, on: &[Action]) -> TextBox {
        let (rect, places) = self.layout(surface, cell);
        let mut text_box = TextBox::new(rect, BACKGROUND);
        let left = |row: &Rect, column: u32| {
            let margin = (row.size().y - cell.y) / 2;
            row.min + IVec2::new((cell.x / 2 + column * cell.x) as i32, margin as i32)
        };
        for (number, (row, place)) in self.rows().zip(&places).enumerate() {
            if row.opens_group {
                let corner = place.min - IVec2::new(0, (cell.x / 2) as i32 + 1);
                let size = UVec2::new(place.size().x, (cell.x / 7).max(1));
                text_box.fill(Rect::new(corner, size), LINE);
            }
            if self.selected == Some(number) {
                text_box.fill(*place, CHOSEN);
            }
            if on.contains(&row.action) {
                text_box.text(left(place, 0), "•", INK);
            }
            text_box.text(left(place, 2), row.label, INK);
            let keys = self.columns() - 1 - row.keys.chars().count() as u32;
            text_box.text(left(place, keys), row.keys, DIM);
        }
        text_box
    }

    /// The columns of the widest row: a mark, the label, the keys, a margin.
    fn columns(&self) -> u32 {
        let longest = |text: fn(&MenuRow) -> &'static str| {
            let lengths = self.rows().map(|row| text(&row).chars().count());
            lengths.max().unwrap_or(0) as u32
        };
        2 + longest(|row| row.label) + 3 + longest(|row| row.keys) + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Stage;

    #[test]
    fn stepping_goes_through_every_row_and_around() {
        let mut menu = Menu::open(Subject::Scene, IVec2::ZERO);
        assert_eq!(menu.chosen(), None);
        let actions: Vec<Action> = rows(Subject::Scene).map(|row| row.action).collect();
        for &action in actions.iter().chain(&actions) {
            menu.step(1);
            assert_eq!(menu.chosen(), Some(action));
        }
        for &action in actions.iter().rev().skip(1) {
            menu.step(-1);
            assert_eq!(menu.chosen(), Some(action));
        }
        let mut menu = Menu::open(Subject::Scene, IVec2::ZERO);
        menu.step(-1);
        assert_eq!(menu.chosen(), Some(Action::Leave));
    }

    const CELL: UVec2 = UVec2::new(7, 14);

    #[test]
    fn the_pointer_selects_what_it_is_on() {
        let surface = UVec2::new(500, 500);
        let mut menu = Menu::open(Subject::Scene, IVec2::new(20, 20));
        let (rect, places) = menu.layout(surface, CELL);
        assert_eq!(rect.min, IVec2::new(20, 20));
        let middle = |row: usize| (places[row].min + places[row].max) / 2;
        assert!(menu.hover(middle(1), surface, CELL));
        assert!(!menu.hover(middle(1) + 1, surface, CELL));
        assert_eq!(menu.chosen(), Some(Action::Stage(Stage::Spheres)));
        let beside = IVec2::new(499, 250);
        assert!(!menu.hover(beside, surface, CELL));
        assert_eq!(menu.click(beside, surface, CELL), None);
        let first = menu.click(middle(0), surface, CELL);
        assert_eq!(first, Some(Action::Stage(Stage::Image)));
    }

    #[test]
    fn every_row_can_be_seen_in_a_small_window() {
        let surface = UVec2::new(90, 60);
        let mut menu = Menu::open(Subject::Scene, IVec2::new(50, 50));
        for number in 0..rows(Subject::Scene).count() {
            menu.step(1);
            let (rect, places) = menu.layout(surface, CELL);
            let seen = places[number].intersection(rect).size().y;
            assert_eq!(seen, places[number].size().y, "row {number}");
        }
    }
}
