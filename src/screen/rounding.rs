//! How many steps a framebuffer has between 0 and 1.

use glow::HasContext as _;

/// The steps from 0 to 1 of red, green and blue in the bound framebuffer, 255 where one has 8 bits;
/// `None` where they are no fixed-point numbers, or of more bits than the shader's floats tell
/// apart.
///
/// OpenGL lets a driver round to either step near the middle of two, and some GPUs do not take the
/// nearest: who wants that one rounds before the driver does.
pub(super) fn steps(gl: &glow::Context) -> Option<[f32; 3]> {
    // SAFETY: the context is current.
    let attachment = match unsafe { gl.get_parameter_i32(glow::DRAW_BUFFER) }.unsigned_abs() {
        // Those of a window; of a pair for both eyes, the left one has the format of both.
        glow::BACK | glow::LEFT | glow::FRONT_AND_BACK => glow::BACK_LEFT,
        glow::FRONT => glow::FRONT_LEFT,
        glow::RIGHT => glow::BACK_RIGHT,
        glow::NONE => return None,
        attachment => attachment,
    };
    // SAFETY: the context is current, and it draws into this attachment of its framebuffer.
    let asked = |parameter| unsafe {
        gl.get_framebuffer_attachment_parameter_i32(glow::DRAW_FRAMEBUFFER, attachment, parameter)
    };
    // Only of an attachment that is there may the rest be asked.
    let is_there = asked(glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE).unsigned_abs() != glow::NONE;
    let kind = glow::FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE;
    if !is_there || asked(kind).unsigned_abs() != glow::UNSIGNED_NORMALIZED {
        return None;
    }
    let bits = [
        glow::FRAMEBUFFER_ATTACHMENT_RED_SIZE,
        glow::FRAMEBUFFER_ATTACHMENT_GREEN_SIZE,
        glow::FRAMEBUFFER_ATTACHMENT_BLUE_SIZE,
    ]
    .map(asked);
    let is_told_apart = bits.iter().all(|bits| (1..=16).contains(bits));
    is_told_apart.then(|| bits.map(|bits| ((1_u32 << bits) - 1) as f32))
}
