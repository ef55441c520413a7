//! What is written over the picture: the menu, the keys, the information line, the inspected pixel, messages, the scale of errors.

use std::time::{Duration, Instant};

use egui::{
    Align2, Area, Button, Color32, Context, Frame, Id, Pos2, Rect, RichText, ScrollArea, Stroke,
    StrokeKind, Ui,
};
use glam::UVec2;

use crate::difference::error_color;

use super::action::{Action, key_table, rows};
use super::comparison::WRONG;
use super::menu::Menu;

/// How long a message stays, and the name of the pixel on which the pointer rests.
const READING_TIME: Duration = Duration::from_secs(4);

/// Where the line that names a pixel ends, in points from the top; with room to spare.
const LINE_HEIGHT: f32 = 32.0;

/// Everything that may lie over the picture.
#[derive(Debug, Default)]
pub(super) struct Sheet {
    pub(super) menu: Option<Menu>,
    pub(super) help: bool,
    pub(super) information: bool,
    /// An inspected pixel, and its text once it is there.
    pub(super) inspected: Option<(UVec2, String)>,
    /// The pixel under the pointer is named until then, for the pointer moved.
    pointed: Option<Instant>,
    message: Option<(String, Instant)>,
}

/// What the sheet says about the picture below it; each only where it is shown.
#[derive(Debug, Default)]
pub(super) struct Facts {
    /// Stage, kernel, α, times.
    pub(super) information: String,
    /// The pixel under the pointer.
    pub(super) pixel: String,
    /// Where the pointer is, in points.
    pub(super) pointer: Option<Pos2>,
    /// The square of the window, in points, that shows the inspected pixel.
    pub(super) inspected: Option<Rect>,
    /// What the error view says.
    pub(super) errors: Option<String>,
    /// The squares of the window, in points, that show wrong pixels.
    pub(super) rings: Vec<Rect>,
    /// The rows of the menu that stand for something that is on.
    pub(super) on: Vec<Action>,
    pub(super) kernel: &'static str,
}

impl Sheet {
    /// Whether there is anything to draw.
    pub(super) fn is_empty(&self) -> bool {
        self.menu.is_none()
            && !self.help
            && !self.information
            && self.inspected.is_none()
            && self.pointed.is_none()
            && self.message.is_none()
    }

    /// Whether the pixel under the pointer is named.
    pub(super) fn names_pixels(&self) -> bool {
        self.information || self.inspected.is_some() || self.pointed.is_some()
    }

    /// Names the pixel under the pointer, which moved at `now`, for a while.
    pub(super) fn point(&mut self, now: Instant) {
        self.pointed = Some(now + READING_TIME);
    }

    /// Nothing is pointed at any more.
    pub(super) fn unpoint(&mut self) {
        self.pointed = None;
    }

    /// Says `text` for a while.
    pub(super) fn say(&mut self, text: String) {
        self.message = Some((text, Instant::now() + READING_TIME));
    }

    /// Takes away what was there for a while; when the next of it goes.
    pub(super) fn expire(&mut self, now: Instant) -> Option<Instant> {
        self.message.take_if(|(_, end)| *end <= now);
        self.pointed.take_if(|end| *end <= now);
        let message = self.message.as_ref().map(|(_, end)| *end);
        message.into_iter().chain(self.pointed).min()
    }

    /// Closes what was opened last, if anything is open that hides the picture.
    pub(super) fn close(&mut self) -> bool {
        if self.menu.take().is_some() {
            return true;
        }
        std::mem::take(&mut self.help) || self.inspected.take().is_some()
    }

    /// Lays everything out. A window may be smaller than any of it: then it is cut off, or scrolls.
    pub(super) fn lay_out(&mut self, context: &Context, facts: &Facts) {
        if let Some(square) = facts.inspected {
            let layer = egui::LayerId::new(egui::Order::Background, Id::unique("inspected square"));
            let painter = context.layer_painter(layer);
            for (width, color) in [(3.0, Color32::BLACK), (1.0, Color32::WHITE)] {
                let stroke = Stroke::new(width, color);
                painter.rect_stroke(square.expand(1.5), 0, stroke, StrokeKind::Middle);
            }
        }
        if let Some(text) = &facts.errors {
            ring(context, &facts.rings);
            panel(context, "errors", Align2::RIGHT_BOTTOM, |ui| {
                say(ui, text);
                draw_scale(ui);
            });
        }
        if self.information {
            panel(context, "information", Align2::LEFT_TOP, |ui| {
                say(ui, &facts.information);
                if !facts.pixel.is_empty() {
                    say(ui, &facts.pixel);
                }
            });
        } else if !facts.pixel.is_empty() {
            // Not over the pixel that it names.
            let high = facts.pointer.is_some_and(|place| place.y < LINE_HEIGHT);
            let place = if high && self.inspected.is_none() {
                Align2::LEFT_BOTTOM
            } else {
                Align2::LEFT_TOP
            };
            panel(context, "pixel", place, |ui| say(ui, &facts.pixel));
        }
        if let Some((_, text)) = &self.inspected {
            let text =
                format!("{text}(Ctrl+C copies this, Esc closes it; also on standard output)");
            panel(context, "inspected", Align2::LEFT_BOTTOM, |ui| {
                ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Wrap);
                ui.label(RichText::new(text).monospace().size(10.0));
            });
        }
        if self.help {
            panel(context, "keys", Align2::CENTER_CENTER, |ui| {
                say(ui, key_table().trim_end());
                say(ui, MOUSE);
            });
        }
        if let Some((text, _)) = &self.message {
            panel(context, "message", Align2::CENTER_BOTTOM, |ui| {
                say(ui, text)
            });
        }
        if let Some(menu) = &mut self.menu {
            draw_menu(context, menu, facts);
        }
    }
}

/// Rings around squares, however small they are.
fn ring(context: &Context, squares: &[Rect]) {
    let layer = egui::LayerId::new(egui::Order::Background, Id::unique("rings"));
    let painter = context.layer_painter(layer);
    for square in squares {
        let radius = square.width() / 2.0 + 5.0;
        painter.circle_stroke(square.center(), radius, Stroke::new(1.5, rgb(WRONG)));
    }
}

fn rgb([red, green, blue]: [u8; 3]) -> Color32 {
    Color32::from_rgb(red, green, blue)
}

/// The scale of the error view: its colours from 1 f32 step to 2²⁴, those without an error, and those that are no number.
fn draw_scale(ui: &mut Ui) {
    const OCTAVES: u32 = 24;
    const WIDTH: f32 = 8.0;
    let (strip, _) = ui.allocate_exact_size([25.0 * WIDTH, 10.0].into(), egui::Sense::hover());
    for octave in 0..=OCTAVES {
        let left = strip.min + egui::vec2(octave as f32 * WIDTH, 0.0);
        let rect = Rect::from_min_size(left, [WIDTH, strip.height()].into());
        let color = rgb(error_color(Some(1 << octave)));
        ui.painter().rect_filled(rect, 0, color);
    }
    let (labels, _) = ui.allocate_exact_size([230.0, 14.0].into(), egui::Sense::hover());
    for (octave, label) in [(0, "1"), (8, "2⁸"), (16, "2¹⁶"), (24, "2²⁴ ULP")] {
        let place = labels.min + egui::vec2(octave as f32 * WIDTH, 0.0);
        let font = egui::FontId::monospace(12.0);
        let white = Color32::WHITE;
        ui.painter()
            .text(place, Align2::LEFT_TOP, label, font, white);
    }
    ui.horizontal(|ui| {
        for (color, meaning) in [
            (error_color(Some(0)), "exact"),
            (error_color(None), "NaN"),
            (WRONG, "wrong decision"),
        ] {
            let (square, _) = ui.allocate_exact_size([10.0, 10.0].into(), egui::Sense::hover());
            ui.painter().rect_filled(square, 0, rgb(color));
            let frame = Stroke::new(1.0, Color32::GRAY);
            ui.painter()
                .rect_stroke(square, 0, frame, StrokeKind::Inside);
            say(ui, meaning);
        }
    });
}

/// What the mouse does, below the keys.
const MOUSE: &str = "pointer  name the pixel under it\nwheel    zoom around the pointer\ndrag     move the picture\nclick    work a pixel through\nright    the menu";

fn say(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).monospace().size(12.0));
}

/// A dark panel at a corner, a side or in the middle of the window.
fn panel(context: &Context, name: &str, place: Align2, contents: impl FnOnce(&mut Ui)) {
    Area::new(Id::unique(name))
        .anchor(place, [0.0, 0.0])
        .interactable(false)
        .fade_in(false)
        .show(context, |ui| {
            Frame::new()
                .fill(Color32::from_black_alpha(200))
                .inner_margin(4)
                .show(ui, |ui| {
                    ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
                    ui.visuals_mut().override_text_color = Some(Color32::WHITE);
                    contents(ui);
                });
        });
}

fn draw_menu(context: &Context, menu: &mut Menu, facts: &Facts) {
    let mut drawn = Vec::new();
    let height = context.content_rect().height() - 12.0;
    Area::new(Id::unique("menu"))
        .order(egui::Order::Foreground)
        .fixed_pos(menu.place)
        .default_height(height)
        .constrain(true)
        .fade_in(false)
        .show(context, |ui| {
            Frame::menu(ui.style()).show(ui, |ui| {
                let mut scroll = ScrollArea::vertical().max_height(height);
                if menu.selected.is_none() {
                    // Not where the last menu was left.
                    scroll = scroll.vertical_scroll_offset(0.0);
                }
                scroll.show(ui, |ui| {
                    for (number, row) in rows().enumerate() {
                        if row.opens_group {
                            ui.separator();
                        }
                        let mark = if facts.on.contains(&row.action) {
                            "• "
                        } else {
                            "   "
                        };
                        let now = match row.action {
                            Action::NextKernel => format!(" (now {})", facts.kernel),
                            _ => String::new(),
                        };
                        let selected = menu.selected == Some(number);
                        let text = format!("{mark}{}{now}", row.does);
                        let button = Button::selectable(selected, RichText::new(text).size(12.0))
                            .shortcut_text(RichText::new(row.keys).monospace().size(12.0))
                            .min_size([330.0, 0.0].into());
                        let response = ui.add(button);
                        if selected {
                            response.scroll_to_me(None);
                        }
                        drawn.push(response.rect.intersect(ui.clip_rect()));
                    }
                });
            });
        });
    menu.drawn = drawn;
}
