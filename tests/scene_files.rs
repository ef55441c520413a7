//! Promise: a scene file is read exactly, and what is refused is refused with its line and field,
//! in one line.

use firsthit::Scene;
use firsthit::scene::{BUILTIN_TOML, Light, Material, Sphere, Surface, Tetrahedron};
use glam::DVec3;

const BALL: &str = "[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = 0.5\ncolor = [1.0, 0.5, 0.0]\n";
const TETRAHEDRON: &str = "[[tetrahedron]]\nvertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\n\
                           color = [1.0, 0.5, 0.0]\n";
const SURFACE: &str = "[surface]\nheight = -0.5\nhalf_width = 1.0\n";

/// Every refusal: the text, the line, the field, and a part of what is said.
#[rustfmt::skip]
fn refusals() -> Vec<(String, usize, Option<&'static str>, &'static str)> {
    let ball = |from: &str, to: &str| BALL.replace(from, to);
    let corner = |from: &str, to: &str| TETRAHEDRON.replace(from, to);
    let light = |line: &str| format!("[light]\n{line}\n");
    let material = |line: &str| format!("\n[material]\n{line}\n");
    vec![
        // Not TOML, or not a scene's TOML.
        ("[light".into(), 1, None, ""),
        ("background = [0.8, 0.8,\n\n&]".into(), 3, None, ""),
        ("a = 1".into(), 1, Some("a"), "unknown field `a`"),
        (format!("{BALL}shine = 3.0"), 5, Some("sphere[0].shine"), "unknown field `shine`"),
        (light("colour = 1.0"), 2, Some("light.colour"), "unknown field `colour`"),
        (format!("{BALL}radius = 0.5"), 5, Some("radius"), "duplicate key"),
        (format!("{BALL}\"a b\" = 1\n\"a b\" = 2"), 6, Some("\"a b\""), "duplicate key"),
        // Wrong types and lengths.
        (ball("0.5\n", "\"big\"\n"), 3, Some("sphere[0].radius"), "invalid type: string"),
        (ball("[1.0, 0.5, 0.0]", "[1.0, 0.5]"), 4, Some("sphere[0].color"), "2 values where 3 are needed"),
        (ball("[1.0, 0.5, 0.0]", "[1.0, 0.5, 0.0, 1.0]"), 4, Some("sphere[0].color"), "4 values where 3 are needed"),
        (corner(", [0.0, 0.0, 1.0]]", "]"), 2, Some("tetrahedron[0].vertices"), "3 values where 4 are needed"),
        (light("direction = [1.0, 2.0, 3.0, 4.0]"), 2, Some("light.direction"), "4 values where 3 are needed"),
        // Geometry that is left out.
        (ball("radius = 0.5\n", ""), 1, Some("sphere[0]"), "missing field `radius`"),
        (ball("color = [1.0, 0.5, 0.0]\n", ""), 1, Some("sphere[0]"), "missing field `color`"),
        ("[surface]\nheight = 0.0".into(), 1, Some("surface"), "missing field `half_width`"),
        ("[surface]\nhalf_width = 1.0".into(), 1, Some("surface"), "missing field `height`"),
        (format!("{BALL}[[tetrahedron]]\ncolor = [1.0, 0.5, 0.0]"), 5, Some("tetrahedron[0]"), "missing field `vertices`"),
        // Numbers that are none, or out of range.
        (ball("center = [0.0, 0.0", "center = [0.0, nan"), 2, Some("sphere[0].center[1]"), "out of range"),
        (ball("center = [0.0, 0.0", "center = [0.0, -inf"), 2, Some("sphere[0].center[1]"), "out of range"),
        (ball("center = [0.0", "center = [1000001.0"), 2, Some("sphere[0].center[0]"), "out of range"),
        (ball("center = [0.0", "center = [-9.9e-31"), 2, Some("sphere[0].center[0]"), "out of range"),
        (corner("1.0, 0.0, 0.0]", "1.0, 0.0, 1e7]"), 2, Some("tetrahedron[0].vertices[1][2]"), "out of range"),
        (ball("radius = 0.5", "radius = 0.0"), 3, Some("sphere[0].radius"), "out of range"),
        (ball("radius = 0.5", "radius = -0.5"), 3, Some("sphere[0].radius"), "out of range"),
        (ball("radius = 0.5", "radius = 1e-31"), 3, Some("sphere[0].radius"), "out of range"),
        (ball("radius = 0.5", "radius = nan"), 3, Some("sphere[0].radius"), "out of range"),
        (ball("radius = 0.5", "radius = 2e6"), 3, Some("sphere[0].radius"), "out of range"),
        (SURFACE.replace("1.0", "0.0"), 3, Some("surface.half_width"), "out of range"),
        (SURFACE.replace("-0.5", "1e-40"), 2, Some("surface.height"), "out of range"),
        (format!("{SURFACE}reflectance = -0.5"), 4, Some("surface.reflectance"), "out of range"),
        (format!("{SURFACE}color = [0.5, 1e-31, 0.0]"), 4, Some("surface.color[1]"), "out of range"),
        (ball("[1.0, 0.5", "[1.0, -0.5"), 4, Some("sphere[0].color[1]"), "out of range"),
        ("\n\nbackground = [0.8, 0.8, inf]".into(), 3, Some("background[2]"), "out of range"),
        (light("intensity = [1.0, 1.0, 1e7]"), 2, Some("light.intensity[2]"), "out of range"),
        (light("ambient_intensity = [1.0, nan, 1.0]"), 2, Some("light.ambient_intensity[1]"), "out of range"),
        (material("ambient = [-1.0, 0.0, 0.0]"), 3, Some("material.ambient[0]"), "out of range"),
        (material("diffuse = [-1.0, 0.0, 0.0]"), 3, Some("material.diffuse[0]"), "out of range"),
        (material("specular = [-1.0, 0.0, 0.0]"), 3, Some("material.specular[0]"), "out of range"),
        // The light's direction.
        (light("direction = [0.0, -0.0, 0.0]"), 2, Some("light.direction"), "goes nowhere"),
        (light("direction = [0.0, nan, 0.0]"), 2, Some("light.direction"), "finite"),
        (light("direction = [0.0, inf, 0.0]"), 2, Some("light.direction"), "finite"),
        (light("direction = [1.0, 1e-31, 0.0]"), 2, Some("light.direction"), "factor 1e30"),
        (light("direction = [5e200, 1.0, 0.0]"), 2, Some("light.direction"), "factor 1e30"),
        // The exponent.
        (material("exponent = 0"), 3, Some("material.exponent"), "whole number"),
        (material("exponent = -1"), 3, Some("material.exponent"), "whole number"),
        (material("exponent = 1000001"), 3, Some("material.exponent"), "whole number"),
        (material("exponent = 4294967297"), 3, Some("material.exponent"), "whole number"),
        (material("exponent = 1000.0"), 3, Some("material.exponent"), "whole number"),
        (material("exponent = \"9\""), 3, Some("material.exponent"), "whole number"),
        // Solids.
        (corner("[0.0, 0.0, 1.0]]", "[1.0, 1.0, 0.0]]"), 2, Some("tetrahedron[0].vertices"), "flat"),
        (corner("[0.0, 0.0, 1.0]]", "[0.0, 1.0, 0.0]]"), 2, Some("tetrahedron[0].vertices"), "flat"),
        (BALL.repeat(4096) + TETRAHEDRON, 4096 * 4 + 1, Some("tetrahedron[0]"), "4097 solids"),
        (BALL.repeat(4098), 4096 * 4 + 1, Some("sphere[4096]"), "4098 solids"),
    ]
}

#[test]
fn a_refusal_is_short_however_long_a_key_is() {
    let key = "k".repeat(300_000);
    for (text, part) in [
        (format!("{key} = 1"), "k…k"),
        (format!("{key} = 1"), "`, expected one of `background`"),
        (format!("{key} = 1\n{key} = 2"), "duplicate key"),
        (
            format!("background = \"{key}\""),
            "invalid type: string \"k",
        ),
        (format!("light.{key} = 1"), "light.k"),
    ] {
        let said = Scene::from_toml(&text).unwrap_err().to_string();
        assert!(said.contains(part), "{part}: {} characters", said.len());
        assert!(said.chars().count() < 600, "{} characters", said.len());
    }
}

#[test]
fn what_is_refused_and_how() {
    for (text, line, field, part) in refusals() {
        let shown: String = text.chars().take(200).collect();
        let error = Scene::from_toml(&text).expect_err(&shown);
        assert_eq!(
            (error.line, error.field.as_deref()),
            (Some(line), field),
            "{shown}\n{error}"
        );
        assert!(error.problem.contains(part), "{shown}\n{error}");
        let said = error.to_string();
        assert!(
            !said.contains('\n') && said.starts_with(&format!("line {line}: ")),
            "{said}"
        );
    }
}

#[test]
fn what_is_admitted() {
    for text in [
        "",
        &ball_with("center = [0.0, 0.0, 0.0]", "center = [1e-30, -1e6, -0.0]"),
        &ball_with("radius = 0.5", "radius = 1e-30"),
        &ball_with("radius = 0.5", "radius = 1e6"),
        &ball_with("radius = 0.5", "radius = 1"),
        &BALL.repeat(4096),
        "[light]\ndirection = [5e200, 0.0, 5e200]",
        "[light]\ndirection = [5e-201, 0.0, -5e-231]",
        "[light]\ndirection = [0, 5e-324, 0]",
        "[light]\ndirection = [1e30, 1.0, 0.0]",
        "[material]\nexponent = 1",
        "[material]\nexponent = 1_000_000",
        "background = [0.0, 1e6, 1e-30]",
    ] {
        let shown: String = text.chars().take(200).collect();
        assert!(
            Scene::from_toml(text).is_ok(),
            "{shown}: {:?}",
            Scene::from_toml(text)
        );
    }
}

fn ball_with(from: &str, to: &str) -> String {
    BALL.replace(from, to)
}

#[test]
fn what_is_left_out_is_as_in_the_builtin_scene() {
    let builtin = Scene::builtin();
    let bare = Scene::from_toml(SURFACE).unwrap();
    assert_eq!(
        (bare.light(), bare.material()),
        (builtin.light(), builtin.material())
    );
    assert_eq!(bare.background(), builtin.background());
    let (surface, standard) = (bare.surface().unwrap(), builtin.surface().unwrap());
    assert_eq!(
        (surface.color, surface.reflectance),
        (standard.color, standard.reflectance)
    );
    assert_eq!((surface.height, surface.half_width), (-0.5, 1.0));
    let partly =
        Scene::from_toml("[light]\nintensity = [2.0, 3.0, 4.0]\n[material]\nexponent = 9").unwrap();
    assert_eq!(partly.light().intensity, DVec3::new(2.0, 3.0, 4.0));
    assert_eq!(partly.light().direction, builtin.light().direction);
    assert_eq!(
        (partly.material().exponent, partly.material().diffuse),
        (9, builtin.material().diffuse)
    );
    assert!(partly.surface().is_none());
}

#[test]
fn the_builtin_text_is_the_builtin_scene() {
    assert_eq!(Scene::from_toml(BUILTIN_TOML).unwrap(), Scene::builtin());
    let sphere = Scene::builtin().spheres()[1];
    assert_eq!(
        (sphere.center, sphere.radius),
        (DVec3::new(-0.28125, -0.3125, 0.40625), 0.1875)
    );
}

#[test]
fn numbers_are_read_to_the_last_bit() {
    let text = ball_with(
        "radius = 0.5",
        "radius = 0.1000000000000000055511151231257827021181583404541015625",
    );
    assert_eq!(
        Scene::from_toml(&text).unwrap().spheres()[0]
            .radius
            .to_bits(),
        0.1f64.to_bits()
    );
    let text = ball_with("radius = 0.5", "radius = 0.10000000000000002");
    assert_eq!(
        Scene::from_toml(&text).unwrap().spheres()[0].radius,
        0.1f64.next_up()
    );
}

/// A scene in code, made of what another one has.
fn rebuilt(scene: &Scene) -> firsthit::scene::SceneBuilder {
    let mut builder = Scene::builder()
        .background(scene.background())
        .light(*scene.light())
        .material(*scene.material());
    if let Some(surface) = scene.surface() {
        builder = builder.surface(*surface);
    }
    for sphere in scene.spheres() {
        builder = builder.sphere(*sphere);
    }
    for tetrahedron in scene.tetrahedra() {
        builder = builder.tetrahedron(*tetrahedron);
    }
    builder
}

#[test]
fn a_scene_made_in_code_and_one_written_as_toml_are_the_scene_that_they_were_made_of() {
    let mut scenes = vec![Scene::builtin(), Scene::from_toml("").unwrap()];
    for file in std::fs::read_dir("tests/scenes").unwrap() {
        scenes.push(Scene::from_file(file.unwrap().path()).unwrap());
    }
    assert!(scenes.len() > 30);
    for scene in scenes {
        assert_eq!(rebuilt(&scene).build().unwrap(), scene);
        let text = scene.to_toml();
        assert_eq!(Scene::from_toml(&text).unwrap(), scene, "{text}");
        // Whoever reads it needs to know of no default.
        for field in ["background", "ambient_intensity", "exponent"] {
            assert!(text.contains(field), "{text}");
        }
    }
}

#[test]
fn a_scene_made_in_code_is_refused_as_its_text_would_be() {
    let scene = Scene::builtin();
    let (sphere, tetrahedron) = (scene.spheres()[0], scene.tetrahedra()[0]);
    let (surface, light, material) = (*scene.surface().unwrap(), *scene.light(), *scene.material());
    let nan = DVec3::new(0.0, f64::NAN, 0.0);
    let build = Scene::builder;
    let mut flat = tetrahedron.vertices;
    flat[3] = flat[0];
    let cases = [
        (build().background(nan), "background[1]"),
        (
            build().sphere(sphere).sphere(Sphere {
                radius: -1.0,
                ..sphere
            }),
            "sphere[1].radius",
        ),
        (
            build().sphere(Sphere {
                center: nan,
                ..sphere
            }),
            "sphere[0].center[1]",
        ),
        (
            build().sphere(Sphere {
                color: -DVec3::X,
                ..sphere
            }),
            "sphere[0].color[0]",
        ),
        (
            build().tetrahedron(Tetrahedron {
                vertices: flat,
                ..tetrahedron
            }),
            "tetrahedron[0].vertices",
        ),
        (
            build().tetrahedron(Tetrahedron {
                vertices: [nan; 4],
                ..tetrahedron
            }),
            "tetrahedron[0].vertices[0][1]",
        ),
        (
            build().tetrahedron(Tetrahedron {
                color: nan,
                ..tetrahedron
            }),
            "tetrahedron[0].color[1]",
        ),
        (
            build().surface(Surface {
                half_width: 0.0,
                ..surface
            }),
            "surface.half_width",
        ),
        (
            build().surface(Surface {
                height: 1e-40,
                ..surface
            }),
            "surface.height",
        ),
        (
            build().surface(Surface {
                reflectance: f64::INFINITY,
                ..surface
            }),
            "surface.reflectance",
        ),
        (
            build().surface(Surface {
                color: nan,
                ..surface
            }),
            "surface.color[1]",
        ),
        (
            build().light(Light {
                direction: DVec3::ZERO,
                ..light
            }),
            "light.direction",
        ),
        (
            build().light(Light {
                direction: nan,
                ..light
            }),
            "light.direction",
        ),
        (
            build().light(Light {
                intensity: nan,
                ..light
            }),
            "light.intensity[1]",
        ),
        (
            build().light(Light {
                ambient_intensity: nan,
                ..light
            }),
            "light.ambient_intensity[1]",
        ),
        (
            build().material(Material {
                exponent: 0,
                ..material
            }),
            "material.exponent",
        ),
        (
            build().material(Material {
                exponent: 1_000_001,
                ..material
            }),
            "material.exponent",
        ),
        (
            build().material(Material {
                specular: nan,
                ..material
            }),
            "material.specular[1]",
        ),
    ];
    for (builder, field) in cases {
        let error = builder.build().unwrap_err();
        assert_eq!(
            (error.line, error.field.as_deref()),
            (None, Some(field)),
            "{error}"
        );
        assert!(
            error.to_string().starts_with(&format!("{field}: ")),
            "{error}"
        );
    }
    let crowd = (0..4097).fold(build(), |builder, _| builder.sphere(sphere));
    assert_eq!(
        crowd.build().unwrap_err().field.as_deref(),
        Some("sphere[4096]")
    );
}
