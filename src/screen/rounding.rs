//! How many steps a framebuffer has between 0 and 1.

use glow::HasContext as _;

/// The steps from 0 to 1 of what the bound framebuffer holds of red, 255 where it has 8 bits; `None`
/// where it holds floats, or nothing.
///
/// OpenGL lets a driver round to either step near the middle of two, and some GPUs do not take the
/// nearest: who wants that one rounds before the driver does.
pub(super) fn steps(gl: &glow::Context) -> Option<f32> {
    // SAFETY: the context is current.
    let buffer = unsafe { gl.get_parameter_i32(glow::DRAW_BUFFER) }.unsigned_abs();
    // A window is asked for one buffer of its pair for stereo pictures.
    let attachment = match buffer {
        glow::BACK => glow::BACK_LEFT,
        glow::FRONT => glow::FRONT_LEFT,
        attachment => attachment,
    };
    // SAFETY: the context is current, and the attachment is one that its framebuffer has.
    let asked = |parameter| unsafe {
        gl.get_framebuffer_attachment_parameter_i32(glow::DRAW_FRAMEBUFFER, attachment, parameter)
    };
    // Only of an attachment that is there may the rest be asked.
    if buffer == glow::NONE || asked(glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) == 0 {
        return None;
    }
    let holds = asked(glow::FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE).unsigned_abs();
    let bits = asked(glow::FRAMEBUFFER_ATTACHMENT_RED_SIZE);
    (holds == glow::UNSIGNED_NORMALIZED).then(|| ((1_u32 << bits.clamp(0, 16)) - 1) as f32)
}
