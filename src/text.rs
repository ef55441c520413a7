//! Text as pixels: one monospaced font, rasterised at the size at which it is shown.

use std::collections::HashMap;

use ab_glyph::{Font as _, FontRef, Glyph, PxScale, point};
use glam::{IVec2, UVec2};

/// DejaVu Sans Mono at one size: every character has a cell of whole pixels, twice as high as wide.
pub(crate) struct Font {
    /// `None` only where the font file cannot be read; then text has no ink.
    face: Option<FontRef<'static>>,
    scale: PxScale,
    cell: UVec2,
    /// From the top of a cell to the line that letters stand on, in pixels.
    baseline: f32,
    masks: HashMap<char, Mask>,
}

/// How much of each pixel a character covers.
struct Mask {
    /// The top left pixel, from the top left corner of the cell.
    corner: IVec2,
    width: u32,
    /// Rows from the top; 255 is a pixel that is covered wholly.
    coverage: Vec<u8>,
}

impl Font {
    /// The font with cells of `width` pixels, at least one.
    pub(crate) fn new(width: u32) -> Font {
        let width = width.max(1);
        let face = FontRef::try_from_slice(dejavu::sans_mono::regular()).ok();
        let (mut height, mut ascent) = (0.0, 0.0);
        if let Some(face) = &face {
            // Every character of a monospaced font is as wide as this one.
            let pixels = width as f32 / face.h_advance_unscaled(face.glyph_id('0'));
            height = pixels * face.height_unscaled();
            ascent = pixels * face.ascent_unscaled();
        }
        let cell = UVec2::new(width, 2 * width);
        Font {
            face,
            scale: PxScale::from(height),
            cell,
            baseline: ((cell.y as f32 - height) / 2.0 + ascent).round(),
            masks: HashMap::new(),
        }
    }

    /// The width and height of a character's cell, in pixels.
    pub(crate) fn cell(&self) -> UVec2 {
        self.cell
    }

    /// Writes a line of text whose first cell has its top left corner at `place`. `ink` is called
    /// with each pixel that is touched and how much of it is covered, from 1 to 255.
    pub(crate) fn write(&mut self, text: &str, place: IVec2, mut ink: impl FnMut(IVec2, u8)) {
        let mut origin = place;
        for character in text.chars() {
            let mask = match self.masks.get(&character) {
                Some(mask) => mask,
                None => {
                    let mask = self.rasterise(character);
                    self.masks.entry(character).or_insert(mask)
                }
            };
            let rows = mask.coverage.chunks(mask.width.max(1) as usize);
            for (row, y) in rows.zip(origin.y + mask.corner.y..) {
                for (&coverage, x) in row.iter().zip(origin.x + mask.corner.x..) {
                    if coverage > 0 {
                        ink(IVec2::new(x, y), coverage);
                    }
                }
            }
            origin.x += self.cell.x as i32;
        }
    }

    fn rasterise(&self, character: char) -> Mask {
        let outlined = self.face.as_ref().and_then(|face| {
            face.outline_glyph(Glyph {
                id: face.glyph_id(character),
                scale: self.scale,
                position: point(0.0, self.baseline),
            })
        });
        let Some(outlined) = outlined else {
            // A space, for one.
            return Mask {
                corner: IVec2::ZERO,
                width: 0,
                coverage: Vec::new(),
            };
        };
        let bounds = outlined.px_bounds();
        let width = bounds.width() as u32;
        let mut coverage = vec![0; width as usize * bounds.height() as usize];
        outlined.draw(|x, y, part| {
            if let Some(pixel) = coverage.get_mut((y * width + x) as usize) {
                *pixel = (part.clamp(0.0, 1.0) * 255.0).round() as u8;
            }
        });
        Mask {
            corner: IVec2::new(bounds.min.x as i32, bounds.min.y as i32),
            width,
            coverage,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ink of a text at the corner: the bounds of its pixels, and their sum.
    fn ink(font: &mut Font, text: &str) -> (IVec2, IVec2, u64) {
        let (mut min, mut max, mut sum) = (IVec2::MAX, IVec2::MIN, 0);
        font.write(text, IVec2::ZERO, |pixel, coverage| {
            min = min.min(pixel);
            max = max.max(pixel);
            sum += u64::from(coverage);
        });
        (min, max, sum)
    }

    #[test]
    fn every_character_that_the_viewer_writes_is_there_and_stays_in_its_cell() {
        for width in [5, 7, 11, 14, 28] {
            let mut font = Font::new(width);
            let missing = ink(&mut font, "\u{10ffff}");
            let written = ('!'..='~').chain("α−×÷·²⁸¹⁶⁴ⁿ←→λ≤°…•–—ΔπÄ|√".chars());
            for character in written {
                let (min, max, sum) = ink(&mut font, &character.to_string());
                assert!(sum > 0, "{character}");
                assert_ne!((min, max, sum), missing, "{character}");
                let cell = font.cell().as_ivec2();
                assert!(min.x >= -1 && max.x <= cell.x, "{character} in {width}");
                assert!(min.y >= -1 && max.y <= cell.y, "{character} in {width}");
            }
            assert_eq!(ink(&mut font, " ").2, 0);
        }
    }

    #[test]
    fn a_line_goes_on_by_whole_cells() {
        let mut font = Font::new(9);
        let (first, _, once) = ink(&mut font, "α");
        let (second, _, again) = ink(&mut font, "   α");
        assert_eq!(second - first, IVec2::new(27, 0));
        assert_eq!(once, again);
    }
}
