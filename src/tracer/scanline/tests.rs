//! The steps before shading: cached spans are compared with spans computed anew, and what a span
//! shows with the definition of its pixels.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use std::sync::atomic::Ordering::Relaxed;

use fearless_simd::Level;

use super::grid::Columns;
use super::prepare::frame::Crowd;
use super::prepare::late_source::LateMaker;
use super::prepare::solids::Appearance;
use super::row_edges::EdgeAt;
use super::visibility::coverage::Coverage;
use super::visibility::depth_test::DepthTests;
use super::visibility::visible::{Shown, Visible};
use super::write::row_writer::RowWriter;
use super::{DepthTester, Painters, Precision, Progress, RowTracer, Scratch, Tally, visible};
use crate::random::Random;
use crate::scene::Scene;
use crate::stage::Stage;
use crate::tracer::arena::Arena;
use crate::tracer::decision::{Decision, Seen};
use crate::tracer::ladder::{Ladder, Rung};
use crate::tracer::pool::lock;

/// All of the surface in the shadow of one sphere, and in those of others.
const SHADOW_IN_SHADOW: &str = "# Shadows within a shadow
surface = { height = -0.5, half_width = 10.0 }
light = { direction = [0.0, -1.0, 0.0] }
[[sphere]]
center = [0.0, 30.0, 0.0]
radius = 20.0
color = [0.5, 0.5, 0.5]
[[sphere]]
center = [0.0, 0.0, 0.0]
radius = 0.25
color = [0.5, 0.25, 0.5]
";

/// A sphere mostly below the surface, whose part below is not mirrored, before mirror images.
const BELOW_THE_MIRROR: &str = "# Mirror images behind what is not mirrored
surface = { height = -0.25, half_width = 2.0 }
light = { direction = [0.0, -1.0, -0.25] }
[[sphere]]
center = [0.0, -1.0, -0.25]
radius = 0.875
color = [0.5, 0.5, 0.5]
[[sphere]]
center = [0.0625, -0.125, -1.8125]
radius = 0.0625
color = [0.5, 0.25, 0.5]
";

/// Two tetrahedra with a face in one plane. The first turns another face to the eye, too, and the
/// crease between its faces lies before the second.
const CREASE_ON_A_SHARED_PLANE: &str = "# A crease on a shared plane
surface = { height = -0.5, half_width = 0.75 }
[[tetrahedron]]
vertices = [[0.5, 0.5, -0.25], [-0.5, -0.25, 0.25], [0.25, -0.25, 0.25], [0.0, 0.5, 0.25]]
color = [0.5, 0.5, 0.5]
[[tetrahedron]]
vertices = [[0.0, -0.25, 0.25], [0.625, -0.125, 0.25], [0.25, 0.5, 0.25], [0.25, 0.125, -0.25]]
color = [0.5, 0.25, 0.5]
";

/// Two faces in one plane: the first in the scene is seen, though rows reach the other one before.
const FACES_IN_ONE_PLANE: &str = "# Faces in one plane
light = { direction = [0.0, -1.0, -0.25] }
[[tetrahedron]]
vertices = [[-0.25, 0.25, 0.25], [0.25, 0.25, 0.25], [0.0, 0.75, 0.25], [0.0, 0.375, -0.25]]
color = [0.5, 0.5, 0.5]
[[tetrahedron]]
vertices = [[-0.5, -0.75, 0.25], [0.5, -0.75, 0.25], [0.0, 1.0, 0.25], [0.0, 0.0, -0.25]]
color = [0.5, 0.25, 0.5]
";

const SCENES: [&str; 11] = [
    "",
    include_str!("../../../tests/scenes/crossing_spheres.toml"),
    include_str!("../../../tests/scenes/crossing_tetrahedra.toml"),
    include_str!("../../../tests/scenes/crowd.toml"),
    include_str!("../../../tests/scenes/light_from_below.toml"),
    include_str!("../../../tests/scenes/skew_shared_plane.toml"),
    CREASE_ON_A_SHARED_PLANE,
    include_str!("../../../tests/scenes/spheres_in_the_floor.toml"),
    SHADOW_IN_SHADOW,
    BELOW_THE_MIRROR,
    FACES_IN_ONE_PLANE,
];

/// Every frame is one of a crowd.
pub(super) const CROWDED: Crowd = Crowd {
    cull_from: 0,
    low_from: f64::NEG_INFINITY,
    late_from: 0,
    late_bytes: usize::MAX,
    late_edges: usize::MAX,
};

/// The same, without memory for late faces.
pub(super) const CROWDED_WITHOUT_MEMORY: Crowd = Crowd {
    late_bytes: 0,
    late_edges: 0,
    ..CROWDED
};

/// No frame is one of a crowd.
pub(super) const NOT_CROWDED: Crowd = Crowd {
    cull_from: u64::MAX,
    low_from: f64::INFINITY,
    late_from: u64::MAX,
    late_bytes: 0,
    late_edges: 0,
};

/// Calls `check` with the tracer of a frame of this scene; the empty one is the built-in.
pub(super) fn with_tracer<T>(
    text: &str,
    (stage, alpha, size): (Stage, f64, u32),
    crowd: Crowd,
    check: impl FnOnce(&RowTracer<'_>) -> T,
) -> T {
    let scene = match text {
        "" => Scene::builtin(),
        text => Scene::from_toml(text).unwrap(),
    };
    let arena = Arena::default();
    let ladder = Ladder::new(&scene, stage, alpha, size, Rung::Hardware, &arena);
    let (precision, level) = (Precision::Certified, Level::baseline());
    let tracer = RowTracer::with_crowd(crowd, &ladder, precision, level, &arena);
    check(&tracer)
}

/// Calls `check` with some frames of each of the scenes.
pub(super) fn each_frame(size: u32, mut check: impl FnMut(&str, &RowTracer<'_>)) {
    for text in SCENES {
        for (stage, alpha) in [
            (Stage::Shadow, 0.0),
            (Stage::Reflection, 0.0),
            (Stage::Reflection, 0.3),
            (Stage::Reflection, 2.1),
        ] {
            let name = text.lines().next().unwrap_or("built-in");
            for crowd in [CROWDED, CROWDED_WITHOUT_MEMORY, NOT_CROWDED] {
                with_tracer(text, (stage, alpha, size), crowd, |tracer| {
                    check(&format!("{name}, stage {stage}, α = {alpha}"), tracer);
                });
            }
        }
    }
}

/// A scene of long and thin tetrahedra that cast shadows on one another. At α = 0 many edges pass
/// through the centres of pixels.
pub(super) fn slivers(count: usize) -> String {
    let mut random = Random::new();
    let mut number = |most: i64| random.below(2 * most as usize + 1) as i64 - most;
    let mut scene = String::new();
    for _ in 0..count {
        let mut point = |most: i64| [(); 3].map(|()| number(most));
        let beside = |[x, y, z]: [i64; 3], to: [i64; 3]| [x + to[0], y + to[1], z + to[2]];
        let (a, b) = (point(24), point(24));
        let (c, d) = (beside(a, point(1)), beside(b, point(1)));
        let [u, v, w] = [b, c, d].map(|p| [0, 1, 2].map(|axis| p[axis] - a[axis]));
        let cross = |i: usize, j: usize| u[i] * v[j] - u[j] * v[i];
        if cross(1, 2) * w[0] + cross(2, 0) * w[1] + cross(0, 1) * w[2] != 0 {
            let vertices = [a, b, c, d].map(|p| p.map(|x| x as f64 / 64.0));
            scene +=
                &format!("[[tetrahedron]]\nvertices = {vertices:?}\ncolor = [0.5, 0.5, 0.5]\n");
        }
    }
    scene
}

/// A scene of small tetrahedra that cast shadows on one another.
pub(super) fn specks(count: usize) -> String {
    let mut random = Random::new();
    let mut number = |most: f64| most * (2.0 * random.fraction() - 1.0);
    let mut scene = String::new();
    for _ in 0..count {
        let middle = [(); 3].map(|()| number(0.4));
        let vertices = [(); 4].map(|()| middle.map(|x| x + number(0.06)));
        scene += &format!("[[tetrahedron]]\nvertices = {vertices:?}\ncolor = [0.5, 0.5, 0.5]\n");
    }
    scene
}

/// The spans of a row, from the left: where each ends, and what is visible there.
fn spans(tracer: &RowTracer<'_>, row: u32, scratch: &mut Scratch) -> Vec<(u32, Visible)> {
    let Scratch {
        active,
        low,
        depth_tests,
        ..
    } = scratch;
    let (frame, level) = (&tracer.frame, tracer.level);
    let (table, grid) = (&frame.edge_table, frame.grid);
    let mut resolve = |coverage: &Coverage| visible(frame, coverage, depth_tests);
    active.enter(row, table, level, grid, &mut resolve);
    low.enter(row, table, level, grid, |_| {});
    low.overlay(row, table, active, resolve);
    low.spans().collect()
}

/// What is visible, in words that do not depend on the numbers of depth tests.
fn words(visible: Visible, tests: &DepthTests) -> String {
    let shown = |shown: Shown| match shown {
        Shown::Paint(paint) => format!("paint {}", paint.0),
        Shown::Sphere { mirrored, solid } => format!("sphere {} {mirrored}", solid.0),
        Shown::Faces { mirrored, solid } => format!("faces {} {mirrored}", solid.0),
        Shown::InDoubt => "in doubt".to_owned(),
    };
    match visible {
        Visible::Only(only) => shown(only),
        Visible::DepthTest(number) => {
            let (test, candidates) = tests.test(number);
            let solids = candidates.iter();
            let solids: Vec<String> = solids
                .map(|solid| {
                    format!(
                        "{} {:?}: {}",
                        solid.solid.0,
                        solid.front_face,
                        shown(solid.shown)
                    )
                })
                .collect();
            let rest = words(test.rest, tests);
            format!("{} {} {solids:?} or {rest}", test.mirrored, test.surface)
        }
    }
}

/// The decision of a pixel like this in the light.
pub(super) fn lit(decision: Decision) -> Decision {
    let lit = |seen: Seen| Seen {
        in_shadow: false,
        ..seen
    };
    match decision {
        Decision::Solid(seen) => Decision::Solid(lit(seen)),
        Decision::Mirrored(seen) => Decision::Mirrored(lit(seen)),
        other => other,
    }
}

/// What is known of the pixels of some columns before they are shaded.
#[derive(Clone, Copy)]
enum Claim {
    None,
    Shows(Decision),
    /// This decision, or the same in shadow.
    ShowsSphere(Decision),
}

/// What `shown` claims of the pixels of these columns, with faces told apart.
fn claims(
    tracer: &RowTracer<'_>,
    row: u32,
    columns: Columns,
    shown: Shown,
    painters: &mut Painters,
) -> Vec<(Columns, Claim)> {
    let frame = &tracer.frame;
    let appearance = |mirrored, solid| frame.solids(mirrored).appearance(solid);
    let claim = match shown {
        Shown::InDoubt => Claim::None,
        Shown::Paint(paint) => Claim::Shows(frame.paints[paint].decision),
        Shown::Sphere { mirrored, solid } => {
            let sphere = match appearance(mirrored, solid) {
                Appearance::Sphere(sphere) => Some(sphere),
                _ => None,
            };
            Claim::ShowsSphere(sphere.unwrap().in_light)
        }
        Shown::Faces { mirrored, solid } => {
            let late = match appearance(mirrored, solid) {
                Appearance::LateFaces(late) => Some(*late),
                _ => None,
            };
            let late = late.unwrap();
            let Painters {
                face_splitter,
                late_work,
                ..
            } = painters;
            let maker = LateMaker::new(&tracer.late);
            let faces = late.get(row, &maker, late_work);
            let cross =
                |first, edges: &mut _| late.cross(faces, first, edges, &tracer.late, late_work);
            let parts = face_splitter.split((late.number, faces), row, columns, cross);
            let claims = parts.map(|(columns, shown)| match shown {
                Shown::Paint(paint) => (columns, Claim::Shows(faces.paints[paint].decision)),
                _ => (columns, Claim::None),
            });
            return claims.collect();
        }
    };
    vec![(columns, claim)]
}

#[test]
fn spans_kept_from_row_to_row_are_spans_computed_anew() {
    let size = 61;
    each_frame(size, |name, tracer| {
        let mut kept = Scratch::default();
        tracer.begin(&mut kept);
        // Not only from the bottom to the top: threads take bands of rows in any order.
        let rows = (0..size).chain((0..size).rev()).chain((0..size).step_by(7));
        for row in rows {
            let mut anew = Scratch::default();
            tracer.begin(&mut anew);
            let describe = |scratch: &mut Scratch| {
                let mut described: Vec<(u32, String)> = Vec::new();
                for (to, visible) in spans(tracer, row, scratch) {
                    let words = words(visible, &scratch.depth_tests);
                    // Neighbours that show the same may be one span in one of them, and two in the
                    // other.
                    match described.last_mut() {
                        Some(last) if last.1 == words => last.0 = to,
                        _ => described.push((to, words)),
                    }
                }
                described
            };
            let (kept, anew) = (describe(&mut kept), describe(&mut anew));
            assert_eq!(kept, anew, "{name}, row {row}");
        }
    });
}

#[test]
fn a_span_shows_what_its_pixels_are_defined_to_show() {
    let size = 61;
    each_frame(size, |name, tracer| {
        let mut scratch = Scratch::default();
        tracer.begin(&mut scratch);
        let (mut certain, mut in_doubt) = (0, 0);
        for row in 0..size {
            let y = tracer.frame.grid.coordinate(row);
            let mut from = 0;
            for (to, visible) in spans(tracer, row, &mut scratch) {
                let mut depth_tester = DepthTester::default();
                let (frame, tests) = (&tracer.frame, &scratch.depth_tests);
                let parts = depth_tester.test((frame, tests, y), visible, (from, to));
                for (columns, shown) in parts {
                    let painters = &mut scratch.painters;
                    for ((first, end), claim) in claims(tracer, row, columns, shown, painters) {
                        for column in first..end {
                            let (pixel, _) = tracer.pixels.pixel(column, row);
                            let decision = pixel.0;
                            let is_right = match claim {
                                Claim::None => true,
                                Claim::Shows(claimed) => claimed == decision,
                                Claim::ShowsSphere(in_light) => {
                                    let on_sphere =
                                        tracer.pixels.pixel_on_sphere(in_light, column, row);
                                    in_light == lit(decision) && on_sphere.0 == pixel
                                }
                            };
                            assert!(is_right, "{name}, ({column}, {row}): {decision:?}");
                            match claim {
                                Claim::None => in_doubt += 1,
                                _ => certain += 1,
                            }
                        }
                    }
                }
                from = to;
            }
            assert_eq!(from, size, "{name}, row {row}");
        }
        // Spans that leave much in doubt would pass, too.
        assert!(certain > 100 * in_doubt, "{name}: {certain}, {in_doubt}");
    });
}

#[test]
fn late_faces_take_no_more_memory_than_they_may() {
    let mut random = Random::new();
    let mut spheres = String::new();
    for _ in 0..1600 {
        let center = [(); 3].map(|()| random.fraction() - 0.5);
        spheres += &format!(
            "[[sphere]]\ncenter = {center:?}\nradius = 0.03125\ncolor = [0.5, 0.5, 0.5]\n"
        );
    }
    let (tetrahedra, mixed) = (slivers(250), slivers(100) + &spheres);
    let size = 96;
    let bytes = |text: &str, late_bytes, late_edges| {
        let crowd = Crowd {
            late_bytes,
            late_edges,
            ..CROWDED
        };
        with_tracer(text, (Stage::Reflection, 0.3, size), crowd, |tracer| {
            let mut samples = vec![0.0; 3 * (size * size) as usize];
            let measured = allocation_counter::measure(|| {
                let mut scratch = Scratch::default();
                tracer.begin(&mut scratch);
                let progress = Progress::default();
                tracer.trace(0..size, &mut samples, None, None, &mut scratch, &progress);
            });
            let kept = lock(&tracer.late.free);
            let kept = kept.iter().map(|kept| kept.member.as_bump());
            let kept = kept.map(|bump| bump.allocated_bytes() - bump.chunk_capacity());
            (kept.sum::<usize>() as u64, measured.bytes_max)
        })
    };
    let of_regions = |text, most| {
        let kept = [0, most, usize::MAX].map(|most| bytes(text, most, 0).0);
        (most, kept)
    };
    let edges = 1 << 12;
    let in_edges = |bytes: usize| bytes / size_of::<EdgeAt>();
    let of_edges = [0, edges, usize::MAX].map(|most| bytes(&tetrahedra, 0, in_edges(most)).1);
    let of_edges = (edges, of_edges);
    for (most, [none, some, all]) in [
        of_regions(&tetrahedra, 1 << 16),
        of_regions(&mixed, 1 << 15),
        of_edges,
    ] {
        // Memory that grows is more than what lies in it, and one solid may go beyond the most.
        let most = 3 * most as u64;
        let taken = format!("{none}, then {some}, then {all} bytes");
        assert!(some < none + most && none + 2 * most < all, "{taken}");
    }
}

#[test]
fn a_row_makes_no_late_faces_once_its_frame_is_cancelled() {
    let (text, size) = (slivers(60), 64);
    let frame = (Stage::Reflection, 0.3, size);
    with_tracer(&text, frame, CROWDED, |tracer| {
        let taken = |progress: &Progress| {
            let mut scratch = Scratch::default();
            tracer.begin(&mut scratch);
            let row = size / 2;
            let mut writer = RowWriter {
                level: tracer.level,
                precision: tracer.precision,
                grid: tracer.frame.grid,
                first: row,
                row,
                y: tracer.frame.grid.coordinate(row),
                samples: &mut vec![0.0; 3 * size as usize],
                decisions: None,
                history: None,
                pending: None,
                tally: Tally::default(),
                progress,
            };
            tracer.trace_row(&mut writer, &mut scratch, &LateMaker::new(&tracer.late));
            tracer.late.taken.load(Relaxed)
        };
        let progress = Progress::default();
        progress.cancel();
        assert_eq!(taken(&progress), 0);
        progress.begin();
        assert_ne!(taken(&progress), 0);
    });
}
