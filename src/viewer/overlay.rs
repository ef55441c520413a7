//! Boxes with text over the picture and beside it: each is painted on the processor and kept as a
//! texture until it changes.

use std::rc::Rc;

use glam::{IVec2, UVec2};

use crate::screen::{Layer, ScreenError};
use crate::text::Font;

use super::canvas::TextBox;

/// The text boxes that were drawn last, in the context that they were made in. Every method, and
/// the drop, needs that context to be current.
pub(super) struct Overlay {
    gl: Rc<glow::Context>,
    font: Font,
    shown: Vec<(TextBox, Layer)>,
}

impl Overlay {
    /// Nothing yet, in the context that is current and whose functions are `gl`.
    pub(super) fn new(gl: Rc<glow::Context>, cell: UVec2) -> Overlay {
        Overlay {
            gl,
            font: Font::new(cell.x),
            shown: Vec::new(),
        }
    }

    /// Draws `text_boxes` in their order over the bound framebuffer, which is `height` pixels high,
    /// with characters of `cell` pixels.
    ///
    /// # Errors
    /// [`ScreenError`] where the driver refuses shaders or a texture.
    pub(super) fn draw(
        &mut self,
        height: u32,
        cell: UVec2,
        text_boxes: Vec<TextBox>,
    ) -> Result<(), ScreenError> {
        if self.font.cell() != cell {
            self.font = Font::new(cell.x);
            self.shown.clear();
        }
        // What is not there any more needs no memory.
        self.shown.truncate(text_boxes.len());
        for (number, text_box) in text_boxes.into_iter().enumerate() {
            if self.shown.len() == number {
                self.shown
                    .push((TextBox::default(), Layer::new(self.gl.clone())?));
            }
            let (last, layer) = &mut self.shown[number];
            if *last != text_box {
                layer.upload(text_box.rect.size(), &text_box.rasterise(&mut self.font))?;
                *last = text_box;
            }
        }
        for (text_box, layer) in &self.shown {
            let bottom = height as i32 - text_box.rect.max.y;
            layer.draw(IVec2::new(text_box.rect.min.x, bottom));
        }
        Ok(())
    }
}
