//! Promise: the README shows what the program does: its pictures are the program's, its keys are
//! the viewer's.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use firsthit::camera::frame_angle;
use firsthit::image::display_byte;
use firsthit::{Kernel, Scene, Stage, Tracer, viewer};

use crate::helpers::{hard_scene, hard_scenes, trace};

/// A picture under tests/images: its name, the scene's name in tests/scenes or none for the
/// built-in scene, N, stage, frame and kernel.
type Picture = (&'static str, Option<&'static str>, u32, Stage, u64, Kernel);

const PICTURES: [Picture; 10] = [
    ("figure-2-1", None, 500, Stage::Image, 0, Kernel::Exact),
    (
        "figure-3-1-spheres",
        None,
        500,
        Stage::Spheres,
        0,
        Kernel::Exact,
    ),
    (
        "figure-3-1-tetrahedron",
        None,
        500,
        Stage::Tetrahedron,
        0,
        Kernel::Exact,
    ),
    ("figure-4-3", None, 500, Stage::Shading, 0, Kernel::Exact),
    ("section-5-1", None, 500, Stage::Shadow, 0, Kernel::Exact),
    ("figure-6-1", None, 500, Stage::Reflection, 0, Kernel::Exact),
    ("figure-6-2", None, 500, Stage::Reflection, 7, Kernel::Exact),
    (
        "figure-6-2-listing",
        None,
        500,
        Stage::Reflection,
        7,
        Kernel::Listing,
    ),
    (
        "nested-spheres",
        Some("nested_spheres"),
        250,
        Stage::Spheres,
        1,
        Kernel::Exact,
    ),
    (
        "nested-spheres-fast",
        Some("nested_spheres"),
        250,
        Stage::Spheres,
        1,
        Kernel::Fast,
    ),
];

fn file(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

#[test]
fn its_pictures_are_traced_pictures() {
    for (name, scene, size, stage, frame, kernel) in PICTURES {
        let scene = scene.map_or_else(Scene::builtin, hard_scene);
        let png = BufReader::new(File::open(file(&format!("tests/images/{name}.png"))).unwrap());
        let mut reader = png::Decoder::new(png).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();

        let image = trace(kernel, &scene, stage, frame_angle(frame), size);
        let rows = image.samples().chunks(3 * size as usize).rev();
        let expected: Vec<u8> = rows.flatten().copied().map(display_byte).collect();
        assert!(bytes == expected, "{name}");
    }
}

#[test]
fn it_names_every_picture_and_every_key() {
    let readme = fs::read_to_string(file("README.md")).unwrap();
    for (name, ..) in PICTURES {
        assert!(
            readme.contains(&format!("(tests/images/{name}.png)")),
            "{name}"
        );
    }
    // Taken by the tests of the viewer.
    for name in ["viewer-pixel", "viewer-errors"] {
        let path = format!("tests/images/{name}.png");
        assert!(readme.contains(&format!("({path})")), "{name}");
        let png = BufReader::new(File::open(file(&path)).unwrap());
        png::Decoder::new(png).read_info().unwrap();
    }
    for line in viewer::key_table().lines() {
        let (keys, does) = line.split_once("  ").unwrap();
        let row = format!("| {} | {} |", keys, does.trim());
        assert!(readme.contains(&row), "{row}");
    }
}

#[test]
fn its_worked_pixel_is_what_explain_says() {
    let tracer = Tracer::new(Kernel::Exact, 1).unwrap();
    let text = tracer
        .explain(&Scene::builtin(), Stage::Reflection, 0.0, 500, (255, 202))
        .unwrap();
    let readme = fs::read_to_string(file("README.md")).unwrap();
    let indented: String = text.lines().map(|line| format!("    {line}\n")).collect();
    assert!(readme.contains(&indented), "{indented}");
}

#[test]
fn its_plot_is_drawn_by_this_program() {
    let text = fs::read_to_string(file("tests/images/error-against-time.svg")).unwrap();
    let plot = roxmltree::Document::parse(&text).unwrap();
    let texts: Vec<&str> = plot
        .descendants()
        .filter_map(|node| node.text())
        .map(str::trim)
        .collect();
    let hard = format!("{} hard scenes", hard_scenes().len());
    for label in [
        "Built-in scene",
        &hard,
        "exact",
        "fast",
        "double",
        "listing",
    ] {
        assert!(texts.contains(&label), "{label}");
    }
    let readme = fs::read_to_string(file("README.md")).unwrap();
    assert!(readme.contains("(tests/images/error-against-time.svg)"));
}
