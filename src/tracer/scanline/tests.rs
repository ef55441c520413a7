//! The steps before shading: cached spans are compared with spans computed anew, and what a span
//! shows with the definition of its pixels.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use fearless_simd::Level;

use super::grid::Columns;
use super::prepare::frame::Crowd;
use super::prepare::solids::Appearance;
use super::visibility::coverage::Coverage;
use super::visibility::depth_test::DepthTests;
use super::visibility::visible::{Shown, Visible};
use super::{DepthTester, Painters, Precision, RowTracer, Scratch, late_faces, visible};
use crate::scene::Scene;
use crate::stage::Stage;
use crate::tracer::arena::Arena;
use crate::tracer::decision::{Decision, Seen};
use crate::tracer::ladder::{Ladder, Rung};

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

/// Calls `check` with some frames of each of the scenes; the empty one is the built-in.
pub(super) fn each_frame(size: u32, mut check: impl FnMut(&str, &RowTracer<'_>)) {
    for text in SCENES {
        let scene = match text {
            "" => Scene::builtin(),
            text => Scene::from_toml(text).unwrap(),
        };
        for (stage, alpha) in [
            (Stage::Shadow, 0.0),
            (Stage::Reflection, 0.0),
            (Stage::Reflection, 0.3),
            (Stage::Reflection, 2.1),
        ] {
            let arena = Arena::default();
            let ladder = Ladder::new(&scene, stage, alpha, size, Rung::Hardware, &arena);
            let name = text.lines().next().unwrap_or("built-in");
            // Every frame is one of a crowd, or none.
            for (from, low_from) in [(0, f64::NEG_INFINITY), (u64::MAX, f64::INFINITY)] {
                let crowd = Crowd {
                    cull_from: from,
                    low_from,
                    late_from: from,
                };
                let (precision, level) = (Precision::Certified, Level::baseline());
                let tracer = RowTracer::with_crowd(crowd, &ladder, precision, level, &arena);
                check(&format!("{name}, stage {stage}, α = {alpha}"), &tracer);
            }
        }
    }
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
    low.enter(row, table, level, grid);
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
            let color = |decision| tracer.pixels.color(decision);
            let faces = late_faces(late, &tracer.late, mirrored, &color, &mut painters.spare);
            let (numbered, splitter) = ((late.number, faces), &mut painters.face_splitter);
            let parts = splitter.split(numbered, row, columns, tracer.level, frame.grid);
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
                let spans = spans(tracer, row, scratch);
                let spans = spans.into_iter();
                spans
                    .map(|(to, visible)| (to, words(visible, &scratch.depth_tests)))
                    .collect::<Vec<_>>()
            };
            // Neighbours that show the same may be one span in one of them, and two in the other.
            let pixels = |spans: Vec<(u32, String)>| {
                let mut pixels = Vec::new();
                for (to, words) in spans {
                    pixels.resize(to as usize, words);
                }
                pixels
            };
            let (kept, anew) = (describe(&mut kept), describe(&mut anew));
            assert_eq!(pixels(kept), pixels(anew), "{name}, row {row}");
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
                            let ((decision, _), _) = tracer.pixels.pixel(column, row);
                            let is_right = match claim {
                                Claim::None => true,
                                Claim::Shows(claimed) => claimed == decision,
                                Claim::ShowsSphere(in_light) => in_light == lit(decision),
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
