//! Promise: on one thread a frame asks the system for no memory, once the tracer has seen frames
//! like it.
#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use allocation_counter::measure;
use firsthit::{Image, Kernel, Scene, Stage, Tracer, camera};

/// How often each of the first frames of an animation allocates: when it is the first of all, and
/// when all have been traced twice.
fn allocations(
    scene: &Scene,
    (stage, kernel): (Stage, Kernel),
    (size, frames): (u32, u64),
    retained: bool,
) -> (u64, Vec<u64>) {
    let mut tracer = Tracer::new(kernel, 1).unwrap();
    let mut image = Image::new(size).unwrap();
    let mut frame = |number| {
        let alpha = camera::frame_angle(number);
        let measured = measure(|| {
            if retained {
                tracer.retrace(scene, stage, alpha, &mut image).unwrap();
            } else {
                tracer.trace(scene, stage, alpha, &mut image).unwrap();
            }
        });
        measured.count_total
    };
    let first = frame(0);
    for number in (0..2 * frames).chain(0..1) {
        frame(number);
    }
    (first, (0..frames).map(frame).collect())
}

#[test]
fn a_frame_allocates_nothing() {
    let crowd = Scene::from_toml(include_str!("scenes/crowd.toml")).unwrap();
    let check =
        |(name, scene): (&str, &Scene), of: (Stage, Kernel), extent: (u32, u64), retained| {
            let (first, counts) = allocations(scene, of, extent, retained);
            assert!(first > 0, "{name}, {of:?}: nothing is counted");
            let (size, frames) = extent;
            let none = vec![0; frames as usize];
            assert_eq!(counts, none, "{name}, {of:?}, N = {size}, {retained}");
        };
    let builtin = Scene::builtin();
    for scene in [("built-in", &builtin), ("crowd", &crowd)] {
        for kernel in [Kernel::Exact, Kernel::Fast, Kernel::Double] {
            // The reflection is traced as the animation is.
            for stage in Stage::ALL
                .into_iter()
                .filter(|&stage| stage != Stage::Reflection)
            {
                for retained in [false, true] {
                    check(scene, (stage, kernel), (50, camera::ROUND), retained);
                }
            }
        }
    }
    // Rows that are streamed past the caches, from N = 1673 on, lie in a buffer first.
    check(
        ("built-in", &builtin),
        (Stage::Animation, Kernel::Exact),
        (1700, 3),
        false,
    );
}
