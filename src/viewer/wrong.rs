//! What can be wrong with a pixel, and its colour in the error view.

use crate::diagnosis::{Verdict, WrongDecision};
use crate::difference::error_color;
use crate::tracer::Decision;

/// What is wrong with a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wrong {
    Solid,
    Face,
    Shadow,
    Mirror,
    /// It shows what more than one decision gives.
    Several,
    /// It shows what no decision gives.
    AnotherColor,
    NotANumber,
}

impl Wrong {
    /// All of them, in the order of the legend.
    pub(super) const ALL: [Wrong; 7] = [
        Wrong::Solid,
        Wrong::Face,
        Wrong::Shadow,
        Wrong::Mirror,
        Wrong::Several,
        Wrong::AnotherColor,
        Wrong::NotANumber,
    ];

    /// What is wrong with a decision; `None` where it is the true one.
    pub(super) fn of_decision(decision: Decision, truth: Decision) -> Option<Wrong> {
        Some(match WrongDecision::of(decision, truth)? {
            WrongDecision::Solid => Wrong::Solid,
            WrongDecision::Face => Wrong::Face,
            WrongDecision::Shadow => Wrong::Shadow,
            WrongDecision::Mirror => Wrong::Mirror,
        })
    }

    /// What is wrong by a verdict; `None` where the pixel is right, if not for rounding.
    pub(super) fn of_verdict(verdict: Verdict, truth: Decision) -> Option<Wrong> {
        match verdict {
            Verdict::Right | Verdict::Rounding => None,
            Verdict::Shows(decision) => Wrong::of_decision(decision, truth),
            Verdict::Several => Some(Wrong::Several),
            Verdict::NotANumber => Some(Wrong::NotANumber),
            Verdict::AnotherColor => Some(Wrong::AnotherColor),
        }
    }

    /// Its colour: none of the scale of errors, which goes from black over violet and orange to
    /// yellow.
    pub(super) fn color(self) -> [u8; 3] {
        match self {
            Wrong::Solid => [0, 255, 0],
            Wrong::Face => [0, 150, 60],
            Wrong::Shadow => [0, 90, 255],
            Wrong::Mirror => [255, 255, 255],
            Wrong::Several => [150, 150, 150],
            Wrong::AnotherColor => [255, 60, 200],
            Wrong::NotANumber => error_color(None),
        }
    }

    /// What it is called in the legend.
    pub(super) fn label(self) -> &'static str {
        match self {
            Wrong::Solid => "another solid",
            Wrong::Face => "another face",
            Wrong::Shadow => "wrong in shadow or light",
            Wrong::Mirror => "wrongly mirrored",
            Wrong::Several => "several decisions fit",
            Wrong::AnotherColor => "another colour",
            Wrong::NotANumber => "not a number",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_kinds_have_one_color_and_none_is_on_the_scale() {
        let ramp = (0..24).map(|octave| error_color(Some(1 << octave)));
        let mut colors: Vec<_> = Wrong::ALL
            .map(Wrong::color)
            .into_iter()
            .chain(ramp)
            .collect();
        let count = colors.len();
        colors.sort_unstable();
        colors.dedup();
        assert_eq!(colors.len(), count);
    }
}
