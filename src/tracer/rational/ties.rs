//! Promise: a tie that lies exactly on a sample is resolved as the picture's definition says, at
//! every angle.
//!
//! Lengths are in 128ths. With N = 20480 c, at an angle whose sine and cosine are fractions of c,
//! every point whose coordinates are such lengths, or simple fractions of them, lies on a sample's
//! eye ray: so the geometry is chosen first, and [`sample`] finds its pixel, or says that there is
//! none.

use dashu_ratio::Relaxed;

use super::super::decision::{Decision, Seen};
use super::compare::{TURNS, compare, compare_whole};
use super::{Turn, Vector};
use crate::scene::Scene;
use crate::stage::Stage;

type Place = [i32; 3];

fn lengths(place: Place) -> String {
    format!("{:?}", place.map(|x| f64::from(x) / 128.0))
}

fn sphere(center: Place, radius: i32) -> String {
    format!(
        "[[sphere]]\ncenter = {}\nradius = {:?}\ncolor = [1.0, 0.5, 0.25]\n",
        lengths(center),
        f64::from(radius) / 128.0
    )
}

fn tetrahedron(vertices: [Place; 4]) -> String {
    let vertices = vertices.map(lengths).join(", ");
    format!("[[tetrahedron]]\nvertices = [{vertices}]\ncolor = [0.25, 0.5, 1.0]\n")
}

/// `to_light` is the way to the light; the surface is at a height and has half a width.
fn scene(to_light: Place, surface: Option<[i32; 2]>, solids: &[String]) -> Scene {
    let mut text = format!(
        "light = {{ direction = {} }}\n",
        lengths(to_light.map(|x| -x))
    );
    if let Some([height, half_width]) = surface.map(|s| s.map(|x| f64::from(x) / 128.0)) {
        text += &format!("surface = {{ height = {height:?}, half_width = {half_width:?} }}\n");
    }
    Scene::from_toml(&(text + &solids.concat())).unwrap()
}

fn plus(a: Place, b: Place) -> Place {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn times(factor: i32, a: Place) -> Place {
    a.map(|x| factor * x)
}

fn vector(place: Place) -> Vector {
    place.map(|x| Relaxed::from(x) / Relaxed::from(128))
}

/// In the mirror of a surface at this height.
fn mirrored(place: Place, height: i32) -> Place {
    [place[0], 2 * height - place[1], place[2]]
}

/// Where the shadow of a point falls on a surface at this height.
fn shadow(place: Place, to_light: Place, height: i32) -> Vector {
    let t = Relaxed::from(place[1] - height) / Relaxed::from(to_light[1]);
    let length = Relaxed::from(128);
    [0, 1, 2].map(|i| (Relaxed::from(place[i]) - &t * Relaxed::from(to_light[i])) / &length)
}

/// A length to the right, up and toward the eye, as a vector of the world.
fn as_seen(turn: Turn, [right, up, near]: Place) -> Vector {
    let [sin, cos] = turn.sin_cos();
    let [right, up, near] = vector([right, up, near]);
    [
        &right * &cos + &near * &sin,
        up,
        &near * &cos - &right * &sin,
    ]
}

fn sum(a: &Vector, b: &Vector) -> Vector {
    [&a[0] + &b[0], &a[1] + &b[1], &a[2] + &b[2]]
}

/// Whether a surface with this outward normal is turned toward the eye, or toward what the eye's
/// mirrored ray comes from.
fn faces_eye(turn: Turn, [x, y, z]: Place, in_mirror: bool) -> bool {
    let y = if in_mirror { -y } else { y };
    10 * (x * turn.0 + z * turn.1) + 3 * y * turn.2 > 0
}

fn size(turn: Turn) -> u32 {
    20480 * turn.2 as u32
}

/// The pixel whose eye ray goes through a point; `None` where the picture does not reach that far.
fn sample(turn: Turn, [x, y, z]: &Vector) -> Option<(u32, u32)> {
    let [sin, cos] = turn.sin_cos();
    let (u, near) = (x * &cos - z * &sin, x * &sin + z * &cos);
    let v = y + Relaxed::from(3) / Relaxed::from(10) * (Relaxed::ONE - near);
    let [column, row] = [u, v].map(|x| {
        let place = (x + Relaxed::ONE) * Relaxed::from(size(turn) / 2);
        let place = place.canonicalize();
        assert!(place.is_int(), "{place} is between two samples");
        u32::try_from(place).ok().filter(|&x| x < size(turn))
    });
    Some((column?, row?))
}

/// Compares the sample at each of the points, and those around it, and returns what the picture
/// shows at the points.
fn decisions(scene: &Scene, stage: Stage, turn: Turn, places: &[Vector]) -> Vec<Option<Decision>> {
    let samples: Vec<_> = places.iter().map(|place| sample(turn, place)).collect();
    let around = samples.iter().flatten().flat_map(|&(column, row)| {
        let steps = (0..9).map(|i| (i % 3, i / 3));
        steps.map(move |(x, y)| ((column + x).saturating_sub(1), (row + y).saturating_sub(1)))
    });
    let size = size(turn);
    let pixels: Vec<_> = around.filter(|&(x, y)| x < size && y < size).collect();
    let known = compare(scene, stage, turn, size, &pixels).decisions;
    let at = |pixel| pixels.iter().position(|&p| p == pixel).map(|i| known[i]);
    samples.into_iter().map(|pixel| at(pixel?)).collect()
}

/// Whether that shows a certain solid, and whether in shadow.
fn shows(decision: Decision, number: u16) -> Option<bool> {
    match decision {
        Decision::Solid(Seen {
            solid, in_shadow, ..
        }) if solid == number => Some(in_shadow),
        _ => None,
    }
}

/// Checks that where the picture shows these places, and it shows most, it does not show the
/// surface's own colour.
fn check_not_plain(decisions: &[Option<Decision>]) {
    assert!(!decisions.contains(&Some(Decision::Surface)));
    let shown = decisions.iter().flatten().count();
    assert!(
        2 * shown >= decisions.len(),
        "{shown} of {}",
        decisions.len()
    );
}

/// The vertices and the middles of the edges.
fn corners(v: [Place; 4]) -> Vec<Place> {
    let edges = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
    let middle = |(a, b): (usize, usize)| {
        plus(v[a], v[b]).map(|x| {
            assert!(x % 2 == 0, "half a length");
            x / 2
        })
    };
    v.into_iter().chain(edges.map(middle)).collect()
}

/// Checks that vertices and edges belong to their solid, as it is seen, as it is mirrored, and to
/// its shadow.
fn check_corners(vertices: [Place; 4], to_light: Place, turns: &[Turn]) {
    let scene = scene(to_light, Some([-64, 512]), &[tetrahedron(vertices)]);
    let corners = corners(vertices);
    let direct: Vec<_> = corners.iter().map(|&p| vector(p)).collect();
    let in_mirror: Vec<_> = corners.iter().map(|&p| vector(mirrored(p, -64))).collect();
    let shadows: Vec<_> = corners.iter().map(|&p| shadow(p, to_light, -64)).collect();
    for &turn in turns {
        let direct = decisions(&scene, Stage::Tetrahedron, turn, &direct);
        let solid = |decision: &Option<_>| matches!(decision, Some(Decision::Solid(_)));
        assert!(direct.iter().all(solid));
        check_not_plain(&decisions(&scene, Stage::Reflection, turn, &in_mirror));
        check_not_plain(&decisions(&scene, Stage::Shadow, turn, &shadows));
    }
}

#[test]
fn vertices_and_edges() {
    let vertices = [[24, -40, 72], [72, -32, 8], [-56, -24, 16], [16, 48, 24]];
    check_corners(vertices, [64, 128, -32], &TURNS);
    let [a, b, c, d] = vertices;
    check_corners([d, c, a, b], [64, 128, -32], &TURNS[..5]);
}

#[test]
fn edges_along_the_eye_and_along_the_light() {
    // At 3/5 and 4/5 the eye looks along (6, 3, 8), and in the mirror along (6, −3, 8).
    for rise in [24, -24] {
        let first = [-16, -32, -8];
        let vertices = [
            first,
            plus(first, [48, rise, 64]),
            plus(first, [16, 32, -8]),
            [40, -16, -24],
        ];
        check_corners(vertices, [64, 128, -32], &TURNS[2..5]);
    }
    // And at 0 and 1 along (0, 3, 10).
    check_corners(
        [[0, -40, -40], [0, -16, 40], [40, -40, -24], [-24, 0, -64]],
        [24, 32, 0],
        &TURNS[..1],
    );
}

/// All of length 50 and across [3, 4, 0].
const ACROSS: [Place; 8] = [
    [40, -30, 0],
    [-40, 30, 0],
    [0, 0, 50],
    [0, 0, -50],
    [24, -18, 40],
    [-24, 18, 40],
    [32, -24, -30],
    [-32, 24, 30],
];

#[test]
fn silhouettes_of_spheres() {
    let center = [8, 0, -24];
    let scene = scene([24, 32, 0], Some([-64, 512]), &[sphere(center, 59)]);
    // Across the eye's direction (0, 3, 10), and of length 59.
    let outline = [
        [59, 0, 0],
        [-59, 0, 0],
        [50, 30, -9],
        [-50, 30, -9],
        [50, -30, 9],
    ];
    for turn in TURNS {
        let around = |center| outline.map(|offset| sum(&vector(center), &as_seen(turn, offset)));
        for decision in decisions(&scene, Stage::Shading, turn, &around(center)) {
            assert!(shows(decision.unwrap(), 0).is_some());
        }
        let in_mirror = around(mirrored(center, -64));
        check_not_plain(&decisions(&scene, Stage::Reflection, turn, &in_mirror));
    }
}

#[test]
fn borders_of_a_spheres_shadow() {
    let (center, to_light) = ([-8, 0, 16], [3, 4, 0]);
    let scene = scene(to_light, Some([-64, 512]), &[sphere(center, 50)]);
    let borders = ACROSS.map(|offset| shadow(plus(center, offset), to_light, -64));
    for turn in TURNS {
        check_not_plain(&decisions(&scene, Stage::Shadow, turn, &borders));
    }
}

#[test]
fn terminators() {
    let center = [8, 0, -8];
    let scene = scene([3, 4, 0], Some([-64, 512]), &[sphere(center, 50)]);
    let mut seen = [0, 0];
    for turn in TURNS {
        let visible = ACROSS.map(|offset| plus(center, offset));
        let direct = decisions(&scene, Stage::Shadow, turn, &visible.map(vector));
        let in_mirror = visible.map(|place| vector(mirrored(place, -64)));
        let in_mirror = decisions(&scene, Stage::Reflection, turn, &in_mirror);
        for ((offset, direct), in_mirror) in ACROSS.into_iter().zip(direct).zip(in_mirror) {
            if faces_eye(turn, offset, false) {
                assert_eq!(shows(direct.unwrap(), 0), Some(true));
                seen[0] += 1;
            }
            if faces_eye(turn, offset, true)
                && let Some(Decision::Mirrored(Seen { in_shadow, .. })) = in_mirror
            {
                assert!(in_shadow);
                seen[1] += 1;
            }
        }
    }
    assert!(seen[0] > 20 && seen[1] > 10, "{seen:?}");
}

#[test]
fn shadows_that_just_reach_another_solid() {
    let to_light = [3, 4, 0];
    let mut seen = 0;
    for normal in [[18, 24, 40], [18, 24, -40], [30, 40, 0], [-30, 40, 0]] {
        let place = normal;
        let ahead = plus(place, times(8, to_light));
        let side = [8, -6, 0];
        let beyond = plus(ahead, times(2, side));
        let touching = [
            sphere(plus(ahead, side), 10),
            sphere(plus(ahead, times(-1, side)), 10),
            sphere(plus(ahead, [0, 0, 10]), 10),
            tetrahedron([
                plus(ahead, [0, 0, 10]),
                plus(ahead, [0, 0, -10]),
                plus(beyond, [6, 8, 0]),
                plus(beyond, [-6, -8, 0]),
            ]),
            tetrahedron([
                plus(ahead, [-8, 6, 8]),
                plus(ahead, [8, -6, -8]),
                plus(beyond, [6, 8, 0]),
                plus(beyond, [-6, -8, 0]),
            ]),
            tetrahedron([
                plus(beyond, [0, 0, 10]),
                ahead,
                plus(beyond, [0, 0, -10]),
                plus(beyond, [6, 8, 0]),
            ]),
        ];
        for other in touching {
            let scene = scene(to_light, None, &[sphere([0; 3], 50), other]);
            for turn in TURNS {
                let decision = decisions(&scene, Stage::Shadow, turn, &[vector(place)]);
                if faces_eye(turn, normal, false)
                    && let Some(in_shadow) = shows(decision[0].unwrap(), 0)
                {
                    assert!(in_shadow);
                    seen += 1;
                }
            }
        }
    }
    assert!(seen > 50, "{seen}");
}

#[test]
fn border_of_the_surface() {
    let scene = scene([24, 32, 0], Some([-64, 80]), &[]);
    let border = [
        [80, -64, 0],
        [-80, -64, 33],
        [17, -64, 80],
        [-9, -64, -80],
        [80, -64, 80],
        [80, -64, -80],
        [-80, -64, 80],
        [-80, -64, -80],
    ];
    for turn in TURNS {
        let decisions = decisions(&scene, Stage::Reflection, turn, &border.map(vector));
        let inside = |decision: &Option<_>| matches!(decision, None | Some(Decision::Surface));
        assert!(decisions.iter().all(inside));
        assert!(decisions.iter().flatten().count() > 4);
    }
}

#[test]
fn shadow_of_the_surfaces_border() {
    let mut seen = 0;
    // A point, the way to the light from below, and the half width that ends where the ray goes
    // through.
    for (place, to_light, half_width) in [
        ([18, -24, 40], [3, -4, 0], 48),
        ([-18, -24, 40], [3, -4, 0], 40),
        ([18, -24, 40], [22, -40, 0], 40),
        ([30, -40, 0], [3, -4, 0], 48),
    ] {
        for (half_width, expected) in [(half_width, true), (half_width - 1, false)] {
            let scene = scene(to_light, Some([-64, half_width]), &[sphere([0; 3], 50)]);
            for turn in TURNS
                .into_iter()
                .filter(|&turn| faces_eye(turn, place, false))
            {
                let decision = decisions(&scene, Stage::Shadow, turn, &[vector(place)]);
                assert_eq!(shows(decision[0].unwrap(), 0), Some(expected));
                seen += 1;
            }
        }
    }
    assert!(seen > 20, "{seen}");
}

#[test]
fn equal_depths() {
    let place = [5, -3, 7];
    let behind = |normal: Place, radius| sphere(plus(place, times(-1, normal)), radius);
    let tetrahedron = |offsets: [Place; 4]| tetrahedron(offsets.map(|offset| plus(place, offset)));
    let spheres = [
        behind([18, 24, 40], 50),
        behind([0, 30, 40], 50),
        behind([9, 12, 20], 25),
        behind([0, 6, 8], 10),
    ];
    // With a vertex, with an edge, with a face at the place.
    let tetrahedra = [
        tetrahedron([[-20, -30, -50], [20, -30, -50], [0; 3], [0, 10, -60]]),
        tetrahedron([[-20, 10, 4], [0, -40, -50], [20, -10, -4], [0, 40, -60]]),
        tetrahedron([[0, 0, -60], [-40, -20, 0], [40, -20, 0], [0, 40, 0]]),
    ];
    let all = [&spheres[..], &tetrahedra[..]].concat();
    let to_light = [24, 32, 8];
    for turn in [TURNS[0], TURNS[3]] {
        for (i, one) in all.iter().enumerate() {
            for (j, other) in all.iter().enumerate() {
                // The format lists spheres first.
                if i == j || (i >= spheres.len() && j < spheres.len()) {
                    continue;
                }
                let scene = scene(to_light, None, &[one.clone(), other.clone()]);
                let decision = decisions(&scene, Stage::Shadow, turn, &[vector(place)]);
                assert!(
                    shows(decision[0].unwrap(), 0).is_some(),
                    "{i}, {j}, {turn:?}"
                );
            }
        }
    }
    // The light runs along the second sphere where it starts: that is no shadow.
    let along = [spheres[0].clone(), behind([0, 0, 50], 50)];
    let along = scene([3, 4, 0], None, &along);
    for turn in [TURNS[0], TURNS[3]] {
        let decision = decisions(&along, Stage::Shadow, turn, &[vector(place)]);
        assert_eq!(shows(decision[0].unwrap(), 0), Some(false));
    }
    // The surface comes last, whether a solid cuts it there or touches it from below.
    for normal in [[18, 24, 40], [0, 30, 40], [0, 50, 0], [30, -40, 0]] {
        let scene = scene(to_light, Some([place[1], 512]), &[behind(normal, 50)]);
        for turn in TURNS
            .into_iter()
            .filter(|&turn| faces_eye(turn, normal, false))
        {
            let decision = decisions(&scene, Stage::Reflection, turn, &[vector(place)]);
            assert!(shows(decision[0].unwrap(), 0).is_some());
        }
    }
}

#[test]
fn ties_that_cover_areas() {
    let [a, b, c, d, e] = [
        [-40, -64, 40],
        [48, -64, 32],
        [8, -64, -48],
        [8, 40, 8],
        [72, 24, 64],
    ];
    let ball = sphere([-40, -24, -16], 40);
    let scenes = [
        // The same solids twice.
        vec![
            ball.clone(),
            ball,
            tetrahedron([a, b, c, d]),
            tetrahedron([d, a, c, b]),
        ],
        // A shared face, then one that is part of another.
        vec![tetrahedron([a, b, d, c]), tetrahedron([a, b, d, e])],
        vec![
            tetrahedron([a, b, c, d]),
            tetrahedron([a, b, [4, -12, 22], c]),
        ],
    ];
    for solids in scenes {
        // From above, in the surface's plane, and along a face.
        for to_light in [[24, 32, 8], [24, 0, 7], [48, 104, -32]] {
            let scene = scene(to_light, Some([-64, 96]), &solids);
            for turn in [TURNS[0], TURNS[6]] {
                compare_whole(&scene, Stage::Reflection, turn, 16);
                let corners = [a, b, c, d].map(vector);
                decisions(&scene, Stage::Reflection, turn, &corners);
            }
        }
    }
}

#[test]
fn light_in_the_surfaces_plane() {
    // The light grazes the sphere where it rests on the surface.
    let resting = scene([3, 0, 4], Some([-64, 512]), &[sphere([8, -14, -8], 50)]);
    let grazed = [1, 2, 5, 12].map(|t| vector(plus([8, -64, -8], times(-8 * t, [3, 0, 4]))));
    for turn in TURNS {
        check_not_plain(&decisions(&resting, Stage::Shadow, turn, &grazed));
    }

    // A point of a sphere in the surface's plane, but not on it, from where the light lies behind a
    // side or a corner of the surface, along a side, or beyond all of it.
    let mut seen = 0;
    for (place, to_light, expected) in [
        ([-100, -64, 30], [1, 0, 0], true),
        ([-100, -64, 80], [1, 0, 0], true),
        ([-100, -64, 81], [1, 0, 0], false),
        ([-100, -64, 60], [1, 0, 1], true),
        ([-100, -64, 61], [1, 0, 1], false),
        ([-90, -64, -90], [3, 0, 3], true),
        ([90, -64, 0], [1, 0, 0], false),
        ([80, -64, 90], [1, 0, 0], false),
    ] {
        for normal in [[40, 0, 30], [30, 24, 32], [50, 0, 0]] {
            let center = plus(place, times(-1, normal));
            let scene = scene(to_light, Some([-64, 80]), &[sphere(center, 50)]);
            for turn in TURNS
                .into_iter()
                .filter(|&turn| faces_eye(turn, normal, false))
            {
                let decision = decisions(&scene, Stage::Shadow, turn, &[vector(place)]);
                if let Some(in_shadow) = decision[0].and_then(|decision| shows(decision, 0)) {
                    assert_eq!(in_shadow, expected, "{place:?}, {to_light:?}, {turn:?}");
                    seen += 1;
                }
            }
        }
    }
    assert!(seen > 50, "{seen}");
}

#[test]
fn light_along_the_eye() {
    let solids = [
        sphere([8, -14, -8], 50),
        tetrahedron([[24, -40, 72], [72, -32, 8], [-56, -24, 16], [16, 48, 24]]),
    ];
    for turn in [TURNS[0], TURNS[3]] {
        let eye = [10 * turn.0, 3 * turn.2, 10 * turn.1];
        for to_light in [eye, times(-1, eye), [eye[0], -eye[1], eye[2]]] {
            let scene = scene(to_light, Some([-64, 90]), &solids);
            for stage in [Stage::Shading, Stage::Reflection] {
                compare_whole(&scene, stage, turn, 16);
            }
        }
    }
}
