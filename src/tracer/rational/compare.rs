//! Promise: at angles whose sine and cosine are rational, every decision is that of exact
//! arithmetic, whatever the number; a number that cannot tell says so.

use bumpalo::Bump;

use super::super::arena::Arena;
use super::super::decision::Decision;
use super::super::extent::Extents;
use super::super::frame::Frame;
use super::super::ladder::{Ladder, Pixels, Rung};
use super::super::pixel::{Picture, mirrors};
use super::super::view::FrameBearings;
use super::{Definition, Turn};
use crate::number::{Bounded, DoubleDouble, Expression, Real};
use crate::scene::Scene;
use crate::stage::Stage;

/// Points all around the circle, α = 0 first.
pub(super) const TURNS: [Turn; 8] = [
    Turn(0, 1, 1),
    Turn(1, 0, 1),
    Turn(0, -1, 1),
    Turn(3, 4, 5),
    Turn(-5, 12, 13),
    Turn(8, 15, 17),
    Turn(20, -21, 29),
    Turn(-24, -7, 25),
];

/// The stages that show the scene; the seventh is the sixth at another angle.
const STAGES: [Stage; 5] = [
    Stage::Spheres,
    Stage::Tetrahedron,
    Stage::Shading,
    Stage::Shadow,
    Stage::Reflection,
];

/// A frame, as the tracer has it in any kind of number.
struct Traced<'a> {
    scene: &'a Scene,
    stage: Stage,
    turn: Turn,
    size: u32,
}

impl Traced<'_> {
    fn frame<R: Real>(&self) -> Frame<R> {
        let Turn(sin, cos, one) = self.turn;
        let fraction = |x| match one {
            1 => R::exact(f64::from(x)),
            _ => R::exact(f64::from(x)) / R::exact(f64::from(one)),
        };
        let [sin, cos] = [sin, cos].map(fraction);
        Frame::new(sin, cos, self.size)
    }

    fn bearings<'f>(&self, arena: &'f Bump) -> FrameBearings<'f> {
        Expression::session(|| {
            let frame = self.frame::<Expression>();
            let bearings = |mirrored| frame.bearings(self.scene, mirrored, arena);
            let Ok(bearings) = FrameBearings::decide(mirrors(self.scene, self.stage), bearings);
            bearings
        })
    }

    /// What is decided for each pixel; `None` where that is left in doubt.
    fn decisions<R: Real>(&self, bearings: &FrameBearings<'_>, pixels: &[(u32, u32)]) -> Decisions {
        let arena = Bump::new();
        let extents = Extents::new(self.scene, &self.frame(), self.size, &arena);
        let picture = Picture::<R>::new(
            self.scene,
            self.stage,
            &self.frame(),
            self.size,
            bearings,
            &extents,
            &&arena,
        );
        let decision = |&(column, row): &(u32, u32)| {
            let (decision, _) = picture.decide(column, row).ok()?;
            Some(decision)
        };
        pixels.iter().map(decision).collect()
    }
}

type Decisions = Vec<Option<Decision>>;

/// What rationals decide, and how many of the pixels double-doubles and f64s with a bound leave in
/// doubt.
pub(super) struct Compared {
    pub(super) decisions: Vec<Decision>,
    in_doubt: [usize; 2],
}

/// Decides pixels in rationals, in every kind of number, and at α = 0 by the kernels `reference`
/// and `exact` themselves.
pub(super) fn compare(
    scene: &Scene,
    stage: Stage,
    turn: Turn,
    size: u32,
    pixels: &[(u32, u32)],
) -> Compared {
    let definition = Definition::new(scene, stage, turn, size);
    let traced = Traced {
        scene,
        stage,
        turn,
        size,
    };
    let arenas = [Arena::default(), Arena::default(), Arena::default()];
    let bearings = traced.bearings(&arenas[2].frame);
    let kernels: Vec<_> = [Rung::DoubleDouble, Rung::Double]
        .into_iter()
        .filter(|_| turn == TURNS[0])
        .zip(&arenas)
        .map(|(lowest, arena)| Ladder::new(scene, stage, 0.0, size, lowest, arena))
        .collect();
    // Each chunk has one session of expressions.
    let chunks = pixels.chunks(64).map(|pixels| {
        let expected = pixels
            .iter()
            .map(|&(column, row)| definition.decision(column, row));
        let expected: Vec<Decision> = expected.collect();
        let check = |what, decisions: Decisions| {
            for ((pixel, expected), got) in pixels.iter().zip(&expected).zip(&decisions) {
                assert!(
                    got.is_none_or(|got| got == *expected),
                    "{what}: {got:?} instead of {expected:?} at {pixel:?} of {size}, stage {stage}, \
                     {turn:?}"
                );
            }
            decisions.iter().filter(|got| got.is_none()).count()
        };
        let never = Expression::session(|| traced.decisions::<Expression>(&bearings, pixels));
        assert_eq!(check("expression", never), 0);
        for kernel in &kernels {
            let by_kernel = pixels.iter().map(|&(column, row)| kernel.pixel(column, row));
            check("kernel", by_kernel.map(|((decision, _), _)| Some(decision)).collect());
        }
        let in_doubt = [
            check("double-double", traced.decisions::<DoubleDouble>(&bearings, pixels)),
            check("bounded f64", traced.decisions::<Bounded>(&bearings, pixels)),
        ];
        (expected, in_doubt)
    });
    let chunks: Vec<_> = chunks.collect();
    Compared {
        in_doubt: [0, 1].map(|number| chunks.iter().map(|(_, doubts)| doubts[number]).sum()),
        decisions: chunks
            .into_iter()
            .flat_map(|(decisions, _)| decisions)
            .collect(),
    }
}

/// Compares a whole picture, rows from the bottom.
pub(super) fn compare_whole(scene: &Scene, stage: Stage, turn: Turn, size: u32) -> Compared {
    let pixels: Vec<_> = (0..size * size).map(|i| (i % size, i / size)).collect();
    compare(scene, stage, turn, size, &pixels)
}

/// The same of a picture of which double-doubles, and f64s, may leave at most so many pixels in
/// doubt.
fn compare_easy(scene: &Scene, stage: Stage, turn: Turn, size: u32, most: [usize; 2]) {
    let Compared { in_doubt, .. } = compare_whole(scene, stage, turn, size);
    assert!(
        in_doubt[0] <= most[0] && in_doubt[1] <= most[1],
        "{in_doubt:?} in doubt in stage {stage}, {turn:?}"
    );
}

#[test]
fn built_in_scene_in_every_stage() {
    for stage in STAGES {
        // Samples on edges are more than f64s can tell, and so is the surface's border. Five more
        // than double-doubles can.
        let most = if stage >= Stage::Shadow {
            [5, 76]
        } else {
            [0, 5]
        };
        for size in [32, 64] {
            compare_easy(&Scene::builtin(), stage, TURNS[0], size, most);
        }
    }
}

#[test]
fn built_in_scene_all_around() {
    for turn in TURNS {
        for stage in STAGES {
            let size = if stage == Stage::Reflection { 40 } else { 16 };
            compare_easy(&Scene::builtin(), stage, turn, size, [1, 1]);
        }
    }
}

#[test]
fn ties_of_the_built_in_scene() {
    // The mirrored silhouette of the first sphere goes through the sample in the middle of these.
    let scene = Scene::builtin();
    let silhouette: Vec<_> = (245..265).map(|column| (column, 202)).collect();
    let row = compare(&scene, Stage::Reflection, TURNS[0], 500, &silhouette);
    assert!(matches!(row.decisions[10], Decision::Mirrored(seen) if seen.solid == 0));
    assert_eq!(row.decisions[11], Decision::Surface);

    // The surface's left, right and front border lie on samples of this size: |x| = |z| = 11/16.
    let front = (79..434).map(|column| (column, 152));
    let sides = (151..255).flat_map(|row| [79, 80, 81, 431, 432, 433].map(|column| (column, row)));
    let border: Vec<_> = front.chain(sides).collect();
    let border = compare(&scene, Stage::Shadow, TURNS[0], 512, &border).decisions;
    assert_eq!(border[..2], [Decision::Background, Decision::Surface]);
    assert_eq!(border[353..355], [Decision::Surface, Decision::Background]);
}

#[test]
fn a_face_along_the_light_needs_no_digits() {
    let scene = Scene::from_toml(
        r#"
        light = { direction = [-0.75, -1.0, 0.0] }
        [[tetrahedron]]
        vertices = [[0.0, -0.5, 0.5], [0.75, 0.5, 0.5], [-0.75, 0.5, 0.5], [0.0, 0.0, -0.5]]
        color = [1.0, 0.5, 0.25]
        "#,
    )
    .unwrap();
    for lowest in [Rung::DoubleDouble, Rung::Double] {
        for stage in [Stage::Shading, Stage::Shadow] {
            let arena = Arena::default();
            let kernel = Ladder::new(&scene, stage, 0.3, 40, lowest, &arena);
            let pixels = (0..1600).map(|i| kernel.pixel(i % 40, i / 40));
            let mut solid = 0;
            for ((decision, _), rung) in pixels {
                solid += usize::from(matches!(decision, Decision::Solid(_)));
                assert_ne!(rung, Rung::Arbitrary, "{stage}");
            }
            assert!(solid > 200, "{solid}");
        }
    }
}
