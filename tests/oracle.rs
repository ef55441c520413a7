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

/// A colour that is given, in samples.
fn constant(color: DVec3) -> [f32; 3] {
    color.to_array().map(|channel| channel as f32)
}

/// A colour that is computed, in samples.
fn samples(color: &Vector) -> [f32; 3] {
    color.each_ref().map(Number::to_sample)
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

/// The ways that rays go: the eye's, the mirrored one, and the one to the light.
#[derive(Clone, Copy)]
enum Way {
    Direct,
    Mirrored,
    ToLight,
}

/// The vector of each way, in the order of [`Way`].
struct Directions([Vector; 3]);

impl Directions {
    /// What is computed of the vector of each way. What rays of one way share is computed once.
    fn each(&self, f: impl Fn(&Vector) -> Number) -> [Number; 3] {
        self.0.each_ref().map(f)
    }
}

/// The points (place + t · direction)/scale, for t > 0; its line has those for every t.
#[derive(Clone, Copy)]
struct Ray<'a> {
    start: &'a Point,
    way: Way,
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
    fn toward<'a>(&'a self, way: Way, directions: &'a Directions) -> Ray<'a> {
        Ray {
            start: self,
            way,
            direction: &directions.0[way as usize],
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
    /// The square of the direction of each way.
    squares: [Number; 3],
}

/// a, b, c and b² − a c, where the points of a line in a sphere are those with a t² + 2 b t + c ≤ 0.
struct Quadratic<'a> {
    a: &'a Number,
    b: Number,
    c: Number,
    discriminant: Number,
}

impl Quadratic<'_> {
    /// Whether the ray meets the sphere: its line does, and leaves it at (−b + √D)/a, which is
    /// positive where b < 0, and otherwise where D > b².
    fn is_ahead(&self) -> bool {
        self.b.sign().is_lt() || self.c.sign().is_lt()
    }
}

impl Sphere {
    /// From the centre to a point, times its scale.
    fn outward(&self, point: &Point) -> Vector {
        sub(&point.place, &scale(&self.center, &point.scale))
    }

    /// `None` where the line misses the sphere. Touching counts.
    fn quadratic(&self, ray: Ray<'_>) -> Option<Quadratic<'_>> {
        let offset = self.outward(ray.start);
        let radius = &self.radius * &ray.start.scale;
        let a = &self.squares[ray.way as usize];
        let b = dot(ray.direction, &offset);
        let c = &dot(&offset, &offset) - &(&radius * &radius);
        let discriminant = &(&b * &b) - &(a * &c);
        let meets = discriminant.sign().is_ge();
        meets.then_some(Quadratic {
            a,
            b,
            c,
            discriminant,
        })
    }

    fn entry(&self, ray: Ray<'_>, reach: Reach) -> Option<Entry> {
        let quadratic = self.quadratic(ray)?;
        if reach == Reach::Ahead && !quadratic.is_ahead() {
            return None;
        }
        let Quadratic {
            a, b, discriminant, ..
        } = quadratic;
        let t = Fraction(-&(&b + &discriminant.root()), a.clone());
        Some(Entry { t, face: None })
    }

    fn is_ahead(&self, ray: Ray<'_>) -> bool {
        let quadratic = self.quadratic(ray);
        quadratic.is_some_and(|quadratic| quadratic.is_ahead())
    }
}

/// The points x with normal · x ≤ offset.
struct HalfSpace {
    normal: Vector,
    offset: Number,
    /// How fast each way leads outward.
    speeds: [Number; 3],
}

impl HalfSpace {
    fn new(normal: Vector, offset: Number, directions: &Directions) -> HalfSpace {
        HalfSpace {
            speeds: directions.each(|direction| dot(direction, &normal)),
            normal,
            offset,
        }
    }

    /// Positive where the point is outside.
    fn outside(&self, point: &Point) -> Number {
        &dot(&point.place, &self.normal) - &(&point.scale * &self.offset)
    }
}

/// The points of all of some half-spaces: a tetrahedron's faces in their order, or the surface's
/// plane from above and from below with the four sides.
struct Polyhedron(Vec<HalfSpace>);

impl Polyhedron {
    fn tetrahedron(v: &[Vector; 4], directions: &Directions) -> Polyhedron {
        let face = |k: usize| {
            let [a, b, c] = [(k + 1) % 4, (k + 2) % 4, (k + 3) % 4].map(|i| &v[i]);
            let normal = cross(&sub(b, a), &sub(c, a));
            let inward = dot(&normal, &sub(&v[k], a)).sign().is_gt();
            let normal = if inward { negative(&normal) } else { normal };
            let offset = dot(&normal, a);
            HalfSpace::new(normal, offset, directions)
        };
        Polyhedron((0..4).map(face).collect())
    }

    /// The plane comes first: its t is exact at every angle, where that of a side at the same place
    /// is not.
    fn square(height: &Number, half_width: &Number, directions: &Directions) -> Polyhedron {
        let slabs = [
            (DVec3::Y, height, &-height),
            (DVec3::X, half_width, half_width),
            (DVec3::Z, half_width, half_width),
        ];
        let half_space =
            |normal, offset: &Number| HalfSpace::new(exact(normal), offset.clone(), directions);
        let sides = |(n, high, low)| [half_space(n, high), half_space(-n, low)];
        Polyhedron(slabs.into_iter().flat_map(sides).collect())
    }

    /// Where the line of a ray enters the last half-space, of several at once the first in order,
    /// and each t where it leaves one; `None` where it leaves one before that.
    fn meet(&self, ray: Ray<'_>) -> Option<(Entry, Vec<Fraction>)> {
        let (mut entry, mut left): (Option<Entry>, _) = (None, Vec::new());
        for (number, side) in self.0.iter().enumerate() {
            // f + g t ≤ 0 within.
            let (f, g) = (side.outside(ray.start), &side.speeds[ray.way as usize]);
            match g.sign() {
                Ordering::Less => {
                    let (t, face) = (Fraction(f, -g), Some(number as u8));
                    if entry.as_ref().is_none_or(|last| last.t.less(&t)) {
                        entry = Some(Entry { t, face });
                    }
                }
                Ordering::Greater => left.push(Fraction(-&f, g.clone())),
                Ordering::Equal if f.sign().is_gt() => return None,
                Ordering::Equal => {}
            }
        }
        let met = entry.map(|entry| (entry, left));
        met.filter(|(entry, left)| left.iter().all(|t| !t.less(&entry.t)))
    }

    fn entry(&self, ray: Ray<'_>, reach: Reach) -> Option<Entry> {
        let met = self.meet(ray);
        let met = met.filter(|(_, left)| reach == Reach::Line || is_ahead(left));
        met.map(|(entry, _)| entry)
    }

    fn is_ahead(&self, ray: Ray<'_>) -> bool {
        self.meet(ray).is_some_and(|(_, left)| is_ahead(&left))
    }
}

/// Whether a ray meets what its line leaves there at some t > 0.
fn is_ahead(left: &[Fraction]) -> bool {
    left.iter().all(|t| t.0.sign().is_gt())
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

/// How much of a line is asked about.
#[derive(Clone, Copy, PartialEq)]
enum Reach {
    Line,
    /// What is met at some t > 0.
    Ahead,
}

impl Solid {
    /// Where the line of a ray enters it.
    fn entry(&self, ray: Ray<'_>, reach: Reach) -> Option<Entry> {
        match &self.shape {
            Shape::Sphere(sphere) => sphere.entry(ray, reach),
            Shape::Tetrahedron(faces) => faces.entry(ray, reach),
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
    directions: Directions,
    direct: View,
    mirrored: View,
    /// l.
    light: Vector,
    background: [f32; 3],
    /// The light's intensities times the material's coefficients.
    ambient: Vector,
    diffuse: Vector,
    specular: Vector,
}

/// What is the same wherever one looks in one direction.
struct View {
    way: Way,
    /// h = (v + l)/|v + l|; `None` where v + l = 0.
    halfway: Option<Vector>,
}

impl View {
    fn new(way: Way, directions: &Directions, bits: usize) -> View {
        let [looking, to_light] = [way, Way::ToLight].map(|way| &directions.0[way as usize]);
        let across = cross(looking, to_light);
        let is_parallel = across.iter().all(|x| x.sign().is_eq());
        let is_opposite = is_parallel && dot(looking, to_light).sign().is_gt();
        let sum = || sub(&unit(to_light, bits), &unit(looking, bits));
        View {
            way,
            halfway: (!is_opposite).then(|| unit(&sum(), bits)),
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
    /// The point of the surface there, and whether it is in shadow.
    on_surface: OnceCell<(Point, bool)>,
    /// The point of the first of all solids: they all take part where there is light.
    on_solid: OnceCell<Lighting>,
}

/// A point of a solid, and what falls on it.
struct Lighting {
    point: Point,
    /// Outward, of any length.
    normal: Vector,
    in_shadow: OnceCell<bool>,
    /// Equation 4-1 in the light.
    lit: OnceCell<Vector>,
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
        let [x, z] = [&sin, &cos].map(|component| &Number::exact(-10.0) * component);
        let looking = |y: f64| [x.clone(), Number::exact(y), z.clone()];
        let to_light = exact(-scene.light().direction);
        let light_unit = unit(&to_light, bits);
        let directions = Directions([looking(-3.0), looking(3.0), to_light]);
        let spheres = scene.spheres().iter().map(|sphere| Solid {
            shape: Shape::Sphere(Box::new(Sphere {
                center: place(sphere.center),
                radius: length(sphere.radius),
                squares: directions.each(|direction| dot(direction, direction)),
            })),
            color: exact(sphere.color),
        });
        let tetrahedra = scene.tetrahedra().iter().map(|tetrahedron| Solid {
            shape: Shape::Tetrahedron(Polyhedron::tetrahedron(
                &tetrahedron.vertices.map(place),
                &directions,
            )),
            color: exact(tetrahedron.color),
        });
        let square = scene.surface().map(|surface| {
            let [height, half_width] = [surface.height, surface.half_width].map(length);
            Polyhedron::square(&height, &half_width, &directions)
        });
        let (light, material) = (scene.light(), scene.material());
        let product = |k: DVec3, intensity: DVec3| zip(&exact(k), &exact(intensity), |k, i| k * i);
        Oracle {
            scene,
            size,
            bits,
            solids: spheres.chain(tetrahedra).collect(),
            square,
            direct: View::new(Way::Direct, &directions, bits),
            mirrored: View::new(Way::Mirrored, &directions, bits),
            light: light_unit,
            directions,
            background: constant(scene.background()),
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
        stages.map(|stage| self.evaluate(stage, &sight))
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
            on_surface: OnceCell::new(),
            on_solid: OnceCell::new(),
        }
    }

    fn evaluate(&self, stage: Stage, sight: &Sight) -> (Decision, [f32; 3]) {
        let n = f64::from(self.size);
        if stage == Stage::Image {
            let (x, y, middle) = (f64::from(sight.column), f64::from(sight.row), n / 2.0);
            let (quadrant, color) = match () {
                () if x <= middle && y <= middle => (0, [0.3, 0.3, 0.0]),
                () if x <= middle && y >= middle => (1, [0.0, 0.3, 0.3]),
                () if x >= middle && y <= middle => (2, [0.3, 0.0, 0.3]),
                () => (3, [0.0; 3]),
            };
            return (Decision::Quadrant(quadrant), color);
        }

        let takes_part = |solid: &Solid| match stage {
            Stage::Spheres => matches!(solid.shape, Shape::Sphere(_)),
            Stage::Tetrahedron => matches!(solid.shape, Shape::Tetrahedron(_)),
            _ => true,
        };
        let ray = self.ray(&sight.eye, Way::Direct);
        let mut first: Option<(usize, &Entry)> = None;
        for (index, solid) in self.solids.iter().enumerate() {
            if takes_part(solid)
                && let Some(entry) =
                    sight.entries[index].get_or_init(|| solid.entry(ray, Reach::Line))
                && first.is_none_or(|(_, other)| entry.t.less(&other.t))
            {
                first = Some((index, entry));
            }
        }

        if stage >= Stage::Shadow
            && let (Some(surface), Some(square)) = (self.scene.surface(), &self.square)
            && let Some(entry) = sight
                .surface_entry
                .get_or_init(|| square.entry(ray, Reach::Line))
            && first.is_none_or(|(_, other)| entry.t.less(&other.t))
        {
            let on_surface = sight.on_surface.get_or_init(|| {
                let point = ray.at(&entry.t);
                let in_shadow = self.is_shadowed(&point, None);
                (point, in_shadow)
            });
            return self.surface_at(stage, surface, on_surface);
        }
        match first {
            None => (Decision::Background, self.background),
            Some((index, entry)) => {
                let met = (index, entry, &sight.on_solid);
                let (seen, color) = self.shade(stage, met, &sight.eye, &self.direct);
                (Decision::Solid(seen), samples(&color))
            }
        }
    }

    fn ray<'r>(&'r self, start: &'r Point, way: Way) -> Ray<'r> {
        start.toward(way, &self.directions)
    }

    fn to_light(&self) -> &Vector {
        &self.directions.0[Way::ToLight as usize]
    }

    /// What the surface shows at a point of it.
    fn surface_at(
        &self,
        stage: Stage,
        surface: &Surface,
        (point, in_shadow): &(Point, bool),
    ) -> (Decision, [f32; 3]) {
        if *in_shadow {
            return (Decision::SurfaceInShadow, samples(&self.ambient));
        }
        let reflected = self.ray(point, Way::Mirrored);
        let mut first: Option<(usize, Entry)> = None;
        for (index, solid) in self.solids.iter().enumerate() {
            // What the ray starts in it meets there, at t = 0.
            if stage >= Stage::Reflection
                && let Some(entry) = solid.entry(reflected, Reach::Ahead)
                && first
                    .as_ref()
                    .is_none_or(|(_, other)| other.t.0.sign().is_gt() && entry.t.less(&other.t))
            {
                first = Some((index, entry));
            }
        }
        match first {
            None => (Decision::Surface, constant(surface.color)),
            Some((index, entry)) => {
                let met = (index, &entry, &OnceCell::new());
                let (seen, color) = self.shade(stage, met, point, &self.mirrored);
                let reflectance = Number::exact(surface.reflectance);
                (
                    Decision::Mirrored(seen),
                    samples(&scale(&color, &reflectance)),
                )
            }
        }
    }

    /// Whether any solid but one hides the light from a point.
    fn is_shadowed(&self, point: &Point, besides: Option<usize>) -> bool {
        let to_light = self.ray(point, Way::ToLight);
        let mut solids = (0..).zip(&self.solids);
        solids.any(|(index, solid)| Some(index) != besides && solid.is_ahead(to_light))
    }

    /// A solid as the ray of a view sees it, and its colour there.
    fn shade(
        &self,
        stage: Stage,
        (index, entry, lighting): (usize, &Entry, &OnceCell<Lighting>),
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
        let lighting = lighting.get_or_init(|| {
            let point = self.ray(start, view.way).at(&entry.t);
            Lighting {
                normal: solid.normal(entry.face, &point),
                point,
                in_shadow: OnceCell::new(),
                lit: OnceCell::new(),
            }
        });
        let in_shadow = stage >= Stage::Shadow && self.is_in_shadow(index, lighting);
        let light = if in_shadow {
            &self.ambient
        } else {
            let lit = || self.lit(&lighting.normal, view);
            lighting.lit.get_or_init(lit)
        };
        (seen(in_shadow), zip(&solid.color, light, |c, l| c * l))
    }

    /// Whether a point of a solid is in shadow.
    fn is_in_shadow(&self, solid: usize, lighting: &Lighting) -> bool {
        let Lighting { point, normal, .. } = lighting;
        let by_surface = |square: &Polyhedron| square.is_ahead(self.ray(point, Way::ToLight));
        *lighting.in_shadow.get_or_init(|| {
            dot(normal, self.to_light()).sign().is_le()
                || self.is_shadowed(point, Some(solid))
                || self.square.as_ref().is_some_and(by_surface)
        })
    }

    /// Equation 4-1 in the light.
    fn lit(&self, normal: &Vector, view: &View) -> Vector {
        let n = unit(normal, self.bits);
        let mut sum = self.ambient.clone();
        if dot(normal, self.to_light()).sign().is_gt() {
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
