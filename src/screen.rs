//! Pictures on the screen: each is uploaded as one retained texture and drawn on one quad, pixel
//! for pixel.
//!
//! A [`Screen`] is the texture and the quad in whatever OpenGL 3.3 core context is current: a
//! window's, or one of the contexts without a window that [`Offscreen`] makes to read the drawn
//! picture back. A [`Placement`] says where in the window the picture lies.
//!
//! Samples stay the 32-bit floats that were traced: the texture is `RGB32F`, the shader fetches
//! texels without filtering, and nothing blends, dithers or encodes them, so a float framebuffer
//! holds them bit for bit and an 8-bit one holds `(clamp(c, 0, 1) * 255).round_ties_even()`: the
//! shader rounds, since OpenGL leaves a driver either byte near the middle of two. It also leaves
//! drivers some freedom with subnormals and NaNs; Mesa's software renderer keeps all their bits,
//! those of signalling NaNs too.

#[cfg(feature = "program")]
mod check;
mod context;
pub(crate) mod driver_limits;
#[cfg(not(target_vendor = "apple"))]
mod egl;
mod error;
#[cfg(feature = "program")]
mod layer;
mod offscreen;
mod osmesa;
mod placement;
mod rounding;
mod shader_program;
#[cfg(feature = "program")]
mod timed;

use std::ops::Range;
use std::rc::Rc;

use bytemuck::cast_slice;
use glam::{I64Vec2, UVec2};
use glow::HasContext as _;

use crate::image::{ImageError, MAX_SIZE, Raster};
#[cfg(feature = "program")]
pub use check::Differs;
#[cfg(feature = "program")]
pub(crate) use context::functions;
pub use error::ScreenError;
#[cfg(feature = "program")]
pub(crate) use layer::Layer;
pub use offscreen::{Backend, Offscreen};
pub use placement::Placement;
use shader_program::ShaderProgram;
#[cfg(feature = "program")]
pub(crate) use timed::{Cost, DrawMethod, TimedScreen};

/// The clear colour of the document, `glClearColor(0, 0, 1, …)`; opaque, or a compositor would let
/// the desktop shine through.
const CLEAR_COLOR: [f32; 4] = [0.0, 0.0, 1.0, 1.0];

/// The capabilities that change or discard fragments before the framebuffer has them.
const FRAGMENT_CAPABILITIES: [u32; 8] = [
    glow::BLEND,
    glow::CULL_FACE,
    glow::DEPTH_TEST,
    glow::DITHER,
    glow::FRAMEBUFFER_SRGB,
    glow::RASTERIZER_DISCARD,
    glow::SCISSOR_TEST,
    glow::STENCIL_TEST,
];

/// The retained texture and the quad that shows it.
///
/// Every method, and the drop, needs the context of [`Screen::new`] to be current on this thread:
/// that is what its caller promises. Each sets all state it relies on and restores none.
pub struct Screen {
    gl: Rc<glow::Context>,
    program: ShaderProgram,
    origin: Option<glow::UniformLocation>,
    extent: Option<glow::UniformLocation>,
    steps: Option<glow::UniformLocation>,
    texture: glow::Texture,
    /// Empty: a core context draws nothing without one.
    vertex_array: glow::VertexArray,
    /// The width and height of the pictures.
    size: UVec2,
}

impl Screen {
    /// A screen for pictures of `size`, width and height in pixels, in the OpenGL 3.3 core context
    /// that is current and whose functions are `gl`.
    ///
    /// # Errors
    /// [`ScreenError::Image`] where there is no picture of that size,
    /// [`ScreenError::TextureTooLarge`] and [`ScreenError::Memory`] where it is beyond the
    /// driver, [`ScreenError::Refused`] where the driver refuses the shaders or the texture.
    ///
    /// # Safety
    /// `gl` holds the functions of the context that is current on this thread. The same context is
    /// current again whenever a method of the screen is called, and when the screen is dropped.
    pub unsafe fn new(gl: Rc<glow::Context>, size: UVec2) -> Result<Screen, ScreenError> {
        if size.min_element() == 0 || size.max_element() > MAX_SIZE {
            return Err(ImageError::Size(size.x, size.y).into());
        }
        // SAFETY: the context is current, as the caller has promised.
        let max = unsafe { gl.get_parameter_i32(glow::MAX_TEXTURE_SIZE) }.unsigned_abs();
        if size.max_element() > max {
            return Err(ScreenError::TextureTooLarge { size, max });
        }
        let program = ShaderProgram::new(gl.clone(), include_str!("screen/picture.frag"))?;
        // SAFETY: as above.
        let vertex_array = unsafe { gl.create_vertex_array() }
            .map_err(|reason| ScreenError::refused("a vertex array", &reason))?;
        // SAFETY: as above.
        let texture = unsafe { gl.create_texture() }
            .map_err(|reason| ScreenError::refused("a texture", &reason))?;
        let screen = Screen {
            gl,
            origin: program.uniform("origin"),
            extent: program.uniform("extent"),
            steps: program.uniform("steps"),
            program,
            texture,
            vertex_array,
            size,
        };
        screen.allocate()?;
        Ok(screen)
    }

    /// Gives the texture its size and format.
    fn allocate(&self) -> Result<(), ScreenError> {
        let gl = &self.gl;
        // SAFETY: the context is current; without data the driver reads none of our memory.
        unsafe {
            gl.bind_texture(glow::TEXTURE_2D, Some(self.texture));
            gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            gl.tex_image_2d(
                glow::TEXTURE_2D,
                0,
                glow::RGB32F as i32,
                self.size.x as i32,
                self.size.y as i32,
                0,
                glow::RGB,
                glow::FLOAT,
                glow::PixelUnpackData::Slice(None),
            );
            // One level: the texture is complete, and so may be fetched from, whatever filter or
            // sampler is set.
            gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAX_LEVEL, 0);
        }
        check(gl, "a texture of 32-bit floats", self.size)
    }

    /// Replaces the texture's texels by the samples of `image`.
    ///
    /// # Errors
    /// [`ScreenError::Size`] unless `image` has the size of the screen, [`ScreenError::Memory`] and
    /// [`ScreenError::Refused`] where the driver cannot take it.
    pub fn upload(&mut self, image: &Raster) -> Result<(), ScreenError> {
        self.upload_rows(image, 0..self.size.y)
    }

    /// Replaces some rows of texels, counted from the bottom, by those of `image`: after
    /// [`Tracer::retrace`](crate::Tracer::retrace) over a picture that was uploaded, the rows
    /// that it returns. Rows that the picture does not have are left out.
    ///
    /// # Errors
    /// As [`Screen::upload`].
    pub fn upload_rows(&mut self, image: &Raster, rows: Range<u32>) -> Result<(), ScreenError> {
        let size = UVec2::new(image.width(), image.height());
        if size != self.size {
            return Err(ScreenError::Size {
                image: size,
                screen: self.size,
            });
        }
        let rows = rows.start..rows.end.min(self.size.y);
        if rows.is_empty() {
            return Ok(());
        }
        let width = 3 * self.size.x as usize;
        let samples = &image.samples()[rows.start as usize * width..rows.end as usize * width];
        let gl = &self.gl;
        set_unpacking(gl);
        // SAFETY: the context is current, and the texture has these rows. With these pixel-store
        // parameters and no buffer bound, the driver reads exactly as many rows of
        // width × 3 floats, and so many the samples are.
        unsafe {
            gl.bind_texture(glow::TEXTURE_2D, Some(self.texture));
            gl.tex_sub_image_2d(
                glow::TEXTURE_2D,
                0,
                0,
                rows.start as i32,
                self.size.x as i32,
                rows.len() as i32,
                glow::RGB,
                glow::FLOAT,
                glow::PixelUnpackData::Slice(Some(cast_slice(samples))),
            );
        }
        check(gl, "to take the picture as a texture", self.size)
    }

    /// Clears the bound framebuffer, `surface` wide and high in pixels, and draws the picture into
    /// `placement` by nearest neighbour: of the E pixels along a side on which the picture has N,
    /// pixel p shows the picture's ⌊(p + ½) N / E⌋, exactly, as long as N E is less than 2³¹.
    pub fn draw(&self, surface: UVec2, placement: Placement) {
        let gl = &self.gl;
        let origin = placement.origin.as_i64vec2();
        let corner = (origin + placement.size.as_i64vec2()).min(surface.as_i64vec2());
        let start = origin.max(I64Vec2::ZERO);
        let visible = (corner - start).max(I64Vec2::ZERO).as_ivec2();
        let start = start.as_ivec2();
        // SAFETY: the context is current and all names are of it; the vertex shader reads no
        // buffer.
        unsafe {
            for capability in FRAGMENT_CAPABILITIES {
                gl.disable(capability);
            }
            gl.color_mask(true, true, true, true);
            gl.polygon_mode(glow::FRONT_AND_BACK, glow::FILL);

            let [red, green, blue, alpha] = CLEAR_COLOR;
            gl.clear_color(red, green, blue, alpha);
            gl.clear(glow::COLOR_BUFFER_BIT);
            if visible.min_element() == 0 {
                return;
            }

            gl.viewport(start.x, start.y, visible.x, visible.y);
            gl.use_program(Some(self.program.name));
            gl.uniform_2_i32(self.origin.as_ref(), placement.origin.x, placement.origin.y);
            gl.uniform_2_u32(self.extent.as_ref(), placement.size.x, placement.size.y);
            let [red, green, blue] = rounding::steps(gl).unwrap_or_default();
            gl.uniform_3_f32(self.steps.as_ref(), red, green, blue);
            gl.active_texture(glow::TEXTURE0);
            gl.bind_texture(glow::TEXTURE_2D, Some(self.texture));
            gl.bind_vertex_array(Some(self.vertex_array));
            gl.draw_arrays(glow::TRIANGLE_STRIP, 0, 4);
        }
    }

    /// Fills a rectangle of the bound framebuffer, over what was drawn there. `corner` is its
    /// bottom left pixel, `size` its width and height.
    #[cfg(feature = "program")]
    pub(crate) fn fill(&self, corner: glam::IVec2, size: UVec2, [red, green, blue]: [u8; 3]) {
        let color = [red, green, blue].map(|byte| f32::from(byte) / 255.0);
        let gl = &self.gl;
        // SAFETY: the context is current.
        unsafe {
            gl.enable(glow::SCISSOR_TEST);
            gl.scissor(corner.x, corner.y, size.x as i32, size.y as i32);
            gl.clear_color(color[0], color[1], color[2], 1.0);
            gl.clear(glow::COLOR_BUFFER_BIT);
            gl.disable(glow::SCISSOR_TEST);
        }
    }

    /// Waits until the driver has done everything (`glFinish`).
    #[cfg(feature = "program")]
    pub(crate) fn finish(&self) {
        // SAFETY: the context is current.
        unsafe { self.gl.finish() };
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // SAFETY: both names were made here and nothing else deletes them; the program frees
        // itself.
        unsafe {
            self.gl.delete_texture(self.texture);
            self.gl.delete_vertex_array(self.vertex_array);
        }
    }
}

/// Makes the driver read pictures as they lie in our memory: row after row without a gap.
fn set_unpacking(gl: &glow::Context) {
    // SAFETY: the context is current.
    unsafe {
        gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
        for (parameter, value) in [
            (glow::UNPACK_ALIGNMENT, 1),
            (glow::UNPACK_ROW_LENGTH, 0),
            (glow::UNPACK_SKIP_ROWS, 0),
            (glow::UNPACK_SKIP_PIXELS, 0),
            (glow::UNPACK_SWAP_BYTES, 0),
        ] {
            gl.pixel_store_i32(parameter, value);
        }
    }
}

/// The driver's oldest error since the last check, if any, as what kept it from doing `what` for a
/// picture of `size`, width and height in pixels.
fn check(gl: &glow::Context, what: &'static str, size: UVec2) -> Result<(), ScreenError> {
    // SAFETY: the context is current.
    match unsafe { gl.get_error() } {
        glow::NO_ERROR => Ok(()),
        glow::OUT_OF_MEMORY => Err(ScreenError::Memory { size }),
        code => Err(ScreenError::refused(
            what,
            &format!("OpenGL error {code:#06x}"),
        )),
    }
}
