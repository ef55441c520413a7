//! Promise: over random scenes, aimed at what is hard, exact and reference give the same bits,
//! which are the oracle's; and pictures that must be related are, bit for bit.
//!
//! Every run tries the same scenes.

mod aim;
mod model;

use std::fmt::Debug;

use aim::aim;
use firsthit::tracer::Decision;
use firsthit::{Kernel, Scene, Stage};
use glam::DVec3;
use model::{Model, angle, any_model, long, model, short, stage};

use crate::helpers::{Random, trace_with_decisions};
use crate::oracle::Oracle;

/// Why a property does not hold of a scene.
enum Broken {
    /// The scene is refused, so that nothing can be said of it.
    Refused,
    Wrong(String),
}

/// Asks that `property` holds of `count` random scenes, each with whatever else `draw` chooses;
/// those that are refused are not counted. From a scene of which it does not hold all is removed
/// that has nothing to do with that, and the rest is shown.
fn for_all<C: Debug>(
    count: usize,
    draw: impl Fn(&mut Random) -> (Model, C),
    property: impl Fn(&Model, &C) -> Result<(), Broken>,
) {
    let mut random = Random::new();
    let (mut held, mut refused) = (0, 0);
    while held < count {
        let (mut model, choices) = draw(&mut random);
        match property(&model, &choices) {
            Ok(()) => held += 1,
            Err(Broken::Refused) => refused += 1,
            Err(Broken::Wrong(mut what)) => {
                let simpler = |model: &Model| {
                    let mut simpler = model.simpler().into_iter();
                    simpler.find_map(|model| match property(&model, &choices) {
                        Err(Broken::Wrong(what)) => Some((model, what)),
                        _ => None,
                    })
                };
                while let Some(found) = simpler(&model) {
                    (model, what) = found;
                }
                panic!("{what}, {choices:?} of\n{}", model.text());
            }
        }
        assert!(refused < 10 * count, "most scenes are refused");
    }
}

fn scene(model: &Model) -> Result<Scene, Broken> {
    model.scene().ok_or(Broken::Refused)
}

fn same<T: PartialEq + Debug>(
    one: T,
    other: T,
    what: impl FnOnce() -> String,
) -> Result<(), Broken> {
    if one == other {
        return Ok(());
    }
    Err(Broken::Wrong(format!("{one:?} and {other:?} {}", what())))
}

/// A pixel's decision, and its samples by their bits.
type Pixel = (Decision, [u32; 3]);

struct Frame {
    size: u32,
    pixels: Vec<Pixel>,
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

    fn exact(model: &Model, stage: Stage, alpha: f64, size: u32) -> Result<Frame, Broken> {
        Ok(Frame::new(
            Kernel::Exact,
            &scene(model)?,
            stage,
            alpha,
            size,
        ))
    }

    fn at(&self, column: u32, row: u32) -> Pixel {
        self.pixels[(row * self.size + column) as usize]
    }

    /// Compares each pixel with what `expected` says of its column and row.
    fn is(&self, expected: impl Fn(u32, u32) -> Pixel) -> Result<(), Broken> {
        let mut places =
            (0..self.size).flat_map(|row| (0..self.size).map(move |column| (column, row)));
        places.try_for_each(|(column, row)| {
            let at = || format!("at ({column}, {row})");
            same(self.at(column, row), expected(column, row), at)
        })
    }
}

#[test]
fn exact_is_reference_and_the_oracle() {
    let draw = |random: &mut Random| {
        let (mut model, alpha, stage) = (any_model(random), angle(random), stage(random));
        let size = [32, 32, 8 + random.below(20) as u32][random.below(3)];
        let aims: Vec<_> = (0..random.below(4)).map(|_| aim(random)).collect();
        for aim in &aims {
            aim.apply(&mut model, alpha, size);
        }
        let aimed = aims.iter().map(|aim| aim.pixel(size));
        let other = || [(); 2].map(|()| random.below(size as usize) as u32).into();
        let others = std::iter::repeat_with(other).take(12);
        let pixels: Vec<(u32, u32)> = aimed.chain(others).collect();
        (model, (stage, alpha, size, pixels))
    };
    for_all(4000, draw, |model, &(stage, alpha, size, ref pixels)| {
        let scene = scene(model)?;
        let [exact, reference] = [Kernel::Exact, Kernel::Reference]
            .map(|kernel| Frame::new(kernel, &scene, stage, alpha, size));
        exact.is(|column, row| reference.at(column, row))?;
        let oracle = Oracle::new(&scene, alpha, size, 512);
        pixels.iter().try_for_each(|&(column, row)| {
            let (decision, color) = oracle.pixel(stage, column, row);
            let expected = (decision, color.map(f32::to_bits));
            let at = || format!("by the oracle at ({column}, {row})");
            same(exact.at(column, row), expected, at)
        })
    });
}

/// A scene, α and a stage.
fn any(random: &mut Random) -> (Model, f64, Stage) {
    (any_model(random), angle(random), stage(random))
}

/// How many scenes the other properties are asked of, and N.
const COUNT: usize = 150;
const SIZE: u32 = 24;

#[test]
fn every_other_sample_is_the_picture_of_half_the_size() {
    let draw = |random: &mut Random| {
        let (model, alpha, stage) = any(random);
        (model, (stage, alpha, 1 + random.below(23) as u32))
    };
    for_all(COUNT, draw, |model, &(stage, alpha, size)| {
        let small = Frame::exact(model, stage, alpha, size)?;
        let large = Frame::exact(model, stage, alpha, 2 * size)?;
        small.is(|column, row| large.at(2 * column, 2 * row))
    });
}

#[test]
fn the_length_of_the_light_s_direction_does_not_matter() {
    let draw = |random: &mut Random| {
        let (model, alpha, stage) = any(random);
        (model, (stage, alpha, random.below(1800) as i32 - 900))
    };
    for_all(COUNT, draw, |model, &(stage, alpha, k)| {
        let longer = Model {
            light: model.light * f64::from(k).exp2(),
            ..model.clone()
        };
        let longer = Frame::exact(&longer, stage, alpha, SIZE)?;
        Frame::exact(model, stage, alpha, SIZE)?.is(|column, row| longer.at(column, row))
    });
}

#[test]
fn left_is_right_where_x_is_minus_x() {
    let draw = |random: &mut Random| (any_model(random), stage(random));
    for_all(COUNT, draw, |model, &stage| {
        let across = |v: DVec3| DVec3::new(-v.x, v.y, v.z);
        let mut turned = model.moved(across);
        turned.light = across(model.light);
        let frame = Frame::exact(model, stage, 0.0, SIZE)?;
        let turned = Frame::exact(&turned, stage, 0.0, SIZE)?;
        frame.is(|column, row| match column {
            0 => frame.at(0, row),
            _ => turned.at(SIZE - column, row),
        })
    });
}

#[test]
fn without_a_surface_the_line_of_sight_is_no_place() {
    let draw = |random: &mut Random| {
        let model = Model {
            surface: None,
            ..model(random, short)
        };
        // Multiples of 1/64 and of 2^k, below 2^18: the sums are exact.
        let k = random.below(20) as i32 - 6;
        let sign = [1.0, -1.0][random.below(2)];
        (model, (stage(random), sign * f64::from(k).exp2()))
    };
    for_all(COUNT, draw, |model, &(stage, length)| {
        let way = DVec3::new(0.0, 3.0, 10.0) * length;
        let moved = Frame::exact(&model.moved(|v| v + way), stage, 0.0, SIZE)?;
        Frame::exact(model, stage, 0.0, SIZE)?.is(|column, row| moved.at(column, row))
    });
}

#[test]
fn brighter_light_is_brighter_light() {
    let draw = |random: &mut Random| {
        let (model, alpha) = (any_model(random), angle(random));
        let stage = [Stage::Shading, Stage::Shadow, Stage::Reflection][random.below(3)];
        (model, (stage, alpha, random.below(80) as i32 - 60))
    };
    for_all(COUNT, draw, |model, &(stage, alpha, k)| {
        let brighter = Model {
            brightness: k,
            ..model.clone()
        };
        let frame = Frame::exact(model, stage, alpha, SIZE)?;
        Frame::exact(&brighter, stage, alpha, SIZE)?.is(|column, row| {
            let (decision, samples) = frame.at(column, row);
            let times = match decision {
                Decision::Background | Decision::Surface => 1.0,
                _ => (k as f32).exp2(),
            };
            // At least 0.1 · 0.3 · 2^-60: a power of two changes no digit.
            let scaled = samples.map(|bits| (f32::from_bits(bits) * times).to_bits());
            (decision, scaled)
        })
    });
}

#[test]
fn the_order_of_solids_does_not_matter_where_nothing_ties() {
    let draw = |random: &mut Random| {
        let choices = (stage(random), angle(random), random.below(4));
        (model(random, long), choices)
    };
    for_all(COUNT, draw, |model, &(stage, alpha, first)| {
        let mut other = Model {
            backwards: true,
            ..model.clone()
        };
        for vertices in &mut other.tetrahedra {
            vertices.rotate_left(first);
        }
        let frame = Frame::exact(model, stage, alpha, SIZE)?;
        let other = Frame::exact(&other, stage, alpha, SIZE)?;
        // The decisions name other numbers of solids and faces.
        frame.is(|column, row| (frame.at(column, row).0, other.at(column, row).1))
    });
}
