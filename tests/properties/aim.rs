//! What is made to happen exactly at a pixel's sample, or a few ulp beside it.

use glam::DVec3;

use super::model::Model;
use crate::helpers::Random;

#[derive(Clone, Debug)]
pub(crate) struct Aim {
    what: What,
    /// The pixel's place from 0 to 1, from the left and from the bottom.
    place: (f64, f64),
    /// Which solid, modulo their number.
    solid: usize,
    /// How many ulp beside it.
    ulps: i32,
    /// How far behind the screen, where there is a choice.
    depth: f64,
}

#[derive(Clone, Copy, Debug)]
enum What {
    /// A sphere's rim.
    Rim,
    /// The same beside the centre, where short numbers touch exactly.
    RimBeside,
    /// The rim of a sphere in the mirror.
    MirroredRim,
    /// The rim of a sphere's shadow on the surface.
    ShadowRim,
    /// A sphere's terminator.
    Terminator,
    /// The same before the centre, where short numbers meet exactly.
    TerminatorBefore,
    /// A sphere that is hit where another one is.
    EqualDepth,
    /// The same before their centres.
    EqualDepthBefore,
    /// A sphere that is hit where the surface is.
    SurfaceDepth,
    /// A sphere that touches the surface.
    Resting,
    /// A tetrahedron's vertex.
    Vertex,
    /// An edge of a tetrahedron.
    Edge,
    /// An edge of a tetrahedron's shadow on the surface.
    ShadowEdge,
    /// A face along which the light runs.
    LitAlong,
    /// A face along which the eye looks.
    SeenAlong,
    /// A face in the surface's plane.
    Base,
    /// A face that two tetrahedra share.
    SharedFace,
    /// A sphere and a tetrahedron listed twice.
    Twice,
    /// The surface's border.
    Border,
    /// A light in the surface's plane.
    LevelLight,
    /// A light along the line of sight.
    LightAlongTheEye,
}

const ALL: [What; 21] = [
    What::Rim,
    What::RimBeside,
    What::MirroredRim,
    What::ShadowRim,
    What::Terminator,
    What::TerminatorBefore,
    What::EqualDepth,
    What::EqualDepthBefore,
    What::SurfaceDepth,
    What::Resting,
    What::Vertex,
    What::Edge,
    What::ShadowEdge,
    What::LitAlong,
    What::SeenAlong,
    What::Base,
    What::SharedFace,
    What::Twice,
    What::Border,
    What::LevelLight,
    What::LightAlongTheEye,
];

pub(crate) fn aim(random: &mut Random) -> Aim {
    Aim {
        what: ALL[random.below(ALL.len())],
        place: (random.fraction(), random.fraction()),
        solid: random.below(6),
        ulps: match random.below(2) {
            0 => 0,
            _ => random.below(7) as i32 - 3,
        },
        depth: match random.below(4) {
            0 => 0.0,
            1 => 0.625,
            2 => 1.25,
            _ => 2.0 * random.fraction(),
        },
    }
}

/// `x`, `ulps` f64s on.
fn step(x: f64, ulps: i32) -> f64 {
    let next = if ulps > 0 {
        f64::next_up
    } else {
        f64::next_down
    };
    (0..ulps.abs()).fold(x, |x, _| next(x))
}

/// Each component by itself, so that the steps differ.
fn step_each(v: DVec3, ulps: i32) -> DVec3 {
    DVec3::new(step(v.x, ulps), step(v.y, -ulps / 2), step(v.z, ulps / 3))
}

/// The distance of `point` from a line.
fn distance(point: DVec3, origin: DVec3, direction: DVec3) -> f64 {
    (point - origin).cross(direction).length() / direction.length()
}

impl Aim {
    /// The pixel of an N × N picture.
    pub(crate) fn pixel(&self, size: u32) -> (u32, u32) {
        let index = |place: f64| (place * f64::from(size)) as u32;
        (index(self.place.0), index(self.place.1))
    }

    /// Changes the scene so that it happens, as nearly as f64 computes it, in the picture of that α
    /// and N.
    pub(crate) fn apply(&self, model: &mut Model, alpha: f64, size: u32) {
        self.try_apply(model, alpha, size);
    }

    /// `None` where the scene lacks what is needed; it may be changed all the same.
    fn try_apply(&self, model: &mut Model, alpha: f64, size: u32) -> Option<()> {
        let (column, row) = self.pixel(size);
        let half = f64::from(size) / 2.0;
        let (u, v) = (f64::from(column) / half - 1.0, f64::from(row) / half - 1.0);
        let (sin, cos) = alpha.sin_cos();
        let eye = DVec3::new(sin + u * cos, v, cos - u * sin);
        // Toward the scene, one unit deep for each t.
        let looking = -DVec3::new(sin, 0.3, cos);
        let seen = eye + looking * self.depth;
        let on_floor = |height: f64| eye + looking * ((v - height) / 0.3);
        let sphere = self.solid.checked_rem(model.spheres.len());
        let tetrahedron = self.solid.checked_rem(model.tetrahedra.len());
        let ulps = self.ulps;
        match self.what {
            What::Rim => {
                let (center, radius) = &mut model.spheres[sphere?];
                *radius = step(distance(*center, eye, looking), ulps);
            }
            What::RimBeside => {
                let (center, radius) = &mut model.spheres[sphere?];
                *center = seen + DVec3::X * *radius;
                *radius = step(*radius, ulps);
            }
            What::MirroredRim => {
                let mirrored = DVec3::new(looking.x, -looking.y, looking.z);
                let floor = on_floor(model.surface?.0);
                let (center, radius) = &mut model.spheres[sphere?];
                *radius = step(distance(*center, floor, mirrored), ulps);
            }
            What::ShadowRim => {
                let floor = on_floor(model.surface?.0);
                let (center, radius) = &mut model.spheres[sphere?];
                *radius = step(distance(*center, floor, model.light), ulps);
            }
            What::Terminator => {
                let (center, _) = model.spheres[sphere?];
                // The sphere through a point of the line of sight that the light touches there.
                let normal = seen - center;
                let along = normal.cross(DVec3::new(0.3, self.depth, -0.7));
                model.light = step_each(along, ulps);
                model.spheres[sphere?].1 = normal.length();
            }
            What::TerminatorBefore => {
                let (center, radius) = &mut model.spheres[sphere?];
                *center = seen - DVec3::Z * *radius;
                model.light.z = f64::from(ulps) * 1e-17;
            }
            What::EqualDepthBefore => {
                let (center, radius) = &mut model.spheres[sphere?];
                *center = seen - DVec3::Z * *radius;
                let (other, far) = (seen - DVec3::Z * self.depth, step(self.depth, ulps));
                model.spheres.push((other, far));
            }
            What::SurfaceDepth => {
                let (center, radius) = &mut model.spheres[sphere?];
                *center = seen - DVec3::Z * *radius;
                model.surface.as_mut()?.0 = step(seen.y, ulps);
            }
            What::EqualDepth => {
                let (center, radius) = &mut model.spheres[sphere?];
                *radius = (seen - *center).length();
                let other = seen - (seen - *center) * 1.25 + DVec3::X * 0.125;
                model
                    .spheres
                    .push((other, step((seen - other).length(), ulps)));
            }
            What::Resting => {
                let height = model.surface?.0;
                let (center, radius) = &mut model.spheres[sphere?];
                *radius = step((center.y - height).abs(), ulps);
            }
            What::Vertex => {
                model.tetrahedra[tetrahedron?][self.solid % 4] = step_each(seen, ulps);
            }
            What::Edge => {
                let vertices = &mut model.tetrahedra[tetrahedron?];
                let [a, b] = [self.solid % 4, (self.solid + 1) % 4];
                vertices[b] = step_each(vertices[a] + (seen - vertices[a]) * 2.0, ulps);
            }
            What::ShadowEdge => {
                let over = on_floor(model.surface?.0) - model.light * self.depth;
                let vertices = &mut model.tetrahedra[tetrahedron?];
                let [a, b] = [self.solid % 4, (self.solid + 1) % 4];
                vertices[b] = step_each(vertices[a] + (over - vertices[a]) * 1.5, ulps);
            }
            What::LitAlong => {
                let [a, b, c, _] = model.tetrahedra[tetrahedron?];
                model.light = step_each((b - a) + (c - a) * self.depth, ulps);
            }
            What::SeenAlong => {
                let vertices = &mut model.tetrahedra[tetrahedron?];
                let [a, b] = [self.solid % 4, (self.solid + 1) % 4];
                vertices[a] = seen;
                // At α = 0 exactly along the line of sight.
                vertices[b] = step_each(seen + looking * 0.625, ulps);
            }
            What::Base => {
                let (height, _) = model.surface?;
                let vertices = &mut model.tetrahedra[tetrahedron?];
                for vertex in vertices.iter_mut().take(3) {
                    vertex.y = height;
                }
                vertices[0].y = step(height, ulps);
            }
            What::SharedFace => {
                let mut other = model.tetrahedra[tetrahedron?];
                other.rotate_left(1 + self.solid % 3);
                other[self.solid % 4] = step_each(seen, ulps);
                model.tetrahedra.push(other);
            }
            What::Twice => {
                model.spheres.extend(model.spheres.first().copied());
                if let Some(mut again) = model.tetrahedra.first().copied() {
                    again.swap(self.solid % 4, (self.solid + 2) % 4);
                    model.tetrahedra.push(again);
                }
            }
            What::Border => {
                let (height, half_width) = model.surface.as_mut()?;
                let floor = on_floor(*height);
                let side = if self.solid.is_multiple_of(2) {
                    floor.x
                } else {
                    floor.z
                };
                *half_width = step(side.abs(), ulps);
            }
            What::LevelLight => model.light.y = f64::from(ulps) * 1e-17,
            What::LightAlongTheEye => {
                let direction = step_each(looking * 2.5, ulps);
                model.light = match self.solid % 3 {
                    0 => direction,
                    1 => -direction,
                    _ => DVec3::new(-direction.x, direction.y, -direction.z),
                };
            }
        }
        Some(())
    }
}
