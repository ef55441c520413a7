//! Promise: the same bytes everywhere. A checksum for each kernel and stage, made once, holds on
//! every machine, at every number of threads, in debug and release, on every architecture.

use firsthit::camera::{ROUND, frame_angle};
use firsthit::tracer::{Decision, Simd};
use firsthit::{Image, Kernel, Scene, Stage, Tracer};

use crate::helpers::{Random, hard_scene, hard_scenes, same_bits, trace, trace_with_decisions};

const SIZE: u32 = 125;

/// FNV-1a over the samples' bytes, least significant first.
fn checksum(image: &Image) -> u64 {
    let bytes = image
        .samples()
        .iter()
        .flat_map(|sample| sample.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

fn picture(kernel: Kernel, stage: Stage, frame: u64) -> u64 {
    let alpha = frame_angle(frame);
    checksum(&trace(kernel, &Scene::builtin(), stage, alpha, SIZE))
}

/// The stages of the built-in scene as the picture's definition has them, at frame 0; then stage 6
/// at frames 3, 10 and 17.
const TRUE_PICTURES: [(Stage, u64, u64); 10] = [
    (Stage::Image, 0, 0x47ae_6df5_9afb_3219),
    (Stage::Spheres, 0, 0xd1e0_98b3_224c_8fb7),
    (Stage::Tetrahedron, 0, 0x93ba_9595_b23e_ff9e),
    (Stage::Shading, 0, 0x8ebc_7fab_ed27_401b),
    (Stage::Shadow, 0, 0x7154_abed_7a4a_ebd5),
    (Stage::Reflection, 0, 0x8f57_a9f3_0a2e_fe64),
    (Stage::Animation, 0, 0x8f57_a9f3_0a2e_fe64),
    (Stage::Reflection, 3, 0x01dc_1d75_bdfb_c395),
    (Stage::Reflection, 10, 0x5071_0d54_fc11_f2be),
    (Stage::Reflection, 17, 0x0bf1_cc6c_6a2a_ee7a),
];

#[test]
fn the_true_pictures() {
    for kernel in [Kernel::Exact, Kernel::Reference] {
        for (stage, frame, expected) in TRUE_PICTURES {
            let got = picture(kernel, stage, frame);
            assert_eq!(
                got,
                expected,
                "{} stage {stage} frame {frame}: {got:#018x}",
                kernel.name()
            );
        }
    }
}

/// The kernels that may be wrong are wrong in the same way everywhere: stage 6 at frame 3.
const OTHER_PICTURES: [(Kernel, u64); 3] = [
    (Kernel::Fast, 0x3dd0_8d66_ba53_9bf7),
    (Kernel::Listing, 0x76fc_b264_a4f3_034b),
    (Kernel::Double, 0x01dc_1d75_bdfb_c395),
];

#[test]
fn the_other_kernels() {
    for (kernel, expected) in OTHER_PICTURES {
        let got = picture(kernel, Stage::Reflection, 3);
        assert_eq!(got, expected, "{}: {got:#018x}", kernel.name());
    }
}

/// Whole, traced over another frame, and with what was decided.
#[test]
fn any_number_of_threads() {
    // Eleven bands of rows, the last of them not whole: more than there are threads.
    const SIZE: u32 = 83;
    const THREADS: [usize; 5] = [1, 2, 3, 5, 8];
    let scene = Scene::builtin();
    for kernel in Kernel::ALL {
        let mut tracers = THREADS.map(|threads| Tracer::new(kernel, threads).unwrap());
        let mut retained = vec![Image::new(SIZE).unwrap(); tracers.len()];
        let mut whole = Image::new(SIZE).unwrap();
        for (stage, frame, _) in TRUE_PICTURES {
            let alpha = frame_angle(frame);
            let (expected, decisions) = trace_with_decisions(kernel, &scene, stage, alpha, SIZE);
            for (tracer, (threads, retained)) in
                tracers.iter_mut().zip(THREADS.iter().zip(&mut retained))
            {
                tracer.retrace(&scene, stage, alpha, retained).unwrap();
                tracer.trace(&scene, stage, alpha, &mut whole).unwrap();
                let same = same_bits(retained, &expected) && same_bits(&whole, &expected);
                let decided = tracer.trace_with_decisions(&scene, stage, alpha, &mut whole);
                let same = same && same_bits(&whole, &expected) && decided.unwrap() == decisions;
                let kernel = kernel.name();
                assert!(
                    same,
                    "{kernel} stage {stage} frame {frame}, {threads} threads"
                );
            }
        }
    }
}

/// A frame and its decisions, at a size at which every border meets pixels of the hard
/// scenes.
fn with_simd(
    simd: Simd,
    kernel: Kernel,
    scene: &Scene,
    stage: Stage,
    alpha: f64,
) -> (Image, Vec<Decision>) {
    let mut image = Image::new(96).unwrap();
    let mut tracer = Tracer::new(kernel, 1).unwrap().with_simd(simd);
    let decisions = tracer
        .trace_with_decisions(scene, stage, alpha, &mut image)
        .unwrap();
    (image, decisions)
}

#[test]
fn any_vector_instructions() {
    let levels = Simd::all();
    eprintln!("vector instructions here: {levels:?}");
    let is_same = |one: &(Image, Vec<Decision>), other: &(Image, Vec<Decision>)| {
        same_bits(&one.0, &other.0) && one.1 == other.1
    };
    let scenes = hard_scenes().into_iter().map(|name| hard_scene(&name));
    for scene in scenes.chain([Scene::builtin()]) {
        for stage in [Stage::Shading, Stage::Reflection] {
            for alpha in [0.0, 0.9] {
                for kernel in [Kernel::Exact, Kernel::Fast, Kernel::Double] {
                    let all = levels
                        .iter()
                        .map(|&simd| with_simd(simd, kernel, &scene, stage, alpha));
                    let all: Vec<_> = all.collect();
                    assert!(
                        all.windows(2).all(|two| is_same(&two[0], &two[1])),
                        "{} {stage} {alpha}",
                        kernel.name()
                    );
                }
            }
        }
    }
}

#[test]
fn few_pixels_of_a_round_are_in_doubt() {
    let mut tracer = Tracer::new(Kernel::Exact, 0).unwrap();
    let mut image = Image::new(500).unwrap();
    let (mut double_double, mut arbitrary) = (0, 0);
    for frame in 0..ROUND {
        let alpha = frame_angle(frame);
        tracer
            .trace(&Scene::builtin(), Stage::Reflection, alpha, &mut image)
            .unwrap();
        double_double += tracer.tally().double_double;
        arbitrary += tracer.tally().arbitrary;
    }
    eprintln!("{double_double} pixels by double-doubles, {arbitrary} by arbitrary precision");
    assert!(double_double + arbitrary <= 20 && arbitrary <= 2);
}

#[test]
fn what_is_traced_over_another_frame_is_what_is_traced_whole() {
    let scenes = [
        "resting_spheres",
        "crowd",
        "light_from_below",
        "shared_faces",
    ]
    .map(hard_scene);
    let kernels = [
        (Kernel::Exact, 1),
        (Kernel::Exact, 3),
        (Kernel::Fast, 1),
        (Kernel::Double, 2),
    ];
    let mut tracers = kernels.map(|(kernel, threads)| Tracer::new(kernel, threads).unwrap());
    // Two pictures of two sizes, which the tracers take turns with; now and then somebody else
    // writes into one.
    let mut retained = [61, 96].map(|size| Image::new(size).unwrap());
    let mut whole = retained.clone();
    let mut random = Random::new();
    let mut choose = |count| random.below(count);
    for step in 0..3000 {
        let tracer = &mut tracers[if step % 3 == 0 { choose(4) } else { 0 }];
        let scene = &scenes[if step % 5 == 0 { choose(4) } else { 0 }];
        let stage = Stage::from_number([6, 6, 6, choose(7) as u8 + 1][choose(4)]).unwrap();
        let alpha = frame_angle(step) + [0.0, 0.01][choose(2)];
        let size = choose(2);
        if choose(20) == 0 {
            retained[size].samples_mut()[choose(3 * 61 * 61)] = 7.0;
        }
        tracer
            .retrace(scene, stage, alpha, &mut retained[size])
            .unwrap();
        tracer.trace(scene, stage, alpha, &mut whole[size]).unwrap();
        let same = same_bits(&retained[size], &whole[size]);
        assert!(same, "step {step}");
    }
}

/// From N = 1673 on, whole pictures are written past the caches.
#[test]
fn a_picture_too_large_for_caches_has_the_same_bytes() {
    for size in [1672, 1673, 1675, 1700] {
        let mut images = [0; 3].map(|_| Image::new(size).unwrap());
        let [retained, whole, shared] = &mut images;
        let scene = Scene::builtin();
        let mut tracers = [1, 3].map(|threads| Tracer::new(Kernel::Exact, threads).unwrap());
        for alpha in [0.3, 0.9] {
            tracers[0]
                .retrace(&scene, Stage::Reflection, alpha, retained)
                .unwrap();
            for (tracer, image) in tracers.iter_mut().zip([&mut *whole, &mut *shared]) {
                tracer
                    .trace(&scene, Stage::Reflection, alpha, image)
                    .unwrap();
            }
            let same = same_bits(whole, retained) && same_bits(shared, retained);
            assert!(same, "{size}");
        }
    }
}

/// One sphere, of which nothing but the shading changes.
#[test]
fn the_rows_of_a_sphere_in_another_light_are_told() {
    let scenes = [-0.5, 0.5].map(|light| {
        let text = format!(
            "light.direction = [{light}, -0.5, -0.5]\n\n[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = 0.25\ncolor = [0.9, 0.25, 0.2]\n"
        );
        Scene::from_toml(&text).unwrap()
    });
    for kernel in [Kernel::Exact, Kernel::Fast, Kernel::Double] {
        let mut tracer = Tracer::new(kernel, 1).unwrap();
        let mut image = Image::new(SIZE).unwrap();
        let mut retrace = |scene| {
            let before = image.clone();
            let rows = tracer.retrace(scene, Stage::Shading, 0.0, &mut image);
            let lines = |image: &Image| {
                image
                    .samples()
                    .chunks(3 * SIZE as usize)
                    .map(<[f32]>::to_vec)
                    .collect::<Vec<_>>()
            };
            let (before, after) = (lines(&before), lines(&image));
            let changed = |row: &u32| before[*row as usize] != after[*row as usize];
            let changed: Vec<_> = (0..SIZE).filter(changed).collect();
            (rows.unwrap(), changed)
        };
        assert_eq!(retrace(&scenes[0]).0, 0..SIZE);
        let (rows, changed) = retrace(&scenes[1]);
        assert!(changed.len() > 20 && changed.iter().all(|row| rows.contains(row)));
        // The sphere is a quarter as high as the picture, and nothing else is written.
        assert!(rows.len() < 40, "{rows:?}");
    }
}
