//! A comparison for programs.

use firsthit::difference::{WorstPixel, limit};
use firsthit::image::Window;
use serde::Serialize;

use super::{Arguments, Compared};

/// The whole of it. What cannot be said as a number, an infinite error or a NaN, is `null`.
#[derive(Serialize)]
struct Json {
    version: u32,
    a: JsonPicture,
    b: JsonPicture,
    /// Of a square picture; `null` of another.
    size: Option<u32>,
    width: u32,
    height: u32,
    /// Where the pixels lie that are compared.
    window: JsonWindow,
    samples: u64,
    wrong: u64,
    max_ulp: u32,
    mean_ulp: f64,
    max_abs: f64,
    mean_abs: f64,
    max_relative: f64,
    eight_bit_differences: u64,
    psnr: f64,
    /// `null` without `--flip`.
    flip: Option<f64>,
    pixels_per_degree: Option<f64>,
    nan_against_number: u64,
    pixels: u64,
    pixels_beyond_ulp: Vec<Beyond>,
    pixels_beyond_bytes: Vec<Beyond>,
    worst_pixel: Option<JsonPixel>,
    /// Whether all is within the limits that were given.
    within_limits: bool,
}

#[derive(Serialize)]
struct JsonPicture {
    path: String,
    layer: String,
    other_layers: Vec<String>,
    data_window: JsonWindow,
    nans: u64,
}

/// A rectangle in the pixel space of OpenEXR, where rows count down.
#[derive(Serialize)]
struct JsonWindow {
    left: i32,
    top: i32,
    width: u32,
    height: u32,
}

impl From<Window> for JsonWindow {
    fn from(window: Window) -> JsonWindow {
        let ([left, top], [width, height]) = (window.corner, window.size);
        JsonWindow {
            left,
            top,
            width,
            height,
        }
    }
}

/// So many pixels are off by more than this.
#[derive(Serialize)]
struct Beyond {
    limit: u32,
    pixels: u64,
}

#[derive(Serialize)]
struct JsonPixel {
    column: u32,
    row_from_top: u32,
    row_from_bottom: u32,
    a: [f32; 3],
    b: [f32; 3],
    /// `null` where only one has a NaN.
    ulp: Option<u32>,
}

/// One object, and a line break.
pub(super) fn json(arguments: &Arguments, compared: &Compared, within_limits: bool) -> String {
    let (samples, pixels) = (&compared.samples, &compared.pixels);
    let image = &compared.pictures[0].image;
    let (width, height) = (image.width(), image.height());
    let picture = |place: usize| JsonPicture {
        path: arguments.paths()[place].display().to_string(),
        layer: compared.pictures[place].layer.clone(),
        other_layers: compared.pictures[place].other_layers.clone(),
        data_window: compared.data_windows[place].into(),
        nans: samples.nans[place],
    };
    let beyond = |counts: &[u64]| {
        let counts = counts.iter().enumerate();
        let counts = counts.map(|(place, &pixels)| Beyond {
            limit: limit(place),
            pixels,
        });
        counts.collect()
    };
    let pixel = |pixel: WorstPixel| JsonPixel {
        column: pixel.column,
        row_from_top: height - 1 - pixel.row,
        row_from_bottom: pixel.row,
        a: pixel.colors[0],
        b: pixel.colors[1],
        ulp: pixel.steps,
    };
    let json = Json {
        version: 1,
        a: picture(0),
        b: picture(1),
        size: (width == height).then_some(width),
        width,
        height,
        window: compared.pictures[0].data_window().into(),
        samples: samples.samples,
        wrong: samples.wrong,
        max_ulp: samples.max_steps,
        mean_ulp: samples.mean_steps(),
        max_abs: samples.max_abs,
        mean_abs: samples.mean_abs(),
        max_relative: samples.max_relative,
        eight_bit_differences: samples.eight_bit,
        psnr: samples.psnr(),
        flip: compared.flip.as_ref().map(|flip| flip.mean),
        pixels_per_degree: compared.flip.as_ref().map(|flip| flip.pixels_per_degree),
        nan_against_number: samples.nan_against_number,
        pixels: pixels.pixels,
        pixels_beyond_ulp: beyond(&pixels.beyond_steps),
        pixels_beyond_bytes: beyond(&pixels.beyond_bytes),
        worst_pixel: pixels.worst.map(pixel),
        within_limits,
    };
    serde_json::to_string_pretty(&json).map_or_else(|_| String::new(), |text| text + "\n")
}
