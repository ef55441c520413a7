//! Scene files: TOML in, a scene or a refusal with line and field out.

use std::ops::Range;

use glam::DVec3;
use serde::Deserialize;
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Value};

use super::orientation::orientation;
use super::{Light, Material, Scene, Sphere, Surface, Tetrahedron};

/// The most solids that a scene can have.
pub const MAX_SOLIDS: usize = 4096;

/// The smallest and the largest magnitude of a number that is not 0.
const MAGNITUDES: std::ops::RangeInclusive<f64> = 1e-30..=1e6;

/// A scene file that is refused: where, and why.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {}{problem}", .field.as_ref().map(|field| format!("{field}: ")).unwrap_or_default())]
pub struct SceneError {
    /// The line, counted from 1.
    pub line: usize,
    /// The field, such as `sphere[1].radius` (counted from 0), where the problem lies in one.
    pub field: Option<String>,
    /// What is wrong and what would be right, in one line.
    pub problem: String,
}

type Number = Spanned<f64>;
type Triple = Exactly<3, Number>;

/// As many values as that: serde's own arrays let a longer one pass.
#[derive(Deserialize)]
#[serde(try_from = "Vec<T>")]
struct Exactly<const N: usize, T>([T; N]);

impl<const N: usize, T> TryFrom<Vec<T>> for Exactly<N, T> {
    type Error = String;

    fn try_from(values: Vec<T>) -> Result<Self, String> {
        let length = values.len();
        values
            .try_into()
            .map(Exactly)
            .map_err(|_| format!("{length} values where {N} are needed"))
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    background: Option<Triple>,
    surface: Option<SurfaceTable>,
    #[serde(default)]
    light: LightTable,
    #[serde(default)]
    material: MaterialTable,
    #[serde(default)]
    sphere: Vec<Spanned<SphereTable>>,
    #[serde(default)]
    tetrahedron: Vec<Spanned<TetrahedronTable>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SurfaceTable {
    height: Number,
    half_width: Number,
    color: Option<Triple>,
    reflectance: Option<Number>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct LightTable {
    direction: Option<Spanned<Exactly<3, f64>>>,
    intensity: Option<Triple>,
    ambient_intensity: Option<Triple>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct MaterialTable {
    ambient: Option<Triple>,
    diffuse: Option<Triple>,
    specular: Option<Triple>,
    exponent: Option<Spanned<Value>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SphereTable {
    center: Triple,
    radius: Number,
    color: Triple,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TetrahedronTable {
    vertices: Spanned<Exactly<4, Triple>>,
    color: Triple,
}

/// A problem and where in the text it is.
struct Refusal {
    span: Range<usize>,
    problem: String,
}

impl Refusal {
    fn new(span: Range<usize>, problem: impl Into<String>) -> Refusal {
        Refusal {
            span,
            problem: problem.into(),
        }
    }
}

/// Reads a scene; what the text leaves out is taken from `standard`.
pub(super) fn read(text: &str, standard: Option<&Scene>) -> Result<Scene, SceneError> {
    let file = toml::from_str::<File>(text).map_err(|error| {
        // The parser's messages have a second line with a hint; a refusal is one line.
        let message = error.message().trim().replace('\n', "; ");
        Refusal::new(error.span().unwrap_or(0..0), message)
    });
    file.and_then(|file| scene(file, standard))
        .map_err(|refusal| locate(text, refusal))
}

fn scene(file: File, standard: Option<&Scene>) -> Result<Scene, Refusal> {
    let left_out = |field: &str| Refusal::new(0..0, format!("missing field `{field}`"));
    let or_standard = |triple: Option<Triple>, value: Option<DVec3>, field: &str| match triple {
        Some(triple) => amounts(triple),
        None => value.ok_or_else(|| left_out(field)),
    };
    let light = standard.map(Scene::light);
    let material = standard.map(Scene::material);
    let (direction_given, exponent_given) = (file.light.direction, file.material.exponent);
    let surface = file.surface.map(|table| {
        let standard = standard.and_then(Scene::surface);
        Ok(Surface {
            height: coordinate(table.height)?,
            half_width: length(table.half_width)?,
            color: or_standard(table.color, standard.map(|s| s.color), "surface.color")?,
            reflectance: match table.reflectance {
                Some(number) => amount(number)?,
                None => standard
                    .map(|s| s.reflectance)
                    .ok_or_else(|| left_out("surface.reflectance"))?,
            },
        })
    });
    let excess = file
        .sphere
        .iter()
        .map(Spanned::span)
        .chain(file.tetrahedron.iter().map(Spanned::span))
        .nth(MAX_SOLIDS);
    if let Some(span) = excess {
        let count = file.sphere.len() + file.tetrahedron.len();
        return Err(Refusal::new(
            span,
            format!("{count} solids are too many: leave at most {MAX_SOLIDS}"),
        ));
    }
    Ok(Scene {
        background: or_standard(
            file.background,
            standard.map(Scene::background),
            "background",
        )?,
        surface: surface.transpose()?,
        light: Light {
            direction: match direction_given {
                Some(given) => direction(given)?,
                None => light
                    .map(|light| light.direction)
                    .ok_or_else(|| left_out("light.direction"))?,
            },
            intensity: or_standard(
                file.light.intensity,
                light.map(|l| l.intensity),
                "light.intensity",
            )?,
            ambient_intensity: or_standard(
                file.light.ambient_intensity,
                light.map(|l| l.ambient_intensity),
                "light.ambient_intensity",
            )?,
        },
        material: Material {
            ambient: or_standard(
                file.material.ambient,
                material.map(|m| m.ambient),
                "material.ambient",
            )?,
            diffuse: or_standard(
                file.material.diffuse,
                material.map(|m| m.diffuse),
                "material.diffuse",
            )?,
            specular: or_standard(
                file.material.specular,
                material.map(|m| m.specular),
                "material.specular",
            )?,
            exponent: match exponent_given {
                Some(given) => exponent(given)?,
                None => material
                    .map(|m| m.exponent)
                    .ok_or_else(|| left_out("material.exponent"))?,
            },
        },
        spheres: file
            .sphere
            .into_iter()
            .map(|table| sphere(table.into_inner()))
            .collect::<Result<_, _>>()?,
        tetrahedra: file
            .tetrahedron
            .into_iter()
            .map(|t| tetrahedron(t.into_inner()))
            .collect::<Result<_, _>>()?,
    })
}

fn sphere(table: SphereTable) -> Result<Sphere, Refusal> {
    Ok(Sphere {
        center: point(table.center)?,
        radius: length(table.radius)?,
        color: amounts(table.color)?,
    })
}

fn tetrahedron(table: TetrahedronTable) -> Result<Tetrahedron, Refusal> {
    let span = table.vertices.span();
    let mut vertices = [DVec3::ZERO; 4];
    for (vertex, triple) in vertices.iter_mut().zip(table.vertices.into_inner().0) {
        *vertex = point(triple)?;
    }
    let color = amounts(table.color)?;
    let orientation = orientation(vertices);
    if orientation.is_eq() {
        return Err(Refusal::new(
            span,
            "the tetrahedron is flat: move a vertex out of the plane of the others",
        ));
    }
    Ok(Tetrahedron {
        vertices,
        color,
        right_handed: orientation.is_gt(),
    })
}

/// Each number of a triple, read by `one`. A −0 becomes +0.
fn each(triple: Triple, one: fn(Number) -> Result<f64, Refusal>) -> Result<DVec3, Refusal> {
    let Exactly([x, y, z]) = triple;
    Ok(DVec3::new(one(x)?, one(y)?, one(z)?))
}

fn point(triple: Triple) -> Result<DVec3, Refusal> {
    each(triple, coordinate)
}

fn amounts(triple: Triple) -> Result<DVec3, Refusal> {
    each(triple, amount)
}

fn coordinate(number: Number) -> Result<f64, Refusal> {
    let (span, value) = (number.span(), number.into_inner());
    if value != 0.0 && !MAGNITUDES.contains(&value.abs()) {
        return Err(Refusal::new(
            span,
            format!("{value:?} is out of range: a coordinate is 0 or of magnitude 1e-30 to 1e6"),
        ));
    }
    Ok(value + 0.0)
}

fn length(number: Number) -> Result<f64, Refusal> {
    let (span, value) = (number.span(), number.into_inner());
    if !MAGNITUDES.contains(&value) {
        return Err(Refusal::new(
            span,
            format!("{value:?} is out of range: a length is from 1e-30 to 1e6"),
        ));
    }
    Ok(value)
}

/// A colour's, intensity's or coefficient's number.
fn amount(number: Number) -> Result<f64, Refusal> {
    let (span, value) = (number.span(), number.into_inner());
    if value != 0.0 && !MAGNITUDES.contains(&value) {
        return Err(Refusal::new(
            span,
            format!("{value:?} is out of range: it must be 0 or from 1e-30 to 1e6"),
        ));
    }
    Ok(value + 0.0)
}

fn direction(given: Spanned<Exactly<3, f64>>) -> Result<DVec3, Refusal> {
    let (span, values) = (given.span(), given.into_inner().0);
    let magnitudes = values
        .map(f64::abs)
        .into_iter()
        .filter(|&magnitude| magnitude != 0.0);
    if let Some(bad) = values.into_iter().find(|value| !value.is_finite()) {
        return Err(Refusal::new(
            span,
            format!("{bad:?} is not a direction's component: give finite numbers"),
        ));
    }
    let (smallest, largest) =
        magnitudes.fold((f64::INFINITY, 0.0), |(s, l), m| (m.min(s), m.max(l)));
    if largest == 0.0 {
        return Err(Refusal::new(
            span,
            "light of direction 0 goes nowhere: give at least one component that is not 0",
        ));
    }
    if largest / smallest > 1e30 {
        return Err(Refusal::new(
            span,
            "the components that are not 0 differ by more than a factor 1e30: make one of them 0",
        ));
    }
    Ok(DVec3::from_array(values.map(|value| value + 0.0)))
}

fn exponent(given: Spanned<Value>) -> Result<u32, Refusal> {
    let (span, value) = (given.span(), given.into_inner());
    match value
        .as_integer()
        .and_then(|whole| u32::try_from(whole).ok())
    {
        Some(exponent @ 1..=1_000_000) => Ok(exponent),
        _ => Err(Refusal::new(
            span,
            format!("{value} is not an exponent: give a whole number from 1 to 1000000"),
        )),
    }
}

/// The line of a refusal, and the innermost field that holds all of its place.
fn locate(text: &str, refusal: Refusal) -> SceneError {
    let start = refusal.span.start.min(text.len());
    let line = 1 + text.as_bytes()[..start]
        .iter()
        .filter(|&&byte| byte == b'\n')
        .count();
    // A text that does not parse has no fields.
    let field = DeTable::parse(text)
        .ok()
        .and_then(|table| field_at(table.get_ref(), &refusal.span));
    SceneError {
        line,
        field,
        problem: refusal.problem,
    }
}

/// The path to the innermost entry of `table` whose key or value holds `span`.
fn field_at(table: &DeTable<'_>, span: &Range<usize>) -> Option<String> {
    let holds = |outer: Range<usize>| outer.start <= span.start && span.end <= outer.end;
    table.iter().find_map(|(key, value)| {
        let name = key.get_ref();
        match inside(value, span) {
            Some(rest) => Some(format!("{name}{rest}")),
            None => (holds(key.span()) || holds(value.span())).then(|| name.to_string()),
        }
    })
}

/// The path within a value, starting with `.` or `[`.
fn inside(value: &Spanned<DeValue<'_>>, span: &Range<usize>) -> Option<String> {
    match value.get_ref() {
        DeValue::Table(table) => field_at(table, span).map(|rest| format!(".{rest}")),
        DeValue::Array(array) => array.iter().enumerate().find_map(|(index, element)| {
            let outer = element.span();
            match inside(element, span) {
                Some(rest) => Some(format!("[{index}]{rest}")),
                None => (outer.start <= span.start && span.end <= outer.end)
                    .then(|| format!("[{index}]")),
            }
        }),
        _ => None,
    }
}
