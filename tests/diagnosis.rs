//! Promise: a wrong pixel is told what it shows.

use std::collections::HashMap;

use firsthit::diagnosis::{
    Diagnosis, Examination, ExaminationError, PixelDiagnosis, Summary, TOLERANCE, Verdict,
    WrongDecision,
};
use firsthit::scene::BUILTIN_TOML;
use firsthit::tracer::{Decision, Seen};
use firsthit::{Image, Kernel, Scene, Stage};

use crate::helpers::trace_with_decisions;

const SIZE: u32 = 60;
/// Two faces of the tetrahedron are seen from here, and all else.
const ALPHA: f64 = 2.1;

fn diagnosis(scene: &Scene, stage: Stage, alpha: f64, image: &Image) -> Diagnosis {
    let examination = Examination::new(scene, stage, alpha, image, TOLERANCE, 1).unwrap();
    examination.diagnosis().unwrap()
}

fn pixel(scene: &Scene, stage: Stage, image: &Image, index: usize) -> PixelDiagnosis {
    let examination = Examination::new(scene, stage, ALPHA, image, TOLERANCE, 1).unwrap();
    let (column, row) = (index as u32 % image.size(), index as u32 / image.size());
    examination.pixel(column, row).unwrap()
}

fn samples(image: &Image, index: usize) -> [f32; 3] {
    [0, 1, 2].map(|channel| image.samples()[3 * index + channel])
}

fn set(image: &mut Image, index: usize, samples: [f32; 3]) {
    image.samples_mut()[3 * index..][..3].copy_from_slice(&samples);
}

fn is_within(a: [f32; 3], b: [f32; 3]) -> bool {
    (0..3).all(|channel| (f64::from(a[channel]) - f64::from(b[channel])).abs() <= 1.0 / 255.0)
}

#[test]
fn the_true_picture_is_right_in_every_stage() {
    for stage in Stage::ALL {
        let (image, _) = trace_with_decisions(Kernel::Exact, &Scene::builtin(), stage, ALPHA, SIZE);
        let Diagnosis { verdicts, summary } = diagnosis(&Scene::builtin(), stage, ALPHA, &image);
        assert_eq!(verdicts, vec![Verdict::Right; (SIZE * SIZE) as usize]);
        assert_eq!((summary.right, summary.wrong()), (3600, 0));
        assert_eq!(summary.worst, None);
    }
}

/// What a decision looks like: the faces of a solid in shadow look the same.
fn looks(decision: Decision) -> Decision {
    let without_face = |seen: Seen| Seen {
        face: seen.face.filter(|_| !seen.in_shadow),
        ..seen
    };
    match decision {
        Decision::Solid(seen) => Decision::Solid(without_face(seen)),
        Decision::Mirrored(seen) => Decision::Mirrored(without_face(seen)),
        other => other,
    }
}

/// Whether a decision gives each of its pixels a colour of its own.
fn varies(decision: Decision, stage: Stage) -> bool {
    let varies = |seen: Seen| seen.face.is_none() && !seen.in_shadow && stage >= Stage::Shading;
    match decision {
        Decision::Solid(seen) | Decision::Mirrored(seen) => varies(seen),
        _ => false,
    }
}

#[test]
fn a_pixel_that_shows_what_another_decision_gives_is_told_which() {
    let scene = Scene::builtin();
    let mut kinds: HashMap<WrongDecision, u64> = HashMap::new();
    for stage in Stage::ALL {
        let (truth, decisions) = trace_with_decisions(Kernel::Exact, &scene, stage, ALPHA, SIZE);
        let mut places = HashMap::new();
        for (index, decision) in decisions.iter().enumerate() {
            places.entry(*decision).or_insert(index);
        }
        for (&shown, &from) in places.iter().filter(|(shown, _)| !varies(**shown, stage)) {
            // Every decision in place of every other one, each in a pixel.
            let (mut image, mut expected) = (truth.clone(), Summary::default());
            for (&decision, &index) in &places {
                let color = samples(&truth, from);
                set(&mut image, index, color);
                let differs = !is_within(color, samples(&truth, index));
                if differs {
                    expected.wrong_decisions.add(shown, decision);
                }
            }
            let Diagnosis { verdicts, summary } = diagnosis(&scene, stage, ALPHA, &image);
            for (&decision, &index) in &places {
                let is_right = is_within(samples(&image, index), samples(&truth, index));
                match verdicts[index] {
                    Verdict::Right | Verdict::Rounding => assert!(is_right),
                    Verdict::Shows(told) => {
                        assert!(!is_right);
                        if stage != Stage::Tetrahedron {
                            assert_eq!(looks(told), looks(shown), "{stage}, {decision:?}");
                        }
                        let kind = WrongDecision::of(told, decision).unwrap();
                        *kinds.entry(kind).or_default() += 1;
                    }
                    other => panic!("{other:?} for {shown:?}, {stage}, {decision:?}"),
                }
            }
            // The true face of a solid in shadow is told where it is the true solid.
            let found = summary.wrong_decisions;
            assert_eq!(found.total(), expected.wrong_decisions.total());
            assert_eq!(summary.wrong(), found.total());
        }
    }
    assert_eq!(kinds.len(), 4, "{kinds:?}");
}

#[test]
fn a_tetrahedron_in_shadow_is_seen_at_its_true_face() {
    let (scene, stage) = (Scene::builtin(), Stage::Shadow);
    let (truth, decisions) = trace_with_decisions(Kernel::Exact, &scene, stage, ALPHA, SIZE);
    let mut faces = 0;
    for (index, &decision) in decisions.iter().enumerate() {
        let Decision::Solid(lit @ Seen { face: Some(_), .. }) = decision else {
            continue;
        };
        faces |= 1 << lit.face.unwrap();
        let mut image = truth.clone();
        set(&mut image, index, [0.06, 0.135, 0.285]);
        let shown = Decision::Solid(Seen {
            in_shadow: true,
            ..lit
        });
        let Diagnosis { verdicts, summary } = diagnosis(&scene, stage, ALPHA, &image);
        assert_eq!(verdicts[index], Verdict::Shows(shown));
        assert_eq!(summary.wrong_decisions.shadow, 1);
    }
    assert!(u32::count_ones(faces) > 1, "{faces:b}");
}

/// The solid of the built-in scene that has this number where the second sphere is missing.
fn renumbered(decision: Decision) -> Decision {
    let next = |seen: Seen| Seen {
        solid: if seen.solid == 0 { 0 } else { 2 },
        ..seen
    };
    match decision {
        Decision::Solid(seen) => Decision::Solid(next(seen)),
        Decision::Mirrored(seen) => Decision::Mirrored(next(seen)),
        other => other,
    }
}

#[test]
fn a_tracer_that_misses_a_sphere_shows_what_that_hides_or_shades() {
    let (second, next) = (
        BUILTIN_TOML.rfind("[[sphere]]").unwrap(),
        BUILTIN_TOML.find("[[tetrahedron]]").unwrap(),
    );
    let text = format!("{}{}", &BUILTIN_TOML[..second], &BUILTIN_TOML[next..]);
    let without = Scene::from_toml(&text).unwrap();
    let (scene, mut spheres_in_the_light) = (Scene::builtin(), 0);
    // From here the second sphere is seen before the first.
    for stage in [
        Stage::Spheres,
        Stage::Shading,
        Stage::Shadow,
        Stage::Reflection,
    ] {
        let (truth, decisions) = trace_with_decisions(Kernel::Exact, &scene, stage, 0.0, SIZE);
        let (image, shown) = trace_with_decisions(Kernel::Exact, &without, stage, 0.0, SIZE);
        let Diagnosis { verdicts, summary } = diagnosis(&scene, stage, 0.0, &image);
        for (index, verdict) in verdicts.into_iter().enumerate() {
            let (shown, decision) = (renumbered(shown[index]), decisions[index]);
            if is_within(samples(&image, index), samples(&truth, index)) {
                assert!(matches!(verdict, Verdict::Right | Verdict::Rounding));
            } else if verdict != Verdict::Several {
                assert_eq!(verdict, Verdict::Shows(shown), "{stage}, not {decision:?}");
                spheres_in_the_light += u32::from(varies(shown, stage));
            }
        }
        // Where the first sphere hardly faces the light, it looks as in shadow.
        assert!(summary.several <= 6, "{summary:?}");
        assert!(summary.wrong() > 100);
    }
    assert!(spheres_in_the_light > 40, "{spheres_in_the_light}");
}

/// Two spheres of one colour, `apart` from each other along the screen and one behind the other.
fn twins(apart: f64) -> Scene {
    let sphere = |x: f64, y: f64, z: f64| {
        format!("[[sphere]]\ncenter = [{x}, {y}, {z}]\nradius = 0.25\ncolor = [0.5, 0.25, 1.0]\n")
    };
    let light = "[light]\ndirection = [0.0, 0.0, -1.0]\n";
    let text = format!(
        "{light}{}{}",
        sphere(0.0, -0.3, 0.0),
        sphere(apart, -0.45, -0.5)
    );
    Scene::from_toml(&text).unwrap()
}

#[test]
fn what_two_decisions_explain_is_several() {
    for (apart, expected, words) in [
        (
            0.0,
            Verdict::Several,
            "is within 1/255 of what 2 decisions give: sphere 1 in shadow and sphere 2 in shadow",
        ),
        (
            0.75,
            Verdict::Shows(Decision::Solid(Seen {
                solid: 0,
                face: None,
                in_shadow: true,
            })),
            "shows sphere 1 in shadow, where it is lit",
        ),
    ] {
        let (scene, stage) = (twins(apart), Stage::Shadow);
        let (mut image, decisions) = trace_with_decisions(Kernel::Exact, &scene, stage, 0.0, SIZE);
        let lit = Decision::Solid(Seen {
            solid: 0,
            face: None,
            in_shadow: false,
        });
        // The middle of the picture, where the second sphere is behind the first or beside it.
        let index = (SIZE / 2 * SIZE + SIZE / 2) as usize;
        assert_eq!(decisions[index], lit);
        set(&mut image, index, [0.15, 0.075, 0.3]);
        let examination = Examination::new(&scene, stage, 0.0, &image, TOLERANCE, 1).unwrap();
        let found = examination.diagnosis().unwrap();
        assert_eq!(found.verdicts[index], expected);
        assert_eq!(found.summary.wrong(), 1);
        assert_eq!(found.summary.worst, Some((SIZE / 2, SIZE / 2)));
        let pixel = examination.pixel(SIZE / 2, SIZE / 2).unwrap();
        assert_eq!(pixel.words, words);
        assert_eq!(pixel.verdict, expected);
    }
}

#[test]
fn no_sample_is_too_wild() {
    let (scene, stage) = (Scene::builtin(), Stage::Reflection);
    let (truth, _) = trace_with_decisions(Kernel::Exact, &scene, stage, ALPHA, SIZE);
    let first = samples(&truth, 0);
    let with_blue = |blue| [first[0], first[1], blue];
    for (wild, verdict) in [
        (first, Verdict::Right),
        (with_blue(first[2].next_up()), Verdict::Rounding),
        (with_blue(first[2] + 1.0 / 256.0), Verdict::Rounding),
        (with_blue(first[2] - 1.0 / 128.0), Verdict::AnotherColor),
        (with_blue(f32::NAN), Verdict::NotANumber),
        ([f32::NAN, f32::INFINITY, 0.0], Verdict::NotANumber),
        (with_blue(f32::INFINITY), Verdict::AnotherColor),
        ([f32::NEG_INFINITY; 3], Verdict::AnotherColor),
        ([f32::MAX, f32::MIN, 0.0], Verdict::AnotherColor),
        ([-0.0; 3], Verdict::AnotherColor),
    ] {
        let mut image = truth.clone();
        set(&mut image, 0, wild);
        let found = diagnosis(&scene, stage, ALPHA, &image);
        assert_eq!(found.verdicts[0], verdict, "{wild:?}");
        let right = verdict == Verdict::Right;
        assert_eq!(found.summary.worst, (!right).then_some((0, 0)));
        assert_eq!(found.summary.right, 3600 - u64::from(!right));
        let wrong = !matches!(verdict, Verdict::Right | Verdict::Rounding);
        assert_eq!(found.summary.wrong(), u64::from(wrong));
        let text = pixel(&scene, stage, &image, 0).to_string();
        assert_eq!(text.lines().count(), 4, "{text}");
    }
}

#[test]
fn the_worst_pixel_is_the_first_of_those_farthest_from_the_truth() {
    let (scene, stage) = (Scene::builtin(), Stage::Shadow);
    let (mut image, _) = trace_with_decisions(Kernel::Exact, &scene, stage, ALPHA, SIZE);
    let mut worst = |column: u32, sample: f32| {
        set(&mut image, column as usize, [0.8, sample, 0.8]);
        diagnosis(&scene, stage, ALPHA, &image).summary.worst
    };
    assert_eq!(worst(7, 0.7), Some((7, 0)));
    assert_eq!(worst(9, 0.5), Some((9, 0)));
    assert_eq!(worst(8, 0.75), Some((9, 0)));
    assert_eq!(worst(11, 0.5), Some((9, 0)));
    assert_eq!(worst(12, f32::NAN), Some((12, 0)));
    assert_eq!(worst(13, f32::NEG_INFINITY), Some((12, 0)));
}

#[test]
fn the_tolerance_is_a_matter_of_choice() {
    let (scene, stage) = (Scene::builtin(), Stage::Shadow);
    let (mut image, _) = trace_with_decisions(Kernel::Exact, &scene, stage, ALPHA, SIZE);
    set(&mut image, 0, [0.75, 0.8, 0.8]);
    set(&mut image, 1, [0.31, 0.3, 0.3]);
    for (tolerance, verdicts, words) in [
        (
            0.1,
            [Verdict::Rounding, Verdict::Shows(Decision::SurfaceInShadow)],
            "is right but for rounding: within 0.1",
        ),
        (
            0.0,
            [Verdict::AnotherColor; 2],
            "is another colour: what no decision gives within 0",
        ),
        (
            f32::NAN,
            [Verdict::AnotherColor; 2],
            "is another colour: what no decision gives within NaN",
        ),
    ] {
        let examination = Examination::new(&scene, stage, ALPHA, &image, tolerance, 1).unwrap();
        assert_eq!(examination.diagnosis().unwrap().verdicts[..2], verdicts);
        assert_eq!(examination.pixel(0, 0).unwrap().words, words);
    }
}

#[test]
fn an_angle_that_is_none_and_a_pixel_that_is_none_are_refused() {
    let (scene, image) = (Scene::builtin(), Image::new(3).unwrap());
    let examine = |alpha| Examination::new(&scene, Stage::Shadow, alpha, &image, TOLERANCE, 1);
    assert!(matches!(
        examine(f64::INFINITY),
        Err(ExaminationError::Trace(_))
    ));
    let examination = examine(1e300).unwrap();
    assert!(examination.pixel(2, 2).is_some());
    assert!(examination.pixel(3, 0).is_none() && examination.pixel(0, 3).is_none());
}
