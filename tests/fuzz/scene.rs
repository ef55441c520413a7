//! Bytes → a scene, a stage, α and N → `exact` equals `reference`, bit for bit.
//!
//! Bytes that begin with `#` are a scene file, whose first line may give the stage, α and N, as in
//! `#6 0.3 16`. All others choose a scene that is aimed at what is hard.

use std::f64::consts::FRAC_PI_2;
use std::fmt::{Debug, Write};
use std::str::FromStr;

use firsthit::camera::frame_angle;
use firsthit::tracer::Simd;
use firsthit::{Image, Kernel, Scene, Stage, Tracer};
use glam::DVec3;

/// The most solids of a scene that is traced: the time grows with them, and few are as hard as
/// many.
const SOLIDS: usize = 6;

/// Panics where the promise is broken.
pub(crate) fn run(bytes: &[u8]) {
    match bytes {
        [b'#', ..] => of_text(bytes),
        _ => {
            let chosen = Choice::of(bytes);
            if let Ok(scene) = read(&chosen.text) {
                check(&scene, &chosen);
            }
        }
    }
}

/// What is traced.
struct Choice {
    text: String,
    stage: Stage,
    alpha: f64,
    size: u32,
    /// A pixel to be explained.
    pixel: (u32, u32),
}

impl Debug for Choice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Choice {
            text, alpha, size, ..
        } = self;
        let stage = self.stage.number();
        write!(
            f,
            "as a file of the corpus:\n#{stage} {alpha:e} {size}\n{text}"
        )
    }
}

/// The scene of `text`, or its refusal in one line.
fn read(text: &str) -> Result<Scene, ()> {
    Scene::from_toml(text).map_err(|error| {
        let said = error.to_string();
        assert!(
            said.starts_with("line ") && !said.contains(['\n', '\r']),
            "{said:?}"
        );
    })
}

fn of_text(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let Ok(scene) = read(text) else {
        return;
    };
    if scene.spheres().len() + scene.tetrahedra().len() > SOLIDS {
        return;
    }
    let line = text.lines().next().unwrap_or_default();
    let mut words = line.trim_start_matches('#').split(' ');
    let stage = Stage::from_number(next_or(&mut words, 6)).unwrap_or(Stage::Reflection);
    let alpha: f64 = next_or(&mut words, 0.0);
    let size = next_or(&mut words, 16).clamp(1, 17);
    if !alpha.is_finite() {
        return;
    }
    let choice = Choice {
        text: text.to_owned(),
        stage,
        alpha,
        size,
        pixel: (size / 2, size / 2),
    };
    check(&scene, &choice);
}

fn next_or<'a, T: FromStr>(words: &mut impl Iterator<Item = &'a str>, otherwise: T) -> T {
    words
        .next()
        .and_then(|word| word.parse().ok())
        .unwrap_or(otherwise)
}

/// Every way that leads to the picture gives the same.
fn check(scene: &Scene, choice: &Choice) {
    let &Choice {
        stage, alpha, size, ..
    } = choice;
    let tracer = |kernel| Tracer::new(kernel, 1).unwrap();
    let [exact, reference] = [Kernel::Exact, Kernel::Reference].map(|kernel| {
        let mut image = Image::new(size).unwrap();
        let decisions = tracer(kernel)
            .trace_with_decisions(scene, stage, alpha, &mut image)
            .unwrap();
        (bits(&image), decisions)
    });
    for (place, (exact, reference)) in exact.1.iter().zip(&reference.1).enumerate() {
        let (column, row) = (place as u32 % size, place as u32 / size);
        assert_eq!(exact, reference, "at ({column}, {row}) {choice:?}");
    }
    for (place, (exact, reference)) in exact.0.iter().zip(&reference.0).enumerate() {
        let (column, row) = (place as u32 / 3 % size, place as u32 / 3 / size);
        assert!(
            exact == reference,
            "{exact:#x} and {reference:#x} at ({column}, {row}) {choice:?}"
        );
    }
    // The narrowest instructions, and over the frame before.
    let plain = Simd::all().into_iter().next_back().unwrap();
    let mut tracer_over = tracer(Kernel::Exact).with_simd(plain);
    let mut over = Image::new(size).unwrap();
    for alpha in [alpha - 0.3, alpha] {
        tracer_over.retrace(scene, stage, alpha, &mut over).unwrap();
    }
    assert!(
        bits(&over) == exact.0,
        "traced over, with plain code, {choice:?}"
    );
    // These promise no bits, but a picture.
    for kernel in [Kernel::Fast, Kernel::Double] {
        let mut image = Image::new(size).unwrap();
        tracer(kernel)
            .trace(scene, stage, alpha, &mut image)
            .unwrap();
    }
    let said = tracer(Kernel::Exact)
        .explain(scene, stage, alpha, size, choice.pixel)
        .unwrap();
    assert!(!said.is_empty(), "{choice:?}");
}

fn bits(image: &Image) -> Vec<u32> {
    image.samples().iter().map(|s| s.to_bits()).collect()
}

/// Bytes that are read as choices; where they end, they go on as zeros.
struct Choices<'a>(&'a [u8]);

impl Choices<'_> {
    fn byte(&mut self) -> u8 {
        match self.0 {
            [first, rest @ ..] => {
                self.0 = rest;
                *first
            }
            [] => 0,
        }
    }

    /// A number from 0 to before `count`.
    fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }

    fn word(&mut self) -> u64 {
        u64::from_le_bytes([(); 8].map(|()| self.byte()))
    }

    fn one_of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    /// A multiple of a small power of two, of which most sums are exact.
    fn dyadic(&mut self) -> f64 {
        let denominator = self.one_of(&[64.0, 64.0, 64.0, 128.0, 128.0, 16.0, 1.0, 1024.0]);
        f64::from(self.byte() as i8) / denominator
    }

    /// Any finite f64 with an exponent of `exponents`.
    fn any(&mut self, exponents: std::ops::Range<i32>) -> f64 {
        let bits = self.word();
        let count = (exponents.end - exponents.start) as u64;
        let exponent = exponents.start + ((bits >> 52 & 0x7ff) % count) as i32;
        let mantissa = 1.0 + (bits & ((1 << 52) - 1)) as f64 / (1u64 << 52) as f64;
        let sign = if bits >> 63 == 1 { -1.0 } else { 1.0 };
        sign * mantissa * f64::from(exponent).exp2()
    }

    /// 0 mostly, else up to three f64s to either side.
    fn ulps(&mut self) -> i32 {
        match self.byte() {
            byte @ 0..64 => i32::from(byte) % 7 - 3,
            _ => 0,
        }
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

/// Magnitudes that a scene file just admits, and such whose squares and products are far away.
const EXTREMES: [f64; 8] = [1e-30, 1e6, 1e-15, 1e-8, 1e-16, 999_999.999, 1e-29, 1e3];

/// The scene as it grows: what is chosen later takes up the numbers and points from before, so that
/// there are ties.
struct Builder<'a> {
    choices: Choices<'a>,
    size: u32,
    /// Along the line of sight, a unit deep, in f64.
    looking: DVec3,
    sin_cos: (f64, f64),
    light: DVec3,
    surface: Option<(f64, f64)>,
    spheres: Vec<(DVec3, f64)>,
    tetrahedra: Vec<[DVec3; 4]>,
    numbers: Vec<f64>,
    points: Vec<DVec3>,
}

impl Choice {
    fn of(bytes: &[u8]) -> Choice {
        let mut choices = Choices(bytes);
        // Not the byte that would make it a text.
        choices.byte();
        let stage = match choices.below(3) {
            0 => choices.one_of(&Stage::ALL),
            _ => Stage::Reflection,
        };
        let alpha = match choices.below(16) {
            0..8 => 0.0,
            8 | 9 => frame_angle(choices.byte().into()),
            10 => choices.one_of(&[1e-9, FRAC_PI_2, -FRAC_PI_2, 1e22, f64::MAX, 0.3, 1e-30]),
            // Subnormal, or of any size.
            11 => f64::from_bits(choices.word() & 0x800f_ffff_ffff_ffff),
            12 => choices.any(-1022..1024),
            13 => choices.any(-20..7),
            14 => choices.dyadic(),
            _ => {
                let quarters = f64::from(choices.byte() as i8);
                step(quarters * FRAC_PI_2, choices.ulps())
            }
        };
        let size = match choices.below(4) {
            0 => 1 + choices.below(17) as u32,
            _ => 16,
        };
        let pixel = [(); 2].map(|()| choices.below(size as usize) as u32);
        let (sin, cos) = alpha.sin_cos();
        let mut builder = Builder {
            choices,
            size,
            looking: -DVec3::new(sin, 0.3, cos),
            sin_cos: (sin, cos),
            light: DVec3::new(1.0, -2.0, -1.0),
            surface: None,
            spheres: Vec::new(),
            tetrahedra: Vec::new(),
            numbers: vec![0.0],
            points: vec![DVec3::ZERO],
        };
        Choice {
            text: builder.text(),
            stage,
            alpha,
            size,
            pixel: pixel.into(),
        }
    }
}

impl Builder<'_> {
    fn number(&mut self) -> f64 {
        let old = self.choices.one_of(&self.numbers);
        let number = match self.choices.below(16) {
            0..6 => self.choices.dyadic(),
            6 | 7 => old,
            8 => step(old, self.choices.ulps()),
            9 => {
                let sign = self.choices.one_of(&[1.0, -1.0]);
                sign * self.choices.one_of(&EXTREMES)
            }
            10 => self.choices.any(-99..20),
            11 | 12 => self.choices.any(-10..0),
            13 => old + self.choices.one_of(&self.numbers),
            _ => old - self.choices.dyadic(),
        };
        let number = fit(number);
        self.numbers.push(number);
        number
    }

    /// A radius, mostly less than the screen.
    fn radius(&mut self) -> f64 {
        self.number().abs() * self.choices.one_of(&[1.0, 0.5, 0.25])
    }

    /// A place of the screen at a sample.
    fn sample(&mut self) -> DVec3 {
        let half = f64::from(self.size) / 2.0;
        let mut place = || self.choices.below(self.size as usize) as f64 / half - 1.0;
        let (u, v) = (place(), place());
        let (sin, cos) = self.sin_cos;
        DVec3::new(sin + u * cos, v, cos - u * sin)
    }

    fn point(&mut self) -> DVec3 {
        let old = self.choices.one_of(&self.points);
        let point = match self.choices.below(10) {
            0..3 => DVec3::new(self.number(), self.number(), self.number()),
            3 => old,
            // Along the line of sight, or the light.
            4 => old + self.looking * self.choices.one_of(&[0.625, -0.625, 1.25, 10.0, 0.1]),
            5 => old + self.light * self.choices.dyadic(),
            // Before a sample: exact for α = 0 and a depth that 10 · 2^k divides.
            6 => self.sample() + self.looking * (0.625 * f64::from(self.choices.byte() % 8)),
            7 => {
                let height = self.surface.map_or(0.0, |(height, _)| height);
                match self.choices.below(2) {
                    0 => DVec3::new(old.x, height, old.z),
                    _ => DVec3::new(old.x, 2.0 * height - old.y, old.z),
                }
            }
            8 => {
                let mut point = old;
                point[self.choices.below(3)] = self.number();
                point
            }
            _ => {
                let ulps = [(); 3].map(|()| self.choices.ulps());
                DVec3::new(
                    step(old.x, ulps[0]),
                    step(old.y, ulps[1]),
                    step(old.z, ulps[2]),
                )
            }
        };
        let point = DVec3::from_array(point.to_array().map(fit));
        self.points.push(point);
        point
    }

    fn sphere(&mut self) -> (DVec3, f64) {
        let last = self.spheres.last().copied();
        let (center, radius) = match (self.choices.below(9), last) {
            (0, Some((center, radius))) => (center, step(radius, self.choices.ulps())),
            // It touches another one from outside or inside.
            (1, Some((center, radius))) => {
                let own = self.radius();
                let side = self.choices.one_of(&[1.0, -1.0]);
                let mut other = center;
                other[self.choices.below(3)] += radius + side * own;
                (other, own)
            }
            // It rests on the surface or hangs below it.
            (2, _) => {
                let center = self.point();
                let height = self.surface.map_or(0.0, |(height, _)| height);
                (center, (center.y - height).abs())
            }
            // It passes through a point, exactly where the numbers are short.
            (3, _) => {
                let (point, unit) = (self.point(), self.choices.dyadic());
                let way = self.choices.one_of(&[
                    DVec3::new(3.0, 4.0, 0.0),
                    DVec3::new(0.0, -3.0, 4.0),
                    DVec3::new(4.0, 0.0, -3.0),
                    DVec3::new(5.0, 0.0, 0.0),
                    DVec3::new(0.0, 0.0, -5.0),
                ]);
                (point + way * unit, (5.0 * unit).abs())
            }
            // Its rim lies on a sample, or that of its shadow or of its mirrored picture.
            (4 | 5, _) => {
                let (center, sample) = (self.point(), self.sample());
                let floor = self.surface.map_or(0.0, |(height, _)| height);
                let seen = sample + self.looking * ((sample.y - floor) / 0.3);
                let up = DVec3::new(self.looking.x, -self.looking.y, self.looking.z);
                let (origin, way) = match self.choices.below(3) {
                    0 => (sample, self.looking),
                    1 => (seen, self.light),
                    _ => (seen, up),
                };
                (center, (center - origin).cross(way).length() / way.length())
            }
            // A sample sees its rim exactly, beside its centre, for α = 0.
            (6, _) => {
                let radius = self.radius();
                let sample = self.sample();
                (sample + self.looking * 0.625 + DVec3::X * radius, radius)
            }
            _ => (self.point(), self.radius()),
        };
        let radius = fit(step(radius, self.choices.ulps())).abs();
        let center = DVec3::from_array(center.to_array().map(fit));
        self.points.push(center);
        self.numbers.push(radius);
        (center, if radius == 0.0 { 0.5 } else { radius })
    }

    fn tetrahedron(&mut self) -> [DVec3; 4] {
        let mut vertices = self.corners();
        let [a, b, c, d] = vertices;
        if (b - a).cross(c - a).dot(d - a) == 0.0 {
            // Flat, as a rule, which is refused.
            vertices[1].x += 0.125;
            vertices[2].y += 0.375;
            vertices[3].z -= 0.25;
        }
        let vertices = vertices.map(|v| DVec3::from_array(v.to_array().map(fit)));
        self.points.extend(vertices);
        vertices
    }

    fn corners(&mut self) -> [DVec3; 4] {
        if let Some(&last) = self.tetrahedra.last() {
            let mut again = last;
            let first = self.choices.below(8);
            if first < 4 {
                again.rotate_left(first);
                // The same again, or one that shares a face or an edge.
                let new = self.choices.below(3);
                again[..new].fill_with(|| self.point());
                return again;
            }
        }
        let mut vertices = [(); 4].map(|()| self.point());
        let [a, b] = [0, 1].map(|_| self.choices.below(4));
        let along = self.choices.one_of(&[0.625, 1.25, -0.625]);
        match self.choices.below(6) {
            // An edge along the line of sight or the light.
            0 => vertices[b] = vertices[a] + self.looking * along,
            1 => vertices[b] = vertices[a] + self.light * along,
            // A face in the surface's plane.
            2 => {
                let height = self.surface.map_or(0.0, |(height, _)| height);
                for vertex in vertices.iter_mut().take(3) {
                    vertex.y = height;
                }
            }
            // A sample on an edge.
            3 => {
                let sample = self.sample() + self.looking * 0.625;
                vertices[b] = vertices[a] + (sample - vertices[a]) * 2.0;
            }
            _ => {}
        }
        vertices
    }

    fn light(&mut self) -> DVec3 {
        let [a, b, c] = [0, 1, 2].map(|_| self.choices.one_of(&self.points));
        let light = match self.choices.below(9) {
            0 => DVec3::new(self.number(), self.number(), self.number()),
            1 => self.looking,
            2 => DVec3::new(self.looking.x, -self.looking.y, self.looking.z),
            3 => -self.looking,
            4 => self
                .choices
                .one_of(&[DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::Y]),
            // Along an edge, or a tangent of a sphere.
            5 => b - a,
            6 => (b - a).cross(c - a),
            // Nearly level.
            7 => DVec3::new(self.number(), 0.0, self.number()),
            _ => {
                let length = f64::from(self.choices.byte() as i8) * 7.0;
                DVec3::new(self.number(), self.number(), self.number()) * length.exp2()
            }
        };
        let light = DVec3::new(
            step(light.x, self.choices.ulps()),
            step(light.y, self.choices.ulps()),
            light.z,
        );
        // What is beside it as good as 0 would be refused.
        let least = light.abs().max_element() * 1e-30;
        let component = |c: f64| if c.abs() <= least { 0.0 } else { c };
        match light.to_array().map(component) {
            [0.0, 0.0, 0.0] => DVec3::NEG_Y,
            components => DVec3::from_array(components),
        }
    }

    /// A colour's or an intensity's three numbers.
    fn amounts(&mut self) -> [f64; 3] {
        let mut amount = || match self.choices.below(6) {
            0 => 0.0,
            1 => self.choices.one_of(&EXTREMES),
            2 => self.choices.any(-99..19).abs(),
            _ => f64::from(self.choices.byte()) / 64.0,
        };
        [amount(), amount(), amount()]
    }

    /// The scene file.
    fn text(&mut self) -> String {
        let mut text = String::new();
        let mut line = |line: String| writeln!(text, "{line}").unwrap();
        if self.choices.below(4) == 0 {
            line(format!("background = {:?}", self.amounts()));
        }
        if self.choices.below(8) != 0 {
            let half_width = self.number().abs();
            let half_width = if half_width == 0.0 { 1.0 } else { half_width };
            let height = match self.choices.below(2) {
                0 => -self.choices.dyadic().abs(),
                _ => self.number(),
            };
            self.surface = Some((height, half_width));
            self.numbers.push(height);
            line(format!(
                "[surface]\nheight = {height:?}\nhalf_width = {half_width:?}"
            ));
            if self.choices.below(4) == 0 {
                let [reflectance, ..] = self.amounts();
                let color = self.amounts();
                line(format!("color = {color:?}\nreflectance = {reflectance:?}"));
            }
        }
        // Before the solids, which may lie along it, or after them, so that it may lie along them.
        let early = self.choices.below(2) == 0;
        if early {
            self.light = self.light();
        }
        let mut solids = String::new();
        for i in 0..1 + self.choices.below(SOLIDS) {
            let color = match self.choices.below(8) {
                0 => self.amounts(),
                // No two of one colour, no channel of one value.
                _ => [0.9 - 0.07 * i as f64, 0.2 + 0.09 * i as f64, 0.51],
            };
            let solid = match self.choices.below(2) {
                0 => {
                    let (center, radius) = self.sphere();
                    self.spheres.push((center, radius));
                    let center = center.to_array();
                    format!("[[sphere]]\ncenter = {center:?}\nradius = {radius:?}")
                }
                _ => {
                    let vertices = self.tetrahedron();
                    self.tetrahedra.push(vertices);
                    let vertices = vertices.map(|v| v.to_array());
                    format!("[[tetrahedron]]\nvertices = {vertices:?}")
                }
            };
            writeln!(solids, "{solid}\ncolor = {color:?}").unwrap();
        }
        if !early {
            self.light = self.light();
        }
        line(format!("[light]\ndirection = {:?}", self.light.to_array()));
        if self.choices.below(4) == 0 {
            let [intensity, ambient] = [self.amounts(), self.amounts()];
            line(format!(
                "intensity = {intensity:?}\nambient_intensity = {ambient:?}"
            ));
        }
        let exponent = self.choices.one_of(&[1000, 1, 2, 7, 1_000_000, 999_983]);
        line(format!("[material]\nexponent = {exponent}"));
        if self.choices.below(4) == 0 {
            let [ambient, diffuse, specular] = [(); 3].map(|()| self.amounts());
            line(format!(
                "ambient = {ambient:?}\ndiffuse = {diffuse:?}\nspecular = {specular:?}"
            ));
        }
        text + &solids
    }
}

/// The number, or the nearest that a scene file admits as a coordinate.
fn fit(number: f64) -> f64 {
    match number.abs() {
        0.0..5e-31 => 0.0,
        5e-31..1e-30 => 1e-30_f64.copysign(number),
        magnitude if magnitude <= 1e6 => number,
        _ => 1e6_f64.copysign(number),
    }
}
