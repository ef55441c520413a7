//! Random scenes, as their numbers.

use std::fmt::Write;

use firsthit::{Scene, Stage};
use glam::DVec3;
use proptest::collection::vec;
use proptest::prelude::*;

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
    /// As a scene file; `None` for a scene that is refused, such as one with a flat tetrahedron.
    pub(crate) fn scene(&self) -> Option<Scene> {
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
            .ok()?;
        }
        writeln!(
            text,
            "[light]\ndirection = {}\nintensity = {bright}\nambient_intensity = {bright}",
            triple(self.light)
        )
        .ok()?;
        writeln!(text, "[material]\nexponent = {}", self.exponent).ok()?;
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
            .ok()?;
        }
        for i in order(self.tetrahedra.len()) {
            let vertices = self.tetrahedra[i].map(|v| v.to_array());
            let color = color(5 + i);
            writeln!(
                text,
                "[[tetrahedron]]\nvertices = {vertices:?}\ncolor = {color}"
            )
            .ok()?;
        }
        Scene::from_toml(&text).ok()
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

/// A multiple of 1/64: where these meet samples, they meet them exactly.
pub(crate) fn short() -> impl Strategy<Value = f64> + Clone {
    (-56..=56).prop_map(|k| f64::from(k) / 64.0)
}

/// Any f64 of that size.
pub(crate) fn long() -> impl Strategy<Value = f64> + Clone {
    -0.875..0.875
}

fn point(coordinate: impl Strategy<Value = f64> + Clone) -> impl Strategy<Value = DVec3> {
    (coordinate.clone(), coordinate.clone(), coordinate).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// Up to three spheres and up to two tetrahedra, mostly on a surface.
pub(crate) fn model(
    coordinate: impl Strategy<Value = f64> + Clone + 'static,
) -> impl Strategy<Value = Model> {
    let radius = || coordinate.clone().prop_map(|r| 0.015625 + r.abs() / 2.0);
    let surface = (coordinate.clone(), radius()).prop_map(|(h, w)| (h / 2.0 - 0.4375, 2.0 * w));
    let corners = || std::array::from_fn(|_| point(coordinate.clone()).boxed());
    let tetrahedron: [_; 4] = corners();
    (
        proptest::option::weighted(0.85, surface),
        point(coordinate.clone()).prop_filter("a light", |d| *d != DVec3::ZERO),
        prop_oneof![Just(1), Just(7), Just(1000), Just(1_000_000)],
        vec((point(coordinate.clone()), radius()), 0..=3),
        vec(tetrahedron, 0..=2),
    )
        .prop_map(|(surface, light, exponent, spheres, tetrahedra)| Model {
            surface,
            light: DVec3::new(light.x, -light.y, light.z),
            brightness: 0,
            exponent,
            spheres,
            tetrahedra,
            backwards: false,
        })
}

/// Coordinates of either kind, all of a scene of one.
pub(crate) fn any_model() -> impl Strategy<Value = Model> {
    prop_oneof![model(short()), model(long())]
}

/// α = 0 half of the time, where samples are met exactly.
pub(crate) fn angle() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => Just(0.0),
        2 => (0u64..21).prop_map(firsthit::camera::frame_angle),
        1 => -10.0..10.0,
        1 => prop_oneof![Just(1e-9), Just(std::f64::consts::FRAC_PI_2), Just(1e22)],
    ]
}

pub(crate) fn stage() -> impl Strategy<Value = Stage> {
    let stages = [
        Stage::Spheres,
        Stage::Tetrahedron,
        Stage::Shading,
        Stage::Shadow,
    ];
    prop_oneof![1 => proptest::sample::select(stages.to_vec()), 2 => Just(Stage::Reflection)]
}
