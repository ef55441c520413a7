//! Promise: every stage shows what the picture's definition says, pixel by pixel.

use firsthit::camera::{ROUND, frame_angle};
use firsthit::tracer::Decision;
use firsthit::{Image, Kernel, Scene, Stage, Tracer};

use crate::helpers::{on_all_cores, same_bits, trace, trace_with_decisions};
use crate::oracle::Oracle;

/// The kernels that promise to be right, and double, which these scenes are not hard enough for.
const KERNELS: [Kernel; 3] = [Kernel::Exact, Kernel::Reference, Kernel::Double];

/// A kernel, and what it traced and decided.
type Frame = (Kernel, (Image, Vec<Decision>));

/// Traces a frame of each of some stages with each kernel and compares every pixel's decision and
/// every sample with the oracle's. Returns the frames.
fn compare<const COUNT: usize>(
    scene: &Scene,
    stages: [Stage; COUNT],
    alpha: f64,
    size: u32,
) -> [[Frame; KERNELS.len()]; COUNT] {
    let frames = stages.map(|stage| {
        KERNELS.map(|kernel| {
            (
                kernel,
                trace_with_decisions(kernel, scene, stage, alpha, size),
            )
        })
    });
    let oracle = Oracle::new(scene, alpha, size, 256);
    let wrong_at = |column: u32, row: u32| {
        let expected = oracle.pixel_in_stages(stages, column, row);
        let each_stage = stages.into_iter().zip(&frames).zip(expected);
        let wrong = each_stage.flat_map(|((stage, frames), (decision, color))| {
            let wrong = frames.iter().filter_map(move |(kernel, (image, decisions))| {
                let decided = decisions[(row * size + column) as usize];
                let got = image.pixel(column, row).unwrap();
                let same = decided == decision && got.map(f32::to_bits) == color.map(f32::to_bits);
                (!same).then(|| {
                    format!(
                        "{} in stage {stage} at ({column}, {row}): {decided:?} {got:?} instead of {decision:?} {color:?}",
                        kernel.name()
                    )
                })
            });
            wrong.take(1)
        });
        wrong.collect::<Vec<String>>()
    };
    let wrong = on_all_cores(0..size, |row| {
        let wrong = (0..size).flat_map(|column| wrong_at(column, row));
        wrong.collect::<Vec<String>>()
    });
    let wrong = wrong.concat();
    assert!(
        wrong.is_empty(),
        "α = {alpha}, N = {size}: {} pixels wrong, the first by {}",
        wrong.len(),
        wrong[0]
    );
    frames
}

/// The same in every stage.
fn compare_all(scene: &Scene, alpha: f64, size: u32) {
    // The animation is the reflection at one angle after another, and that is compared.
    let [stages @ .., _] = Stage::ALL;
    assert_eq!(stages.last(), Some(&Stage::Reflection));
    let [.., reflections] = compare(scene, stages, alpha, size);
    for (kernel, reflection) in reflections {
        let animation = trace_with_decisions(kernel, scene, Stage::Animation, alpha, size);
        let same = same_bits(&animation.0, &reflection.0) && animation.1 == reflection.1;
        assert!(same, "{}, α = {alpha}, N = {size}", kernel.name());
    }
}

#[test]
fn every_stage_at_full_size() {
    compare_all(&Scene::builtin(), 0.0, 500);
}

#[test]
fn every_stage_all_around() {
    for frame in 0..ROUND {
        // Odd, even, and small: the round takes every size with every stage.
        let size = [33, 40, 27][frame as usize % 3];
        compare_all(&Scene::builtin(), frame_angle(frame), size);
    }
}

#[test]
fn angles_of_any_size_and_sign() {
    for alpha in [-0.75, 0.001, 1e22, -1.7e308] {
        let stages = [Stage::Spheres, Stage::Tetrahedron, Stage::Reflection];
        compare(&Scene::builtin(), stages, alpha, 32);
    }
}

#[test]
fn other_scenes() {
    // Overlapping solids, a light from below the surface, solids below it, a vertex order of the
    // other hand.
    let scene = Scene::from_toml(
        r#"
        background = [0.1, 0.2, 0.3]
        surface = { height = -0.25, half_width = 0.75, color = [0.4, 0.5, 0.6], reflectance = 0.75 }
        light = { direction = [0.3, 1.0, -0.4], intensity = [1.0, 0.9, 0.8] }
        material = { exponent = 7 }
        [[sphere]]
        center = [0.0, 0.0, 0.0]
        radius = 0.375
        color = [0.9, 0.9, 0.9]
        [[sphere]]
        center = [0.25, 0.125, 0.125]
        radius = 0.25
        color = [0.5, 0.1, 0.9]
        [[sphere]]
        center = [-0.5, -0.75, 0.25]
        radius = 0.25
        color = [0.1, 0.9, 0.2]
        [[tetrahedron]]
        vertices = [[0.5625, -0.125, 0.25], [0.125, -0.25, 0.5625], [0.125, -0.5, 0.0], [-0.28125, 0.5, 0.28125]]
        color = [0.2, 0.45, 0.95]
        "#,
    )
    .unwrap();
    for alpha in [0.0, 0.5, 2.0, 4.0] {
        compare_all(&scene, alpha, 41);
    }
    compare_all(&Scene::from_toml("").unwrap(), 0.3, 8);
}

#[test]
fn quadrants_pixel_by_pixel() {
    for size in [500, 501, 7, 2, 1] {
        let image = trace(Kernel::Exact, &Scene::builtin(), Stage::Image, 0.0, size);
        for row in 0..size {
            for column in 0..size {
                // Left and lower quadrants own the line through the middle, which only an even size
                // has.
                let (left, low) = (2 * column <= size, 2 * row <= size);
                let expected = match (left, low) {
                    (true, true) => [0.3f32, 0.3, 0.0],
                    (true, false) => [0.0, 0.3, 0.3],
                    (false, true) => [0.3, 0.0, 0.3],
                    (false, false) => [0.0, 0.0, 0.0],
                };
                assert_eq!(
                    image.pixel(column, row),
                    Some(expected),
                    "({column}, {row}) of {size}"
                );
            }
        }
    }
}

#[test]
fn an_angle_that_is_none_is_refused() {
    let mut tracer = Tracer::new(Kernel::Exact, 1).unwrap();
    for alpha in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut image = Image::new(4).unwrap();
        assert!(
            tracer
                .trace(&Scene::builtin(), Stage::Reflection, alpha, &mut image)
                .is_err()
        );
        assert!(image.samples().iter().all(|&sample| sample == 0.0));
    }
}

#[test]
fn a_tracer_says_how_far_it_is() {
    let mut image = Image::new(64).unwrap();
    for threads in [1, 2] {
        for kernel in Kernel::ALL {
            let mut tracer = Tracer::new(kernel, threads).unwrap();
            let progress = tracer.progress();
            assert_eq!(progress.rows(), 0);
            for _ in 0..2 {
                tracer
                    .trace(&Scene::builtin(), Stage::Reflection, 0.0, &mut image)
                    .unwrap();
                assert_eq!(progress.rows(), 64, "{}", kernel.name());
            }
        }
    }
}
