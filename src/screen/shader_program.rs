//! A shader program that draws one quad.

use std::rc::Rc;

use glow::HasContext as _;

use super::ScreenError;

/// A linked program: the quad that fills the viewport, and a fragment shader.
pub(super) struct ShaderProgram {
    gl: Rc<glow::Context>,
    pub(super) name: glow::Program,
}

impl ShaderProgram {
    /// Compiles and links, with `fragment` as the source of the fragment shader; `gl`'s context is
    /// current.
    pub(super) fn new(gl: Rc<glow::Context>, fragment: &str) -> Result<ShaderProgram, ScreenError> {
        // SAFETY: as for every call in this folder, `gl`'s functions are loaded and its context is
        // current on this thread.
        let name = unsafe { gl.create_program() }
            .map_err(|reason| ScreenError::refused("a shader program", &reason))?;
        let program = ShaderProgram { gl, name };
        let quad = include_str!("quad.vert");
        program.attach(glow::VERTEX_SHADER, "the vertex shader", quad)?;
        program.attach(glow::FRAGMENT_SHADER, "the fragment shader", fragment)?;
        program.link()?;
        Ok(program)
    }

    /// The place of a uniform of the program; `None` where the driver found no use for it.
    pub(super) fn uniform(&self, name: &str) -> Option<glow::UniformLocation> {
        // SAFETY: the context is current and the program's name is of it.
        unsafe { self.gl.get_uniform_location(self.name, name) }
    }

    fn attach(&self, kind: u32, what: &'static str, source: &str) -> Result<(), ScreenError> {
        let gl = &self.gl;
        // SAFETY: the context is current; the shader is this one's own, and once marked deleted
        // lives on only while attached.
        unsafe {
            let shader = gl
                .create_shader(kind)
                .map_err(|reason| ScreenError::refused(what, &reason))?;
            gl.shader_source(shader, source);
            gl.compile_shader(shader);
            let compiled = if gl.get_shader_compile_status(shader) {
                gl.attach_shader(self.name, shader);
                Ok(())
            } else {
                Err(ScreenError::refused(what, &gl.get_shader_info_log(shader)))
            };
            gl.delete_shader(shader);
            compiled
        }
    }

    fn link(&self) -> Result<(), ScreenError> {
        let gl = &self.gl;
        // SAFETY: the context is current and the program's name is of it.
        unsafe {
            gl.link_program(self.name);
            if !gl.get_program_link_status(self.name) {
                let log = gl.get_program_info_log(self.name);
                return Err(ScreenError::refused("to link the shader program", &log));
            }
        }
        Ok(())
    }
}

impl Drop for ShaderProgram {
    fn drop(&mut self) {
        // SAFETY: the program was made here and nothing else deletes it.
        unsafe { self.gl.delete_program(self.name) };
    }
}
