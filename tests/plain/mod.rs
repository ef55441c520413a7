//! The picture evaluated plainly in 256 bits, straight from its definition: world space, Equation 3-1 with its textbook
//! discriminant, planes cut one by one, a mirrored ray that is really mirrored. It shares no formula with the tracer.
//!
//! Lengths are measured in 1/(3N) and the eye looks along −(10 sin α, 3, 10 cos α), so that at α = 0 and for a scene of short
//! binary fractions everything but square roots and the final colour is exact, and a touching line is seen to touch.

use std::cmp::Ordering;

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use firsthit::tracer::{Decision, Seen};
use firsthit::{Scene, Stage};
use glam::DVec3;

type Number = FBig<HalfEven, 2>;
type Vector = [Number; 3];

const BITS: usize = 256;

fn number(value: f64) -> Number {
    Number::try_from(value)
        .unwrap()
        .with_precision(BITS)
        .value()
}

fn vector(v: DVec3) -> Vector {
    [number(v.x), number(v.y), number(v.z)]
}

fn zip(a: &Vector, b: &Vector, f: impl Fn(&Number, &Number) -> Number) -> Vector {
    [f(&a[0], &b[0]), f(&a[1], &b[1]), f(&a[2], &b[2])]
}

fn add(a: &Vector, b: &Vector) -> Vector {
    zip(a, b, |a, b| a + b)
}

fn sub(a: &Vector, b: &Vector) -> Vector {
    zip(a, b, |a, b| a - b)
}

fn scale(a: &Vector, factor: &Number) -> Vector {
    a.each_ref().map(|a| a * factor)
}

fn dot(a: &Vector, b: &Vector) -> Number {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [
        &a[1] * &b[2] - &a[2] * &b[1],
        &a[2] * &b[0] - &a[0] * &b[2],
        &a[0] * &b[1] - &a[1] * &b[0],
    ]
}

fn root(x: &Number) -> Number {
    if sign(x).is_eq() { x.clone() } else { x.sqrt() }
}

fn unit(a: &Vector) -> Vector {
    let length = root(&dot(a, a));
    a.each_ref().map(|a| a / &length)
}

fn sign(x: &Number) -> Ordering {
    x.cmp(&number(0.0))
}

enum Shape {
    Sphere {
        center: Vector,
        radius: Number,
    },
    /// A point of each face's plane, and its outward normal.
    Tetrahedron(Vec<(Vector, Vector)>),
}

struct Solid {
    shape: Shape,
    color: Vector,
}

/// Where a line is in a solid: from `near`, entering `face` with the outward normal there, to `far`.
struct Inside {
    near: Number,
    far: Number,
    face: Option<u8>,
    normal: Vector,
}

impl Solid {
    fn meet(&self, origin: &Vector, direction: &Vector) -> Option<Inside> {
        match &self.shape {
            Shape::Sphere { center, radius } => {
                let from_center = sub(origin, center);
                let a = dot(direction, direction);
                let b = dot(direction, &from_center);
                let c = dot(&from_center, &from_center) - radius * radius;
                let discriminant = &b * &b - &a * &c;
                if sign(&discriminant).is_lt() {
                    return None;
                }
                let root = root(&discriminant);
                let near = (-&b - &root) / &a;
                let far = (-&b + &root) / &a;
                let normal = add(&from_center, &scale(direction, &near));
                Some(Inside {
                    near,
                    far,
                    face: None,
                    normal,
                })
            }
            Shape::Tetrahedron(faces) => {
                // t = num/den with den > 0; fractions are compared by multiplying out, which is exact where they are.
                let less = |(a, b): &(Number, Number), (c, d): &(Number, Number)| a * d < c * b;
                let mut near: Option<(usize, (Number, Number))> = None;
                let mut far: Option<(Number, Number)> = None;
                for (k, (point, normal)) in faces.iter().enumerate() {
                    let f = dot(&sub(origin, point), normal);
                    let g = dot(direction, normal);
                    match sign(&g) {
                        Ordering::Less => {
                            let t = (f, -g);
                            if near.as_ref().is_none_or(|(_, other)| less(other, &t)) {
                                near = Some((k, t));
                            }
                        }
                        Ordering::Greater => {
                            let t = (-f, g);
                            if far.as_ref().is_none_or(|other| less(&t, other)) {
                                far = Some(t);
                            }
                        }
                        Ordering::Equal if sign(&f).is_gt() => return None,
                        Ordering::Equal => {}
                    }
                }
                let ((face, near), far) = (near?, far?);
                if less(&far, &near) {
                    return None;
                }
                Some(Inside {
                    near: near.0 / near.1,
                    far: far.0 / far.1,
                    face: Some(face as u8),
                    normal: faces[face].1.clone(),
                })
            }
        }
    }
}

/// A frame of the picture, ready to be evaluated pixel by pixel.
pub(crate) struct Plain<'a> {
    scene: &'a Scene,
    stage: Stage,
    size: u32,
    sin: Number,
    cos: Number,
    solids: Vec<Solid>,
    /// Toward the light.
    light: Vector,
}

impl<'a> Plain<'a> {
    pub(crate) fn new(scene: &'a Scene, stage: Stage, alpha: f64, size: u32) -> Plain<'a> {
        let (sin, cos) = number(alpha).sin_cos();
        let unit_length = number(3.0 * f64::from(size));
        let place = |p: DVec3| scale(&vector(p), &unit_length);
        let spheres = scene.spheres().iter().map(|sphere| Solid {
            shape: Shape::Sphere {
                center: place(sphere.center),
                radius: number(sphere.radius) * &unit_length,
            },
            color: vector(sphere.color),
        });
        let tetrahedra = scene.tetrahedra().iter().map(|tetrahedron| {
            let v = tetrahedron.vertices.map(place);
            let faces = [0, 1, 2, 3].map(|k: usize| {
                let [a, b, c] = [(k + 1) % 4, (k + 2) % 4, (k + 3) % 4];
                let normal = cross(&sub(&v[b], &v[a]), &sub(&v[c], &v[a]));
                let inward = sign(&dot(&normal, &sub(&v[k], &v[a]))).is_gt();
                (
                    v[a].clone(),
                    if inward { normal.map(|x| -x) } else { normal },
                )
            });
            Solid {
                shape: Shape::Tetrahedron(faces.to_vec()),
                color: vector(tetrahedron.color),
            }
        });
        let solids = spheres.chain(tetrahedra).collect();
        let light = vector(-scene.light().direction);
        Plain {
            scene,
            stage,
            size,
            sin,
            cos,
            solids,
            light,
        }
    }

    pub(crate) fn pixel(&self, column: u32, row: u32) -> (Decision, [f32; 3]) {
        let (decision, color) = self.evaluate(column, row);
        (decision, color.map(|x| x.to_f32().value() + 0.0))
    }

    fn evaluate(&self, column: u32, row: u32) -> (Decision, Vector) {
        let n = f64::from(self.size);
        if self.stage == Stage::Image {
            let (x, y, middle) = (f64::from(column), f64::from(row), n / 2.0);
            let (quadrant, color) = match () {
                () if x <= middle && y <= middle => (0, [0.3, 0.3, 0.0]),
                () if x <= middle && y >= middle => (1, [0.0, 0.3, 0.3]),
                () if x >= middle && y <= middle => (2, [0.3, 0.0, 0.3]),
                () => (3, [0.0; 3]),
            };
            return (Decision::Quadrant(quadrant), color.map(number));
        }
        let u = number(3.0 * (2.0 * f64::from(column) - n));
        let v = number(3.0 * (2.0 * f64::from(row) - n));
        let near = number(3.0 * n);
        let eye = [
            &near * &self.sin + &u * &self.cos,
            v.clone(),
            &near * &self.cos - &u * &self.sin,
        ];
        let looking = [
            number(-10.0) * &self.sin,
            number(-3.0),
            number(-10.0) * &self.cos,
        ];

        let takes_part = |solid: &Solid| match self.stage {
            Stage::Spheres => matches!(solid.shape, Shape::Sphere { .. }),
            Stage::Tetrahedron => matches!(solid.shape, Shape::Tetrahedron { .. }),
            _ => true,
        };
        let mut first: Option<(usize, Inside)> = None;
        for (index, solid) in self
            .solids
            .iter()
            .enumerate()
            .filter(|(_, solid)| takes_part(solid))
        {
            if let Some(inside) = solid.meet(&eye, &looking)
                && first
                    .as_ref()
                    .is_none_or(|(_, other)| inside.near < other.near)
            {
                first = Some((index, inside));
            }
        }

        if self.stage >= Stage::Shadow
            && let Some(surface) = self.scene.surface()
        {
            // 3 t = v − height, both a multiple of 3.
            let t = number(2.0 * f64::from(row) - n) - number(n) * number(surface.height);
            let point = add(&eye, &scale(&looking, &t));
            let visible = first.as_ref().is_none_or(|(_, inside)| t < inside.near);
            if visible && self.on_square(&point, &number(1.0)) {
                return self.surface_at(&point, &looking);
            }
        }
        match first {
            None => (Decision::Background, vector(self.scene.background())),
            Some((index, inside)) => {
                let point = add(&eye, &scale(&looking, &inside.near));
                let (in_shadow, color) = self.shade(index, &inside, &point, &looking);
                (
                    Decision::Solid(Seen {
                        solid: index as u16,
                        face: inside.face,
                        in_shadow,
                    }),
                    color,
                )
            }
        }
    }

    fn surface_at(&self, point: &Vector, looking: &Vector) -> (Decision, Vector) {
        let Some(surface) = self.scene.surface() else {
            unreachable!("there is a surface")
        };
        if self.shadowed(point, None) {
            return (Decision::SurfaceInShadow, self.ambient());
        }
        if self.stage >= Stage::Reflection {
            let mirrored = [looking[0].clone(), -&looking[1], looking[2].clone()];
            let zero = number(0.0);
            let start = |inside: &Inside| {
                if inside.near < zero {
                    zero.clone()
                } else {
                    inside.near.clone()
                }
            };
            let mut first: Option<(usize, Inside)> = None;
            for (index, solid) in self.solids.iter().enumerate() {
                if let Some(inside) = solid.meet(point, &mirrored)
                    && inside.far > zero
                    && first
                        .as_ref()
                        .is_none_or(|(_, other)| start(&inside) < start(other))
                {
                    first = Some((index, inside));
                }
            }
            if let Some((index, inside)) = first {
                let seen_point = add(point, &scale(&mirrored, &inside.near));
                let (in_shadow, color) = self.shade(index, &inside, &seen_point, &mirrored);
                let seen = Seen {
                    solid: index as u16,
                    face: inside.face,
                    in_shadow,
                };
                return (
                    Decision::Mirrored(seen),
                    scale(&color, &number(surface.reflectance)),
                );
            }
        }
        (Decision::Surface, vector(surface.color))
    }

    /// Whether a point in the square's plane is in the square, both scaled by `factor`.
    fn on_square(&self, point: &Vector, factor: &Number) -> bool {
        self.scene.surface().is_some_and(|surface| {
            let half_width =
                number(surface.half_width) * number(3.0 * f64::from(self.size)) * factor;
            [&point[0], &point[2]]
                .into_iter()
                .all(|x| *x <= half_width && -x <= half_width)
        })
    }

    fn shadowed(&self, point: &Vector, besides: Option<usize>) -> bool {
        self.solids.iter().enumerate().any(|(index, solid)| {
            Some(index) != besides
                && solid
                    .meet(point, &self.light)
                    .is_some_and(|inside| sign(&inside.far).is_gt())
        })
    }

    fn shaded_by_surface(&self, point: &Vector) -> bool {
        let Some(surface) = self.scene.surface() else {
            return false;
        };
        let rise = number(surface.height) * number(3.0 * f64::from(self.size)) - &point[1];
        let climb = &self.light[1];
        // A light in the surface's plane is not among the scenes that this evaluation is used for.
        assert!(!sign(climb).is_eq());
        let positive = if sign(climb).is_lt() {
            -climb
        } else {
            climb.clone()
        };
        let scaled_t = if sign(climb).is_lt() { -rise } else { rise };
        sign(&scaled_t).is_gt()
            && self.on_square(
                &add(&scale(point, &positive), &scale(&self.light, &scaled_t)),
                &positive,
            )
    }

    fn ambient(&self) -> Vector {
        let (light, material) = (self.scene.light(), self.scene.material());
        zip(
            &vector(material.ambient),
            &vector(light.ambient_intensity),
            |k, i| k * i,
        )
    }

    /// Whether a point of a solid is in shadow, and its colour.
    fn shade(
        &self,
        index: usize,
        inside: &Inside,
        point: &Vector,
        looking: &Vector,
    ) -> (bool, Vector) {
        let color = &self.solids[index].color;
        if matches!(self.stage, Stage::Spheres | Stage::Tetrahedron) {
            return (false, color.clone());
        }
        let normal = unit(&inside.normal);
        let l = unit(&self.light);
        let n_l = dot(&normal, &l);
        let in_shadow = self.stage >= Stage::Shadow
            && (sign(&dot(&inside.normal, &self.light)).is_le()
                || self.shadowed(point, Some(index))
                || self.shaded_by_surface(point));
        let mut light = self.ambient();
        if !in_shadow {
            let (i, material) = (vector(self.scene.light().intensity), self.scene.material());
            let zero = number(0.0);
            let diffuse = zip(&vector(material.diffuse), &i, |k, i| k * i);
            light = add(
                &light,
                &scale(&diffuse, if n_l > zero { &n_l } else { &zero }),
            );
            let v = unit(&scale(looking, &number(-1.0)));
            let h = unit(&add(&v, &l));
            let n_h = dot(&normal, &h);
            if n_h > zero {
                let specular = zip(&vector(material.specular), &i, |k, i| k * i);
                let highlight = n_h.powi(material.exponent.into());
                light = add(&light, &scale(&specular, &highlight));
            }
        }
        (in_shadow, zip(color, &light, |c, l| c * l))
    }
}
