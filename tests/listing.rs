//! Promise: `listing` is the document's listings as printed. Each of their slips shows, just there
//! and just as the equation predicts, and nothing else differs from the truth.

use firsthit::camera::{ROUND, frame_angle, sin_cos};
use firsthit::tracer::{Decision, Seen, TraceError};
use firsthit::{Image, Kernel, Scene, Stage, Tracer};
use glam::{DVec2, DVec3, dvec2, dvec3};

use crate::helpers::trace_with_decisions;

const SIZE: u32 = 500;

/// A pixel: column, row, what was decided, its samples.
#[derive(Clone, Copy)]
struct Pixel {
    column: u32,
    row: u32,
    decision: Decision,
    samples: [f32; 3],
}

fn trace_pixels(kernel: Kernel, scene: &Scene, stage: Stage, alpha: f64, size: u32) -> Vec<Pixel> {
    let (image, decisions) = trace_with_decisions(kernel, scene, stage, alpha, size);
    (0..size * size)
        .zip(decisions)
        .map(|(index, decision)| {
            let (column, row) = (index % size, index / size);
            Pixel {
                column,
                row,
                decision,
                samples: image.pixel(column, row).unwrap(),
            }
        })
        .collect()
}

/// Each pixel by `exact` and by `listing`.
fn both(scene: &Scene, stage: Stage, alpha: f64, size: u32) -> Vec<(Pixel, Pixel)> {
    let exact = trace_pixels(Kernel::Exact, scene, stage, alpha, size);
    exact
        .into_iter()
        .zip(trace_pixels(Kernel::Listing, scene, stage, alpha, size))
        .collect()
}

fn count<T>(items: &[T], holds: impl Fn(&T) -> bool) -> usize {
    items.iter().filter(|item| holds(item)).count()
}

fn solid(decision: Decision) -> Option<Seen> {
    match decision {
        Decision::Solid(seen) => Some(seen),
        _ => None,
    }
}

fn mirrored(decision: Decision) -> Option<Seen> {
    match decision {
        Decision::Mirrored(seen) => Some(seen),
        _ => None,
    }
}

fn close(a: [f32; 3], b: [f32; 3]) -> bool {
    a.into_iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6)
}

/// A scene of the document's shape: these spheres (centre, radius), this tetrahedron, and TOML that
/// goes before them.
fn scene(before: &str, spheres: [([f64; 3], f64); 2], vertices: [[f64; 3]; 4]) -> Scene {
    let mut text = format!("{before}\nsurface = {{ height = -0.5, half_width = 0.6875 }}\n");
    for (center, radius) in spheres {
        text += &format!(
            "[[sphere]]\ncenter = {center:?}\nradius = {radius:?}\ncolor = [1.0, 1.0, 1.0]\n"
        );
    }
    text += &format!("[[tetrahedron]]\nvertices = {vertices:?}\ncolor = [1.0, 1.0, 1.0]\n");
    Scene::from_toml(&text).unwrap()
}

/// Spheres and a tetrahedron that no ray of the picture meets.
const AWAY: [f64; 3] = [0.0, 90.0, 0.0];
const TETRAHEDRON_AWAY: [[f64; 3]; 4] = [
    [0.0, 90.0, 0.0],
    [1.0, 90.0, 0.0],
    [0.0, 91.0, 0.0],
    [0.0, 90.0, 1.0],
];

/// The pixel's place e and the unit vector d along which the eye looks, at angle α.
fn eye_ray(pixel: &Pixel, alpha: f64, size: u32) -> (DVec3, DVec3) {
    let half = f64::from(size) / 2.0;
    let (u, v) = (
        f64::from(pixel.column) / half - 1.0,
        f64::from(pixel.row) / half - 1.0,
    );
    let (sin, cos) = sin_cos(alpha);
    (
        dvec3(sin + u * cos, v, cos - u * sin),
        -dvec3(sin, 0.3, cos).normalize(),
    )
}

#[test]
fn stage_1_is_exact() {
    for size in [SIZE, 501, 7, 2, 1] {
        for (exact, listing) in both(&Scene::builtin(), Stage::Image, 0.3, size) {
            assert_eq!(exact.decision, listing.decision);
            assert_eq!(
                exact.samples.map(f32::to_bits),
                listing.samples.map(f32::to_bits)
            );
        }
    }
}

#[test]
fn spheres_are_seen_as_they_are() {
    for frame in 0..ROUND {
        for (exact, listing) in both(&Scene::builtin(), Stage::Spheres, frame_angle(frame), 100) {
            assert_eq!(
                (exact.decision, exact.samples),
                (listing.decision, listing.samples)
            );
        }
    }
}

/// Code 3-1 takes the root of smaller magnitude: behind the screen that is the last point along the
/// ray. Where v = l, only the first is lit.
#[test]
fn a_sphere_behind_the_screen_shows_its_far_side() {
    let scene = scene(
        "light = { direction = [0.0, 0.3, 1.0] }\nmaterial = { specular = [0.0, 0.0, 0.0] }",
        [([-0.5, 0.0, 0.0], 0.25), ([0.5, 0.5, 2.0], 0.25)],
        TETRAHEDRON_AWAY,
    );
    let listing = trace_pixels(Kernel::Listing, &scene, Stage::Shading, 0.0, SIZE);
    for (number, lit) in [(0, true), (1, false)] {
        let sphere: Vec<_> = listing
            .iter()
            .filter(|pixel| solid(pixel.decision).is_some_and(|seen| seen.solid == number))
            .collect();
        assert!(sphere.len() > 10_000);
        for pixel in sphere {
            assert_eq!(pixel.samples[0] > 0.3, lit);
        }
    }
}

/// Nothing asks for t > 0: a sphere under the surface casts a shadow up onto it and is mirrored in
/// it. The only light that such a shadow could come from is below.
#[test]
fn what_lies_behind_a_ray_is_met() {
    let below = [0.0, -0.75, 0.5];
    for spheres in [
        [(below, 0.1875), (AWAY, 0.25)],
        [(AWAY, 0.25), (below, 0.1875)],
    ] {
        let scene = scene("", spheres, TETRAHEDRON_AWAY);
        let pixels = both(&scene, Stage::Reflection, 0.0, SIZE);
        assert_eq!(
            count(&pixels, |(exact, _)| {
                exact.decision == Decision::SurfaceInShadow || mirrored(exact.decision).is_some()
            }),
            0
        );
        assert!(
            count(&pixels, |(_, listing)| listing.decision
                == Decision::SurfaceInShadow)
                > 1000
        );
        assert!(count(&pixels, |(_, listing)| mirrored(listing.decision).is_some()) > 1000);
    }
    let below = [
        [0.0, -1.0, 0.0],
        [0.0, -0.75, 0.0],
        [0.25, -0.75, 0.0],
        [0.0, -0.75, 0.25],
    ];
    let scene = scene("", [(AWAY, 0.25); 2], below);
    let pixels = both(&scene, Stage::Shadow, 0.0, SIZE);
    assert!(
        count(&pixels, |(exact, listing)| {
            exact.decision == Decision::Surface && listing.decision == Decision::SurfaceInShadow
        }) > 100
    );
}

/// Code 3-2 is strict at edges: the line through (298, 211) meets the edge between the faces 1 and
/// 2, and goes on to the face behind them.
#[test]
fn a_line_through_a_shared_edge_hits_neither_face() {
    let size = 512;
    let pixels = both(&Scene::builtin(), Stage::Tetrahedron, 0.0, size);
    let faces = |column: u32| {
        let (exact, listing) = &pixels[(211 * size + column) as usize];
        [exact, listing].map(|pixel| solid(pixel.decision).and_then(|seen| seen.face))
    };
    assert_eq!(faces(297), [Some(1), Some(1)]);
    assert_eq!(faces(298), [Some(1), Some(0)]);
    assert_eq!(faces(299), [Some(2), Some(2)]);
}

/// Code 3-2 reads `distance` before it is set where the first triangle is missed: then nothing is
/// hit.
#[test]
fn a_tetrahedron_is_seen_through_its_first_face_only() {
    let [_, b, c, d] = Scene::builtin().tetrahedra()[0]
        .vertices
        .map(|p| dvec2(p.x, p.y + 0.3 * (1.0 - p.z)));
    let side = |from: DVec2, to: DVec2, p: DVec2| (to - from).perp_dot(p - from);
    let pixels = both(&Scene::builtin(), Stage::Tetrahedron, 0.0, SIZE);
    for (_, listing) in &pixels {
        let (e, _) = eye_ray(listing, 0.0, SIZE);
        let p = dvec2(e.x, e.y);
        let sides = [side(b, c, p), side(c, d, p), side(d, b, p)];
        let inside = sides.iter().all(|&s| s > 0.0) || sides.iter().all(|&s| s < 0.0);
        assert_eq!(solid(listing.decision).is_some(), inside);
    }
    assert!(
        count(&pixels, |(exact, listing)| {
            solid(exact.decision).is_some() && listing.decision == Decision::Background
        }) > 2000
    );
}

/// Code 3-2 does not make the flag of one face false for the next: a missed face counts as hit at
/// the origin of space, and is seen where that is nearer to the pixel than the tetrahedron.
#[test]
fn a_face_missed_after_a_hit_counts_as_hit_at_the_origin() {
    let (scene, alpha) = (Scene::builtin(), frame_angle(10));
    let [_, b, c, d] = scene.tetrahedra()[0].vertices;
    let normal = (c - b).cross(d - b);
    let mut wrong = 0;
    for (exact, listing) in both(&scene, Stage::Tetrahedron, alpha, SIZE) {
        // Where the first face is seen first, no other one is hit before it.
        if solid(exact.decision).is_none_or(|seen| seen.face != Some(0)) {
            continue;
        }
        let (e, direction) = eye_ray(&listing, alpha, SIZE);
        let depth = (b - e).dot(normal) / direction.dot(normal);
        let face = solid(listing.decision).and_then(|seen| seen.face);
        assert_eq!(face != Some(0), e.length() < depth);
        wrong += usize::from(face != Some(0));
    }
    assert!(wrong > 10_000);
}

/// Code 3-2 divides by zero for a line along a face: a solid owns its faces, but here the point is
/// a NaN, and even the first face, which every hit depends on, is missed.
#[test]
fn a_line_along_a_face_misses_it() {
    let scene = scene(
        "",
        [(AWAY, 0.25); 2],
        [
            [0.5, 0.0, 0.0],
            [0.0, -0.25, 0.5],
            [0.0, -0.25, -0.25],
            [0.0, 0.5, 0.0],
        ],
    );
    let mut pixels = both(&scene, Stage::Tetrahedron, 0.0, SIZE);
    pixels.retain(|(exact, _)| exact.column == SIZE / 2);
    assert!(count(&pixels, |(exact, _)| solid(exact.decision).is_some()) > 200);
    assert_eq!(
        count(&pixels, |(_, listing)| solid(listing.decision).is_some()),
        0
    );
}

/// Code 5-1 hands LightDir to Equation 4-1: the truth under the opposite light, which comes from
/// below.
#[test]
fn solids_are_lit_from_below() {
    let builtin = Scene::builtin();
    let opposite = firsthit::scene::BUILTIN_TOML.replace("[-0.5, -0.5, 0.1]", "[0.5, 0.5, -0.1]");
    let opposite = Scene::from_toml(&opposite).unwrap();
    assert_ne!(builtin, opposite);
    let opposite = trace_pixels(Kernel::Exact, &opposite, Stage::Shading, 0.0, SIZE);
    let mut differing = 0;
    for ((exact, listing), opposite) in both(&builtin, Stage::Shading, 0.0, SIZE)
        .into_iter()
        .zip(opposite)
    {
        if solid(listing.decision).is_some() {
            assert!(
                close(listing.samples, opposite.samples),
                "({}, {})",
                listing.column,
                listing.row
            );
            differing += usize::from(!close(listing.samples, exact.samples));
        }
    }
    assert!(differing > 30_000, "{differing}");
}

/// … and traces shadows the other way, from above. No surface is in shadow that should not be.
#[test]
fn shadows_are_thrown_from_above() {
    for frame in 0..ROUND {
        let pixels = both(&Scene::builtin(), Stage::Shadow, frame_angle(frame), 100);
        assert_eq!(
            count(&pixels, |(exact, listing)| {
                exact.decision == Decision::Surface && listing.decision != Decision::Surface
            }),
            0
        );
        assert!(
            count(&pixels, |(exact, listing)| exact.decision
                == Decision::SurfaceInShadow
                && exact.samples == listing.samples)
                > 50
        );
    }
}

/// Code 5-1 traces the shadow of sphere 2 along +LightDir, and Code 3-1 does not ask for t > 0: two
/// slips cancel.
#[test]
fn the_shadow_of_sphere_2_falls_where_it_should() {
    let sphere2 = ([-0.28125, -0.3125, 0.40625], 0.1875);
    let scene = scene("", [(AWAY, 0.25), sphere2], TETRAHEDRON_AWAY);
    let pixels = both(&scene, Stage::Shadow, 0.3, SIZE);
    let shadow = |pixel: &Pixel| pixel.decision == Decision::SurfaceInShadow;
    assert!(count(&pixels, |(exact, _)| shadow(exact)) > 1000);
    assert_eq!(
        count(&pixels, |(exact, listing)| shadow(exact) != shadow(listing)),
        0
    );
}

#[test]
fn only_the_surface_receives_shadows() {
    let pixels = both(&Scene::builtin(), Stage::Shadow, 0.0, SIZE);
    let unshadowed = trace_pixels(
        Kernel::Listing,
        &Scene::builtin(),
        Stage::Shading,
        0.0,
        SIZE,
    );
    let in_shadow = |pixel: &Pixel| solid(pixel.decision).is_some_and(|seen| seen.in_shadow);
    assert!(count(&pixels, |(exact, _)| in_shadow(exact)) > 10_000);
    for ((_, listing), unshadowed) in pixels.iter().zip(unshadowed) {
        assert!(!in_shadow(listing));
        if solid(listing.decision).is_some() {
            assert_eq!(listing.samples, unshadowed.samples);
        }
    }
}

/// Code 5-1 lets mirrored objects overwrite each other: sphere 1, then sphere 2, then the
/// tetrahedron.
#[test]
fn the_last_mirrored_solid_is_shown() {
    let mut overwritten = [0; 3];
    for frame in 0..ROUND {
        for (exact, listing) in both(
            &Scene::builtin(),
            Stage::Reflection,
            frame_angle(frame),
            200,
        ) {
            if let (Some(exact), Some(listing)) =
                (mirrored(exact.decision), mirrored(listing.decision))
            {
                // The tetrahedron itself may be missed.
                assert!(exact.solid == 2 || exact.solid <= listing.solid);
                if exact.solid < listing.solid {
                    overwritten[usize::from(exact.solid + listing.solid - 1)] += 1;
                }
            }
        }
    }
    // Sphere 1 by sphere 2, sphere 1 by the tetrahedron, sphere 2 by the tetrahedron.
    assert!(overwritten.iter().all(|&n| n > 20), "{overwritten:?}");
}

/// Code 5-1 shades mirrored points with the eye's direction: a mirrored face shows half of what the
/// face itself shows. An exponent of 1 makes the highlight wide.
#[test]
fn a_mirrored_highlight_is_the_eyes() {
    let text = firsthit::scene::BUILTIN_TOML.replace("exponent = 1000 ", "exponent = 1 ");
    let scene = Scene::from_toml(&text).unwrap();
    assert_eq!(scene.material().exponent, 1);
    let pixels = both(&scene, Stage::Reflection, 0.0, SIZE);
    let shown = |pixels: &[Pixel], of: fn(Decision) -> Option<Seen>| {
        pixels
            .iter()
            .find(|pixel| {
                of(pixel.decision)
                    .is_some_and(|seen| (seen.face, seen.in_shadow) == (Some(2), false))
            })
            .unwrap()
            .samples
    };
    let (exact, listing): (Vec<_>, Vec<_>) = pixels.into_iter().unzip();
    let ratio = |pixels: &[Pixel]| shown(pixels, mirrored)[2] / shown(pixels, solid)[2];
    assert_eq!(ratio(&listing), 0.5);
    assert!((ratio(&exact) - 0.5).abs() > 0.01, "{}", ratio(&exact));
}

#[test]
fn other_scenes_are_refused() {
    let ball = "[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = 0.5\ncolor = [1.0, 0.5, 0.0]\n";
    let three = format!("{}\n{ball}", firsthit::scene::BUILTIN_TOML);
    for (text, counts) in [
        ("", "0, 0 and 0"),
        (ball, "1, 0 and 0"),
        (&three, "3, 1 and 1"),
    ] {
        let scene = Scene::from_toml(text).unwrap();
        for stage in Stage::ALL {
            let mut image = Image::new(4).unwrap();
            let refused = Tracer::new(Kernel::Listing, 1)
                .unwrap()
                .trace(&scene, stage, 0.0, &mut image)
                .unwrap_err();
            assert!(matches!(refused, TraceError::Listing { .. }));
            let line = refused.to_string();
            assert!(
                line.contains(counts) && line.contains("choose another kernel"),
                "{line}"
            );
            assert!(!line.contains('\n') && !line.contains("  "), "{line}");
            assert!(image.samples().iter().all(|&sample| sample == 0.0));
        }
    }
}

#[test]
fn extreme_scenes_give_what_comes_out() {
    let scene = scene(
        "light = { direction = [5e200, 0.0, 5e200] }\nmaterial = { exponent = 1000000 }",
        [([1e6, 1e-30, -1e6], 1e-30), ([0.0, 0.0, 1.0], 1e6)],
        [
            [1e-30, 0.0, 0.0],
            [0.0, 1e-30, 0.0],
            [0.0, 0.0, 1e-30],
            [1e6, 1e6, 1e6],
        ],
    );
    for stage in Stage::ALL {
        for alpha in [0.0, 5e-324, -1.7e308] {
            assert_eq!(
                trace_pixels(Kernel::Listing, &scene, stage, alpha, 9).len(),
                81
            );
        }
    }
}
