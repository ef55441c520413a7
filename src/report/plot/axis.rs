//! Logarithmic axes.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

/// Positive numbers, labelled at 1, 2 and 5 of every decade, or at its 1 only.
#[derive(Clone, Copy, Debug)]
pub(super) struct LogAxis {
    /// The decimal logarithms of the ends.
    ends: [f64; 2],
}

/// Errors, labelled at decades, with a place for 0 below the smallest.
#[derive(Clone, Copy, Debug)]
pub(super) struct ErrorAxis {
    /// The decades of the smallest and the largest label.
    decades: [i32; 2],
}

/// What an error axis has above its last label, in decades.
const TOP: f64 = 0.3;

impl LogAxis {
    /// An axis that has room for all `values`.
    pub(super) fn over(values: impl Iterator<Item = f64>) -> LogAxis {
        let [low, high] = logarithms(values).unwrap_or([0.0, 0.0]);
        // A little more on both sides, and never less than half a decade in all.
        let margin = ((high - low) * 0.06).max(0.25);
        let ends = [low - margin, high + margin];
        LogAxis { ends }
    }
}

impl ErrorAxis {
    /// An axis that has room for all `errors`, and for 1.
    pub(super) fn over(errors: impl Iterator<Item = f64>) -> ErrorAxis {
        let [low, high] = logarithms(errors).unwrap_or([0.0, 0.0]);
        // Above the last label there is room for a third of a decade.
        let decades = [
            (low.floor() as i32).min(-3),
            ((high - TOP).ceil() as i32).max(0),
        ];
        ErrorAxis { decades }
    }

    /// The error at its upper end.
    pub(super) fn upper_end(self) -> f64 {
        libm::pow(10.0, f64::from(self.decades[1]) + TOP)
    }

    /// Far enough below the smallest decade for a label.
    fn place_of_zero(self) -> f64 {
        let [low, high] = self.decades.map(f64::from);
        low - ((high - low) / 12.0).max(1.0)
    }

    /// Where an error is, in decades.
    fn place(self, error: f64) -> f64 {
        let lowest = self.place_of_zero();
        if error == 0.0 {
            lowest
        } else {
            libm::log10(error).clamp(lowest, f64::from(self.decades[1]) + TOP)
        }
    }
}

/// The least and the largest decimal logarithm of the positive numbers; `None` if there are none.
fn logarithms(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let positive = values.filter(|value| *value > 0.0 && value.is_finite());
    positive
        .map(libm::log10)
        .fold(None, |ends, value| match ends {
            None => Some([value; 2]),
            Some([low, high]) => Some([low.min(value), high.max(value)]),
        })
}

fn power_of_ten(exponent: i32) -> f64 {
    libm::pow(10.0, exponent.into())
}

/// The pixel at `place` of the axis from `low` to `high`.
fn pixel(place: f64, [low, high]: [f64; 2], limit: (i32, i32)) -> i32 {
    let part = (place - low) / (high - low);
    (f64::from(limit.0) + part * f64::from(limit.1 - limit.0)).round() as i32
}

impl Ranged for LogAxis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        pixel(libm::log10(*value), self.ends, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let [low, high] = self.ends.map(|end| end.floor() as i32);
        let points = |digits: &[f64]| -> Vec<f64> {
            (low..=high)
                .flat_map(|decade| digits.iter().map(move |digit| digit * power_of_ten(decade)))
                .filter(|value| self.range().contains(value))
                .collect()
        };
        let fine = points(&[1.0, 2.0, 5.0]);
        if fine.len() <= hint.max_num_points() {
            fine
        } else {
            points(&[1.0])
        }
    }

    fn range(&self) -> Range<f64> {
        let [low, high] = self.ends.map(|end| libm::pow(10.0, end));
        low..high
    }
}

impl ValueFormatter<f64> for LogAxis {
    fn format_ext(&self, value: &f64) -> String {
        // 0.1 is not 0.1 exactly, nor 1e-1 what a power gives.
        let decimals = (-libm::log10(*value) - 1e-9).ceil().max(0.0) as usize;
        format!("{value:.decimals$}")
    }
}

impl Ranged for ErrorAxis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let ends = [self.place_of_zero() - 0.4, f64::from(self.decades[1]) + TOP];
        pixel(self.place(*value), ends, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let [low, high] = self.decades;
        let decades = (high - low + 1).max(1) as usize;
        let step = decades.div_ceil(hint.max_num_points().max(2) - 1);
        let labelled = (low..=high).rev().step_by(step);
        labelled.map(power_of_ten).chain([0.0]).collect()
    }

    fn range(&self) -> Range<f64> {
        0.0..self.upper_end()
    }
}

impl ValueFormatter<f64> for ErrorAxis {
    fn format_ext(&self, value: &f64) -> String {
        let exponent = libm::log10(*value).round() as i32;
        match exponent {
            _ if *value == 0.0 => "0".to_owned(),
            0 => "1".to_owned(),
            1 => "10".to_owned(),
            _ => format!("10{}", superscript(exponent)),
        }
    }
}

fn superscript(number: i32) -> String {
    number
        .to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '4' => '⁴',
            '5' => '⁵',
            '6' => '⁶',
            '7' => '⁷',
            '8' => '⁸',
            '9' => '⁹',
            _ => '⁰',
        })
        .collect()
}
