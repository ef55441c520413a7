//! Random scenes, as their numbers.

use std::fmt::Write;

use firsthit::{Scene, Stage};
use glam::DVec3;

use crate::helpers::Random;

#[derive(Clone, Debug)]
pub(crate) struct Model {
    /// Height and half width.
    pub(crate) surface: Option<(f64, f64)>,
    pub(crate) light: DVec3,
    /// The power of two that I and I_a are.
    pub(crate) brightness: i32,
    pub(crate) exponent: u32,
    pub(crate) spheres: Vec<(DVec3, f64)>,
    pub(crate) tetrahedra: Vec<[DVec3; 4]>,
    /// Whether the last of each kind is listed first.
    pub(crate) backwards: bool,
}

impl Model {
    /// `None` for a scene that is refused, such as one with a flat tetrahedron.
    pub(crate) fn scene(&self) -> Option<Scene> {
        Scene::from_toml(&self.text()).ok()
    }

    /// As a scene file.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        let triple = |v: DVec3| format!("{:?}", v.to_array());
        // No two solids of one colour, no channel of one value.
        let color = |i: usize| {
            let i = i as f64;
            triple(DVec3::new(0.9 - 0.07 * i, 0.2 + 0.09 * i, 0.51 + 0.013 * i))
        };
        let bright = triple(DVec3::splat(f64::from(self.brightness).exp2()));
        if let Some((height, half_width)) = self.surface {
            writeln!(
                text,
                "[surface]\nheight = {height:?}\nhalf_width = {half_width:?}"
            )
            .unwrap();
        }
        writeln!(
            text,
            "[light]\ndirection = {}\nintensity = {bright}\nambient_intensity = {bright}",
            triple(self.light)
        )
        .unwrap();
        writeln!(text, "[material]\nexponent = {}", self.exponent).unwrap();
        let order = |length: usize| -> Vec<usize> {
            if self.backwards {
                (0..length).rev().collect()
            } else {
                (0..length).collect()
            }
        };
        for i in order(self.spheres.len()) {
            let (center, radius) = self.spheres[i];
            let (center, color) = (triple(center), color(i));
            writeln!(
                text,
                "[[sphere]]\ncenter = {center}\nradius = {radius:?}\ncolor = {color}"
            )
            .unwrap();
        }
        for i in order(self.tetrahedra.len()) {
            let vertices = self.tetrahedra[i].map(|v| v.to_array());
            let color = color(5 + i);
            writeln!(
                text,
                "[[tetrahedron]]\nvertices = {vertices:?}\ncolor = {color}"
            )
            .unwrap();
        }
        text
    }

    /// The same with less: each without its surface, or without one of its solids.
    pub(crate) fn simpler(&self) -> Vec<Model> {
        let mut simpler = Vec::new();
        let mut without = |remove: &dyn Fn(&mut Model)| {
            let mut model = self.clone();
            remove(&mut model);
            simpler.push(model);
        };
        if self.surface.is_some() {
            without(&|model| model.surface = None);
        }
        for i in 0..self.spheres.len() {
            without(&|model| _ = model.spheres.remove(i));
        }
        for i in 0..self.tetrahedra.len() {
            without(&|model| _ = model.tetrahedra.remove(i));
        }
        simpler
    }

    /// The same with every point changed.
    pub(crate) fn moved(&self, change: impl Fn(DVec3) -> DVec3) -> Model {
        let mut moved = self.clone();
        for (center, _) in &mut moved.spheres {
            *center = change(*center);
        }
        for vertex in moved.tetrahedra.iter_mut().flatten() {
            *vertex = change(*vertex);
        }
        moved
    }
}

/// Chooses a coordinate.
pub(crate) type Coordinate = fn(&mut Random) -> f64;

/// A multiple of 1/64: where these meet samples, they meet them exactly.
pub(crate) fn short(random: &mut Random) -> f64 {
    (random.below(113) as f64 - 56.0) / 64.0
}

/// Any f64 of that size.
pub(crate) fn long(random: &mut Random) -> f64 {
    0.875 * (2.0 * random.fraction() - 1.0)
}

/// Up to three spheres and up to two tetrahedra, mostly on a surface.
pub(crate) fn model(random: &mut Random, coordinate: Coordinate) -> Model {
    let radius = |random: &mut Random| 0.015625 + coordinate(random).abs() / 2.0;
    let point = |random: &mut Random| {
        DVec3::new(coordinate(random), coordinate(random), coordinate(random))
    };
    let surface = random.below(20) < 17;
    Model {
        surface: surface.then(|| (coordinate(random) / 2.0 - 0.4375, 2.0 * radius(random))),
        light: std::iter::repeat_with(|| point(random))
            .find(|light| *light != DVec3::ZERO)
            .unwrap(),
        brightness: 0,
        exponent: [1, 7, 1000, 1_000_000][random.below(4)],
        spheres: (0..random.below(4))
            .map(|_| (point(random), radius(random)))
            .collect(),
        tetrahedra: (0..random.below(3))
            .map(|_| [(); 4].map(|()| point(random)))
            .collect(),
        backwards: false,
    }
}

/// Coordinates of either kind, all of a scene of one.
pub(crate) fn any_model(random: &mut Random) -> Model {
    let coordinate = [short, long][random.below(2)];
    model(random, coordinate)
}

/// α = 0 half of the time, where samples are met exactly.
pub(crate) fn angle(random: &mut Random) -> f64 {
    match random.below(8) {
        0..4 => 0.0,
        4 | 5 => firsthit::camera::frame_angle(random.below(21) as u64),
        6 => 20.0 * random.fraction() - 10.0,
        _ => [1e-9, std::f64::consts::FRAC_PI_2, 1e22][random.below(3)],
    }
}

/// The reflection two times of three.
pub(crate) fn stage(random: &mut Random) -> Stage {
    let others = [
        Stage::Spheres,
        Stage::Tetrahedron,
        Stage::Shading,
        Stage::Shadow,
    ];
    match random.below(3) {
        0 => others[random.below(4)],
        _ => Stage::Reflection,
    }
}
