//! The picture evaluated plainly in as many bits as asked for, straight from its definition: world
//! space, Equation 3-1 with its textbook discriminant, planes cut one by one, a mirrored ray that
//! is really mirrored. It shares no formula with the tracer.
//!
//! Lengths are measured in 1/(3N) and the eye looks along −(10 sin α, 3, 10 cos α), so that at α =
//! 0 everything but square roots and the final colour is rational, and a touching line is seen to
//! touch. At other angles what is zero for every α is seen to be small beyond accident (see
//! [`Number`]).

mod number;

use std::cell::OnceCell;
use std::cmp::Ordering;

use firsthit::tracer::{Decision, Seen};
use firsthit::{Scene, Stage};
use glam::DVec3;
use number::Number;

type Vector = [Number; 3];

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

fn negative(a: &Vector) -> Vector {
    a.each_ref().map(|a| -a)
}

fn dot(a: &Vector, b: &Vector) -> Number {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    let minor = |i: usize, j: usize| &(&a[i] * &b[j]) - &(&a[j] * &b[i]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn unit(a: &Vector) -> Vector {
    let length = dot(a, a).root();
    a.each_ref().map(|a| a / &length)
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

/// Where a line is in a solid: from `near`, entering `face` with the outward normal there, to
/// `far`.
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
                let c = &dot(&from_center, &from_center) - &(radius * radius);
                let discriminant = &(&b * &b) - &(&a * &c);
                if discriminant.sign().is_lt() {
                    return None;
                }
                let root = discriminant.root();
                let near = &(-&(&b + &root)) / &a;
                let far = &(&root - &b) / &a;
                let normal = add(&from_center, &scale(direction, &near));
                Some(Inside {
                    near,
                    far,
                    face: None,
                    normal,
                })
            }
            Shape::Tetrahedron(faces) => {
                // t = num/den with den > 0; fractions are compared by multiplying out, which is
                // exact where they are.
                let less =
                    |(a, b): &(Number, Number), (c, d): &(Number, Number)| (a * d).less(&(c * b));
                let mut near: Option<(usize, (Number, Number))> = None;
                let mut far: Option<(Number, Number)> = None;
                for (k, (point, normal)) in faces.iter().enumerate() {
                    let f = dot(&sub(origin, point), normal);
                    let g = dot(direction, normal);
                    match g.sign() {
                        Ordering::Less => {
                            let t = (f, -&g);
                            if near.as_ref().is_none_or(|(_, other)| less(other, &t)) {
                                near = Some((k, t));
                            }
                        }
                        Ordering::Greater => {
                            let t = (-&f, g);
                            if far.as_ref().is_none_or(|other| less(&t, other)) {
                                far = Some(t);
                            }
                        }
                        Ordering::Equal if f.sign().is_gt() => return None,
                        Ordering::Equal => {}
                    }
                }
                let ((face, near), far) = (near?, far?);
                if less(&far, &near) {
                    return None;
                }
                Some(Inside {
                    near: &near.0 / &near.1,
                    far: &far.0 / &far.1,
                    face: Some(face as u8),
                    normal: faces[face].1.clone(),
                })
            }
        }
    }
}

/// A frame of the picture, ready to be evaluated pixel by pixel.
pub(crate) struct Oracle<'a> {
    scene: &'a Scene,
    size: u32,
    bits: usize,
    sin: Number,
    cos: Number,
    solids: Vec<Solid>,
    /// Toward the light.
    light: Vector,
}

/// The line of sight through a pixel, which is the same in every stage.
struct Sight {
    column: u32,
    row: u32,
    eye: Vector,
    looking: Vector,
    /// Where it is in each solid, once a stage has asked.
    inside: Vec<OnceCell<Option<Inside>>>,
}

impl<'a> Oracle<'a> {
    /// In 256 bits where nothing is extreme; twice as many as the numbers of scene and angle are
    /// apart where something is.
    pub(crate) fn new(scene: &'a Scene, alpha: f64, size: u32, bits: usize) -> Oracle<'a> {
        let number = |value: f64| Number::exact(value, bits);
        let vector = |v: DVec3| v.to_array().map(number);
        let (sin, cos) = number(alpha).sin_cos();
        let unit_length = number(3.0 * f64::from(size));
        let place = |p: DVec3| scale(&vector(p), &unit_length);
        let spheres = scene.spheres().iter().map(|sphere| Solid {
            shape: Shape::Sphere {
                center: place(sphere.center),
                radius: &number(sphere.radius) * &unit_length,
            },
            color: vector(sphere.color),
        });
        let tetrahedra = scene.tetrahedra().iter().map(|tetrahedron| {
            let v = tetrahedron.vertices.map(place);
            let faces = [0, 1, 2, 3].map(|k: usize| {
                let [a, b, c] = [(k + 1) % 4, (k + 2) % 4, (k + 3) % 4];
                let normal = cross(&sub(&v[b], &v[a]), &sub(&v[c], &v[a]));
                let inward = dot(&normal, &sub(&v[k], &v[a])).sign().is_gt();
                (
                    v[a].clone(),
                    if inward { negative(&normal) } else { normal },
                )
            });
            Solid {
                shape: Shape::Tetrahedron(faces.to_vec()),
                color: vector(tetrahedron.color),
            }
        });
        let solids = spheres.chain(tetrahedra).collect();
        let light = vector(-scene.light().direction);
        Oracle {
            scene,
            size,
            bits,
            sin,
            cos,
            solids,
            light,
        }
    }

    fn number(&self, value: f64) -> Number {
        Number::exact(value, self.bits)
    }

    fn vector(&self, v: DVec3) -> Vector {
        v.to_array().map(|x| self.number(x))
    }

    /// What a pixel shows in a stage.
    pub(crate) fn pixel(&self, stage: Stage, column: u32, row: u32) -> (Decision, [f32; 3]) {
        self.pixel_in_stages([stage], column, row)[0]
    }

    /// What it shows in each of some stages.
    pub(crate) fn pixel_in_stages<const COUNT: usize>(
        &self,
        stages: [Stage; COUNT],
        column: u32,
        row: u32,
    ) -> [(Decision, [f32; 3]); COUNT] {
        let sight = self.sight(column, row);
        stages.map(|stage| {
            let (decision, color) = self.evaluate(stage, &sight);
            (decision, color.each_ref().map(Number::to_sample))
        })
    }

    fn sight(&self, column: u32, row: u32) -> Sight {
        let n = f64::from(self.size);
        let u = self.number(3.0 * (2.0 * f64::from(column) - n));
        let v = self.number(3.0 * (2.0 * f64::from(row) - n));
        let near = self.number(3.0 * n);
        let eye = [
            &(&near * &self.sin) + &(&u * &self.cos),
            v,
            &(&near * &self.cos) - &(&u * &self.sin),
        ];
        let looking = [
            &self.number(-10.0) * &self.sin,
            self.number(-3.0),
            &self.number(-10.0) * &self.cos,
        ];
        Sight {
            column,
            row,
            eye,
            looking,
            inside: self.solids.iter().map(|_| OnceCell::new()).collect(),
        }
    }

    fn evaluate(&self, stage: Stage, sight: &Sight) -> (Decision, Vector) {
        let n = f64::from(self.size);
        if stage == Stage::Image {
            let (x, y, middle) = (f64::from(sight.column), f64::from(sight.row), n / 2.0);
            let (quadrant, color) = match () {
                () if x <= middle && y <= middle => (0, [0.3, 0.3, 0.0]),
                () if x <= middle && y >= middle => (1, [0.0, 0.3, 0.3]),
                () if x >= middle && y <= middle => (2, [0.3, 0.0, 0.3]),
                () => (3, [0.0; 3]),
            };
            return (Decision::Quadrant(quadrant), color.map(|x| self.number(x)));
        }
        let Sight { eye, looking, .. } = sight;

        let takes_part = |solid: &Solid| match stage {
            Stage::Spheres => matches!(solid.shape, Shape::Sphere { .. }),
            Stage::Tetrahedron => matches!(solid.shape, Shape::Tetrahedron { .. }),
            _ => true,
        };
        let mut first: Option<(usize, &Inside)> = None;
        for (index, solid) in self
            .solids
            .iter()
            .enumerate()
            .filter(|(_, solid)| takes_part(solid))
        {
            if let Some(inside) = sight.inside[index].get_or_init(|| solid.meet(eye, looking))
                && first
                    .as_ref()
                    .is_none_or(|(_, other)| inside.near.less(&other.near))
            {
                first = Some((index, inside));
            }
        }

        if stage >= Stage::Shadow
            && let Some(surface) = self.scene.surface()
        {
            // 3 t = v − height, both a multiple of 3.
            let middle = self.number(2.0 * f64::from(sight.row) - n);
            let t = &middle - &(&self.number(n) * &self.number(surface.height));
            let point = add(eye, &scale(looking, &t));
            let visible = first
                .as_ref()
                .is_none_or(|(_, inside)| t.less(&inside.near));
            if visible && self.on_square(&point, &self.number(1.0)) {
                return self.surface_at(stage, &point, looking);
            }
        }
        match first {
            None => (Decision::Background, self.vector(self.scene.background())),
            Some((index, inside)) => {
                let point = add(eye, &scale(looking, &inside.near));
                let (in_shadow, color) = self.shade(stage, (index, inside), &point, looking);
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

    fn surface_at(&self, stage: Stage, point: &Vector, looking: &Vector) -> (Decision, Vector) {
        let Some(surface) = self.scene.surface() else {
            unreachable!("there is a surface")
        };
        if self.shadowed(point, None) {
            return (Decision::SurfaceInShadow, self.ambient());
        }
        if stage >= Stage::Reflection {
            let mirrored = [looking[0].clone(), -&looking[1], looking[2].clone()];
            let zero = self.number(0.0);
            let start = |inside: &Inside| {
                if inside.near.less(&zero) {
                    zero.clone()
                } else {
                    inside.near.clone()
                }
            };
            let mut first: Option<(usize, Inside)> = None;
            for (index, solid) in self.solids.iter().enumerate() {
                if let Some(inside) = solid.meet(point, &mirrored)
                    && inside.far.sign().is_gt()
                    && first
                        .as_ref()
                        .is_none_or(|(_, other)| start(&inside).less(&start(other)))
                {
                    first = Some((index, inside));
                }
            }
            if let Some((index, inside)) = first {
                let seen_point = add(point, &scale(&mirrored, &inside.near));
                let (in_shadow, color) =
                    self.shade(stage, (index, &inside), &seen_point, &mirrored);
                let seen = Seen {
                    solid: index as u16,
                    face: inside.face,
                    in_shadow,
                };
                return (
                    Decision::Mirrored(seen),
                    scale(&color, &self.number(surface.reflectance)),
                );
            }
        }
        (Decision::Surface, self.vector(surface.color))
    }

    /// Half the length of the square's sides.
    fn half_width(&self) -> Option<Number> {
        let surface = self.scene.surface()?;
        let unit_length = self.number(3.0 * f64::from(self.size));
        Some(&self.number(surface.half_width) * &unit_length)
    }

    /// Whether a point in the square's plane is in the square, both scaled by `factor`.
    fn on_square(&self, point: &Vector, factor: &Number) -> bool {
        self.half_width().is_some_and(|half_width| {
            let half_width = &half_width * factor;
            [&point[0], &point[2]]
                .into_iter()
                .all(|x| !half_width.less(x) && !half_width.less(&-x))
        })
    }

    fn shadowed(&self, point: &Vector, besides: Option<usize>) -> bool {
        self.solids.iter().enumerate().any(|(index, solid)| {
            Some(index) != besides
                && solid
                    .meet(point, &self.light)
                    .is_some_and(|inside| inside.far.sign().is_gt())
        })
    }

    fn shaded_by_surface(&self, point: &Vector) -> bool {
        let Some(surface) = self.scene.surface() else {
            return false;
        };
        let unit_length = self.number(3.0 * f64::from(self.size));
        let rise = &(&self.number(surface.height) * &unit_length) - &point[1];
        let climb = &self.light[1];
        let (positive, scaled_t) = match climb.sign() {
            Ordering::Less => (-climb, -&rise),
            Ordering::Equal => return rise.sign().is_eq() && self.crosses_square(point),
            Ordering::Greater => (climb.clone(), rise),
        };
        scaled_t.sign().is_gt()
            && self.on_square(
                &add(&scale(point, &positive), &scale(&self.light, &scaled_t)),
                &positive,
            )
    }

    /// Whether the ray to a light in the square's plane meets the square at some t > 0, from a
    /// point in that plane.
    fn crosses_square(&self, point: &Vector) -> bool {
        let Some(half_width) = self.half_width() else {
            return false;
        };
        // −H ≤ p + t l ≤ H for x and for z, each bound on t as numerator and positive denominator.
        let (mut lower, mut upper) = (vec![(self.number(0.0), self.number(1.0))], vec![]);
        for axis in [0, 2] {
            let (p, l) = (&point[axis], &self.light[axis]);
            let (to_low, to_high) = (&-&half_width - p, &half_width - p);
            match l.sign() {
                Ordering::Greater => {
                    lower.push((to_low, l.clone()));
                    upper.push((to_high, l.clone()));
                }
                Ordering::Less => {
                    lower.push((-&to_high, -l));
                    upper.push((-&to_low, -l));
                }
                Ordering::Equal if to_low.sign().is_gt() || to_high.sign().is_lt() => return false,
                Ordering::Equal => {}
            }
        }
        // 0 itself does not belong to the ray.
        upper
            .iter()
            .all(|(a, b)| a.sign().is_gt() && lower.iter().all(|(c, d)| !(a * d).less(&(c * b))))
    }

    fn ambient(&self) -> Vector {
        let (light, material) = (self.scene.light(), self.scene.material());
        zip(
            &self.vector(material.ambient),
            &self.vector(light.ambient_intensity),
            |k, i| k * i,
        )
    }

    /// Whether a point of a solid is in shadow, and its colour.
    fn shade(
        &self,
        stage: Stage,
        (index, inside): (usize, &Inside),
        point: &Vector,
        looking: &Vector,
    ) -> (bool, Vector) {
        let color = &self.solids[index].color;
        if matches!(stage, Stage::Spheres | Stage::Tetrahedron) {
            return (false, color.clone());
        }
        let normal = unit(&inside.normal);
        let l = unit(&self.light);
        let facing = dot(&inside.normal, &self.light).sign();
        let in_shadow = stage >= Stage::Shadow
            && (facing.is_le()
                || self.shadowed(point, Some(index))
                || self.shaded_by_surface(point));
        let mut light = self.ambient();
        if !in_shadow {
            let material = self.scene.material();
            let intensity = self.vector(self.scene.light().intensity);
            let times_intensity = |k: DVec3| zip(&self.vector(k), &intensity, |k, i| k * i);
            if facing.is_gt() {
                let diffuse = times_intensity(material.diffuse);
                light = add(&light, &scale(&diffuse, &dot(&normal, &l)));
            }
            let sum = add(&unit(&negative(looking)), &l);
            if sum.iter().any(|x| x.sign().is_ne()) {
                let n_h = dot(&normal, &unit(&sum));
                let specular = times_intensity(material.specular);
                let highlight = n_h.clipped_power(material.exponent);
                light = add(&light, &scale(&specular, &highlight));
            }
        }
        (in_shadow, zip(color, &light, |c, l| c * l))
    }
}
