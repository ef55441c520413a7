//! Whether a framebuffer shows what was drawn: a driver may be wrong.

use glam::{IVec2, UVec2};
use glow::HasContext as _;

use super::{Placement, Screen};
use crate::image::{Raster, display_byte};
use crate::memory;

/// The most pixels of a framebuffer that are compared: to compare four times as many would slow
/// down the resizing of a window.
const MAX_PIXELS: u32 = 1 << 20;

/// A pixel of a framebuffer that is not what the picture says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Differs {
    /// The pixel of the picture: column from the left, row from the bottom.
    pub pixel: UVec2,
    /// Its bytes as they should be shown.
    pub drawn: [u8; 3],
    /// As they are shown.
    pub shown: [u8; 3],
}

impl Screen {
    /// The first pixel, of up to a million from the bottom of a framebuffer with 8 bits a colour,
    /// that is not what [`Screen::draw`] of `image` should have left there.
    pub(crate) fn first_difference(
        &self,
        surface: UVec2,
        placement: Placement,
        image: &Raster,
    ) -> Option<Differs> {
        let size = UVec2::new(surface.x, surface.y.min(MAX_PIXELS / surface.x.max(1)));
        let mut bytes = Vec::new();
        let length = size.x as usize * size.y as usize * 4;
        // Without memory nothing is looked at.
        memory::reserve(&mut bytes, length).ok()?;
        bytes.resize(length, 0);
        // SAFETY: the context is current. No buffer is bound, and rows of four bytes a pixel have
        // no gaps at any alignment, so that the driver writes as many bytes as are there.
        unsafe {
            self.gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            self.gl.read_pixels(
                0,
                0,
                size.x as i32,
                size.y as i32,
                glow::RGBA,
                glow::UNSIGNED_BYTE,
                glow::PixelPackData::Slice(Some(&mut bytes)),
            );
        }
        let picture = UVec2::new(image.width(), image.height());
        let rows = bytes.chunks_exact(size.x.max(1) as usize * 4);
        rows.zip(0..)
            .flat_map(|(row, y)| {
                row.chunks_exact(4)
                    .zip((0..).map(move |x| IVec2::new(x, y)))
            })
            .find_map(|(shown, place)| {
                let pixel = placement.pixel_at(place, picture)?;
                let drawn = image.pixel(pixel.x, pixel.y)?.map(display_byte);
                let shown = [shown[0], shown[1], shown[2]];
                (shown != drawn).then_some(Differs {
                    pixel,
                    drawn,
                    shown,
                })
            })
    }
}
