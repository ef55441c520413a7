//! Promise: over random scenes, aimed at what is hard, exact and reference give the same bits, which are those of the plain
//! evaluation; and pictures that must be related are, bit for bit.
//!
//! The seed is fixed: every run tries the same scenes.

mod aim;
mod model;

use aim::aim;
use firsthit::tracer::Decision;
use firsthit::{Kernel, Scene, Stage};
use glam::DVec3;
use model::{Model, angle, any_model, long, model, short, stage};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestCaseError};

use crate::helpers::trace_with_decisions;
use crate::plain::Plain;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(0x5eed),
        max_global_rejects: 10 * cases,
        ..ProptestConfig::default()
    }
}

fn scene(model: &Model) -> Result<Scene, TestCaseError> {
    model
        .scene()
        .ok_or_else(|| TestCaseError::reject("refused"))
}

/// Samples by their bits.
#[derive(PartialEq)]
struct Frame {
    size: u32,
    pixels: Vec<(Decision, [u32; 3])>,
}

impl Frame {
    fn new(kernel: Kernel, scene: &Scene, stage: Stage, alpha: f64, size: u32) -> Frame {
        let (image, decisions) = trace_with_decisions(kernel, scene, stage, alpha, size);
        let samples = image.samples().chunks(3);
        let samples = samples.map(|rgb| [rgb[0], rgb[1], rgb[2]].map(f32::to_bits));
        Frame {
            size,
            pixels: decisions.into_iter().zip(samples).collect(),
        }
    }

    fn exact(scene: &Scene, stage: Stage, alpha: f64, size: u32) -> Frame {
        Frame::new(Kernel::Exact, scene, stage, alpha, size)
    }

    fn at(&self, column: u32, row: u32) -> (Decision, [u32; 3]) {
        self.pixels[(row * self.size + column) as usize]
    }
}

/// Every column and row of an N × N picture.
fn places(size: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..size * size).map(move |index| (index % size, index / size))
}

proptest! {
    #![proptest_config(config(4000))]

    #[test]
    fn exact_is_reference_and_the_plain_evaluation(
        (mut model, alpha, stage) in (any_model(), angle(), stage()),
        aims in vec(aim(), 0..4),
        size in prop_oneof![2 => Just(32u32), 1 => 8u32..28],
        others in vec((0.0..1.0, 0.0..1.0), 12),
    ) {
        for aim in &aims {
            aim.apply(&mut model, alpha, size);
        }
        let scene = scene(&model)?;
        let exact = Frame::exact(&scene, stage, alpha, size);
        let reference = Frame::new(Kernel::Reference, &scene, stage, alpha, size);
        for (column, row) in places(size) {
            prop_assert_eq!(exact.at(column, row), reference.at(column, row), "at ({}, {})", column, row);
        }
        let plain = Plain::new(&scene, stage, alpha, size, 512);
        let aimed = aims.iter().map(|aim| aim.pixel(size));
        let index = |place: f64| (place * f64::from(size)) as u32;
        let others = others.into_iter().map(|(x, y): (f64, f64)| (index(x), index(y)));
        for (column, row) in aimed.chain(others) {
            let (decision, color) = plain.pixel(column, row);
            prop_assert_eq!(exact.at(column, row), (decision, color.map(f32::to_bits)), "at ({}, {})", column, row);
        }
    }
}

proptest! {
    #![proptest_config(config(150))]

    #[test]
    fn every_other_sample_is_the_picture_of_half_the_size(
        (model, alpha, stage) in (any_model(), angle(), stage()),
        size in 1u32..24,
    ) {
        let scene = scene(&model)?;
        let (small, large) =
            (Frame::exact(&scene, stage, alpha, size), Frame::exact(&scene, stage, alpha, 2 * size));
        for (column, row) in places(size) {
            prop_assert_eq!(small.at(column, row), large.at(2 * column, 2 * row));
        }
    }

    #[test]
    fn the_length_of_the_light_s_direction_does_not_matter(
        (model, alpha, stage) in (any_model(), angle(), stage()),
        k in -900..900,
    ) {
        let longer = Model { light: model.light * f64::from(k).exp2(), ..model.clone() };
        let frame = |model| Ok::<_, TestCaseError>(Frame::exact(&scene(model)?, stage, alpha, 24));
        prop_assert!(frame(&model)? == frame(&longer)?);
    }

    #[test]
    fn left_is_right_where_x_is_minus_x((model, stage) in (any_model(), stage())) {
        let across = |v: DVec3| DVec3::new(-v.x, v.y, v.z);
        let mut turned = model.moved(across);
        turned.light = across(model.light);
        let [frame, turned] = [scene(&model)?, scene(&turned)?].map(|scene| Frame::exact(&scene, stage, 0.0, 24));
        for (column, row) in places(24).filter(|&(column, _)| column > 0) {
            prop_assert_eq!(frame.at(column, row), turned.at(24 - column, row));
        }
    }

    #[test]
    fn without_a_surface_the_line_of_sight_is_no_place(
        (mut model, stage) in (model(short()), stage()),
        k in -6..14,
        toward in any::<bool>(),
    ) {
        model.surface = None;
        // Multiples of 1/64 and of 2^k, below 2^18: the sums are exact.
        let way = DVec3::new(0.0, 3.0, 10.0) * f64::from(k).exp2() * if toward { 1.0 } else { -1.0 };
        let [frame, moved] = [scene(&model)?, scene(&model.moved(|v| v + way))?]
            .map(|scene| Frame::exact(&scene, stage, 0.0, 24));
        prop_assert!(frame == moved);
    }

    #[test]
    fn brighter_light_is_brighter_light(
        (model, alpha) in (any_model(), angle()),
        stage in prop_oneof![Just(Stage::Shading), Just(Stage::Shadow), Just(Stage::Reflection)],
        k in -60..=19,
    ) {
        let brighter = Model { brightness: k, ..model.clone() };
        let [frame, brighter] = [scene(&model)?, scene(&brighter)?].map(|scene| Frame::exact(&scene, stage, alpha, 24));
        for ((decision, samples), (same, scaled)) in frame.pixels.into_iter().zip(brighter.pixels) {
            prop_assert_eq!(decision, same);
            let times = match decision {
                Decision::Background | Decision::Surface => 1.0,
                _ => (k as f32).exp2(),
            };
            // At least 0.1 · 0.3 · 2^-60: a power of two changes no digit.
            prop_assert_eq!(samples.map(|bits| (f32::from_bits(bits) * times).to_bits()), scaled);
        }
    }

    #[test]
    fn the_order_of_solids_does_not_matter_where_nothing_ties(
        (model, alpha, stage) in (model(long()), angle(), stage()),
        first in 0usize..4,
    ) {
        let mut other = Model { backwards: true, ..model.clone() };
        for vertices in &mut other.tetrahedra {
            vertices.rotate_left(first);
        }
        let [frame, other] = [scene(&model)?, scene(&other)?].map(|scene| Frame::exact(&scene, stage, alpha, 24));
        for (column, row) in places(24) {
            prop_assert_eq!(frame.at(column, row).1, other.at(column, row).1);
        }
    }
}
