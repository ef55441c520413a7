//! Promise: `firsthit compare` reads other programs' pictures as they mean them, or says in one
//! line what it does not read.

use std::fs;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image as File, ImageAttributes,
    IntegerBounds, Layer as Part, LayerAttributes, SmallVec, Vec2, WritableImage,
};
use firsthit::Image;
use firsthit::image::Raster;
use tempfile::TempDir;

use crate::helpers::{self, printed, program};

/// A part of an EXR of 2 × 2 pixels: its name, and its channels, each of one value.
type Channels<'a> = (&'a str, &'a [(&'a str, f32)]);

/// A part with its data window's upper left pixel there.
fn part((name, channels): Channels<'_>, corner: [i32; 2]) -> Part<AnyChannels<FlatSamples>> {
    let channels = channels
        .iter()
        .map(|&(name, value)| AnyChannel::new(name, FlatSamples::F32(vec![value; 4])));
    let channels: SmallVec<[_; 4]> = channels.collect();
    let attributes = match name {
        "" => LayerAttributes::default(),
        name => LayerAttributes::named(name),
    };
    let attributes = attributes.with_position(Vec2(corner[0], corner[1]));
    let encoding = Encoding::FAST_LOSSLESS;
    Part::new((2, 2), attributes, encoding, AnyChannels::sort(channels))
}

/// Writes an EXR of those parts.
fn write_exr(folder: &TempDir, name: &str, parts: &[Channels<'_>]) {
    let parts: SmallVec<[_; 2]> = parts
        .iter()
        .map(|&channels| part(channels, [0, 0]))
        .collect();
    write_parts(&folder.path().join(name), [0, 0], parts);
}

/// Writes an EXR whose display window has 2 × 2 pixels from `corner` on.
fn write_parts(
    path: &Path,
    corner: [i32; 2],
    parts: SmallVec<[Part<AnyChannels<FlatSamples>>; 2]>,
) {
    let window = IntegerBounds::new((corner[0], corner[1]), (2, 2));
    let file = File::from_layers(ImageAttributes::new(window), parts);
    file.write().to_file(path).unwrap();
}

/// Writes an EXR of the program's own, each pixel of this colour.
fn write_own(folder: &TempDir, name: &str, color: [f32; 3]) {
    let mut image = Image::new(2).unwrap();
    for pixel in image.samples_mut().chunks_exact_mut(3) {
        pixel.copy_from_slice(&color);
    }
    image.save(folder.path().join(name)).unwrap();
}

/// What the program printed; it must have found the pictures equal.
fn equal(folder: &TempDir, line: &str) -> String {
    let text = printed(folder, &format!("compare {line} --threshold 0"));
    assert!(text.contains("0 of 12 (0.000 %)"), "{line}: {text}");
    text
}

/// What the program said when it refused to compare.
fn refused(folder: &TempDir, line: &str) -> String {
    let output = program(folder, &format!("compare {line}"))
        .output()
        .unwrap();
    assert_eq!(output.stdout, b"", "{line}");
    helpers::failed(&output, 1, line)
}

const COLOR: [f32; 3] = [0.25, 0.5, 4.0];

#[test]
fn red_green_and_blue_are_found_by_each_usual_name() {
    let folder = tempfile::tempdir().unwrap();
    write_own(&folder, "own.exr", COLOR);
    let [red, green, blue] = COLOR;
    for names in [
        ["R", "G", "B"],
        ["r", "g", "b"],
        [".R", ".G", ".B"],
        ["View.Combined.R", "View.Combined.G", "View.Combined.B"],
        ["rgba.r", "rgba.g", "rgba.b"],
    ] {
        let [r, g, b] = names;
        // Others stand between them in the order of the alphabet.
        let channels = [
            (r, red),
            (g, green),
            (b, blue),
            ("D", 9.0),
            ("Z", 9.0),
            ("a.R", 9.0),
        ];
        write_exr(&folder, "other.exr", &[("", &channels)]);
        let text = equal(&folder, "other.exr own.exr");
        assert!(!text.contains("note"), "{text}");
    }
    let channels = [("R", red), ("G", green), ("b", blue), ("xB", 1.0)];
    write_exr(&folder, "other.exr", &[("", &channels)]);
    let said = refused(&folder, "other.exr own.exr");
    let expected = "other.exr: has no red, green and blue, but the channels G, R, b, xB: name";
    assert!(said.contains(expected), "{said}");
}

#[test]
fn of_several_layers_the_one_read_is_named_and_another_can_be_chosen() {
    let folder = tempfile::tempdir().unwrap();
    write_own(&folder, "own.exr", COLOR);
    let [red, green, blue] = COLOR;
    let layers = [
        ("beauty.R", red),
        ("beauty.G", green),
        ("beauty.B", blue),
        ("direct.R", 1.0),
        ("direct.G", green),
        ("direct.B", blue),
    ];
    write_exr(&folder, "layers.exr", &[("", &layers)]);
    let text = equal(&folder, "layers.exr own.exr");
    let note = "note               layers.exr: beauty is read of 2 layers: --layer chooses another: direct\n";
    assert!(text.ends_with(note), "{text}");
    equal(&folder, "own.exr layers.exr --layer beauty");
    let text = printed(&folder, "compare layers.exr own.exr --layer direct");
    assert!(text.contains("4 of 12"), "{text}");
    let said = refused(&folder, "own.exr layers.exr --layer depth");
    let expected = "firsthit: layers.exr: has no layer depth: choose one of beauty, direct\n";
    assert_eq!(said, expected);
    let said = refused(&folder, "own.exr own.exr --layer beauty");
    assert!(said.contains("neither has a layer beauty"), "{said}");
}

#[test]
fn of_several_parts_that_of_plain_channels_is_read() {
    let folder = tempfile::tempdir().unwrap();
    write_own(&folder, "own.exr", COLOR);
    let [red, green, blue] = COLOR;
    let plain: Channels<'_> = ("beauty", &[("R", red), ("G", green), ("B", blue)]);
    let glossy: Channels<'_> = (
        "light",
        &[("glossy.R", 1.0), ("glossy.G", 2.0), ("glossy.B", 3.0)],
    );
    write_exr(
        &folder,
        "parts.exr",
        &[("depth", &[("Z", 1.0)]), glossy, plain],
    );
    let text = equal(&folder, "parts.exr own.exr");
    let note = "parts.exr: beauty is read of 2 layers: --layer chooses another: glossy\n";
    assert!(text.ends_with(note), "{text}");
    write_own(&folder, "glossy.exr", [1.0, 2.0, 3.0]);
    for name in ["glossy", "light"] {
        equal(&folder, &format!("parts.exr glossy.exr --layer {name}"));
    }
}

/// The table of the first part names the second one's block, of a compression that is not read.
#[test]
fn a_part_is_not_read_out_of_another_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("crafted.exr");
    let color = [("R", 1.0), ("G", 1.0), ("B", 1.0)];
    let mut parts = ["one", "two"].map(|name| part((name, &color), [0, 0]));
    parts[1].encoding.compression = Compression::B44;
    write_parts(&path, [0, 0], parts.into_iter().collect());
    let mut file = fs::read(&path).unwrap();
    let number = |file: &[u8], at: usize| u64::from_le_bytes(file[at..at + 8].try_into().unwrap());
    // The tables, of one place each, end where the first block begins.
    let is_table = |&at: &usize| number(&file, at) == at as u64 + 16;
    let table = (0..file.len() - 16).find(is_table).unwrap();
    file.copy_within(table + 8..table + 16, table);
    fs::write(&path, file).unwrap();
    let said = refused(&folder, "crafted.exr crafted.exr");
    let expected = "its table of blocks names one of another picture";
    assert!(said.contains(expected), "{said}");
}

#[test]
fn what_is_not_opaque_is_refused_unless_its_alpha_is_to_be_ignored() {
    let folder = tempfile::tempdir().unwrap();
    write_own(&folder, "own.exr", COLOR);
    let [red, green, blue] = COLOR;
    let color = [("R", red), ("G", green), ("B", blue)];
    for (alpha, opaque) in [
        (("A", 1.0), true),
        (("A", 0.5), false),
        (("A", 1.0_f32.next_down()), false),
        (("A", f32::NAN), false),
        (("other.A", 0.5), true),
    ] {
        let channels = [&color[..], &[alpha]].concat();
        write_exr(&folder, "glass.exr", &[("", &channels)]);
        if opaque {
            equal(&folder, "glass.exr own.exr");
            continue;
        }
        let said = refused(&folder, "glass.exr own.exr");
        let expected = "firsthit: glass.exr: some pixels are transparent: give an opaque picture, or ignore its alpha (--ignore-alpha)\n";
        assert_eq!(said, expected);
        equal(&folder, "glass.exr own.exr --ignore-alpha");
    }
    let layer = ["r", "g", "b", "a"].map(|letter| format!("rgba.{letter}"));
    let [r, g, b, a] = &layer;
    let layer: [(&str, f32); 4] = [(r, red), (g, green), (b, blue), (a, 0.0)];
    write_exr(&folder, "glass.exr", &[("", &layer)]);
    refused(&folder, "own.exr glass.exr");

    let image = Raster::load(folder.path().join("own.exr")).unwrap();
    image.save(folder.path().join("own.png")).unwrap();
    let path = folder.path().join("glass.png");
    let mut encoder = png::Encoder::new(fs::File::create(path).unwrap(), 2, 2);
    encoder.set_color(png::ColorType::Rgba);
    let mut writer = encoder.write_header().unwrap();
    writer
        .write_image_data(&[64, 128, 255, 3].repeat(4))
        .unwrap();
    writer.finish().unwrap();
    refused(&folder, "own.png glass.png");
    equal(&folder, "own.png glass.png --ignore-alpha");
}

#[test]
fn pictures_of_other_windows_are_not_compared() {
    let folder = tempfile::tempdir().unwrap();
    let channels = [("R", 0.25), ("G", 0.5), ("B", 4.0)];
    write_own(&folder, "own.exr", COLOR);
    for (name, corner, shown) in [
        ("left.exr", [-3, 0], [0, 0]),
        ("down.exr", [0, 1], [0, 1]),
        ("again.exr", [0, 1], [0, 1]),
    ] {
        let parts = [part(("", &channels), corner)].into_iter().collect();
        write_parts(&folder.path().join(name), shown, parts);
    }
    for (line, windows) in [
        (
            "own.exr left.exr",
            "(0, 0) to (1, 1) and (-3, 0) to (-2, 1)",
        ),
        ("down.exr own.exr", "(0, 1) to (1, 2) and (0, 0) to (1, 1)"),
        (
            "left.exr down.exr",
            "(-3, 0) to (-2, 1) and (0, 1) to (1, 2)",
        ),
    ] {
        for overlap in ["", " --overlap"] {
            let said = refused(&folder, &format!("{line}{overlap}"));
            assert!(said.contains(windows), "{said}");
        }
    }
    equal(&folder, "down.exr again.exr");
    equal(&folder, "own.exr own.exr");
}

/// Writes an EXR of a scene of 6 × 4 pixels that has those of a data window, given by its upper
/// left pixel and its size, and that shows all of them. The colour of each is that of its place.
fn write_crop(folder: &TempDir, name: &str, corner: [i32; 2], size: [usize; 2]) {
    let place = |i: usize| {
        let column = corner[0] + (i % size[0]) as i32;
        let row = corner[1] + (i / size[0]) as i32;
        (100 + 10 * row + column) as f32
    };
    let samples = (0..size[0] * size[1]).map(place).collect::<Vec<_>>();
    let channels = ["R", "G", "B"].map(|name| {
        let samples = samples.clone();
        AnyChannel::new(name, FlatSamples::F32(samples))
    });
    let attributes = LayerAttributes::default().with_position(Vec2(corner[0], corner[1]));
    let channels = AnyChannels::sort(channels.into_iter().collect());
    let size = (size[0], size[1]);
    let part = Part::new(size, attributes, Encoding::FAST_LOSSLESS, channels);
    let shown = IntegerBounds::from_dimensions((6, 4));
    let file = File::from_layers(ImageAttributes::new(shown), vec![part]);
    file.write().to_file(folder.path().join(name)).unwrap();
}

#[test]
fn a_pixel_outside_of_a_data_window_is_black_or_left_out() {
    let folder = tempfile::tempdir().unwrap();
    write_crop(&folder, "whole.exr", [0, 0], [6, 4]);
    write_crop(&folder, "crop.exr", [2, 1], [3, 2]);
    let text = printed(&folder, "compare whole.exr crop.exr");
    assert!(text.contains("6 × 4 pixels\n"), "{text}");
    // 18 pixels are not in the crop.
    assert!(text.contains("54 of 72 (75.000 %)"), "{text}");
    let worst = "column 5, row 3 from the top, 0 from the bottom: [135.0, 135.0, 135.0] and [0.0, 0.0, 0.0]";
    assert!(text.contains(worst), "{text}");
    let note = "note               crop.exr holds the pixels (2, 1) to (4, 2): of (0, 0) to (5, 3) those it lacks count as black: --overlap leaves them out\n";
    assert!(text.ends_with(note), "{text}");
    assert_eq!(text.matches("note").count(), 1);
    helpers::failed(
        &program(&folder, "compare crop.exr whole.exr --threshold 0")
            .output()
            .unwrap(),
        1,
        "crop",
    );

    let line = "compare whole.exr crop.exr --overlap --threshold 0 --json c.json";
    let text = printed(&folder, line);
    assert!(text.contains("3 × 2 pixels\n"), "{text}");
    assert!(text.contains("0 of 18 (0.000 %)"), "{text}");
    let note = "note               whole.exr holds the pixels (0, 0) to (5, 3): only (2, 1) to (4, 2) are compared\n";
    assert!(text.ends_with(note), "{text}");
    let json = fs::read_to_string(folder.path().join("c.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let window = serde_json::json!({"left": 2, "top": 1, "width": 3, "height": 2});
    let whole = serde_json::json!({"left": 0, "top": 0, "width": 6, "height": 4});
    for (name, expected) in [
        ("/window", &window),
        ("/a/data_window", &whole),
        ("/b/data_window", &window),
    ] {
        assert_eq!(json.pointer(name), Some(expected), "{name} of {json}");
    }
}

#[test]
fn a_pixel_outside_of_the_display_window_is_left_out() {
    let folder = tempfile::tempdir().unwrap();
    write_crop(&folder, "whole.exr", [0, 0], [6, 4]);
    write_crop(&folder, "beyond.exr", [-1, -2], [9, 8]);
    for overlap in ["", " --overlap"] {
        let line = format!("compare beyond.exr whole.exr --threshold 0{overlap}");
        let text = printed(&folder, &line);
        assert!(text.contains("0 of 72 (0.000 %)"), "{text}");
        let note = "note               beyond.exr holds the pixels (-1, -2) to (7, 5): only (0, 0) to (5, 3) are compared\n";
        assert!(text.ends_with(note), "{text}");
    }
    write_crop(&folder, "left.exr", [0, 0], [2, 4]);
    write_crop(&folder, "right.exr", [2, 0], [4, 4]);
    let said = refused(&folder, "left.exr right.exr --overlap");
    let windows = "left.exr and right.exr: show pixels (0, 0) to (1, 3) and (2, 0) to (5, 3)";
    assert!(said.contains(windows), "{said}");
    let text = printed(&folder, "compare left.exr right.exr");
    assert!(text.contains("72 of 72 (100.000 %)"), "{text}");
}
