//! What a pixel shows, decided from the picture's definition in exact rationals, at angles whose
//! sine and cosine are rational.
//!
//! World space, lengths of the scene, equation 3-1 with its textbook discriminant, a ray that is
//! really mirrored, polyhedra as systems of linear inequalities: it shares no formula with the
//! tracer. The only roots in a decision are those of discriminants, so every sign is that of P +
//! Q√C or of P + √B − √C.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod compare;
mod surd;
mod ties;

use std::cmp::Ordering;

use dashu_ratio::Relaxed;
use glam::DVec3;

use super::decision::{Decision, Seen};
use crate::scene::{Scene, Tetrahedron};
use crate::stage::Stage;
use surd::{Surd, sign};

type Vector = [Relaxed; 3];
type Point = [Surd; 3];

fn exact(v: DVec3) -> Vector {
    v.to_array().map(|x| Relaxed::try_from(x).unwrap())
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

fn dot(a: &Vector, b: &Vector) -> Relaxed {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [
        &a[1] * &b[2] - &a[2] * &b[1],
        &a[2] * &b[0] - &a[0] * &b[2],
        &a[0] * &b[1] - &a[1] * &b[0],
    ]
}

fn point(a: &Vector) -> Point {
    a.clone().map(Surd::from)
}

fn dot_point(a: &Point, b: &Vector) -> Surd {
    let [x, y, z] = [0, 1, 2].map(|i| a[i].scaled(&b[i]));
    &(&x + &y) + &z
}

fn from_center(x: &Point, center: &Vector) -> Point {
    [0, 1, 2].map(|i| &x[i] - &Surd::from(center[i].clone()))
}

/// origin + t · direction.
fn along(origin: &Vector, direction: &Vector, t: &Surd) -> Point {
    [0, 1, 2].map(|i| &Surd::from(origin[i].clone()) + &t.scaled(&direction[i]))
}

/// The sine and the cosine of an angle where both are rational: (a, b, c) for a/c and b/c with a² +
/// b² = c².
#[derive(Clone, Copy, Debug, PartialEq)]
struct Turn(i32, i32, i32);

impl Turn {
    fn sin_cos(self) -> [Relaxed; 2] {
        [self.0, self.1].map(|x| Relaxed::from(x) / Relaxed::from(self.2))
    }
}

/// The points x with normal · x ≤ offset.
struct HalfSpace {
    normal: Vector,
    offset: Relaxed,
}

impl HalfSpace {
    /// Positive where x is outside.
    fn outside(&self, x: &Point) -> Surd {
        &dot_point(x, &self.normal) - &Surd::from(self.offset.clone())
    }
}

/// A tetrahedron's faces in their order, or the four sides of the surface with its plane from above
/// and from below.
struct Polyhedron(Vec<HalfSpace>);

impl Polyhedron {
    fn tetrahedron(tetrahedron: &Tetrahedron) -> Polyhedron {
        let v = tetrahedron.vertices.map(exact);
        let face = |k: usize| {
            let [a, b, c] = [(k + 1) % 4, (k + 2) % 4, (k + 3) % 4].map(|i| &v[i]);
            let normal = cross(&minus(b, a), &minus(c, a));
            let inward = sign(&dot(&normal, &minus(&v[k], a))).is_gt();
            let normal = if inward { normal.map(|x| -x) } else { normal };
            HalfSpace {
                offset: dot(&normal, a),
                normal,
            }
        };
        Polyhedron((0..4).map(face).collect())
    }

    fn square(height: f64, half_width: f64) -> Polyhedron {
        let sides = [
            (DVec3::X, half_width),
            (-DVec3::X, half_width),
            (DVec3::Z, half_width),
            (-DVec3::Z, half_width),
            (DVec3::Y, height),
            (-DVec3::Y, -height),
        ];
        let half_space = |(normal, offset)| HalfSpace {
            normal: exact(normal),
            offset: Relaxed::try_from(offset).unwrap(),
        };
        Polyhedron(sides.map(half_space).into())
    }

    fn contains(&self, x: &Point) -> bool {
        self.0.iter().all(|side| side.outside(x).sign().is_le())
    }

    /// Where a line that meets it enters it, and through which face; of several, the lowest.
    fn entry(&self, origin: &Vector, direction: &Vector) -> Option<(usize, Relaxed)> {
        let mut last: Option<(usize, Relaxed)> = None;
        for (k, face) in self.0.iter().enumerate() {
            let speed = dot(direction, &face.normal);
            if sign(&speed).is_lt() {
                let t = (&face.offset - dot(origin, &face.normal)) / speed;
                if last.as_ref().is_none_or(|(_, other)| t > *other) {
                    last = Some((k, t));
                }
            }
        }
        last.filter(|(_, t)| self.contains(&along(origin, direction, &t.clone().into())))
    }

    /// Whether any t > 0 fulfils f + g t ≤ 0 for every side: by Fourier and Motzkin's elimination
    /// of t, if and only if every inequality without t holds and no lower bound of t exceeds an
    /// upper one.
    fn is_ahead(&self, origin: &Point, direction: &Vector) -> bool {
        let all: Vec<(Surd, Relaxed)> = self
            .0
            .iter()
            .map(|side| (side.outside(origin), dot(direction, &side.normal)))
            .collect();
        let alone = all.iter().all(|(f, g)| match sign(g) {
            // t ≥ f/|g|, which some t > 0 always is.
            Ordering::Less => true,
            Ordering::Equal => f.sign().is_le(),
            // 0 < t ≤ −f/g.
            Ordering::Greater => f.sign().is_lt(),
        });
        let pairs = || {
            all.iter().filter(|(_, g)| sign(g).is_lt()).all(|(f, g)| {
                all.iter()
                    .filter(|(_, g)| sign(g).is_gt())
                    .all(|(f2, g2)| (&f.scaled(g2) - &f2.scaled(g)).sign().is_le())
            })
        };
        alone && pairs()
    }
}

enum Solid {
    Sphere { center: Vector, radius: Relaxed },
    Tetrahedron(Polyhedron),
}

/// Where a line enters a solid.
struct Entry {
    t: Surd,
    face: Option<u8>,
    point: Point,
    /// Outward, of any length.
    normal: Point,
}

impl Solid {
    fn entry(&self, origin: &Vector, direction: &Vector) -> Option<Entry> {
        match self {
            Solid::Sphere { center, radius } => {
                let offset = minus(origin, center);
                let a = dot(direction, direction);
                let b = dot(direction, &offset);
                let c = dot(&offset, &offset) - radius * radius;
                let discriminant = &b * &b - &a * &c;
                if sign(&discriminant).is_lt() {
                    return None;
                }
                let t = Surd::new(-&b / &a, -(Relaxed::ONE / &a), discriminant);
                let point = along(origin, direction, &t);
                Some(Entry {
                    t,
                    face: None,
                    normal: from_center(&point, center),
                    point,
                })
            }
            Solid::Tetrahedron(faces) => {
                let (k, t) = faces.entry(origin, direction)?;
                let t = Surd::from(t);
                Some(Entry {
                    point: along(origin, direction, &t),
                    t,
                    face: Some(k as u8),
                    normal: point(&faces.0[k].normal),
                })
            }
        }
    }

    /// Whether the ray meets the solid at some t > 0.
    fn is_ahead(&self, origin: &Point, direction: &Vector) -> bool {
        match self {
            Solid::Sphere { center, radius } => {
                let offset = from_center(origin, center);
                let a = dot(direction, direction);
                let b = dot_point(&offset, direction);
                let squares = offset.each_ref().map(|x| x.times(x));
                let c =
                    &(&(&squares[0] + &squares[1]) + &squares[2]) - &Surd::from(radius * radius);
                let discriminant = &b.times(&b) - &c.scaled(&a);
                // t_far = (−b + √D)/a > 0: where b < 0 always, otherwise where D > b², which is c <
                // 0.
                discriminant.sign().is_ge() && (b.sign().is_lt() || c.sign().is_lt())
            }
            Solid::Tetrahedron(faces) => faces.is_ahead(origin, direction),
        }
    }
}

/// A frame of the picture, ready to be decided pixel by pixel.
struct Definition {
    stage: Stage,
    size: u32,
    sin: Relaxed,
    cos: Relaxed,
    solids: Vec<Solid>,
    to_light: Vector,
    surface: Option<Surface>,
}

struct Surface {
    height: Relaxed,
    square: Polyhedron,
}

impl Definition {
    /// `stage` is one that shows the scene: the second or a later one.
    fn new(scene: &Scene, stage: Stage, turn: Turn, size: u32) -> Definition {
        let spheres = scene.spheres().iter().map(|sphere| Solid::Sphere {
            center: exact(sphere.center),
            radius: Relaxed::try_from(sphere.radius).unwrap(),
        });
        let tetrahedra = scene.tetrahedra().iter();
        let tetrahedra = tetrahedra.map(|t| Solid::Tetrahedron(Polyhedron::tetrahedron(t)));
        let surface = scene.surface().filter(|_| stage >= Stage::Shadow);
        let [sin, cos] = turn.sin_cos();
        Definition {
            stage,
            size,
            sin,
            cos,
            solids: spheres.chain(tetrahedra).collect(),
            to_light: exact(-scene.light().direction),
            surface: surface.map(|surface| Surface {
                height: Relaxed::try_from(surface.height).unwrap(),
                square: Polyhedron::square(surface.height, surface.half_width),
            }),
        }
    }

    fn takes_part(&self, solid: &Solid) -> bool {
        match self.stage {
            Stage::Spheres => matches!(solid, Solid::Sphere { .. }),
            Stage::Tetrahedron => matches!(solid, Solid::Tetrahedron(_)),
            _ => true,
        }
    }

    /// e(u, v) for a pixel.
    fn eye(&self, column: u32, row: u32) -> Vector {
        let n = Relaxed::from(self.size);
        let [u, v] = [column, row].map(|x| (Relaxed::from(2 * x) - &n) / &n);
        [&self.sin + &u * &self.cos, v, &self.cos - &u * &self.sin]
    }

    /// −w.
    fn looking(&self) -> Vector {
        let rise = Relaxed::from(3) / Relaxed::from(10);
        [-self.sin.clone(), -rise, -self.cos.clone()]
    }

    fn decision(&self, column: u32, row: u32) -> Decision {
        let (eye, looking) = (self.eye(column, row), self.looking());
        let mut first: Option<(usize, Entry)> = None;
        for (index, solid) in self.solids.iter().enumerate() {
            if self.takes_part(solid)
                && let Some(entry) = solid.entry(&eye, &looking)
                && first
                    .as_ref()
                    .is_none_or(|(_, other)| entry.t.compare(&other.t).is_lt())
            {
                first = Some((index, entry));
            }
        }
        if let Some(surface) = &self.surface {
            let t = (&surface.height - &eye[1]) / &looking[1];
            let place = [0, 1, 2].map(|i| &eye[i] + &t * &looking[i]);
            let t = Surd::from(t);
            let hides = first
                .as_ref()
                .is_none_or(|(_, entry)| t.compare(&entry.t).is_lt());
            if hides && surface.square.contains(&point(&place)) {
                return self.surface_at(&place, &looking);
            }
        }
        match first {
            None => Decision::Background,
            Some((index, entry)) => Decision::Solid(self.seen(index, &entry)),
        }
    }

    fn surface_at(&self, place: &Vector, looking: &Vector) -> Decision {
        let start = point(place);
        let mut solids = self.solids.iter();
        if solids.any(|solid| solid.is_ahead(&start, &self.to_light)) {
            return Decision::SurfaceInShadow;
        }
        if self.stage < Stage::Reflection {
            return Decision::Surface;
        }
        // r = d − 2(d·m)m with m = (0, 1, 0).
        let [x, y, z] = looking.clone();
        let mirrored = [x, -y, z];
        let from = |entry: &Entry| match entry.t.sign() {
            Ordering::Less => Surd::from(Relaxed::ZERO),
            _ => entry.t.clone(),
        };
        let mut first: Option<(usize, Entry)> = None;
        for (index, solid) in self.solids.iter().enumerate() {
            if solid.is_ahead(&start, &mirrored)
                && let Some(entry) = solid.entry(place, &mirrored)
                && first
                    .as_ref()
                    .is_none_or(|(_, other)| from(&entry).compare(&from(other)).is_lt())
            {
                first = Some((index, entry));
            }
        }
        match first {
            None => Decision::Surface,
            Some((index, entry)) => Decision::Mirrored(self.seen(index, &entry)),
        }
    }

    fn seen(&self, index: usize, entry: &Entry) -> Seen {
        Seen {
            solid: index as u16,
            face: entry.face,
            in_shadow: self.stage >= Stage::Shadow && self.in_shadow(index, entry),
        }
    }

    fn in_shadow(&self, index: usize, entry: &Entry) -> bool {
        let ahead = |solid: &Solid| solid.is_ahead(&entry.point, &self.to_light);
        let mut others = self.solids.iter().enumerate();
        dot_point(&entry.normal, &self.to_light).sign().is_le()
            || others.any(|(other, solid)| other != index && ahead(solid))
            || self
                .surface
                .as_ref()
                .is_some_and(|surface| surface.square.is_ahead(&entry.point, &self.to_light))
    }
}
