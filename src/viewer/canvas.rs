//! Text boxes, painted on the processor.

use glam::{IVec2, UVec2};

use crate::text::Font;

use super::rect::Rect;

/// Red, green, blue, and how much they hide of what lies below: 255 is all of it.
pub(super) type Color = [u8; 4];

/// A rectangle of the window and what is painted on it, in this order. Places are pixels of the
/// window; what reaches out of the rectangle is cut off.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct TextBox {
    pub(super) rect: Rect,
    pub(super) paint: Vec<Paint>,
}

/// Something painted.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Paint {
    /// Hides what was painted there before.
    Fill(Rect, Color),
    /// A line of text from the top left corner of its first cell, cut off outside the rectangle.
    Text(IVec2, String, Color, Rect),
}

impl TextBox {
    /// A text box with a background of one colour.
    pub(super) fn new(rect: Rect, background: Color) -> TextBox {
        let paint = vec![Paint::Fill(rect, background)];
        TextBox { rect, paint }
    }

    pub(super) fn fill(&mut self, rect: Rect, color: Color) {
        self.paint.push(Paint::Fill(rect, color));
    }

    /// Text that is cut off at the edges of the text box.
    pub(super) fn text(&mut self, place: IVec2, text: impl Into<String>, color: Color) {
        self.text_within(place, text, color, self.rect);
    }

    /// Text that is cut off at the edges of `clip`.
    pub(super) fn text_within(
        &mut self,
        place: IVec2,
        text: impl Into<String>,
        color: Color,
        clip: Rect,
    ) {
        self.paint
            .push(Paint::Text(place, text.into(), color, clip));
    }

    /// The pixels of the rectangle, rows from the top: red, green and blue multiplied by alpha, and
    /// alpha.
    pub(super) fn rasterise(&self, font: &mut Font) -> Vec<u8> {
        let size = self.rect.size();
        let mut canvas = Canvas {
            rect: self.rect,
            width: size.x as usize,
            bytes: vec![0; 4 * size.x as usize * size.y as usize],
        };
        for paint in &self.paint {
            match paint {
                Paint::Fill(rect, color) => canvas.fill(*rect, *color),
                Paint::Text(place, text, color, clip) => {
                    let clip = clip.intersection(self.rect);
                    font.write(text, *place, |pixel, coverage| {
                        if clip.contains(pixel) {
                            canvas.blend(pixel, *color, coverage);
                        }
                    });
                }
            }
        }
        canvas.bytes
    }
}

/// The pixels of a text box while it is painted.
struct Canvas {
    rect: Rect,
    width: usize,
    bytes: Vec<u8>,
}

impl Canvas {
    fn fill(&mut self, rect: Rect, [red, green, blue, alpha]: Color) {
        let part = rect.intersection(self.rect);
        // One that lies beside the text box has no first pixel.
        if part.is_empty() {
            return;
        }
        let UVec2 { x: width, .. } = part.size();
        let color = [red, green, blue].map(|part| times(part, alpha));
        let pixel = [color[0], color[1], color[2], alpha];
        for y in part.min.y..part.max.y {
            let first = self.index(IVec2::new(part.min.x, y));
            for bytes in self.bytes[first..][..4 * width as usize].as_chunks_mut().0 {
                *bytes = pixel;
            }
        }
    }

    /// Lays `color` over a pixel of the canvas of which it covers so much.
    fn blend(&mut self, pixel: IVec2, [red, green, blue, alpha]: Color, coverage: u8) {
        let first = self.index(pixel);
        let over = times(alpha, coverage);
        for (byte, part) in self.bytes[first..][..4]
            .iter_mut()
            .zip([red, green, blue, 255])
        {
            // The two parts add up to at most 255.
            *byte = times(part, over).saturating_add(times(*byte, 255 - over));
        }
    }

    /// Where the bytes of a pixel begin that lies on the canvas.
    fn index(&self, pixel: IVec2) -> usize {
        let place = (pixel - self.rect.min).as_uvec2();
        4 * (place.y as usize * self.width + place.x as usize)
    }
}

/// a b / 255, rounded.
fn times(a: u8, b: u8) -> u8 {
    ((u32::from(a) * u32::from(b) + 127) / 255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Color = [255; 4];
    const DARK: Color = [20, 40, 60, 255];

    fn pixel(bytes: &[u8], text_box: &TextBox, x: i32, y: i32) -> [u8; 4] {
        let width = text_box.rect.size().x as i32;
        let first = 4 * (y * width + x) as usize;
        [0, 1, 2, 3].map(|byte| bytes[first + byte])
    }

    #[test]
    fn fills_are_cut_at_the_text_box_and_keep_their_alpha() {
        let rect = Rect::new(IVec2::new(10, 20), UVec2::new(4, 3));
        let mut text_box = TextBox::new(rect, [0, 0, 0, 0]);
        let half = [255, 100, 0, 128];
        text_box.fill(Rect::new(IVec2::new(12, 0), UVec2::new(50, 22)), half);
        let bytes = text_box.rasterise(&mut Font::new(7));
        assert_eq!(bytes.len(), 4 * 12);
        assert_eq!(pixel(&bytes, &text_box, 1, 0), [0; 4]);
        assert_eq!(pixel(&bytes, &text_box, 2, 1), [128, 50, 0, 128]);
        assert_eq!(pixel(&bytes, &text_box, 3, 2), [0; 4]);
    }

    #[test]
    fn text_is_blended_and_cut_off() {
        let rect = Rect::new(IVec2::ZERO, UVec2::new(70, 14));
        let mut text_box = TextBox::new(rect, DARK);
        text_box.text(IVec2::new(-3, 0), "WWWWWWWWWWWW", WHITE);
        let left = Rect::new(IVec2::ZERO, UVec2::new(35, 14));
        let mut half = TextBox::new(rect, DARK);
        half.text_within(IVec2::new(-3, 0), "WWWWWWWWWWWW", WHITE, left);
        let mut font = Font::new(7);
        let (whole, half) = (text_box.rasterise(&mut font), half.rasterise(&mut font));
        let background = |bytes: &[u8], x: i32| {
            (0..14).all(|y| pixel(bytes, &text_box, x, y) == [20, 40, 60, 255])
        };
        assert!((0..70).any(|x| !background(&whole, x)));
        assert!((0..35).all(|x| background(&half, x) == background(&whole, x)));
        assert!((35..70).all(|x| background(&half, x)));
        // All of a pixel that is covered wholly.
        assert_eq!(
            [times(255, 255), times(7, 0), times(255, 128)],
            [255, 0, 128]
        );
    }

    #[test]
    fn what_lies_beside_a_text_box_fills_nothing() {
        let rect = |min: [i32; 2], max: [i32; 2]| Rect {
            min: min.into(),
            max: max.into(),
        };
        for beside in [
            rect([9, 0], [12, 4]),
            rect([-9, 0], [-2, 4]),
            rect([0, 5], [4, 9]),
        ] {
            let text_box = TextBox {
                rect: rect([0, 0], [4, 4]),
                paint: vec![Paint::Fill(beside, [1, 2, 3, 255])],
            };
            let bytes = text_box.rasterise(&mut Font::new(7));
            assert_eq!(bytes, [0; 64], "{beside:?}");
        }
    }
}
