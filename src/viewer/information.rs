//! The information line: what is shown, and what it costs.

use std::time::Duration;

use crate::Image;
use crate::image::display_byte;

use super::renderer::Renderer;
use super::tracing::Traced;
use glam::UVec2;

/// What is known about the frame that was drawn last.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Times {
    /// The last upload.
    pub(super) upload: Duration,
    pub(super) draw: Duration,
    /// Frames a second on the display, while something plays.
    pub(super) display: Option<f64>,
}

/// Stage, kernel, α and size; the times of tracing, upload and drawing, and their sum; how many
/// frames a second could be traced, and how many are displayed; the pixels in doubt, and the parts
/// of a row. Lines of a name and a value.
pub(super) fn information(traced: &Traced, size: u32, times: Times) -> String {
    let frame = &traced.frame;
    let ms = |time: Duration| format!("{:.2} ms", 1e3 * time.as_secs_f64());
    let rate = 1.0 / traced.time.as_secs_f64().max(1e-9);
    let display = match times.display {
        Some(rate) => format!("{rate:.0} fps"),
        None => "still".to_owned(),
    };
    let tally = traced.tally;
    let doubts = format!(
        "{} after f64, {} after double-doubles",
        tally.double_double + tally.arbitrary,
        tally.arbitrary
    );
    let a_row = |count: u64| count as f64 / f64::from(size.max(1));
    let parts = format!(
        "{:.1} edges, {:.1} spans",
        a_row(tally.edges),
        a_row(tally.spans)
    );
    let kind = match frame.renderer {
        Renderer::Kernel(_) => "kernel",
        Renderer::Given(_) => "renderer",
    };
    let lines = [
        ("stage", frame.stage.to_string()),
        (kind, frame.renderer.name().to_owned()),
        ("α", format!("{:.3} rad", frame.alpha)),
        ("size", format!("{size} × {size}")),
        ("trace", format!("{}, {rate:.0} fps", ms(traced.time))),
        ("upload", ms(times.upload)),
        ("draw", ms(times.draw)),
        ("total", ms(traced.time + times.upload + times.draw)),
        ("display", display),
        ("in doubt", doubts),
        ("a row", parts),
    ];
    // How a renderer that was given works is not known here.
    let known =
        |(name, _): &(&str, String)| kind == "kernel" || !["in doubt", "a row"].contains(name);
    lines
        .into_iter()
        .filter(known)
        .map(|(name, value)| format!("{name:13}{value}\n"))
        .collect()
}

/// A pixel by its column and row, its floats and its bytes.
pub(super) fn name_pixel(image: &Image, pixel: UVec2) -> String {
    let Some(color) = image.pixel(pixel.x, pixel.y) else {
        return String::new();
    };
    let [floats, bytes] = color_text(color);
    format!("column {}, row {}: {floats} = {bytes}", pixel.x, pixel.y)
}

/// Red, green and blue, as floats and as bytes.
pub(super) fn color_text([red, green, blue]: [f32; 3]) -> [String; 2] {
    let [r, g, b] = [red, green, blue].map(display_byte);
    [format!("{red} {green} {blue}"), format!("{r} {g} {b}")]
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_is_named_by_its_floats_and_bytes() {
        let mut image = Image::new(500).unwrap();
        let first = 3 * (202 * 500 + 255);
        image.samples_mut()[first..first + 3].copy_from_slice(&[0.135, 0.0375, 0.03]);
        assert_eq!(
            name_pixel(&image, UVec2::new(255, 202)),
            "column 255, row 202: 0.135 0.0375 0.03 = 34 10 8"
        );
        assert_eq!(name_pixel(&image, UVec2::new(500, 0)), "");
    }
}
