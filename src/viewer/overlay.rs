//! What lies over the picture, drawn by egui. egui only lays out and paints: it gets no events, so it moves nothing by itself.

use std::sync::Arc;

use egui::{Pos2, RawInput, Rect, Vec2, ViewportId};
use glam::UVec2;

use crate::screen::ScreenError;

/// egui with its painter, in the context that it was made in. Every method, and the drop, needs that context to be current.
pub(super) struct Overlay {
    egui: egui::Context,
    painter: egui_glow::Painter,
}

impl Overlay {
    /// # Errors
    /// [`ScreenError::Refused`] where the driver refuses the shaders.
    pub(super) fn new(gl: glow::Context) -> Result<Overlay, ScreenError> {
        let painter = egui_glow::Painter::new(Arc::new(gl), "", None, false)
            .map_err(|error| ScreenError::refused("egui's shaders", &error.to_string()))?;
        let egui = egui::Context::default();
        egui.set_theme(egui::Theme::Dark);
        egui.all_styles_mut(|style| {
            style.interaction.selectable_labels = false;
            style.spacing.item_spacing = Vec2::new(6.0, 1.0);
            style.spacing.button_padding = Vec2::new(6.0, 0.0);
            style.spacing.interact_size.y = 15.0;
            style.spacing.window_margin = 4.into();
            style.animation_time = 0.0;
            style.scroll_animation = egui::style::ScrollAnimation::none();
        });
        Ok(Overlay { egui, painter })
    }

    /// Draws `contents` over the bound framebuffer, `surface` pixels wide and high, `scale` of them to a point.
    pub(super) fn draw(
        &mut self,
        surface: UVec2,
        scale: f32,
        mut contents: impl FnMut(&egui::Context),
    ) {
        let size = surface.as_vec2() / scale;
        let mut input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, Vec2::new(size.x, size.y))),
            max_texture_side: Some(self.painter.max_texture_side()),
            ..RawInput::default()
        };
        if let Some(viewport) = input.viewports.get_mut(&ViewportId::ROOT) {
            viewport.native_pixels_per_point = Some(scale);
        }
        // Twice: egui places a panel by the size that it had in the pass before, and hides one that had none.
        let mut output = self
            .egui
            .run_pass(input.clone(), |context| contents(context));
        output.append(self.egui.run_pass(input, |context| contents(context)));
        let shapes = std::mem::take(&mut output.shapes);
        let primitives = self.egui.tessellate(shapes, output.pixels_per_point);
        self.painter.paint_and_update_textures(
            surface.into(),
            output.pixels_per_point,
            &primitives,
            &mut output.textures_delta,
        );
    }
}

impl Drop for Overlay {
    fn drop(&mut self) {
        self.painter.destroy();
    }
}
