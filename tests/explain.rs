//! Promise: an explanation is of the pixel that is traced, with every kernel, in every stage.

use firsthit::tracer::{Decision, TraceError};
use firsthit::{Kernel, Scene, Stage, Tracer};

use crate::helpers::{
    compiled, failed, line, printed, program, says_what_is_shown, succeeded, trace_with_decisions,
};

const SIZE: u32 = 48;

#[test]
fn it_ends_in_the_samples_and_bytes_of_the_picture() {
    let scene = Scene::builtin();
    for kernel in [
        Kernel::Exact,
        Kernel::Fast,
        Kernel::Double,
        Kernel::Reference,
    ] {
        let tracer = Tracer::new(kernel, 1).unwrap();
        for stage in Stage::ALL {
            let (image, decisions) = trace_with_decisions(kernel, &scene, stage, 0.6, SIZE);
            for index in (0..SIZE * SIZE).step_by(7) {
                let pixel = (index % SIZE, index / SIZE);
                let text = tracer.explain(&scene, stage, 0.6, SIZE, pixel).unwrap();
                let shown = (
                    decisions[index as usize],
                    image.pixel(pixel.0, pixel.1).unwrap(),
                );
                says_what_is_shown(&text, (&scene, stage), shown);
            }
        }
    }
}

#[test]
fn it_tells_the_arithmetic_that_decided() {
    let scene = Scene::builtin();
    let by = |kernel, pixel| {
        let tracer = Tracer::new(kernel, 1).unwrap();
        line(
            &tracer
                .explain(&scene, Stage::Reflection, 0.0, 500, pixel)
                .unwrap(),
            "decided by",
        )
        .unwrap()
        .to_owned()
    };
    assert!(by(Kernel::Exact, (0, 0)).starts_with("f64 with a bound"));
    assert!(
        by(Kernel::Exact, (255, 202)).starts_with("f64 with a bound"),
        "the mirrored silhouette touches here, which f64 computes without rounding"
    );
    assert!(by(Kernel::Reference, (0, 0)).starts_with("double-doubles"));
    assert!(by(Kernel::Fast, (0, 0)).starts_with("f32"));
}

#[test]
fn a_pixel_outside_of_the_picture_is_refused() {
    let tracer = Tracer::new(Kernel::Exact, 1).unwrap();
    for pixel in [(SIZE, 0), (0, SIZE), (u32::MAX, u32::MAX)] {
        let refused = tracer.explain(&Scene::builtin(), Stage::Reflection, 0.0, SIZE, pixel);
        assert!(matches!(refused, Err(TraceError::Pixel { .. })));
    }
}

#[test]
fn the_command_prints_it() {
    let folder = tempfile::tempdir().unwrap();
    let line = "explain 20 30 --stage 6 --frame 2 --size 48 --kernel double";
    let tracer = Tracer::new(Kernel::Double, 1).unwrap();
    let text = tracer
        .explain(&Scene::builtin(), Stage::Reflection, 0.6, 48, (20, 30))
        .unwrap();
    assert_eq!(printed(&folder, line), text);

    for (line, status) in [
        ("explain 20 48 --stage 6 --size 48", 1),
        ("explain -1 0 --stage 6", 2),
        ("explain 1 --stage 6", 2),
        ("explain 1 1", 2),
        ("explain 1 1 --stage 6 --tolerance 0.1", 2),
        ("explain 1 1 --stage 6 --program true --tolerance -1", 2),
        ("explain 1 1 --stage 6 --program true", 1),
    ] {
        let refused = program(&folder, line).output().unwrap();
        failed(&refused, status, line);
        assert!(refused.stdout.is_empty(), "{line}");
    }
}

#[test]
fn the_pixel_of_another_program_is_told_what_it_shows() {
    let folder = tempfile::tempdir().unwrap();
    let Some(command) = compiled("correct.c") else {
        return;
    };
    let (scene, stage) = (Scene::builtin(), Stage::Shadow);
    let (_, decisions) = trace_with_decisions(Kernel::Exact, &scene, stage, 0.3, 200);
    let in_shadow = decisions
        .iter()
        .position(|&decision| decision == Decision::SurfaceInShadow);
    let index = in_shadow.unwrap() as u32;
    let (column, row) = (index % 200, index / 200);
    let tracer = Tracer::new(Kernel::Exact, 1).unwrap();
    let explanation = tracer
        .explain(&scene, stage, 0.3, 200, (column, row))
        .unwrap();
    let line = format!("explain {column} {row} --stage 5 --alpha 0.3 --size 200");
    let explain = |more: &[&str]| {
        let mut explain = program(&folder, &line);
        let command = format!("{command} SHADOW_DIRECTION");
        explain.args(["--program", &command]).args(more);
        let text = succeeded(&explain.output().unwrap(), &line);
        text.strip_suffix(&explanation).unwrap().to_owned()
    };
    assert_eq!(
        explain(&[]),
        "yours        0.5 0.5 0.5  (bytes 128 128 128)\n\
         ours         0.3 0.3 0.3  (bytes 76 76 76)\n\
         apart        6710886 6710886 6710886 f32 steps, 52 52 52 bytes\n\
         verdict      shows the surface lit, where it is in shadow\n\
         hint         shadows fall to the wrong side: shadow rays go toward the light\n"
    );
    let verdict = "verdict      is right but for rounding: within 0.25\n";
    assert!(explain(&["--tolerance", "0.25"]).ends_with(verdict));
}

#[test]
fn threads_share_a_tracer() {
    let (scene, tracer) = (Scene::builtin(), Tracer::new(Kernel::Exact, 1).unwrap());
    let explain = || tracer.explain(&scene, Stage::Animation, 0.3, 60, (30, 20));
    std::thread::scope(|threads| {
        let other = threads.spawn(explain);
        assert_eq!(explain().unwrap(), other.join().unwrap().unwrap());
    });
}
