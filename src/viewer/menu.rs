//! The main menu: the document's GLUT menu, made of the table of actions.

use egui::{Pos2, Rect};

use super::action::{Action, rows};

/// The open menu.
#[derive(Debug)]
pub(super) struct Menu {
    /// Its top left corner in points, as far as it fits there.
    pub(super) place: Pos2,
    /// The row that Enter or a click takes.
    pub(super) selected: Option<usize>,
    /// Where the rows were drawn, in points; nothing of those that are scrolled out of sight.
    pub(super) drawn: Vec<Rect>,
}

impl Menu {
    pub(super) fn open(place: Pos2) -> Menu {
        Menu {
            place,
            selected: None,
            drawn: Vec::new(),
        }
    }

    /// Goes by so many rows from the selected one, and around.
    pub(super) fn step(&mut self, by: isize) {
        let count = rows().count() as isize;
        let from = match self.selected {
            Some(row) => row as isize,
            None if by > 0 => -1,
            None => count,
        };
        self.selected = Some((from + by).rem_euclid(count) as usize);
    }

    /// The pointer is at `place`; whether that selects another row.
    pub(super) fn hover(&mut self, place: Pos2) -> bool {
        let under = self.drawn.iter().position(|row| row.contains(place));
        let changed = under.is_some() && under != self.selected;
        if changed {
            self.selected = under;
        }
        changed
    }

    /// What a click at `place` asks for.
    pub(super) fn click(&mut self, place: Pos2) -> Option<Action> {
        let under = self.drawn.iter().position(|row| row.contains(place))?;
        rows().nth(under).map(|row| row.action)
    }

    /// What the selected row asks for.
    pub(super) fn chosen(&self) -> Option<Action> {
        rows().nth(self.selected?).map(|row| row.action)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Stage;

    #[test]
    fn stepping_goes_through_every_row_and_around() {
        let mut menu = Menu::open(Pos2::ZERO);
        assert_eq!(menu.chosen(), None);
        let actions: Vec<Action> = rows().map(|row| row.action).collect();
        for &action in actions.iter().chain(&actions) {
            menu.step(1);
            assert_eq!(menu.chosen(), Some(action));
        }
        for &action in actions.iter().rev().skip(1) {
            menu.step(-1);
            assert_eq!(menu.chosen(), Some(action));
        }
        let mut menu = Menu::open(Pos2::ZERO);
        menu.step(-1);
        assert_eq!(menu.chosen(), Some(Action::Leave));
    }

    #[test]
    fn the_pointer_selects_what_it_is_on() {
        let mut menu = Menu::open(Pos2::ZERO);
        let row = |top| Rect::from_min_max(Pos2::new(0.0, top), Pos2::new(100.0, top + 10.0));
        menu.drawn = vec![row(0.0), row(10.0), Rect::NOTHING];
        assert!(menu.hover(Pos2::new(50.0, 15.0)));
        assert!(!menu.hover(Pos2::new(51.0, 16.0)));
        assert_eq!(menu.chosen(), Some(Action::Stage(Stage::Spheres)));
        assert!(!menu.hover(Pos2::new(500.0, 15.0)));
        assert_eq!(menu.click(Pos2::new(500.0, 15.0)), None);
        let first = menu.click(Pos2::new(50.0, 5.0));
        assert_eq!(first, Some(Action::Stage(Stage::Image)));
    }
}
