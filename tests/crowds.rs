//! Promise: where many solids overlap, cross, hide each other and reach through the surface, exact
//! and reference give the same bits, whole and traced over the frame before.
//!
//! Every run tries the same scenes.

use std::fmt::Write;

use firsthit::{Image, Kernel, Scene, Stage, Tracer};
use glam::DVec3;

use crate::helpers::{Random, trace_with_decisions};

/// A scene of so many solids of about a size, of which one in so many is a tetrahedron.
fn crowd(random: &mut Random, count: usize, size: f64, one_in: usize) -> String {
    // Multiples of 1/32, where solids touch and samples are met exactly, or any numbers.
    let grid = [32.0, 0.0][random.below(2)];
    let mut coordinate = |reach: f64| {
        let any = reach * (2.0 * random.fraction() - 1.0);
        if grid > 0.0 {
            (any * grid).round() / grid
        } else {
            any
        }
    };
    let mut point = |reach: f64| DVec3::from_array([(); 3].map(|()| coordinate(reach)));
    let height = point(0.5).x;
    let light = point(1.0) + DVec3::new(0.0, [-0.5, -0.5, 0.5][count % 3], 0.0);
    let mut text = format!(
        "surface = {{ height = {height:?}, half_width = 0.9 }}\n\
         light = {{ direction = {:?} }}\n",
        if light == DVec3::ZERO {
            [0.0, -1.0, 0.0]
        } else {
            light.to_array()
        }
    );
    let mut solids: Vec<(DVec3, f64)> = Vec::new();
    for number in 0..count {
        let middle = point(0.75);
        let radius = size / 2.0 + (size * point(0.5).y).abs();
        // The same once more, one inside of another, or a new one.
        let (center, radius) = match (number % 8, solids.last()) {
            (6, Some(&last)) => last,
            (7, Some(&(center, radius))) => (center, radius / 2.0),
            _ => (middle, radius),
        };
        solids.push((center, radius));
        let shade = |factor: f64| 0.1 + 0.8 * (factor * number as f64).fract();
        let color = [0.618, 0.414, 0.732].map(shade);
        if number % one_in == 0 {
            let vertices = [(); 4].map(|()| (center + point(2.0 * radius)).to_array());
            write!(
                text,
                "[[tetrahedron]]\nvertices = {vertices:?}\ncolor = {color:?}\n"
            )
            .unwrap();
        } else {
            let center = center.to_array();
            write!(
                text,
                "[[sphere]]\ncenter = {center:?}\nradius = {radius:?}\ncolor = {color:?}\n"
            )
            .unwrap();
        }
    }
    text
}

#[test]
fn exact_is_reference_where_many_solids_overlap() {
    let mut random = Random::new();
    let mut tried = 0;
    while tried < 60 {
        let count = [6, 12, 24, 40, 80][tried % 5];
        let size = [0.1, 0.3, 0.6, 1.5][random.below(4)];
        let text = crowd(&mut random, count, size, [1, 2, 5, 100][tried % 4]);
        // One with a flat tetrahedron is refused.
        let Ok(scene) = Scene::from_toml(&text) else {
            continue;
        };
        tried += 1;
        let stage = [
            Stage::Reflection,
            Stage::Reflection,
            Stage::Shadow,
            Stage::Shading,
        ][random.below(4)];
        let pixels = 24 + random.below(25) as u32;
        let mut tracer = Tracer::new(Kernel::Exact, 1).unwrap();
        let mut image = Image::new(pixels).unwrap();
        for alpha in [0.0, 0.4 + random.fraction()] {
            let exact = trace_with_decisions(Kernel::Exact, &scene, stage, alpha, pixels);
            let reference = trace_with_decisions(Kernel::Reference, &scene, stage, alpha, pixels);
            tracer.retrace(&scene, stage, alpha, &mut image).unwrap();
            let frame = format!("stage {stage}, α = {alpha}, N = {pixels} of\n{text}");
            let differs = exact.1.iter().zip(&reference.1).position(|(a, b)| a != b);
            if let Some(place) = differs {
                let at = (place as u32 % pixels, place as u32 / pixels);
                let (exact, reference) = (exact.1[place], reference.1[place]);
                panic!("{exact:?} instead of {reference:?} at {at:?}, {frame}");
            }
            assert!(exact.0 == reference.0 && image == exact.0, "{frame}");
        }
    }
}
