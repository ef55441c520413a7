//! What the pointer does: drags and turns of the wheel. Places are pixels of the window, counted
//! from its bottom left corner.

use glam::IVec2;
use winit::event::MouseScrollDelta;

/// A press that moves less than this, in pixels of the window, is a click.
const CLICK: i32 = 4;

/// So many pixels of a touchpad are as much as a notch of a wheel.
const NOTCH: f64 = 40.0;

/// What the pointer asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Gesture {
    /// The picture follows the pointer, which was pressed at `from`.
    Drag { from: IVec2, by: IVec2 },
    /// Notches of the wheel; away from the person is positive, and nearer to the picture.
    Wheel { steps: i32, at: IVec2 },
    /// The pointer moved while no button was down.
    Hover,
    /// The left button was pressed and let go without moving.
    Click { at: IVec2 },
}

/// The pointer over the window.
#[derive(Debug, Default)]
pub(super) struct Pointer {
    /// `None` where it is outside.
    place: Option<IVec2>,
    press: Option<ButtonPress>,
    /// The fraction of a notch that was turned since the last whole one.
    notches: f64,
}

/// The left button is down.
#[derive(Debug)]
struct ButtonPress {
    /// Where it went down.
    start: IVec2,
    /// The press has become a drag.
    drags: bool,
}

impl Pointer {
    pub(super) fn moved(&mut self, place: IVec2) -> Option<Gesture> {
        let last = self.place.replace(place);
        let Some(press) = &mut self.press else {
            return Some(Gesture::Hover);
        };
        if !press.drags {
            let distance = (place - press.start).abs().max_element();
            press.drags = distance >= CLICK;
            return press.drags.then(|| Gesture::Drag {
                from: press.start,
                by: place - press.start,
            });
        }
        let (from, by) = (press.start, place - last?);
        (by != IVec2::ZERO).then_some(Gesture::Drag { from, by })
    }

    /// It left the window. While a button is down, it is still told where it is.
    pub(super) fn left(&mut self) {
        if self.press.is_none() {
            self.place = None;
        }
    }

    /// Where it is; `None` where it is outside.
    pub(super) fn place(&self) -> Option<IVec2> {
        self.place
    }

    /// The left button went down or up.
    pub(super) fn pressed(&mut self, down: bool) -> Option<Gesture> {
        let press = self.place.filter(|_| down).map(|start| ButtonPress {
            start,
            drags: false,
        });
        let before = std::mem::replace(&mut self.press, press);
        let still = before.is_some_and(|before| !before.drags);
        let at = self.place.filter(|_| still && !down)?;
        Some(Gesture::Click { at })
    }

    pub(super) fn wheel(&mut self, delta: MouseScrollDelta) -> Option<Gesture> {
        let notches = match delta {
            MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
            MouseScrollDelta::PixelDelta(pixels) => pixels.y / NOTCH,
        };
        self.notches += notches;
        let steps = self.notches.trunc();
        self.notches -= steps;
        let at = self.place?;
        (steps != 0.0).then_some(Gesture::Wheel {
            steps: steps as i32,
            at,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_press_drags_once_it_moves_further_than_a_hand_trembles() {
        let mut pointer = Pointer::default();
        assert_eq!(pointer.moved(IVec2::new(10, 10)), Some(Gesture::Hover));
        assert_eq!(pointer.pressed(true), None);
        assert_eq!(pointer.moved(IVec2::new(13, 8)), None);
        let from = IVec2::new(10, 10);
        let by = IVec2::new(5, 2);
        let drag = pointer.moved(IVec2::new(15, 12));
        assert_eq!(drag, Some(Gesture::Drag { from, by }));
        let by = IVec2::new(-1, 0);
        let drag = pointer.moved(IVec2::new(14, 12));
        assert_eq!(drag, Some(Gesture::Drag { from, by }));
        assert_eq!(pointer.pressed(false), None);
        let at = IVec2::new(50, 50);
        assert_eq!(pointer.moved(at), Some(Gesture::Hover));
        assert_eq!(pointer.pressed(true), None);
        assert_eq!(pointer.moved(at + 2), None);
        assert_eq!(pointer.pressed(false), Some(Gesture::Click { at: at + 2 }));
    }

    #[test]
    fn parts_of_a_notch_add_up() {
        let mut pointer = Pointer::default();
        let at = IVec2::new(3, 4);
        pointer.moved(at);
        let lines = |lines| MouseScrollDelta::LineDelta(0.0, lines);
        assert_eq!(pointer.wheel(lines(0.5)), None);
        assert_eq!(
            pointer.wheel(lines(0.5)),
            Some(Gesture::Wheel { steps: 1, at })
        );
        assert_eq!(
            pointer.wheel(lines(-2.0)),
            Some(Gesture::Wheel { steps: -2, at })
        );
        pointer.left();
        assert_eq!(pointer.wheel(lines(1.0)), None);
    }
}
