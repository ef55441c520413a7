//! The picture evaluated straight from its definition: world space, equation 3-1 with its textbook
//! discriminant, planes cut one by one, a mirrored ray that is really mirrored. The oracle shares
//! no code with the tracer, and hardly a formula.
//!
//! Lengths are measured in 1/(3N), the eye looks along −(10 sin α, 3, 10 cos α), and nothing is
//! divided before the colour. So at α = 0 every number of a decision is exact, p + q√c, and so is
//! every decision. At other angles sine and cosine are rounded to as many bits as asked for, and
//! what is zero for every α is seen to be small beyond accident (see [`binary`]).

mod binary;
mod number;

use std::cell::OnceCell;
use std::cmp::Ordering;

use firsthit::scene::Surface;
use firsthit::tracer::{Decision, Seen};
use firsthit::{Scene, Stage};
use glam::DVec3;
use number::Number;

type Vector = [Number; 3];

fn exact(v: DVec3) -> Vector {
    v.to_array().map(Number::exact)
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
    [&a[0] * factor, &a[1] * factor, &a[2] * factor]
}

fn negative(a: &Vector) -> Vector {
    [-&a[0], -&a[1], -&a[2]]
}

fn dot(a: &Vector, b: &Vector) -> Number {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    let minor = |i: usize, j: usize| &(&a[i] * &b[j]) - &(&a[j] * &b[i]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// The unit vector, in `bits` bits.
fn unit(a: &Vector, bits: usize) -> Vector {
    let a = a.each_ref().map(|a| a.limited(bits));
    let length = dot(&a, &a).root();
    a.each_ref().map(|a| a / &length)
}

/// The point `place`/`scale`.
struct Point {
    place: Vector,
    /// Positive.
    scale: Number,
}

/// The points (place + t · direction)/scale, for t > 0; its line has those for every t.
#[derive(Clone, Copy)]
struct Ray<'a> {
    start: &'a Point,
    direction: &'a Vector,
}

/// A t as a numerator and a positive denominator, which has no root.
struct Fraction(Number, Number);

impl Fraction {
    fn less(&self, other: &Fraction) -> bool {
        (&self.0 * &other.1).less(&(&other.0 * &self.1))
    }
}

impl Point {
    fn toward<'a>(&'a self, direction: &'a Vector) -> Ray<'a> {
        Ray {
            start: self,
            direction,
        }
    }
}

impl Ray<'_> {
    fn at(self, Fraction(t, denominator): &Fraction) -> Point {
        let place = scale(&self.start.place, denominator);
        Point {
            place: add(&place, &scale(self.direction, t)),
            scale: &self.start.scale * denominator,
        }
    }
}

struct Sphere {
    center: Vector,
    radius: Number,
}

impl Sphere {
    /// From the centre to a point, times its scale.
    fn outward(&self, point: &Point) -> Vector {
        sub(&point.place, &scale(&self.center, &point.scale))
    }

    /// a, b, c and b² − a c, where the points of the line in the sphere are those with a t² + 2 b t
    /// + c ≤ 0; `None` where the line misses the sphere. Touching counts.
    fn quadratic(&self, Ray { start, direction }: Ray<'_>) -> Option<[Number; 4]> {
        let offset = self.outward(start);
        let radius = &self.radius * &start.scale;
        let a = dot(direction, direction);
        let b = dot(direction, &offset);
        let c = &dot(&offset, &offset) - &(&radius * &radius);
        let discriminant = &(&b * &b) - &(&a * &c);
        let meets = discriminant.sign().is_ge();
        meets.then_some([a, b, c, discriminant])
    }

    fn entry(&self, ray: Ray<'_>) -> Option<Entry> {
        let [a, b, _, discriminant] = self.quadratic(ray)?;
        let t = Fraction(-&(&b + &discriminant.root()), a);
        Some(Entry { t, face: None })
    }

    /// Whether the ray meets the sphere: its line does, and leaves it at (−b + √D)/a, which is
    /// positive where b < 0, and otherwise where D > b².
    fn is_ahead(&self, ray: Ray<'_>) -> bool {
        let quadratic = self.quadratic(ray);
        quadratic.is_some_and(|[_, b, c, _]| b.sign().is_lt() || c.sign().is_lt())
    }
}

/// The points x with normal · x ≤ offset.
struct HalfSpace {
    normal: Vector,
    offset: Number,
}

impl HalfSpace {
    /// Positive where the point is outside.
    fn outside(&self, point: &Point) -> Number {
        &dot(&point.place, &self.normal) - &(&point.scale * &self.offset)
    }
}

/// The points of all of some half-spaces: a tetrahedron's faces in their order, or the surface's
/// plane from above and from below with the four sides.
struct Polyhedron(Vec<HalfSpace>);

impl Polyhedron {
    fn tetrahedron(v: &[Vector; 4]) -> Polyhedron {
        let face = |k: usize| {
            let [a, b, c] = [(k + 1) % 4, (k + 2) % 4, (k + 3) % 4].map(|i| &v[i]);
            let normal = cross(&sub(b, a), &sub(c, a));
            let inward = dot(&normal, &sub(&v[k], a)).sign().is_gt();
            let normal = if inward { negative(&normal) } else { normal };
            HalfSpace {
                offset: dot(&normal, a),
                normal,
            }
        };
        Polyhedron((0..4).map(face).collect())
    }

    /// The plane comes first: its t is exact at every angle, where that of a side at the same place
    /// is not.
    fn square(height: &Number, half_width: &Number) -> Polyhedron {
        let slabs = [
            (DVec3::Y, height, &-height),
            (DVec3::X, half_width, half_width),
            (DVec3::Z, half_width, half_width),
        ];
        let half_space = |normal, offset: &Number| HalfSpace {
            normal: exact(normal),
            offset: offset.clone(),
        };
        let sides = |(n, high, low)| [half_space(n, high), half_space(-n, low)];
        Polyhedron(slabs.into_iter().flat_map(sides).collect())
    }

    /// Where the line of a ray enters the last half-space, of several at once the first in order,
    /// and each t where it leaves one; `None` where it leaves one before that.
    fn meet(&self, ray: Ray<'_>) -> Option<(Entry, Vec<Fraction>)> {
        let (mut entry, mut left): (Option<Entry>, _) = (None, Vec::new());
        for (number, side) in self.0.iter().enumerate() {
            // f + g t ≤ 0 within.
            let (f, g) = (side.outside(ray.start), dot(ray.direction, &side.normal));
            match g.sign() {
                Ordering::Less => {
                    let (t, face) = (Fraction(f, -&g), Some(number as u8));
                    if entry.as_ref().is_none_or(|last| last.t.less(&t)) {
                        entry = Some(Entry { t, face });
                    }
                }
                Ordering::Greater => left.push(Fraction(-&f, g)),
                Ordering::Equal if f.sign().is_gt() => return None,
                Ordering::Equal => {}
            }
        }
        let met = entry.map(|entry| (entry, left));
        met.filter(|(entry, left)| left.iter().all(|t| !t.less(&entry.t)))
    }

    fn entry(&self, ray: Ray<'_>) -> Option<Entry> {
        self.meet(ray).map(|(entry, _)| entry)
    }

    /// Whether the ray meets it at some t > 0.
    fn is_ahead(&self, ray: Ray<'_>) -> bool {
        let met = self.meet(ray);
        met.is_some_and(|(_, left)| left.iter().all(|t| t.0.sign().is_gt()))
    }
}

enum Shape {
    Sphere(Box<Sphere>),
    Tetrahedron(Polyhedron),
}

struct Solid {
    shape: Shape,
    color: Vector,
}

/// Where a ray enters a solid.
struct Entry {
    t: Fraction,
    face: Option<u8>,
}

impl Solid {
    /// Where the line of a ray enters it.
    fn entry(&self, ray: Ray<'_>) -> Option<Entry> {
        match &self.shape {
            Shape::Sphere(sphere) => sphere.entry(ray),
            Shape::Tetrahedron(faces) => faces.entry(ray),
        }
    }

    /// Whether the ray meets it at some t > 0.
    fn is_ahead(&self, ray: Ray<'_>) -> bool {
        match &self.shape {
            Shape::Sphere(sphere) => sphere.is_ahead(ray),
            Shape::Tetrahedron(faces) => faces.is_ahead(ray),
        }
    }

    /// The outward normal, of any length, at a point of a face or of the sphere.
    fn normal(&self, face: Option<u8>, point: &Point) -> Vector {
        match &self.shape {
            Shape::Sphere(sphere) => sphere.outward(point),
            Shape::Tetrahedron(faces) => faces.0[usize::from(face.unwrap())].normal.clone(),
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
    square: Option<Polyhedron>,
    direct: View,
    mirrored: View,
    to_light: Vector,
    /// l.
    light: Vector,
    background: Vector,
    /// The light's intensities times the material's coefficients.
    ambient: Vector,
    diffuse: Vector,
    specular: Vector,
}

/// What is the same wherever one looks in one direction.
struct View {
    looking: Vector,
    /// h = (v + l)/|v + l|; `None` where v + l = 0.
    halfway: Option<Vector>,
}

impl View {
    fn new(looking: Vector, to_light: &Vector, bits: usize) -> View {
        let across = cross(&looking, to_light);
        let is_parallel = across.iter().all(|x| x.sign().is_eq());
        let is_opposite = is_parallel && dot(&looking, to_light).sign().is_gt();
        let sum = || sub(&unit(to_light, bits), &unit(&looking, bits));
        View {
            halfway: (!is_opposite).then(|| unit(&sum(), bits)),
            looking,
        }
    }
}

/// The line of sight through a pixel, which is the same in every stage.
struct Sight {
    column: u32,
    row: u32,
    eye: Point,
    /// Where it enters each solid, once a stage has asked.
    entries: Vec<OnceCell<Option<Entry>>>,
    /// The same of the surface.
    surface_entry: OnceCell<Option<Entry>>,
}

impl<'a> Oracle<'a> {
    /// Colours, and decisions at other angles than 0, are computed in `bits` bits: 256 where
    /// nothing is extreme; twice as many as the numbers of scene and angle are apart where
    /// something is.
    pub(crate) fn new(scene: &'a Scene, alpha: f64, size: u32, bits: usize) -> Oracle<'a> {
        let [sin, cos] = Number::sin_cos(alpha, bits);
        let unit_length = Number::exact(3.0 * f64::from(size));
        let length = |value: f64| &Number::exact(value) * &unit_length;
        let place = |p: DVec3| p.to_array().map(length);
        let spheres = scene.spheres().iter().map(|sphere| Solid {
            shape: Shape::Sphere(Box::new(Sphere {
                center: place(sphere.center),
                radius: length(sphere.radius),
            })),
            color: exact(sphere.color),
        });
        let tetrahedra = scene.tetrahedra().iter().map(|tetrahedron| Solid {
            shape: Shape::Tetrahedron(Polyhedron::tetrahedron(&tetrahedron.vertices.map(place))),
            color: exact(tetrahedron.color),
        });
        let square = scene.surface().map(|surface| {
            Polyhedron::square(&length(surface.height), &length(surface.half_width))
        });
        let [x, z] = [&sin, &cos].map(|component| &Number::exact(-10.0) * component);
        let to_light = exact(-scene.light().direction);
        let view = |y: f64| View::new([x.clone(), Number::exact(y), z.clone()], &to_light, bits);
        let (light, material) = (scene.light(), scene.material());
        let product = |k: DVec3, intensity: DVec3| zip(&exact(k), &exact(intensity), |k, i| k * i);
        Oracle {
            scene,
            size,
            bits,
            solids: spheres.chain(tetrahedra).collect(),
            square,
            direct: view(-3.0),
            mirrored: view(3.0),
            light: unit(&to_light, bits),
            to_light,
            background: exact(scene.background()),
            ambient: product(material.ambient, light.ambient_intensity),
            diffuse: product(material.diffuse, light.intensity),
            specular: product(material.specular, light.intensity),
            sin,
            cos,
        }
    }

    /// What is wrong with a pixel, if anything is.
    pub(crate) fn problem(
        &self,
        stage: Stage,
        (column, row): (u32, u32),
        got: (Decision, [f32; 3]),
    ) -> Option<String> {
        let expected = self.pixel(stage, column, row);
        let bits = |(decision, color): (Decision, [f32; 3])| (decision, color.map(f32::to_bits));
        let is_wrong = bits(got) != bits(expected);
        is_wrong.then(|| format!("({column}, {row}): {got:?} instead of {expected:?}"))
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
        let u = Number::exact(3.0 * (2.0 * f64::from(column) - n));
        let v = Number::exact(3.0 * (2.0 * f64::from(row) - n));
        let near = Number::exact(3.0 * n);
        let eye = [
            &(&near * &self.sin) + &(&u * &self.cos),
            v,
            &(&near * &self.cos) - &(&u * &self.sin),
        ];
        Sight {
            column,
            row,
            eye: Point {
                place: eye,
                scale: Number::exact(1.0),
            },
            entries: self.solids.iter().map(|_| OnceCell::new()).collect(),
            surface_entry: OnceCell::new(),
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
            return (Decision::Quadrant(quadrant), color.map(Number::exact));
        }

        let takes_part = |solid: &Solid| match stage {
            Stage::Spheres => matches!(solid.shape, Shape::Sphere(_)),
            Stage::Tetrahedron => matches!(solid.shape, Shape::Tetrahedron(_)),
            _ => true,
        };
        let ray = sight.eye.toward(&self.direct.looking);
        let mut first: Option<(usize, &Entry)> = None;
        for (index, solid) in self.solids.iter().enumerate() {
            if takes_part(solid)
                && let Some(entry) = sight.entries[index].get_or_init(|| solid.entry(ray))
                && first.is_none_or(|(_, other)| entry.t.less(&other.t))
            {
                first = Some((index, entry));
            }
        }

        if stage >= Stage::Shadow
            && let (Some(surface), Some(square)) = (self.scene.surface(), &self.square)
            && let Some(entry) = sight.surface_entry.get_or_init(|| square.entry(ray))
            && first.is_none_or(|(_, other)| entry.t.less(&other.t))
        {
            return self.surface_at(stage, surface, &ray.at(&entry.t));
        }
        match first {
            None => (Decision::Background, self.background.clone()),
            Some((index, entry)) => {
                let (seen, color) = self.shade(stage, (index, entry), &sight.eye, &self.direct);
                (Decision::Solid(seen), color)
            }
        }
    }

    /// What the surface shows at a point of it.
    fn surface_at(&self, stage: Stage, surface: &Surface, point: &Point) -> (Decision, Vector) {
        if self.is_shadowed(point, None) {
            return (Decision::SurfaceInShadow, self.ambient.clone());
        }
        let reflected = point.toward(&self.mirrored.looking);
        let mut first: Option<(usize, Entry)> = None;
        for (index, solid) in self.solids.iter().enumerate() {
            // What the ray starts in it meets there, at t = 0.
            if stage >= Stage::Reflection
                && solid.is_ahead(reflected)
                && let Some(entry) = solid.entry(reflected)
                && first
                    .as_ref()
                    .is_none_or(|(_, other)| other.t.0.sign().is_gt() && entry.t.less(&other.t))
            {
                first = Some((index, entry));
            }
        }
        match first {
            None => (Decision::Surface, exact(surface.color)),
            Some((index, entry)) => {
                let (seen, color) = self.shade(stage, (index, &entry), point, &self.mirrored);
                let reflectance = Number::exact(surface.reflectance);
                (Decision::Mirrored(seen), scale(&color, &reflectance))
            }
        }
    }

    /// Whether any solid but one hides the light from a point.
    fn is_shadowed(&self, point: &Point, besides: Option<usize>) -> bool {
        let to_light = point.toward(&self.to_light);
        let mut solids = (0..).zip(&self.solids);
        solids.any(|(index, solid)| Some(index) != besides && solid.is_ahead(to_light))
    }

    /// A solid as the ray of a view sees it, and its colour there.
    fn shade(
        &self,
        stage: Stage,
        (index, entry): (usize, &Entry),
        start: &Point,
        view: &View,
    ) -> (Seen, Vector) {
        let solid = &self.solids[index];
        let seen = |in_shadow| Seen {
            solid: index as u16,
            face: entry.face,
            in_shadow,
        };
        if stage < Stage::Shading {
            return (seen(false), solid.color.clone());
        }
        let point = start.toward(&view.looking).at(&entry.t);
        let normal = solid.normal(entry.face, &point);
        let by_surface = |square: &Polyhedron| square.is_ahead(point.toward(&self.to_light));
        let in_shadow = stage >= Stage::Shadow
            && (dot(&normal, &self.to_light).sign().is_le()
                || self.is_shadowed(&point, Some(index))
                || self.square.as_ref().is_some_and(by_surface));
        let color = if in_shadow {
            zip(&solid.color, &self.ambient, |c, l| c * l)
        } else {
            zip(&solid.color, &self.lit(&normal, view), |c, l| c * l)
        };
        (seen(in_shadow), color)
    }

    /// Equation 4-1 in the light.
    fn lit(&self, normal: &Vector, view: &View) -> Vector {
        let n = unit(normal, self.bits);
        let mut sum = self.ambient.clone();
        if dot(normal, &self.to_light).sign().is_gt() {
            sum = add(&sum, &scale(&self.diffuse, &dot(&n, &self.light)));
        }
        if let Some(halfway) = &view.halfway {
            let exponent = self.scene.material().exponent;
            let highlight = dot(&n, halfway).clipped_power(exponent);
            sum = add(&sum, &scale(&self.specular, &highlight));
        }
        sum
    }
}
