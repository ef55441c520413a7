//! Promise: `firsthit compare` says how far two pictures are apart, hides no NaN, and fails beyond
//! its threshold.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;
use std::process::Output;

use firsthit::Image;
use firsthit::difference::{Difference, PIXELS_PER_DEGREE, error_color, flip};
use firsthit::image::{Raster, display_byte};
use tempfile::TempDir;

use crate::helpers::{self, printed, program, same_bits, text};

/// Runs `firsthit compare` with the words of `line` in `folder`.
fn compare(folder: &TempDir, line: &str) -> Output {
    program(folder, &format!("compare {line}"))
        .output()
        .unwrap()
}

/// What it printed; it must have succeeded.
fn compared(folder: &TempDir, line: &str) -> String {
    printed(folder, &format!("compare {line}"))
}

/// What it said when it failed with `status`.
fn failed(folder: &TempDir, line: &str, status: i32) -> String {
    helpers::failed(&compare(folder, line), status, line)
}

/// What follows `name` in the text of a comparison.
fn line<'a>(text: &'a str, name: &str) -> &'a str {
    let mut lines = text.lines().filter_map(|line| line.strip_prefix(name));
    lines
        .next()
        .unwrap_or_else(|| panic!("no {name} in {text}"))
        .trim()
}

/// A picture of 4 × 4 pixels, all samples 0.5 but those of `changes`: the place of a sample, and
/// what it is.
fn picture(changes: &[(usize, f32)]) -> Image {
    let mut image = Image::new(4).unwrap();
    image.samples_mut().fill(0.5);
    for &(place, sample) in changes {
        image.samples_mut()[place] = sample;
    }
    image
}

fn saved(folder: &TempDir, name: &str, image: &Raster) {
    image.save(folder.path().join(name)).unwrap();
}

/// The bytes of an RGB PNG of 8 bits, its width, and its height.
fn png(path: &Path) -> (Vec<u8>, usize, usize) {
    let decoder = png::Decoder::new(std::io::BufReader::new(File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgb);
    (bytes, info.width as usize, info.height as usize)
}

/// Writes a PNG of other kinds than the program's own.
fn write_png(
    path: &Path,
    (width, height): (u32, u32),
    color: png::ColorType,
    depth: png::BitDepth,
    bytes: &[u8],
) {
    let file = BufWriter::new(File::create(path).unwrap());
    let mut encoder = png::Encoder::new(file, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(bytes).unwrap();
}

#[test]
fn known_errors_are_counted_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    saved(&folder, "a.exr", &picture(&[]));
    // One step up, a whole half up, three steps down.
    let b = picture(&[
        (0, 0.5_f32.next_up()),
        (7, 1.0),
        (20, 0.5_f32.next_down().next_down().next_down()),
    ]);
    saved(&folder, "b.exr", &b);
    let text = compared(&folder, "a.exr b.exr");
    assert_eq!(line(&text, "wrong samples"), "3 of 48 (6.250 %)");
    // From 1/2 to 1 there are 2^23 floats.
    let mean = f64::from((1 << 23) + 4) / 48.0;
    assert_eq!(
        line(&text, "error in f32 steps"),
        format!("8388608 at most, {mean:.4} in the mean")
    );
    // 2^-24 up, 3 × 2^-25 down.
    let mean = (0.5 + 2.0_f64.powi(-24) + 3.0 * 2.0_f64.powi(-25)) / 48.0;
    assert_eq!(
        line(&text, "absolute error"),
        format!("5.0000e-1 at most, {mean:.4e} in the mean")
    );
    let bytes = picture(&[])
        .samples()
        .iter()
        .zip(b.samples())
        .fold(0, |sum, (&a, &b)| {
            sum + u32::from(display_byte(a) != display_byte(b))
        });
    assert_eq!(line(&text, "8-bit differences"), bytes.to_string());
    // The mean of the squares is 0.25/48, but for what eight digits do not show.
    let ratio = 10.0 * (48.0_f64 / 0.25).log10();
    assert_eq!(
        line(&text, "PSNR"),
        format!("{ratio:.2} dB for a peak of 1")
    );
    assert!(line(&text, "NaN").starts_with("0 and 0; 0 against"));
}

#[test]
fn a_picture_is_itself() {
    let folder = tempfile::tempdir().unwrap();
    saved(
        &folder,
        "a.exr",
        &picture(&[(5, f32::NAN), (6, -0.0), (9, f32::INFINITY)]),
    );
    let text = compared(&folder, "a.exr a.exr --threshold 0");
    assert_eq!(line(&text, "wrong samples"), "0 of 48 (0.000 %)");
    assert!(line(&text, "error in f32 steps").starts_with("0 at most, 0.0000"));
    assert!(line(&text, "PSNR").starts_with("infinite"));
    // They are equal, but they are there.
    assert!(line(&text, "NaN").starts_with("1 and 1; 0 against"));
}

#[test]
fn a_zero_of_another_sign_is_wrong_and_no_step_away() {
    let folder = tempfile::tempdir().unwrap();
    saved(&folder, "a.exr", &picture(&[(6, -0.0)]));
    saved(&folder, "b.exr", &picture(&[(6, 0.0)]));
    let text = compared(&folder, "a.exr b.exr --threshold 0");
    assert_eq!(line(&text, "wrong samples"), "1 of 48 (2.083 %)");
    assert!(line(&text, "error in f32 steps").starts_with("0 at most"));
}

#[test]
fn a_nan_is_beyond_every_threshold_and_in_no_mean() {
    let folder = tempfile::tempdir().unwrap();
    saved(&folder, "a.exr", &picture(&[]));
    saved(
        &folder,
        "b.exr",
        &picture(&[(5, f32::NAN), (8, 0.5_f32.next_up())]),
    );
    let text = compared(&folder, "a.exr b.exr");
    assert_eq!(line(&text, "wrong samples"), "2 of 48 (4.167 %)");
    assert_eq!(
        line(&text, "error in f32 steps"),
        format!("1 at most, {:.4} in the mean", 1.0 / 47.0)
    );
    assert!(line(&text, "NaN").starts_with("0 and 1; 1 against"));
    for order in ["a.exr b.exr", "b.exr a.exr"] {
        let message = failed(&folder, &format!("{order} --threshold 4294967295"), 1);
        assert!(message.contains("1 NaNs against a number"), "{message}");
    }
}

#[test]
fn the_threshold_is_the_most_that_passes() {
    let folder = tempfile::tempdir().unwrap();
    saved(&folder, "a.exr", &picture(&[]));
    saved(
        &folder,
        "b.exr",
        &picture(&[(3, 0.5_f32.next_up().next_up())]),
    );
    compared(&folder, "a.exr b.exr --threshold 2");
    let message = failed(&folder, "a.exr b.exr --threshold 1", 1);
    assert!(message.contains("up to 2 f32 steps apart"), "{message}");
    // What was found is said all the same.
    let output = compare(&folder, "a.exr b.exr --threshold 1");
    assert!(text(&output.stdout).contains("2 at most"));
}

#[test]
fn infinities_are_one_step_beyond_the_largest_float() {
    let image = |sample| picture(&[(0, sample)]);
    let difference = Difference::of(&image(f32::INFINITY), &image(f32::MAX)).unwrap();
    assert_eq!(
        (difference.max_steps, difference.max_abs),
        (1, f64::INFINITY)
    );
    assert_eq!(difference.psnr(), f64::NEG_INFINITY);
}

#[test]
fn a_png_is_bytes_over_255() {
    let folder = tempfile::tempdir().unwrap();
    let exact: Vec<(usize, f32)> = (0..48).map(|i| (i, (5 * i) as f32 / 255.0)).collect();
    saved(&folder, "a.png", &picture(&exact));
    saved(&folder, "a.exr", &picture(&exact));
    let text = compared(&folder, "a.png a.exr --threshold 0");
    assert_eq!(line(&text, "wrong samples"), "0 of 48 (0.000 %)");
    assert!(line(&text, "note").starts_with("a.png holds"), "{text}");
    assert_eq!(text.matches("note").count(), 1);

    // The same in grey, with a palette's sixteen bits, and with an opaque alpha.
    let path = |name: &str| folder.path().join(name);
    let grey: Vec<u8> = (0..16).collect();
    let rgb: Vec<u8> = grey.iter().flat_map(|&byte| [byte; 3]).collect();
    let wide: Vec<u8> = rgb.iter().flat_map(|&byte| [byte, byte]).collect();
    let rgba: Vec<u8> = grey
        .iter()
        .flat_map(|&byte| [byte, byte, byte, 255])
        .collect();
    let (eight, sixteen) = (png::BitDepth::Eight, png::BitDepth::Sixteen);
    write_png(
        &path("grey.png"),
        (4, 4),
        png::ColorType::Grayscale,
        eight,
        &grey,
    );
    write_png(&path("rgb.png"), (4, 4), png::ColorType::Rgb, eight, &rgb);
    write_png(
        &path("wide.png"),
        (4, 4),
        png::ColorType::Rgb,
        sixteen,
        &wide,
    );
    write_png(
        &path("rgba.png"),
        (4, 4),
        png::ColorType::Rgba,
        eight,
        &rgba,
    );
    let rgb = Raster::load(path("rgb.png")).unwrap();
    // Rows of a file go down, those of a picture up.
    assert_eq!(rgb.pixel(1, 3), Some([1.0 / 255.0; 3]));
    for name in ["grey.png", "wide.png", "rgba.png"] {
        assert!(Raster::load(path(name)).unwrap() == rgb, "{name}");
    }
    let mut glass = rgba.clone();
    glass[3] = 254;
    write_png(
        &path("glass.png"),
        (4, 4),
        png::ColorType::Rgba,
        eight,
        &glass,
    );
    assert!(failed(&folder, "glass.png rgb.png", 1).contains("transparent"));
}

#[test]
fn an_exr_comes_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    for size in [1, 2, 17, 65] {
        let mut image = Image::new(size).unwrap();
        for (i, sample) in image.samples_mut().iter_mut().enumerate() {
            *sample = f32::from_bits((i as u32).wrapping_mul(0x9e37_79b1));
        }
        saved(&folder, "a.exr", &image);
        let read = Raster::load(folder.path().join("a.exr")).unwrap();
        assert!(same_bits(&read, &image), "{size}");
    }
}

#[test]
fn what_cannot_be_compared_is_one_line() {
    let folder = tempfile::tempdir().unwrap();
    saved(&folder, "a.exr", &picture(&[]));
    saved(&folder, "three.exr", &Image::new(3).unwrap());
    let path = |name: &str| folder.path().join(name);
    fs::write(path("text.exr"), "no picture").unwrap();
    fs::write(path("text.png"), "no picture").unwrap();
    let whole = fs::read(path("a.exr")).unwrap();
    fs::write(path("half.exr"), &whole[..whole.len() / 2]).unwrap();
    saved(&folder, "a.png", &picture(&[]));
    let whole = fs::read(path("a.png")).unwrap();
    fs::write(path("half.png"), &whole[..whole.len() - 20]).unwrap();
    let bytes = [0; 24];
    write_png(
        &path("wide.png"),
        (4, 2),
        png::ColorType::Rgb,
        png::BitDepth::Eight,
        &bytes,
    );

    for (line, says) in [
        (
            "a.exr three.exr",
            "a.exr and three.exr: 4 × 4 and 3 × 3 pixels cannot be compared",
        ),
        ("a.exr missing.exr", "missing.exr: cannot be read"),
        ("a.exr .", ".: this extension"),
        ("a.exr a.jpeg", "a.jpeg: this extension"),
        ("a.exr a.apng", "a.apng: this extension"),
        ("text.exr a.exr", "text.exr: is not a whole exr"),
        ("text.png a.exr", "text.png: is not a whole png"),
        ("half.exr a.exr", "half.exr: is not a whole exr"),
        ("half.png a.exr", "half.png: is not a whole png"),
        (
            "wide.png a.exr",
            "wide.png and a.exr: 4 × 2 and 4 × 4 pixels cannot be compared",
        ),
        (
            "a.exr a.exr -o none/heat.png",
            "none/heat.png: cannot be written",
        ),
    ] {
        let message = failed(&folder, line, 1);
        assert!(
            message.starts_with(&format!("firsthit: {says}")),
            "{line}: {message}"
        );
    }
    for (line, says) in [
        ("a.exr", "<B>"),
        (
            "a.exr a.exr -o heat.exr",
            "a false-colour picture is a .png",
        ),
        (
            "a.exr a.exr --threshold -1",
            "a whole number from 0 to 4294967295 is needed",
        ),
        (
            "a.exr a.exr --threshold 1.5",
            "a whole number from 0 to 4294967295 is needed",
        ),
    ] {
        let message = failed(&folder, line, 2);
        assert!(message.contains(says), "{line}: {message}");
    }
}

#[test]
fn the_false_colours_are_those_of_the_errors_above_a_scale() {
    let folder = tempfile::tempdir().unwrap();
    saved(&folder, "a.exr", &picture(&[]));
    let b = picture(&[(0, 0.5_f32.next_up()), (15, f32::NAN), (47, 1e30)]);
    saved(&folder, "b.exr", &b);
    compared(&folder, "a.exr b.exr -o heat.png");
    let (bytes, width, height) = png(&folder.path().join("heat.png"));
    // Magnified 128 times, in the middle; the pixel's row counts from the bottom.
    let margin = (width - 512) / 2;
    let color = |column: usize, row: usize| {
        let places = [(0, 0), (127, 0), (0, 127), (127, 127)];
        let colors = places.map(|(x, y)| {
            let first = ((128 * (3 - row) + y) * width + margin + 128 * column + x) * 3;
            [bytes[first], bytes[first + 1], bytes[first + 2]]
        });
        assert!(colors.iter().all(|color| *color == colors[0]));
        colors[0]
    };
    for row in 0..4 {
        for column in 0..4 {
            let steps = match (column, row) {
                (0, 0) => Some(1),
                (1, 1) => None,
                (3, 3) => Some(u32::MAX),
                _ => Some(0),
            };
            assert_eq!(color(column, row), error_color(steps), "{column} {row}");
        }
    }
    // Below, every colour of the scale.
    let scale = &bytes[512 * width * 3..];
    assert!(height > 512);
    for steps in [Some(0), Some(1), Some(1 << 12), Some(1 << 24), None] {
        let color = error_color(steps);
        assert!(
            scale.chunks_exact(3).any(|pixel| pixel == color),
            "{steps:?}"
        );
    }
    // Nothing else is left in the folder.
    assert_eq!(folder.path().read_dir().unwrap().count(), 3);
}

#[test]
fn pictures_need_not_be_square() {
    let folder = tempfile::tempdir().unwrap();
    let mut high = Raster::new(3, 5).unwrap();
    saved(&folder, "a.exr", &high);
    // Column 2, row 1 from the bottom.
    high.samples_mut()[3 * (3 + 2)] = f32::from_bits(1 << 12);
    saved(&folder, "b.exr", &high);
    saved(&folder, "wide.exr", &Raster::new(5, 3).unwrap());
    let text = compared(&folder, "a.exr b.exr -o heat.png --json c.json");
    assert_eq!(line(&text, "pictures"), "a.exr and b.exr, 3 × 5 pixels");
    assert_eq!(line(&text, "wrong samples"), "1 of 45 (2.222 %)");
    let worst = line(&text, "worst pixel");
    let place = "column 2, row 3 from the top, 1 from the bottom: ";
    assert!(worst.starts_with(place), "{worst}");

    let (bytes, width, height) = png(&folder.path().join("heat.png"));
    let side = 512 / 5;
    assert!(height > 5 * side && height < 6 * side, "{height}");
    let margin = (width - 3 * side) / 2;
    for (column, row_from_top) in (0..3).flat_map(|column| (0..5).map(move |row| (column, row))) {
        let expected = match (column, row_from_top) {
            (2, 3) => error_color(Some(1 << 12)),
            _ => error_color(Some(0)),
        };
        for (x, y) in [(0, 0), (side - 1, side - 1)] {
            let pixel = (row_from_top * side + y) * width + margin + column * side + x;
            assert_eq!(bytes[3 * pixel..3 * pixel + 3], expected, "{pixel}");
        }
    }

    let json = fs::read_to_string(folder.path().join("c.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    for (name, value) in [
        ("/size", serde_json::Value::Null),
        ("/width", serde_json::json!(3)),
        ("/height", serde_json::json!(5)),
        ("/pixels", serde_json::json!(15)),
        ("/worst_pixel/row_from_top", serde_json::json!(3)),
    ] {
        assert_eq!(json.pointer(name), Some(&value), "{name} of {json}");
    }
    let said = failed(&folder, "a.exr wide.exr", 1);
    let sizes = "a.exr and wide.exr: 3 × 5 and 5 × 3 pixels cannot be compared: give two";
    assert!(said.contains(sizes), "{said}");
}

#[test]
fn the_worst_pixel_is_named_and_pixels_are_counted_by_how_far_they_are_off() {
    let folder = tempfile::tempdir().unwrap();
    saved(&folder, "a.exr", &picture(&[]));
    let up = |steps: u32| f32::from_bits(0.5_f32.to_bits() + steps);
    // One step; two, and one in another sample; five; a quarter, which is 2^22 floats.
    let b = picture(&[
        (0, up(1)),
        (4, up(2)),
        (5, up(1)),
        (12, up(5)),
        (6 * 3 + 1, 0.75),
        (15, f32::from_bits(0.75_f32.to_bits() - 1)),
    ]);
    saved(&folder, "b.exr", &b);
    let text = compared(&folder, "a.exr b.exr");
    assert_eq!(
        line(&text, "worst pixel"),
        "column 2, row 2 from the top, 1 from the bottom: [0.5, 0.5, 0.5] and [0.5, 0.75, 0.5], 4194304 f32 steps"
    );
    let steps = line(&text, "pixels by steps");
    let begin = "of 16, 5 beyond 0, 4 beyond 1, 3 beyond 2, 3 beyond 4, 2 beyond 8, 2 beyond 16";
    assert!(steps.starts_with(begin), "{steps}");
    let end = ", 2 beyond 1048576, 2 beyond 2097152, 0 beyond 4194304";
    assert!(steps.ends_with(end), "{steps}");
    // Of 128 and 191.
    let bytes = "of 16, 2 beyond 0, 2 beyond 1, 2 beyond 2, 2 beyond 4, 2 beyond 8, 2 beyond 16, 2 beyond 32, 0 beyond 64";
    assert_eq!(line(&text, "pixels by bytes"), bytes);

    saved(&folder, "nan.exr", &picture(&[(19, 1e30), (47, f32::NAN)]));
    let text = compared(&folder, "nan.exr a.exr");
    assert_eq!(
        line(&text, "worst pixel"),
        "column 3, row 0 from the top, 3 from the bottom: [0.5, 0.5, NaN] and [0.5, 0.5, 0.5], a NaN against a number"
    );
    assert!(line(&text, "pixels by steps").ends_with(", 1 beyond 2147483648"));

    saved(&folder, "zero.exr", &picture(&[(0, 0.0), (1, f32::NAN)]));
    saved(&folder, "minus.exr", &picture(&[(0, -0.0), (1, -f32::NAN)]));
    let text = compared(&folder, "zero.exr minus.exr");
    assert_eq!(
        line(&text, "worst pixel"),
        "none: no number differs from another"
    );
    assert_eq!(line(&text, "pixels by steps"), "of 16, 0 beyond 0");
}

#[test]
fn programs_are_told_the_same_as_json() {
    let folder = tempfile::tempdir().unwrap();
    saved(&folder, "a.exr", &picture(&[]));
    let b = picture(&[(0, f32::INFINITY), (7, 0.5_f32.next_up()), (40, f32::NAN)]);
    saved(&folder, "b.exr", &b);
    let text = compared(&folder, "a.exr b.exr --json c.json");
    assert_eq!(text, compared(&folder, "a.exr b.exr"));
    let json = fs::read_to_string(folder.path().join("c.json")).unwrap();
    // Nothing else is on standard output.
    assert_eq!(compared(&folder, "a.exr b.exr --json -"), json);
    assert_eq!(helpers::names(&folder), ["a.exr", "b.exr", "c.json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    for (name, value) in [
        ("/a/path", serde_json::json!("a.exr")),
        ("/b/nans", serde_json::json!(1)),
        ("/b/other_layers", serde_json::json!([])),
        ("/size", serde_json::json!(4)),
        ("/width", serde_json::json!(4)),
        ("/height", serde_json::json!(4)),
        ("/samples", serde_json::json!(48)),
        ("/wrong", serde_json::json!(3)),
        (
            "/max_ulp",
            serde_json::json!(f32::INFINITY.to_bits() - 0.5_f32.to_bits()),
        ),
        ("/max_abs", serde_json::Value::Null),
        ("/nan_against_number", serde_json::json!(1)),
        ("/pixels", serde_json::json!(16)),
        (
            "/pixels_beyond_ulp/0",
            serde_json::json!({"limit": 0, "pixels": 3}),
        ),
        (
            "/pixels_beyond_ulp/1",
            serde_json::json!({"limit": 1, "pixels": 2}),
        ),
        (
            "/pixels_beyond_bytes/8",
            serde_json::json!({"limit": 128, "pixels": 0}),
        ),
        ("/worst_pixel/column", serde_json::json!(1)),
        ("/worst_pixel/row_from_top", serde_json::json!(0)),
        ("/worst_pixel/row_from_bottom", serde_json::json!(3)),
        ("/worst_pixel/a", serde_json::json!([0.5, 0.5, 0.5])),
        ("/worst_pixel/b", serde_json::json!([0.5, null, 0.5])),
        ("/worst_pixel/ulp", serde_json::Value::Null),
        ("/within_limits", serde_json::json!(true)),
    ] {
        assert_eq!(json.pointer(name), Some(&value), "{name} of {json}");
    }
    let output = compare(&folder, "a.exr b.exr --threshold 9 --json -");
    assert_eq!(output.status.code(), Some(1));
    assert!(self::text(&output.stdout).contains("\"within_limits\": false"));
    let said = failed(&folder, "a.exr b.exr --json none/c.json", 1);
    assert!(said.contains("none/c.json: cannot be written"), "{said}");
}

#[test]
fn flip_is_said_if_it_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    saved(&folder, "a.exr", &picture(&[]));
    saved(&folder, "b.exr", &picture(&[(0, 0.75), (7, f32::NAN)]));
    let [a, b] = ["a.exr", "b.exr"].map(|name| Raster::load(folder.path().join(name)).unwrap());
    let json = |line: &str| -> serde_json::Value {
        serde_json::from_str(&compared(&folder, &format!("{line} --json -"))).unwrap()
    };
    for (options, degrees) in [
        ("--flip", PIXELS_PER_DEGREE),
        ("--flip --pixels-per-degree 20.5", 20.5),
    ] {
        let mean = flip(&a, &b, degrees).unwrap();
        let text = compared(&folder, &format!("a.exr b.exr {options}"));
        let said = format!(
            "{mean:.6} in the mean, at {degrees:.2} pixels per degree, of samples taken for sRGB"
        );
        assert_eq!(line(&text, "FLIP"), said);
        let json = json(&format!("a.exr b.exr {options}"));
        assert_eq!(json.pointer("/flip"), Some(&serde_json::json!(mean)));
        let degrees = serde_json::json!(degrees);
        assert_eq!(json.pointer("/pixels_per_degree"), Some(&degrees));
    }
    assert!(!compared(&folder, "a.exr b.exr").contains("FLIP"));
    assert_eq!(
        json("a.exr b.exr").pointer("/flip"),
        Some(&serde_json::Value::Null)
    );
    for options in [
        "--pixels-per-degree 20",
        "--flip --pixels-per-degree 0",
        "--flip --pixels-per-degree -20",
        "--flip --pixels-per-degree 1001",
        "--flip --pixels-per-degree NaN",
        "--flip --pixels-per-degree many",
    ] {
        failed(&folder, &format!("a.exr b.exr {options}"), 2);
    }
}

#[test]
fn an_absolute_and_a_relative_limit_are_the_most_that_passes() {
    let folder = tempfile::tempdir().unwrap();
    saved(&folder, "a.exr", &picture(&[(3, 0.25), (4, -8.0)]));
    saved(&folder, "b.exr", &picture(&[(3, 0.5), (4, -10.0)]));
    let text = compared(&folder, "a.exr b.exr");
    let relative = "5.0000e-1 at most, by the samples of b.exr";
    assert_eq!(line(&text, "relative error"), relative);
    for passes in [
        "a.exr b.exr --tolerance 2",
        "a.exr b.exr --relative 0.5",
        "a.exr b.exr --relative 0.5 --tolerance 2 --threshold 8388608",
        "b.exr a.exr --relative 1",
    ] {
        compared(&folder, passes);
    }
    for (line, says) in [
        (
            "a.exr b.exr --tolerance 1.99",
            "up to 2e0 apart and 0 NaNs against a number, beyond the tolerance of 1.99",
        ),
        (
            "a.exr b.exr --relative 0.49",
            "up to 5e-1 times the latter apart and 0 NaNs against a number, beyond the relative error of 0.49",
        ),
        (
            "b.exr a.exr --relative 0.99 --tolerance 2",
            "beyond the relative error of 0.99",
        ),
        (
            "a.exr b.exr --relative 1 --threshold 8388607",
            "beyond the threshold of 8388607",
        ),
        (
            "a.exr b.exr --relative 1 --tolerance 0",
            "beyond the tolerance of 0",
        ),
    ] {
        let said = failed(&folder, line, 1);
        assert!(said.contains(says), "{line}: {said}");
    }
    // By 0 and by an infinity nothing is measured; a NaN is beyond every limit.
    for sample in [0.0, f32::INFINITY, f32::NAN] {
        saved(&folder, "none.exr", &picture(&[(9, sample)]));
        saved(&folder, "half.exr", &picture(&[]));
        failed(&folder, "half.exr none.exr --relative 1e300", 1);
        compared(&folder, "none.exr none.exr --relative 0 --tolerance 0");
    }
    failed(&folder, "half.exr none.exr --tolerance 1e300", 1);
    for line in [
        "--tolerance -1",
        "--relative -0.5",
        "--relative NaN",
        "--tolerance inf",
    ] {
        failed(&folder, &format!("a.exr b.exr {line}"), 2);
    }
    let help = compared(&folder, "--help");
    assert!(help.contains("Exit status: 0 if"), "{help}");
}

#[test]
fn no_output_takes_the_place_of_another_file_of_the_comparison() {
    let folder = tempfile::tempdir().unwrap();
    saved(&folder, "a.png", &picture(&[]));
    saved(&folder, "b.png", &picture(&[(0, 0.25)]));
    let files = || ["a.png", "b.png"].map(|name| fs::read(folder.path().join(name)).unwrap());
    let before = files();
    let (picture, two) = (
        "this is a picture to be compared",
        "the false colours and the JSON need two files",
    );
    for (line, says) in [
        ("a.png b.png -o a.png", picture),
        ("a.png b.png -o ./b.png", picture),
        ("a.png b.png --json b.png", picture),
        ("a.png b.png -o c.png --json c.png", two),
    ] {
        let said = failed(&folder, line, 2);
        assert!(said.contains(says), "{line}: {said}");
        assert!(files() == before, "{line}");
    }
    assert_eq!(helpers::names(&folder), ["a.png", "b.png"]);
    compared(&folder, "a.png b.png -o c.png --json -");
}
