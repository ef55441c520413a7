//! Scene files: TOML in, a scene or a refusal with line and field out.

use std::ops::Range;

use glam::DVec3;
use serde::Deserialize;
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Value};

use super::exact::{Facts, orientation};
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
    let spans = file
        .sphere
        .iter()
        .map(Spanned::span)
        .chain(file.tetrahedron.iter().map(Spanned::span));
    if let Some(excess) = spans.clone().nth(MAX_SOLIDS) {
        let problem = format!(
            "{} solids are too many: leave at most {MAX_SOLIDS}",
            spans.count()
        );
        return Err(Refusal::new(excess, problem));
    }
    let background = triple(
        file.background,
        standard.map(Scene::background),
        "background",
    )?;
    let surface = file
        .surface
        .map(|table| surface(table, standard.and_then(Scene::surface)));
    let light = light(file.light, standard.map(Scene::light))?;
    let material = material(file.material, standard.map(Scene::material))?;
    let spheres = file
        .sphere
        .into_iter()
        .map(|table| sphere(table.into_inner()));
    let tetrahedra = file
        .tetrahedron
        .into_iter()
        .map(|table| tetrahedron(table.into_inner()));
    let (surface, spheres) = (
        surface.transpose()?,
        spheres.collect::<Result<Vec<_>, _>>()?,
    );
    let tetrahedra = tetrahedra.collect::<Result<Vec<_>, _>>()?;
    let facts = Facts::new(
        &spheres,
        &tetrahedra,
        surface.as_ref(),
        light.scaled_direction(),
    );
    Ok(Scene {
        background,
        surface,
        light,
        material,
        spheres,
        tetrahedra,
        facts,
    })
}

/// What is read where a field is given, else the standard; the built-in scene itself has none and
/// gives every field.
fn or_standard<G, T>(
    given: Option<G>,
    read: fn(G) -> Result<T, Refusal>,
    standard: Option<T>,
    field: &str,
) -> Result<T, Refusal> {
    match given {
        Some(given) => read(given),
        None => standard.ok_or_else(|| Refusal::new(0..0, format!("missing field `{field}`"))),
    }
}

fn triple(given: Option<Triple>, standard: Option<DVec3>, field: &str) -> Result<DVec3, Refusal> {
    or_standard(given, amounts, standard, field)
}

fn surface(table: SurfaceTable, standard: Option<&Surface>) -> Result<Surface, Refusal> {
    Ok(Surface {
        height: coordinate(table.height)?,
        half_width: length(table.half_width)?,
        color: triple(table.color, standard.map(|surface| surface.color), "color")?,
        reflectance: or_standard(
            table.reflectance,
            amount,
            standard.map(|s| s.reflectance),
            "reflectance",
        )?,
    })
}

fn light(table: LightTable, standard: Option<&Light>) -> Result<Light, Refusal> {
    let ambient = standard.map(|light| light.ambient_intensity);
    Ok(Light {
        direction: or_standard(
            table.direction,
            direction,
            standard.map(|l| l.direction),
            "direction",
        )?,
        intensity: triple(
            table.intensity,
            standard.map(|light| light.intensity),
            "intensity",
        )?,
        ambient_intensity: triple(table.ambient_intensity, ambient, "ambient_intensity")?,
    })
}

fn material(table: MaterialTable, standard: Option<&Material>) -> Result<Material, Refusal> {
    Ok(Material {
        ambient: triple(
            table.ambient,
            standard.map(|material| material.ambient),
            "ambient",
        )?,
        diffuse: triple(
            table.diffuse,
            standard.map(|material| material.diffuse),
            "diffuse",
        )?,
        specular: triple(
            table.specular,
            standard.map(|material| material.specular),
            "specular",
        )?,
        exponent: or_standard(
            table.exponent,
            exponent,
            standard.map(|m| m.exponent),
            "exponent",
        )?,
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
