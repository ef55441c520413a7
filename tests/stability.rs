//! Promise: where others stumble, exact and reference make no wrong decision and round every sample
//! correctly; and how far off fast and double are there is known to the pixel.
//!
//! Every scene in `tests/scenes` is one that provokes something, which its first line names. The
//! truth is what the oracle says. The oracle is slow, so it is asked about the pixels on either
//! side of every border, and some others; over the whole frame exact and reference, which go
//! different ways, must agree bit for bit, and the others are measured against them.

mod table;

use std::collections::BTreeSet;

use firsthit::tracer::Decision;
use firsthit::{Kernel, Scene, Stage};
use table::{Errors, Row, TABLE};

use crate::helpers::{
    bits, hard_scene, hard_scene_text, hard_scenes, on_all_cores, trace_with_decisions,
};
use crate::oracle::Oracle;

/// N: a power of two, so that samples at α = 0 are short binary fractions, which scenes can meet
/// exactly.
const SIZE: u32 = 128;

/// The oracle is asked about at most about this many pixels of a frame.
const SAMPLED: usize = 400;

struct Frame {
    samples: Vec<u32>,
    decisions: Vec<Decision>,
    finite: bool,
}

fn trace(kernel: Kernel, scene: &Scene, stage: Stage, alpha: f64) -> Frame {
    let (image, decisions) = trace_with_decisions(kernel, scene, stage, alpha, SIZE);
    Frame {
        finite: image.samples().iter().all(|sample| sample.is_finite()),
        samples: bits(&image),
        decisions,
    }
}

/// How far a frame is from the truth.
fn errors(got: &Frame, truth: &Frame) -> Errors {
    let mut errors = Errors {
        wrong: 0,
        misrounded: 0,
        ulp: 0,
    };
    let decisions = got.decisions.iter().zip(&truth.decisions);
    let samples = got.samples.chunks(3).zip(truth.samples.chunks(3));
    for ((got, truth), (got_samples, true_samples)) in decisions.zip(samples) {
        errors.wrong += u32::from(got != truth);
        for (&got_sample, &true_sample) in got_samples.iter().zip(true_samples) {
            errors.misrounded += u32::from(got_sample != true_sample);
            // Floats that are not negative are in the order of their bits.
            if got == truth {
                errors.ulp = errors.ulp.max(got_sample.abs_diff(true_sample));
            }
        }
    }
    errors
}

/// The pixels to ask the oracle about: those next to another decision, thinned out if they are
/// many, and some others.
fn sampled(decisions: &[Decision]) -> BTreeSet<u32> {
    let differs = |a: u32, b: u32| decisions[a as usize] != decisions[b as usize];
    let mut border = BTreeSet::new();
    for index in 0..SIZE * SIZE {
        let right = (index % SIZE + 1 < SIZE).then_some(index + 1);
        let up = (index / SIZE + 1 < SIZE).then_some(index + SIZE);
        for neighbour in [right, up].into_iter().flatten() {
            if differs(index, neighbour) {
                border.extend([index, neighbour]);
            }
        }
    }
    let thin = border.len().div_ceil(SAMPLED * 3 / 4).max(1);
    let others = (0..SIZE * SIZE).step_by((SIZE * SIZE) as usize * 4 / SAMPLED + 1);
    border.into_iter().step_by(thin).chain(others).collect()
}

/// The pixels of a frame that the oracle sees otherwise.
fn wrong_pixels<'a>(
    frame: &Frame,
    (oracle, stage): (&Oracle<'_>, Stage),
    pixels: impl Iterator<Item = &'a u32>,
) -> Vec<String> {
    let problems = pixels.filter_map(|&index| {
        let place = index as usize;
        let color = [0, 1, 2].map(|channel| f32::from_bits(frame.samples[3 * place + channel]));
        let got = (frame.decisions[place], color);
        oracle.problem(stage, (index % SIZE, index / SIZE), got)
    });
    problems.collect()
}

/// Checks a row: what is wrong, or the row as it should be.
fn check(row: &Row) -> Result<(), String> {
    let scene = hard_scene(row.scene);
    let stage = Stage::from_number(row.stage).unwrap();
    let name = format!("{}, stage {}, α = {:?}", row.scene, row.stage, row.alpha);
    let trace = |kernel: Kernel| {
        let frame = trace(kernel, &scene, stage, row.alpha);
        let problem = format!("{name}: {} gives a NaN or an infinity", kernel.name());
        if frame.finite {
            Ok(frame)
        } else {
            Err(problem)
        }
    };
    let (exact, reference) = (trace(Kernel::Exact)?, trace(Kernel::Reference)?);
    let apart = errors(&exact, &reference);
    if apart.wrong > 0 || apart.misrounded > 0 {
        return Err(format!("{name}: exact and reference differ: {apart:?}"));
    }
    let pixels = sampled(&exact.decisions);
    let oracle = |bits| Oracle::new(&scene, row.alpha, SIZE, bits);
    let mut wrong = wrong_pixels(&exact, (&oracle(row.bits), stage), pixels.iter());
    // What the oracle takes for zero, it still takes for zero in twice as many bits.
    wrong.extend(wrong_pixels(
        &exact,
        (&oracle(2 * row.bits), stage),
        pixels.iter().step_by(16),
    ));
    if let Some(first) = wrong.first() {
        return Err(format!(
            "{name}: {} pixels wrong, the first {first}",
            wrong.len()
        ));
    }

    let fast = errors(&trace(Kernel::Fast)?, &reference);
    let double = errors(&trace(Kernel::Double)?, &reference);
    eprintln!(
        "{name:56} wrong pixels {:6} {:6} {:6}   misrounded samples {:6} {:6} {:6}",
        fast.wrong, double.wrong, apart.wrong, fast.misrounded, double.misrounded, apart.misrounded
    );
    if fast != row.fast || double != row.double {
        let row = Row {
            fast,
            double,
            ..row.clone()
        };
        return Err(row.to_string());
    }
    Ok(())
}

/// Allowances that are exceeded, and those that are looser than needed: both fail.
#[test]
fn every_error_is_as_the_table_says() {
    eprintln!(
        "{:56}                fast double  exact                        fast double  exact",
        ""
    );
    let checked = on_all_cores(TABLE.iter(), check);
    let problems: Vec<String> = checked.into_iter().filter_map(Result::err).collect();
    assert!(
        problems.is_empty(),
        "{} rows of tests/stability/table.rs are not as they should be:\n{}",
        problems.len(),
        problems.join("\n")
    );
}

#[test]
fn every_scene_is_in_the_table_and_says_what_it_provokes() {
    let scenes = hard_scenes();
    for name in &scenes {
        assert!(hard_scene_text(name).starts_with("# "), "{name}");
    }
    let listed: BTreeSet<_> = TABLE.iter().map(|row| row.scene).collect();
    assert!(scenes.iter().map(String::as_str).eq(listed));
}
