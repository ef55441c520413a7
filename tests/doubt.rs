//! Promise: f64s and double-doubles leave few pixels in doubt, also where a scene has ties.

use firsthit::tracer::{Decision, Tally};
use firsthit::{Image, Kernel, Scene, Stage, Tracer};

fn trace(
    kernel: Kernel,
    scene: &Scene,
    stage: Stage,
    alpha: f64,
    size: u32,
) -> (Vec<Decision>, Tally) {
    let (mut tracer, mut image) = (Tracer::new(kernel, 1).unwrap(), Image::new(size).unwrap());
    let decisions = tracer.trace_with_decisions(scene, stage, alpha, &mut image);
    (decisions.unwrap(), tracer.tally())
}

#[test]
fn few_pixels_of_the_built_in_scene_are_in_doubt() {
    for stage in [
        Stage::Spheres,
        Stage::Tetrahedron,
        Stage::Shading,
        Stage::Shadow,
        Stage::Reflection,
    ] {
        for size in [32, 64] {
            let tally = |kernel| trace(kernel, &Scene::builtin(), stage, 0.0, size).1;
            let exact = tally(Kernel::Exact);
            assert_eq!((exact.double_double, exact.arbitrary), (0, 0), "{stage}");
            // A row shows the background on both sides at least where a solid is.
            assert!(exact.spans > size.into() && exact.edges > 0, "{stage}");
            // Samples on edges and on the surface's border are more than double-doubles can tell.
            let most = if stage >= Stage::Shadow { 5 } else { 0 };
            assert!(tally(Kernel::Reference).arbitrary <= most, "{stage}");
        }
    }
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
    for kernel in [Kernel::Reference, Kernel::Exact] {
        for stage in [Stage::Shading, Stage::Shadow] {
            let (decisions, tally) = trace(kernel, &scene, stage, 0.3, 40);
            let is_solid = |decision: &&Decision| matches!(decision, Decision::Solid(_));
            assert!(decisions.iter().filter(is_solid).count() > 200);
            assert_eq!(tally.arbitrary, 0, "{stage}");
        }
    }
}
