//! Verdicts on pixels, and how many there are of each kind.

use super::wrong_decision::WrongPixels;
use crate::tracer::Decision;

/// What is wrong with a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Verdict {
    /// Nothing: the pixel is the true one bit for bit.
    Right,
    /// The pixel is within the tolerance of the true one.
    Rounding,
    /// The pixel is within the tolerance of the colour of this decision, a wrong one, and of no
    /// other. The face of a tetrahedron in shadow, which no colour tells, is the true face or 0.
    Shows(Decision),
    /// The pixel is within the tolerance of the colours of several wrong decisions.
    Several,
    /// The pixel has the colour of no decision.
    AnotherColor,
    /// A sample is a NaN.
    NotANumber,
}

/// How many pixels there are of each kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Summary {
    /// Those of [`Verdict::Right`].
    pub right: u64,
    /// Those of [`Verdict::Rounding`].
    pub rounding: u64,
    /// Those of [`Verdict::Shows`], by what is wrong with the decision.
    pub wrong_decisions: WrongPixels,
    /// Those of [`Verdict::Several`].
    pub several: u64,
    /// Those of [`Verdict::AnotherColor`].
    pub another_color: u64,
    /// Those of [`Verdict::NotANumber`].
    pub not_a_number: u64,
    /// Column and row of the pixel with the largest absolute error of a sample, the first of them;
    /// a NaN and an infinity are farther from the truth than any number. `None` where all pixels
    /// are right.
    pub worst: Option<(u32, u32)>,
}

impl Summary {
    /// Pixels that are neither right nor a rounding.
    pub fn wrong(&self) -> u64 {
        self.wrong_decisions.total() + self.several + self.another_color + self.not_a_number
    }

    /// The counts of two pictures; the worst pixel is that of the first where it has one.
    #[cfg(feature = "program")]
    pub(crate) fn and(&self, other: &Summary) -> Summary {
        Summary {
            right: self.right + other.right,
            rounding: self.rounding + other.rounding,
            wrong_decisions: self.wrong_decisions.and(other.wrong_decisions),
            several: self.several + other.several,
            another_color: self.another_color + other.another_color,
            not_a_number: self.not_a_number + other.not_a_number,
            worst: self.worst.or(other.worst),
        }
    }

    pub(super) fn add(&mut self, verdict: Verdict, truth: Decision) {
        match verdict {
            Verdict::Right => self.right += 1,
            Verdict::Rounding => self.rounding += 1,
            Verdict::Shows(decision) => self.wrong_decisions.add(decision, truth),
            Verdict::Several => self.several += 1,
            Verdict::AnotherColor => self.another_color += 1,
            Verdict::NotANumber => self.not_a_number += 1,
        }
    }
}
