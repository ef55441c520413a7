//! Promise: a tie that lies exactly on a sample is resolved as the picture's definition says, by
//! whole pictures as the kernels make them, at α = 0, where the oracle decides exactly.

mod lattice;

use firsthit::tracer::{Decision, Seen};
use firsthit::{Kernel, Scene, Stage, Tracer};

use crate::helpers::{says_what_is_shown, trace_with_decisions};
use crate::oracle::Oracle;
use lattice::{
    AXIS, FLIPS, HEIGHT, Place, SIZE, Turn, corners, faces_eye, mirrored, plus, sample, scene,
    shadow, sphere, tetrahedron, times, turns,
};

/// Traces a frame at α = 0 with exact, and asks the oracle and reference about some pixels; returns
/// what was decided for each. Reference makes every pixel by itself, so none but those are asked
/// for.
fn compare(
    scene: &Scene,
    stage: Stage,
    size: u32,
    pixels: impl IntoIterator<Item = (u32, u32)>,
) -> Vec<Decision> {
    let (image, decisions) = trace_with_decisions(Kernel::Exact, scene, stage, 0.0, size);
    let oracle = Oracle::new(scene, 0.0, size, 256);
    let reference = Tracer::new(Kernel::Reference, 1).unwrap();
    for pixel in pixels {
        let (column, row) = pixel;
        let decision = decisions[(row * size + column) as usize];
        let got = (decision, image.pixel(column, row).unwrap());
        if let Some(problem) = oracle.problem(stage, pixel, got) {
            panic!("stage {stage}, N = {size}, {problem}");
        }
        let text = reference.explain(scene, stage, 0.0, size, pixel).unwrap();
        says_what_is_shown(&text, (scene, stage), got);
    }
    decisions
}

/// Compares the sample at each of the places, and those around it, and returns what the picture
/// shows at the places that lie on a sample.
fn decisions(scene: &Scene, stage: Stage, places: &[Place]) -> Vec<Decision> {
    let samples: Vec<_> = places.iter().filter_map(|&place| sample(place)).collect();
    let around = samples.iter().flat_map(|&(column, row)| {
        let steps = (0..9).map(|i| (i % 3, i / 3));
        steps.map(move |(x, y)| ((column + x).saturating_sub(1), (row + y).saturating_sub(1)))
    });
    let around = around.filter(|&(column, row)| column < SIZE && row < SIZE);
    let decided = compare(scene, stage, SIZE, around);
    let at = |(column, row)| decided[(row * SIZE + column) as usize];
    samples.into_iter().map(at).collect()
}

fn whole(size: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..size * size).map(move |i| (i % size, i / size))
}

/// What it shows of a solid, directly.
fn seen(decision: Decision, number: u16) -> Option<Seen> {
    match decision {
        Decision::Solid(seen) if seen.solid == number => Some(seen),
        _ => None,
    }
}

fn shows_first(decision: &Decision) -> bool {
    seen(*decision, 0).is_some()
}

/// Checks that the picture does not show the surface's own colour there, and returns how many
/// samples that are.
fn not_plain(decisions: &[Decision]) -> usize {
    assert!(!decisions.contains(&Decision::Surface));
    decisions.len()
}

/// Checks that vertices and edges belong to their solid, as it is seen, as it is mirrored, and to
/// its shadow; counts the samples that lie on them.
fn check_corners(vertices: [Place; 4], to_light: Place, turn: Turn, ties: &mut [usize; 3]) {
    let (vertices, to_light) = (vertices.map(|place| turn.of(place)), turn.of(to_light));
    let scene = scene(to_light, Some([HEIGHT, 512]), &[tetrahedron(vertices)]);
    let corners = corners(vertices);
    let direct = decisions(&scene, Stage::Tetrahedron, &corners);
    let is_solid = |decision: &Decision| matches!(decision, Decision::Solid(_));
    assert!(direct.iter().all(is_solid));
    let images: Vec<_> = corners.iter().map(|&place| mirrored(place)).collect();
    let shadows: Vec<_> = corners
        .iter()
        .filter_map(|&place| shadow(place, to_light))
        .collect();
    let in_mirror = decisions(&scene, Stage::Reflection, &images);
    let shadows = decisions(&scene, Stage::Shadow, &shadows);
    ties[0] += direct.len();
    ties[1] += not_plain(&in_mirror);
    ties[2] += not_plain(&shadows);
}

#[test]
fn vertices_and_edges_belong_to_their_solid() {
    let [a, b, c, d] = [[20, -10, 40], [40, -10, 0], [-40, 10, -20], [0, 30, 20]];
    let mut ties = [0; 3];
    for turn in turns() {
        for vertices in [[a, b, c, d], [d, c, a, b]] {
            check_corners(vertices, [1, 1, -1], turn, &mut ties);
        }
    }
    assert_eq!(ties, [160, 140, 128]);
}

#[test]
fn edges_along_the_eye_and_along_the_light_belong_to_their_solid() {
    let (first, to_light) = ([-10, -10, -20], [1, 1, -1]);
    let along_the_light = plus(first, times(20, to_light));
    let mut ties = [0; 3];
    // Along the eye's direction, and along the mirrored one.
    for along_the_eye in [[0, 12, 40], [0, -12, 40]] {
        let vertices = [
            first,
            plus(first, along_the_eye),
            along_the_light,
            [40, -10, 0],
        ];
        for turn in FLIPS {
            check_corners(vertices, to_light, turn, &mut ties);
        }
    }
    assert_eq!(ties, [40, 40, 24]);
}

#[test]
fn silhouettes_belong_to_spheres() {
    // Across the eye's direction (0, 3, 10), and of the radius's length.
    let small = |radius| vec![[radius, 0, 0], [-radius, 0, 0]];
    let large = vec![
        [84, 100, -30],
        [-84, 100, -30],
        [84, -100, 30],
        [-84, -100, 30],
    ];
    let mut ties = [0; 2];
    for (center, radius, outline) in [
        ([8, 0, -20], 30, small(30)),
        ([-23, 20, 10], 11, small(11)),
        ([41, 5, 30], 7, small(7)),
        ([-80, -90, 0], 134, large.clone()),
        ([70, -90, 10], 134, large.clone()),
        ([70, 80, -10], 134, large.clone()),
        ([-90, 70, 20], 134, large.clone()),
    ] {
        let scene = scene([24, 32, 0], Some([HEIGHT, 512]), &[sphere(center, radius)]);
        let around = |center| -> Vec<_> { outline.iter().map(|&v| plus(center, v)).collect() };
        let direct = decisions(&scene, Stage::Shading, &around(center));
        assert!(direct.iter().all(shows_first));
        let in_mirror = decisions(&scene, Stage::Reflection, &around(mirrored(center)));
        ties[0] += direct.len();
        ties[1] += not_plain(&in_mirror);
    }
    assert_eq!(ties, [10, 8]);
}

/// A way to the light, a length, and vectors of that length across that way, of each of which the
/// opposite is another.
type Across = (Place, i32, &'static [Place]);

const ACROSS: [Across; 3] = [
    (
        [3, 4, 0],
        50,
        &[[40, -30, 0], [0, 0, 50], [24, -18, 40], [32, -24, -30]],
    ),
    ([0, 4, 3], 50, &[[50, 0, 0], [0, -30, 40]]),
    ([1, 2, 2], 30, &[[20, 10, -20], [20, -20, 10]]),
];

/// The vectors with their opposites, turned.
fn all_across(half: &[Place], turn: Turn) -> Vec<Place> {
    let both = half.iter().flat_map(|&offset| [offset, times(-1, offset)]);
    both.map(|offset| turn.of(offset)).collect()
}

#[test]
fn borders_of_a_spheres_shadow_belong_to_it() {
    let mut ties = 0;
    for (to_light, radius, half) in ACROSS {
        for (turn, above) in turns().flat_map(|turn| [30, 40, 52, 54].map(|y| (turn, y))) {
            let (center, to_light) = (turn.of([-10, HEIGHT + above, 0]), turn.of(to_light));
            let border = |&offset: &Place| shadow(plus(center, offset), to_light);
            let borders: Vec<_> = all_across(half, turn).iter().filter_map(border).collect();
            if borders.iter().any(|&place| sample(place).is_some()) {
                let scene = scene(to_light, Some([HEIGHT, 512]), &[sphere(center, radius)]);
                ties += not_plain(&decisions(&scene, Stage::Shadow, &borders));
            }
        }
    }
    assert_eq!(ties, 144);
}

#[test]
fn terminators_are_in_shadow() {
    let mut ties = [0; 2];
    for (to_light, radius, half) in ACROSS {
        for turn in turns() {
            let (center, to_light) = (turn.of([10, 10, 0]), turn.of(to_light));
            let scene = scene(to_light, Some([HEIGHT, 512]), &[sphere(center, radius)]);
            let offsets = all_across(half, turn);
            let direct = offsets.iter().filter(|&&offset| faces_eye(offset));
            let direct: Vec<_> = direct.map(|&offset| plus(center, offset)).collect();
            for decision in decisions(&scene, Stage::Shadow, &direct) {
                assert!(seen(decision, 0).unwrap().in_shadow);
                ties[0] += 1;
            }
            let in_mirror = offsets.iter().filter(|&&[x, y, z]| faces_eye([x, -y, z]));
            let in_mirror = in_mirror.map(|&offset| mirrored(plus(center, offset)));
            let in_mirror: Vec<_> = in_mirror.collect();
            for decision in decisions(&scene, Stage::Reflection, &in_mirror) {
                if let Decision::Mirrored(Seen { in_shadow, .. }) = decision {
                    assert!(in_shadow);
                    ties[1] += 1;
                }
            }
        }
    }
    assert_eq!(ties, [48, 26]);
}

#[test]
fn shadows_that_just_reach_another_solid_are_shadows() {
    let to_light = [3, 4, 0];
    let mut ties = 0;
    for normal in [[18, 24, 40], [18, 24, -40], [30, 40, 0], [-30, 40, 0]] {
        let ahead = plus(normal, times(8, to_light));
        let side = [8, -6, 0];
        let beyond = plus(ahead, times(2, side));
        let apart = |offset| [plus(beyond, offset), plus(beyond, times(-1, offset))];
        let [up, down] = apart([6, 8, 0]);
        let [near, far] = apart([0, 0, 10]);
        let touching = [
            Ok((plus(ahead, side), 10)),
            Ok((plus(ahead, times(-1, side)), 10)),
            Ok((plus(ahead, [0, 0, 10]), 10)),
            // With an edge across, with one aslant, with a vertex.
            Err([plus(ahead, [0, 0, 10]), plus(ahead, [0, 0, -10]), up, down]),
            Err([plus(ahead, [-8, 6, 8]), plus(ahead, [8, -6, -8]), up, down]),
            Err([near, ahead, far, up]),
        ];
        let turned = |other| turns().map(move |turn| (other, turn));
        for (other, turn) in touching.into_iter().flat_map(turned) {
            let place = turn.of(normal);
            if !faces_eye(turn.of(normal)) || sample(place).is_none() {
                continue;
            }
            let other = match other {
                Ok((center, radius)) => sphere(turn.of(center), radius),
                Err(vertices) => tetrahedron(vertices.map(|vertex| turn.of(vertex))),
            };
            let ball = sphere(turn.of([0; 3]), 50);
            let scene = scene(turn.of(to_light), None, &[ball, other]);
            let decision = decisions(&scene, Stage::Shadow, &[place])[0];
            if let Some(Seen { in_shadow, .. }) = seen(decision, 0) {
                assert!(in_shadow);
                ties += 1;
            }
        }
    }
    assert_eq!(ties, 96);
}

#[test]
fn the_border_belongs_to_the_surface() {
    let mut ties = 0;
    // Z is that of the border, of which the front or the back lies on samples.
    for (half_width, z) in [(44, 44), (46, -46)] {
        let z = z - AXIS;
        let scene = scene([24, 32, 0], Some([HEIGHT, half_width]), &[]);
        let sides = [half_width, -half_width].into_iter();
        let sides = sides.flat_map(|x| [-40, -10, 30, z].map(|z| [x, HEIGHT, z]));
        let border: Vec<_> = sides.chain([17, -9].map(|x| [x, HEIGHT, z])).collect();
        let decisions = decisions(&scene, Stage::Reflection, &border);
        let is_surface = |&decision: &_| decision == Decision::Surface;
        assert!(decisions.iter().all(is_surface));
        ties += decisions.len();
    }
    assert_eq!(ties, 20);
}

#[test]
fn the_surfaces_border_casts_shadow() {
    let mut ties = 0;
    // A point, the way to the light from below, and the half width that ends where the ray goes
    // through.
    for (place, to_light, half_width) in [
        ([18, -24, 40], [3, -4, 0], 48),
        ([-18, -24, 40], [3, -4, 0], 44),
        ([18, -24, 40], [26, -40, 0], 44),
        ([0, -30, 40], [4, -2, 0], 68),
        ([0, -30, 40], [0, -34, 10], 54),
    ] {
        for (half_width, expected) in [(half_width, true), (half_width - 1, false)] {
            for turn in FLIPS {
                let (place, to_light) = (turn.of(place), turn.of(to_light));
                let solids = [sphere([0; 3], 50)];
                let scene = scene(to_light, Some([-64, half_width]), &solids);
                let decision = decisions(&scene, Stage::Shadow, &[place])[0];
                assert_eq!(
                    seen(decision, 0).unwrap().in_shadow,
                    expected,
                    "{place:?}, {to_light:?}"
                );
                ties += 1;
            }
        }
    }
    assert_eq!(ties, 20);
}

#[test]
fn of_equal_depths_the_first_solid_is_seen() {
    let place = [10, -3, 0];
    let behind = |normal: Place, radius| (plus(place, times(-1, normal)), radius);
    let spheres = [
        behind([18, 24, 40], 50),
        behind([0, 30, 40], 50),
        behind([9, 12, 20], 25),
        behind([0, 6, 8], 10),
    ];
    // With a vertex, with an edge, with a face at the place.
    let tetrahedra = [
        [[-20, -30, -50], [20, -30, -50], [0; 3], [0, 10, -60]],
        [[-20, 10, 4], [0, -40, -50], [20, -10, -4], [0, 40, -60]],
        [[0, 0, -60], [-40, -20, 0], [40, -20, 0], [0, 40, 0]],
    ];
    let tetrahedra = tetrahedra.map(|offsets| offsets.map(|offset| plus(place, offset)));
    for turn in FLIPS {
        let spheres = spheres.map(|(center, radius)| sphere(turn.of(center), radius));
        let tetrahedra = tetrahedra.map(|vertices| tetrahedron(vertices.map(|v| turn.of(v))));
        let all = [&spheres[..], &tetrahedra[..]].concat();
        let number = |i: usize, j: usize| [all[i].clone(), all[j].clone()];
        let to_light = turn.of([24, 32, 8]);
        for (i, j) in (0..all.len()).flat_map(|i| (0..all.len()).map(move |j| (i, j))) {
            // The format lists spheres first.
            if i == j || (i >= spheres.len() && j < spheres.len()) {
                continue;
            }
            let scene = scene(to_light, None, &number(i, j));
            let decision = decisions(&scene, Stage::Shadow, &[turn.of(place)])[0];
            assert!(seen(decision, 0).is_some(), "{i}, {j}, {turn:?}");
        }
    }
}

#[test]
fn the_surface_comes_after_a_solid_at_the_same_depth() {
    let place = [10, -30, 0];
    let mut ties = 0;
    // A solid cuts the surface there, or touches it from below.
    for normal in [[18, 24, 40], [0, 30, 40], [0, 50, 0], [30, -40, 0]] {
        for turn in turns().filter(|turn| faces_eye(turn.of(normal))) {
            let ball = sphere(turn.of(plus(place, times(-1, normal))), 50);
            let scene = scene(turn.of([24, 32, 8]), Some([HEIGHT, 512]), &[ball]);
            let decisions = decisions(&scene, Stage::Reflection, &[turn.of(place)]);
            assert!(decisions.iter().all(shows_first));
            ties += decisions.len();
        }
    }
    assert_eq!(ties, 20);
}

#[test]
fn a_light_that_runs_along_a_solid_where_it_starts_is_not_hidden_by_it() {
    let place = [10, -3, 0];
    let behind = |normal: Place| sphere(plus(place, times(-1, normal)), 50);
    let scene = scene([3, 4, 0], None, &[behind([18, 24, 40]), behind([0, 0, 50])]);
    let decision = decisions(&scene, Stage::Shadow, &[place])[0];
    assert!(!seen(decision, 0).unwrap().in_shadow);
}

#[test]
fn ties_that_cover_areas() {
    let [a, b, c, d, e] = [
        [-40, -30, 40],
        [40, -30, 20],
        [0, -30, -40],
        [0, 34, 10],
        [70, 24, 60],
    ];
    // (a + b + 2 d)/4.
    let middle = [0, 2, 20];
    let ball = || sphere([-40, -10, -20], 20);
    let scenes = [
        // The same solids twice.
        vec![
            ball(),
            ball(),
            tetrahedron([a, b, c, d]),
            tetrahedron([d, a, c, b]),
        ],
        // A shared face, then one that is part of another.
        vec![tetrahedron([a, b, d, c]), tetrahedron([a, b, d, e])],
        vec![tetrahedron([a, b, c, d]), tetrahedron([a, b, middle, c])],
        // A face in the surface, seen from above.
        vec![tetrahedron([a, b, c, [0, -60, 0]])],
    ];
    for solids in scenes {
        // From above, in the surface's plane, and along a face.
        for to_light in [[24, 32, 8], [24, 0, 7], [40, 64, -30]] {
            let scene = scene(to_light, Some([HEIGHT, 60]), &solids);
            compare(&scene, Stage::Reflection, 32, whole(32));
            decisions(&scene, Stage::Reflection, &[a, b, c, d, middle]);
        }
    }
}

#[test]
fn light_in_the_surfaces_plane_grazes_a_resting_sphere() {
    let mut ties = 0;
    for turn in turns() {
        let foot = [10, HEIGHT, -10];
        let (ball, to_light) = (sphere(turn.of(plus(foot, [0, 30, 0])), 30), [3, 0, 4]);
        let resting = scene(turn.of(to_light), Some([HEIGHT, 512]), &[ball]);
        let grazed = [5, 10, 15, 20].map(|t| turn.of(plus(foot, times(-t, to_light))));
        ties += not_plain(&decisions(&resting, Stage::Shadow, &grazed));
    }
    assert_eq!(ties, 20);
}

#[test]
fn light_in_the_surfaces_plane_is_hidden_by_it() {
    let mut ties = 0;
    // A point of a sphere in the surface's plane, from where the light lies behind a side or a
    // corner of the surface, along a side, or beyond all of it; the last is on the border itself.
    for (place, to_light, half_width, expected) in [
        ([-60, HEIGHT, 20], [1, 0, 0], 44, true),
        ([-60, HEIGHT, 40], [1, 0, 0], 44, true),
        ([-60, HEIGHT, 40], [1, 0, 0], 43, false),
        ([-64, HEIGHT, 20], [1, 0, 1], 44, true),
        ([-64, HEIGHT, 20], [1, 0, 1], 43, false),
        ([-56, HEIGHT, -60], [3, 0, 3], 44, true),
        ([44, HEIGHT, -60], [0, 0, 1], 44, true),
        ([44, HEIGHT, -60], [0, 0, 1], 43, false),
        ([54, HEIGHT, 0], [1, 0, 0], 44, false),
        ([44, HEIGHT, 50], [1, 0, 0], 44, false),
        ([44, HEIGHT, 20], [1, 0, 0], 44, false),
    ] {
        for normal in [[40, 0, 30], [30, 24, 32], [24, 18, 40]] {
            for turn in FLIPS {
                let center = turn.of(plus(place, times(-1, normal)));
                let surface = Some([HEIGHT, half_width]);
                let scene = scene(turn.of(to_light), surface, &[sphere(center, 50)]);
                for decision in decisions(&scene, Stage::Shadow, &[turn.of(place)]) {
                    let Seen { in_shadow, .. } = seen(decision, 0).unwrap();
                    assert_eq!(in_shadow, expected, "{place:?}, {to_light:?}, {half_width}");
                    ties += 1;
                }
            }
        }
    }
    assert_eq!(ties, 60);
}

#[test]
fn light_along_the_eye() {
    let solids = [
        sphere([8, -10, -8], 20),
        tetrahedron([[20, -10, 40], [40, -10, 0], [-40, 10, -20], [0, 30, 20]]),
    ];
    for to_light in [[0, 3, 10], [0, -3, -10], [0, -3, 10]] {
        let scene = scene(to_light, Some([HEIGHT, 60]), &solids);
        for stage in [Stage::Shading, Stage::Reflection] {
            compare(&scene, stage, 32, whole(32));
        }
    }
}

#[test]
fn ties_of_the_built_in_scene() {
    // The mirrored silhouette of the first sphere goes through the sample in the middle of these.
    let scene = Scene::builtin();
    let silhouette = (245..265).map(|column| (column, 202));
    let decided = compare(&scene, Stage::Reflection, 500, silhouette);
    let at = |column: usize| decided[202 * 500 + column];
    assert!(matches!(at(255), Decision::Mirrored(seen) if seen.solid == 0));
    assert_eq!(at(256), Decision::Surface);

    // The surface's left, right and front border lie on samples of this size: |x| = |z| = 11/16.
    let front = (79..434).map(|column| (column, 152));
    let sides = (151..255).flat_map(|row| [79, 80, 81, 431, 432, 433].map(|column| (column, row)));
    let border = compare(&scene, Stage::Shadow, 512, front.chain(sides));
    let at = |column: usize| border[152 * 512 + column];
    assert_eq!([79, 80].map(at), [Decision::Background, Decision::Surface]);
    assert_eq!(
        [432, 433].map(at),
        [Decision::Surface, Decision::Background]
    );
}
