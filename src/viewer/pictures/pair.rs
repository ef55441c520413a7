//! Two pictures of one size, their difference, and what there is to say about them.

use glam::UVec2;

use crate::difference::{Difference, error_color, steps, worst};
use crate::image::Raster;
use crate::viewer::ViewerError;
use crate::viewer::action::Side;
use crate::viewer::information::color_text;

/// The column of the list of pictures in which their names begin.
pub(super) const NAMES: usize = 8;

/// A picture to be looked at.
#[derive(Clone, Debug)]
pub struct Picture {
    /// What it is called: its file, perhaps.
    pub name: String,
    /// Its samples.
    pub image: Raster,
}

pub(super) struct Pair {
    pictures: [Picture; 2],
    /// Their difference in false colours.
    colors: Raster,
    difference: Difference,
}

impl Side {
    /// The one after it, after the last the first.
    pub(super) fn next(self) -> Side {
        match self {
            Side::A => Side::B,
            Side::B => Side::Difference,
            Side::Difference => Side::A,
        }
    }
}

impl Pair {
    /// # Errors
    /// Where the two are not of one size, or there is no memory for their difference.
    pub(super) fn new(pictures: [Picture; 2]) -> Result<Pair, ViewerError> {
        let [a, b] = [&pictures[0].image, &pictures[1].image];
        let difference = Difference::of(a, b)?;
        let mut colors = Raster::new(a.width(), a.height())?;
        let pairs = a.samples().chunks_exact(3).zip(b.samples().chunks_exact(3));
        for (color, (a, b)) in colors.samples_mut().chunks_exact_mut(3).zip(pairs) {
            let bytes = error_color(worst(a, b));
            color.copy_from_slice(&bytes.map(|byte| f32::from(byte) / 255.0));
        }
        Ok(Pair {
            pictures,
            colors,
            difference,
        })
    }

    /// The width and height of each picture.
    pub(super) fn size(&self) -> UVec2 {
        UVec2::new(self.colors.width(), self.colors.height())
    }

    pub(super) fn image(&self, side: Side) -> &Raster {
        match side {
            Side::A => &self.pictures[0].image,
            Side::B => &self.pictures[1].image,
            Side::Difference => &self.colors,
        }
    }

    /// What is shown, for the title of the window.
    pub(super) fn title(&self, side: Side) -> String {
        let [a, b] = self.names();
        match side {
            Side::A => format!("A: {a}"),
            Side::B => format!("B: {b}"),
            Side::Difference => format!("difference of {a} and {b}"),
        }
    }

    fn names(&self) -> [&str; 2] {
        [&self.pictures[0].name, &self.pictures[1].name]
    }

    /// Each with its key, one a line, a mark before the one that is shown; and how far the two are
    /// apart.
    pub(super) fn list(&self, shown: Side) -> String {
        let [a, b] = self.names();
        let rows = [
            (Side::A, format!("1  A  {a}")),
            (Side::B, format!("2  B  {b}")),
            (Side::Difference, "3     their difference".to_owned()),
        ];
        let line = |(side, row)| {
            let mark = if side == shown { '•' } else { ' ' };
            format!("{mark} {row}\n")
        };
        let rows: String = rows.into_iter().map(line).collect();
        format!(
            "{rows}  Tab   the next of them; H all keys\n{}",
            self.summary()
        )
    }

    fn summary(&self) -> String {
        let Difference {
            samples,
            wrong,
            max_steps,
            nan_against_number,
            ..
        } = self.difference;
        let nans = match nan_against_number {
            0 => String::new(),
            count => format!("\nNaN against a number: {count}"),
        };
        format!("wrong samples: {wrong} of {samples}\nat most {max_steps} f32 steps off{nans}")
    }

    /// What both are at a pixel, column and row, and how far apart; without one, the same lines
    /// without values.
    pub(super) fn pixel(&self, pixel: Option<UVec2>) -> String {
        let values = pixel.and_then(|pixel| self.values(pixel));
        let names = ["column", "row", "A", "B", "in bytes", "difference"];
        let line =
            |(name, value): (&str, String)| format!("{name:13}{value}").trim_end().to_owned();
        let lines = names.into_iter().zip(values.unwrap_or_default());
        lines.map(|row| line(row) + "\n").collect()
    }

    fn values(&self, UVec2 { x, y }: UVec2) -> Option<[String; 6]> {
        let [a, b] = [Side::A, Side::B].map(|side| self.image(side).pixel(x, y));
        let (a, b) = (a?, b?);
        let apart = [0, 1, 2].map(|channel| match steps(a[channel], b[channel]) {
            Some(steps) => steps.to_string(),
            None => "NaN".to_owned(),
        });
        let ([floats_a, bytes_a], [floats_b, bytes_b]) = (color_text(a), color_text(b));
        Some([
            x.to_string(),
            format!(
                "{} from the top, {y} from the bottom",
                self.colors.height() - 1 - y
            ),
            floats_a,
            floats_b,
            format!("{bytes_a} and {bytes_b}"),
            format!("{} f32 steps", apart.join(" ")),
        ])
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;
    use crate::difference::SizesDiffer;

    fn picture(name: &str, [width, height]: [u32; 2], samples: &[f32]) -> Picture {
        let mut image = Raster::new(width, height).unwrap();
        image.samples_mut()[..samples.len()].copy_from_slice(samples);
        let name = name.to_owned();
        Picture { name, image }
    }

    #[test]
    fn a_pixel_is_told_by_both_values_and_their_difference() {
        let a = picture("a.exr", [3, 4], &[0.0, 0.0, 0.0, 0.5, 1.0, 0.25]);
        let b = picture(
            "b.exr",
            [3, 4],
            &[0.0, 0.0, 0.0, 0.5, 1.0 + f32::EPSILON, f32::NAN],
        );
        let pair = Pair::new([a, b]).unwrap();
        assert_eq!(
            pair.pixel(Some(UVec2::new(1, 0))),
            "column       1\n\
             row          3 from the top, 0 from the bottom\n\
             A            0.5 1 0.25\n\
             B            0.5 1.0000001 NaN\n\
             in bytes     128 255 64 and 128 255 0\n\
             difference   0 1 NaN f32 steps\n"
        );
        let empty = "column\nrow\nA\nB\nin bytes\ndifference\n";
        assert_eq!(pair.pixel(None), empty);
        assert_eq!(pair.pixel(Some(UVec2::new(3, 0))), empty);
        let colors = pair.image(Side::Difference);
        let byte = |byte| f32::from(byte) / 255.0;
        assert_eq!(colors.pixel(0, 0), Some([0.0; 3]));
        assert_eq!(colors.pixel(1, 0), Some(error_color(None).map(byte)));
    }

    #[test]
    fn the_list_marks_what_is_shown_and_says_how_far_the_two_are_apart() {
        let b = picture("b.exr", [1, 1], &[f32::from_bits(3), f32::NAN]);
        let pair = Pair::new([picture("a.exr", [1, 1], &[]), b]).unwrap();
        assert_eq!(
            pair.list(Side::B),
            "  1  A  a.exr\n\
             • 2  B  b.exr\n  \
             3     their difference\n  \
             Tab   the next of them; H all keys\n\
             wrong samples: 2 of 3\n\
             at most 3 f32 steps off\n\
             NaN against a number: 1"
        );
        assert!(pair.list(Side::A).starts_with("• 1  A  a.exr\n"));
        assert_eq!(pair.list(Side::B).find("a.exr"), Some(NAMES));
    }

    #[test]
    fn pictures_of_two_sizes_are_refused() {
        let pair = Pair::new([picture("a", [1, 2], &[]), picture("b", [2, 1], &[])]);
        assert!(matches!(
            pair,
            Err(ViewerError::Sizes(SizesDiffer([1, 2], [2, 1])))
        ));
    }
}
