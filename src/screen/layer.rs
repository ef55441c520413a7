//! A text box over the picture: a retained texture that is blended over what was drawn before.

use std::rc::Rc;

use glam::{IVec2, UVec2};
use glow::HasContext as _;

use super::shader_program::ShaderProgram;
use super::{ScreenError, check, set_unpacking};

/// The retained texture and the quad that shows it, pixel for pixel.
///
/// Every method, and the drop, needs the context of [`Layer::new`] to be current on this thread.
/// Each sets all state it relies on and restores none.
pub(crate) struct Layer {
    gl: Rc<glow::Context>,
    program: ShaderProgram,
    corner: Option<glow::UniformLocation>,
    texture: glow::Texture,
    /// Empty: a core context draws nothing without one.
    vertex_array: glow::VertexArray,
    /// The width and height of the texture; 0 before the first upload.
    size: UVec2,
}

impl Layer {
    /// A layer without a texel in the context that is current and whose functions are `gl`.
    ///
    /// # Errors
    /// [`ScreenError::Refused`] where the driver refuses the shaders or the texture.
    pub(crate) fn new(gl: Rc<glow::Context>) -> Result<Layer, ScreenError> {
        let program = ShaderProgram::new(gl.clone(), include_str!("layer.frag"))?;
        // SAFETY: as for every call in this folder, `gl`'s context is current on this thread.
        let vertex_array = unsafe { gl.create_vertex_array() }
            .map_err(|reason| ScreenError::refused("a vertex array", &reason))?;
        // SAFETY: as above.
        let texture = unsafe { gl.create_texture() }
            .map_err(|reason| ScreenError::refused("a texture", &reason))?;
        Ok(Layer {
            gl,
            corner: program.uniform("corner"),
            program,
            texture,
            vertex_array,
            size: UVec2::ZERO,
        })
    }

    /// Replaces all texels: `rgba` holds `size.x` × `size.y` pixels, rows from the top, red, green
    /// and blue multiplied by alpha. Whatever is missing or left over makes the layer empty.
    ///
    /// # Errors
    /// [`ScreenError::Memory`] and [`ScreenError::Refused`] where the driver cannot take it.
    pub(crate) fn upload(&mut self, size: UVec2, rgba: &[u8]) -> Result<(), ScreenError> {
        self.size = UVec2::ZERO;
        let pixels = u64::from(size.x) * u64::from(size.y);
        if pixels == 0 || rgba.len() as u64 != 4 * pixels {
            return Ok(());
        }
        let gl = &self.gl;
        set_unpacking(gl);
        // SAFETY: the context is current. With these pixel-store parameters and no buffer bound,
        // the driver reads size.x × size.y × 4 bytes, and so many are there.
        unsafe {
            gl.bind_texture(glow::TEXTURE_2D, Some(self.texture));
            gl.tex_image_2d(
                glow::TEXTURE_2D,
                0,
                glow::RGBA8 as i32,
                size.x as i32,
                size.y as i32,
                0,
                glow::RGBA,
                glow::UNSIGNED_BYTE,
                glow::PixelUnpackData::Slice(Some(rgba)),
            );
            // One level: the texture is complete, whatever filter is set.
            gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAX_LEVEL, 0);
        }
        check(gl, "to take text as a texture", size)?;
        self.size = size;
        Ok(())
    }

    /// Blends the layer over the bound framebuffer; `corner` is where its bottom left pixel lies.
    pub(crate) fn draw(&self, corner: IVec2) {
        if self.size.min_element() == 0 {
            return;
        }
        let gl = &self.gl;
        // SAFETY: the context is current and all names are of it; the vertex shader reads no
        // buffer.
        unsafe {
            gl.viewport(corner.x, corner.y, self.size.x as i32, self.size.y as i32);
            gl.enable(glow::BLEND);
            gl.blend_equation(glow::FUNC_ADD);
            gl.blend_func(glow::ONE, glow::ONE_MINUS_SRC_ALPHA);
            gl.use_program(Some(self.program.name));
            gl.uniform_2_i32(self.corner.as_ref(), corner.x, corner.y);
            gl.active_texture(glow::TEXTURE0);
            gl.bind_texture(glow::TEXTURE_2D, Some(self.texture));
            gl.bind_vertex_array(Some(self.vertex_array));
            gl.draw_arrays(glow::TRIANGLE_STRIP, 0, 4);
            gl.disable(glow::BLEND);
        }
    }
}

impl Drop for Layer {
    fn drop(&mut self) {
        // SAFETY: both names were made here and nothing else deletes them; the program frees
        // itself.
        unsafe {
            self.gl.delete_texture(self.texture);
            self.gl.delete_vertex_array(self.vertex_array);
        }
    }
}
