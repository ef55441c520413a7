//! Promise: a picture with a known mistake earns the hint at it, and no picture earns another one.

#[cfg(feature = "program")]
use std::time::Duration;

use firsthit::diagnosis::{Examination, Hint, TOLERANCE};
#[cfg(feature = "program")]
use firsthit::program::Program;
use firsthit::{Image, Kernel, Scene, Stage};

#[cfg(feature = "program")]
use crate::helpers::compiled;
use crate::helpers::{Random, hard_scene, hard_scenes, trace};

fn hints(scene: &Scene, stage: Stage, alpha: f64, image: &Image) -> Vec<Hint> {
    let examination = Examination::new(scene, stage, alpha, image, TOLERANCE, 1).unwrap();
    examination.hints(&examination.diagnosis().unwrap())
}

const ANGLES: [f64; 4] = [0.0, 0.6, 2.1, -4.2];

#[test]
fn a_kernel_earns_none_but_for_what_the_document_gets_wrong() {
    let scene = Scene::builtin();
    // The pictures of reference are those of exact, bit for bit.
    for kernel in [Kernel::Exact, Kernel::Fast, Kernel::Double, Kernel::Listing] {
        for stage in Stage::ALL {
            for alpha in ANGLES {
                let image = trace(kernel, &scene, stage, alpha, 100);
                let earned = hints(&scene, stage, alpha, &image);
                // The document hands equation 4-1 the way the light travels for l.
                let of_document = kernel == Kernel::Listing && stage >= Stage::Shading;
                if of_document && alpha == 0.0 {
                    assert_eq!(earned, [Hint::LightSign], "{stage}");
                } else if earned != [Hint::LightSign] || !of_document {
                    assert_eq!(earned, [], "{kernel:?}, {stage}, {alpha}");
                }
            }
        }
    }
    for name in hard_scenes() {
        let scene = hard_scene(&name);
        for alpha in ANGLES {
            let image = trace(Kernel::Fast, &scene, Stage::Reflection, alpha, 50);
            let earned = hints(&scene, Stage::Reflection, alpha, &image);
            assert_eq!(earned, [], "{name}, {alpha}");
        }
    }
}

#[test]
fn noise_earns_none() {
    let (scene, mut random) = (Scene::builtin(), Random::new());
    for amplitude in [1e-5, 1.0 / 256.0, 1.0 / 100.0, 0.5] {
        for stage in Stage::ALL {
            let mut image = trace(Kernel::Exact, &scene, stage, 0.6, 80);
            for sample in image.samples_mut() {
                *sample += (amplitude * (2.0 * random.fraction() - 1.0)) as f32;
            }
            let earned = hints(&scene, stage, 0.6, &image);
            assert_eq!(earned, [], "{amplitude}, {stage}");
        }
    }
    for wild in [f32::NAN, f32::INFINITY, f32::MIN] {
        let mut image = Image::new(80).unwrap();
        image.samples_mut().fill(wild);
        assert_eq!(hints(&scene, Stage::Reflection, 0.6, &image), []);
    }
}

/// The picture whose samples at a column, a row and a channel are those.
fn picture(size: usize, sample: impl Fn(usize, usize, usize) -> f32) -> Image {
    let mut image = Image::new(size as u32).unwrap();
    for (index, place) in image.samples_mut().iter_mut().enumerate() {
        *place = sample(index / 3 % size, index / 3 / size, index % 3);
    }
    image
}

#[test]
fn a_picture_that_is_made_otherwise_of_the_true_one_earns_its_hint() {
    const SIZE: usize = 90;
    let (scene, stage, alpha) = (Scene::builtin(), Stage::Reflection, 0.6);
    let truth = trace(Kernel::Exact, &scene, stage, alpha, SIZE as u32);
    let at = |column: usize, row: usize, channel: usize| {
        truth.samples()[3 * (row * SIZE + column) + channel]
    };
    let turned = |alpha: f64| trace(Kernel::Exact, &scene, stage, alpha, SIZE as u32);
    let bytes = |x, y, c| (255.0 * at(x, y, c)).round();
    let srgb = |x, y, c| match at(x, y, c) {
        dark if dark <= 0.003_130_8 => 12.92 * dark,
        sample => 1.055 * sample.powf(1.0 / 2.4) - 0.055,
    };
    for (hint, image) in [
        (
            Hint::UpsideDown,
            picture(SIZE, |x, y, c| at(x, SIZE - 1 - y, c)),
        ),
        // y points down: row 0 shows what would be above the picture.
        (
            Hint::UpsideDown,
            picture(SIZE, |x, y, c| at(x, (SIZE - y).min(SIZE - 1), c)),
        ),
        (Hint::Transposed, picture(SIZE, |x, y, c| at(y, x, c))),
        (Hint::Bgr, picture(SIZE, |x, y, c| at(x, y, 2 - c))),
        (Hint::Bytes, picture(SIZE, bytes)),
        (Hint::Gamma, picture(SIZE, srgb)),
        (
            Hint::Gamma,
            picture(SIZE, |x, y, c| at(x, y, c).powf(1.0 / 2.2)),
        ),
        (Hint::Degrees, turned(alpha.to_radians())),
        (Hint::Degrees, turned(alpha.to_degrees())),
    ] {
        assert_eq!(hints(&scene, stage, alpha, &image), [hint]);
    }
}

#[cfg(feature = "program")]
#[test]
fn a_tracer_with_a_mistake_earns_the_hint_at_it() {
    const SIZE: u32 = 90;
    let Some(command) = compiled("correct.c") else {
        return;
    };
    for (mistake, hints_expected) in [
        ("NONE", &[][..]),
        ("UPSIDE_DOWN", &[Hint::UpsideDown]),
        ("TRANSPOSED", &[Hint::Transposed]),
        ("HALF_PIXEL_OFF", &[Hint::HalfPixelOff]),
        ("GAMMA", &[Hint::Gamma]),
        ("BGR", &[Hint::Bgr]),
        ("BYTES", &[Hint::Bytes]),
        ("DEGREES", &[Hint::Degrees]),
        ("LIGHT_SIGN", &[Hint::LightSign]),
        ("LIGHT_DIRECTION", &[Hint::LightSign]),
        ("SHADOW_DIRECTION", &[Hint::ShadowDirection]),
        ("SHADOW_RAY", &[Hint::ShadowDirection]),
        ("SHADOW_BEHIND", &[Hint::ShadowBehind]),
        ("SHADOW_LINE", &[Hint::ShadowBehind]),
        ("SHADOW_OWN", &[Hint::ShadowBehind]),
        ("FAR_ROOT", &[Hint::FarRoot]),
        ("FAR_ROOTS", &[Hint::FarRoot]),
        ("SHADOW_ACNE", &[Hint::ShadowAcne]),
    ] {
        let command = format!("{command} {mistake}");
        let no_word = |line: &str| panic!("{line}");
        let mut program = Program::start(&command, Duration::from_secs(60), no_word).unwrap();
        let scene = Scene::builtin();
        for stage in [Stage::Shadow, Stage::Reflection] {
            for alpha in [0.3, 0.6, 2.1] {
                let mut image = Image::new(SIZE).unwrap();
                program.ask(&scene, stage, alpha, &mut image).unwrap();
                let earned = hints(&scene, stage, alpha, &image);
                assert_eq!(earned, hints_expected, "{mistake}, {stage}, {alpha}");
            }
        }
        program.finish().unwrap();
    }
}
