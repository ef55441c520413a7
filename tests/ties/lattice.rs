//! Places that lie on samples, and scenes of them.
//!
//! Lengths are in 64ths, and z counts from [`AXIS`]: with N = 128 and at α = 0 every place with
//! whole coordinates, z a multiple of 10, lies on the line of sight through a sample. So the
//! geometry is chosen first. Scenes are turned instead of the eye.

use firsthit::Scene;

pub(crate) type Place = [i32; 3];

pub(crate) const SIZE: u32 = 128;

/// The z of the axis about which scenes are turned.
pub(crate) const AXIS: i32 = 4;

/// The height of most surfaces.
pub(crate) const HEIGHT: i32 = -30;

pub(crate) fn plus(a: Place, b: Place) -> Place {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn times(factor: i32, a: Place) -> Place {
    a.map(|x| factor * x)
}

/// A reflection that exchanges x for −x, or none, and then quarters of a turn about the axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn {
    flipped: bool,
    quarters: u32,
}

/// What leaves what lies along the line of sight there.
pub(crate) const FLIPS: [Turn; 2] = [
    Turn {
        flipped: false,
        quarters: 0,
    },
    Turn {
        flipped: true,
        quarters: 0,
    },
];

/// All.
pub(crate) fn turns() -> impl Iterator<Item = Turn> {
    (0..4).flat_map(|quarters| FLIPS.map(|flip| Turn { quarters, ..flip }))
}

impl Turn {
    /// A place or a vector, turned.
    pub(crate) fn of(self, [x, y, z]: Place) -> Place {
        let x = if self.flipped { -x } else { x };
        let [x, z] = (0..self.quarters).fold([x, z], |[x, z], _| [z, -x]);
        [x, y, z]
    }
}

fn lengths(place: Place) -> [f64; 3] {
    place.map(|x| f64::from(x) / 64.0)
}

fn world(place: Place) -> [f64; 3] {
    lengths(plus(place, [0, 0, AXIS]))
}

/// As it stands in a scene file.
pub(crate) fn sphere(center: Place, radius: i32) -> String {
    let (center, radius) = (world(center), f64::from(radius) / 64.0);
    format!("[[sphere]]\ncenter = {center:?}\nradius = {radius:?}\ncolor = [1.0, 0.5, 0.25]\n")
}

/// As it stands in a scene file.
pub(crate) fn tetrahedron(vertices: [Place; 4]) -> String {
    let vertices = vertices.map(world);
    format!("[[tetrahedron]]\nvertices = {vertices:?}\ncolor = [0.25, 0.5, 1.0]\n")
}

/// `to_light` is the way to the light; the surface is at a height and has half a width.
pub(crate) fn scene(to_light: Place, surface: Option<[i32; 2]>, solids: &[String]) -> Scene {
    let direction = lengths(times(-1, to_light));
    let mut text = format!("light = {{ direction = {direction:?} }}\n");
    if let Some([height, half_width]) = surface.map(|s| s.map(|x| f64::from(x) / 64.0)) {
        text += &format!("surface = {{ height = {height:?}, half_width = {half_width:?} }}\n");
    }
    Scene::from_toml(&(text + &solids.concat())).unwrap()
}

/// In the mirror of a surface at [`HEIGHT`].
pub(crate) fn mirrored([x, y, z]: Place) -> Place {
    [x, 2 * HEIGHT - y, z]
}

/// Where the shadow of a point falls on a surface at [`HEIGHT`], if that is a place.
pub(crate) fn shadow(place: Place, to_light: Place) -> Option<Place> {
    let shift = times(place[1] - HEIGHT, to_light);
    let is_place = shift.iter().all(|shift| shift % to_light[1] == 0);
    is_place.then(|| plus(place, shift.map(|shift| -shift / to_light[1])))
}

/// The vertices and the middles of the edges.
pub(crate) fn corners(v: [Place; 4]) -> Vec<Place> {
    let edges = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
    let middle = |(a, b): (usize, usize)| {
        plus(v[a], v[b]).map(|x| {
            assert!(x % 2 == 0, "half a length");
            x / 2
        })
    };
    v.into_iter().chain(edges.map(middle)).collect()
}

/// Whether a surface with this outward normal is turned toward the eye.
pub(crate) fn faces_eye([_, y, z]: Place) -> bool {
    3 * y + 10 * z > 0
}

/// The pixel whose line of sight goes through a place; `None` where it is between samples, or
/// outside of the picture.
pub(crate) fn sample([x, y, z]: Place) -> Option<(u32, u32)> {
    let half = SIZE as i32 / 2;
    // v = y + 3/10 (1 − z).
    let rise = 3 * (64 - AXIS - z);
    let pixel = [half + x, half + y + rise / 10].map(|i| u32::try_from(i).ok());
    let [column, row] = pixel.map(|i| i.filter(|&i| i < SIZE));
    (rise % 10 == 0).then_some((column?, row?))
}
