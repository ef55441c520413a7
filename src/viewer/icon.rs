//! The icon of the window, which a desktop shows in its list of windows: a small picture, traced.

use winit::window::Icon;

use crate::image::display_byte;
use crate::{Image, Kernel, Scene, Stage, Tracer};

/// The pixels along a side of the icon.
const SIDE: u32 = 64;

/// The built-in scene with shadows and mirror images; `None` where there is no memory for it.
pub(super) fn icon() -> Option<Icon> {
    let mut image = Image::new(SIDE).ok()?;
    let mut tracer = Tracer::new(Kernel::default(), 1).ok()?;
    let scene = Scene::builtin();
    tracer
        .trace(&scene, Stage::Reflection, 0.0, &mut image)
        .ok()?;
    let rows = image.rows_from_top();
    let pixels = rows.flat_map(|row| row.as_chunks::<3>().0);
    let bytes = pixels.flat_map(|pixel| {
        let [red, green, blue] = pixel.map(display_byte);
        [red, green, blue, u8::MAX]
    });
    Icon::from_rgba(bytes.collect(), SIDE, SIDE).ok()
}
