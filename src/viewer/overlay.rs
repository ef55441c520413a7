//! Boxes with text over the picture and beside it: each is painted on the processor and kept as a
//! texture until it changes.

use std::rc::Rc;

use glam::{IVec2, UVec2};

use crate::screen::{Layer, ScreenError};
use crate::text::Font;

use super::canvas::Board;

/// The boards that were drawn last, in the context that they were made in. Every method, and the
/// drop, needs that context to be current.
pub(super) struct Overlay {
    gl: Rc<glow::Context>,
    font: Font,
    shown: Vec<(Board, Layer)>,
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

    /// Draws `boards` in their order over the bound framebuffer, which is `height` pixels high,
    /// with characters of `cell` pixels.
    ///
    /// # Errors
    /// [`ScreenError`] where the driver refuses shaders or a texture.
    pub(super) fn draw(
        &mut self,
        height: u32,
        cell: UVec2,
        boards: Vec<Board>,
    ) -> Result<(), ScreenError> {
        if self.font.cell() != cell {
            self.font = Font::new(cell.x);
            self.shown.clear();
        }
        // What is not there any more needs no memory.
        self.shown.truncate(boards.len());
        for (number, board) in boards.into_iter().enumerate() {
            if self.shown.len() == number {
                self.shown
                    .push((Board::default(), Layer::new(self.gl.clone())?));
            }
            let (last, layer) = &mut self.shown[number];
            if *last != board {
                layer.upload(board.rect.size(), &board.rasterise(&mut self.font))?;
                *last = board;
            }
        }
        for (board, layer) in &self.shown {
            let bottom = height as i32 - board.rect.max.y;
            layer.draw(IVec2::new(board.rect.min.x, bottom));
        }
        Ok(())
    }
}
