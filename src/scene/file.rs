//! Scene files: TOML in, a scene or a refusal with line and field out; a scene as TOML again.

use std::fs::File;
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;

use glam::DVec3;
use serde::Deserialize;
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Value};

use super::builder::SceneBuilder;
use super::error::{SceneError, SceneFileError};
use super::rules::no_exponent;
use super::{Light, Material, Scene, Sphere, Surface, Tetrahedron};

/// More than any scene of 4096 solids takes; without a limit, a device or a video given by mistake
/// would be read until memory is full.
const MAX_BYTES: u64 = 1 << 26;

/// The scene in the file `path`; what the file leaves out is taken from `standard`.
pub(super) fn load(path: &Path, standard: &Scene) -> Result<Scene, SceneFileError> {
    let file = File::open(path).map_err(|reason| SceneFileError::Read {
        path: path.to_owned(),
        reason,
    })?;
    load_from(file, path, standard)
}

/// The scene in the text that `input` gives, which errors call `name`; what the text leaves out is
/// taken from `standard`.
pub(super) fn load_from(
    input: impl Read,
    name: &Path,
    standard: &Scene,
) -> Result<Scene, SceneFileError> {
    let path = name.to_owned();
    match read_text(input) {
        Ok(text) => {
            read(&text, Some(standard)).map_err(|reason| SceneFileError::Scene { path, reason })
        }
        Err(reason) => Err(SceneFileError::Read { path, reason }),
    }
}

fn read_text(input: impl Read) -> io::Result<String> {
    let mut bytes = Vec::new();
    input.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(io::ErrorKind::FileTooLarge.into());
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        io::Error::other(format!("line {} is not UTF-8", line_after(valid)))
    })
}

type Triple = Exactly<3, f64>;

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

impl From<Triple> for DVec3 {
    fn from(Exactly(values): Triple) -> DVec3 {
        DVec3::from_array(values)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneTable {
    background: Option<Triple>,
    surface: Option<SurfaceTable>,
    #[serde(default)]
    light: LightTable,
    #[serde(default)]
    material: MaterialTable,
    #[serde(default)]
    sphere: Vec<SphereTable>,
    #[serde(default)]
    tetrahedron: Vec<TetrahedronTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SurfaceTable {
    height: f64,
    half_width: f64,
    color: Option<Triple>,
    reflectance: Option<f64>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct LightTable {
    direction: Option<Triple>,
    intensity: Option<Triple>,
    ambient_intensity: Option<Triple>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct MaterialTable {
    ambient: Option<Triple>,
    diffuse: Option<Triple>,
    specular: Option<Triple>,
    exponent: Option<Value>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SphereTable {
    center: Triple,
    radius: f64,
    color: Triple,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TetrahedronTable {
    vertices: Exactly<4, Triple>,
    color: Triple,
}

/// Reads a scene; what the text leaves out is taken from `standard`.
pub(super) fn read(text: &str, standard: Option<&Scene>) -> Result<Scene, SceneError> {
    let table = toml::from_str::<SceneTable>(text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        let field = match DeTable::parse(text) {
            Ok(table) => field_at(table.get_ref(), &span),
            // A text that does not parse has no fields, but a key that stands there twice is named.
            Err(_) if error.message() == "duplicate key" => {
                text.get(span.clone()).map(str::to_owned)
            }
            Err(_) => None,
        };
        SceneError {
            line: Some(line_at(text, span.start)),
            field: field.map(|field| shortened(&field)),
            // The parser's messages have a second line with a hint; a refusal is one line.
            problem: shortened(&error.message().trim().replace('\n', "; ")),
        }
    })?;
    let scene = describe(table, standard).and_then(SceneBuilder::build);
    scene.map_err(|error| {
        let field = error.field.as_deref().unwrap_or_default();
        let line = Some(line_at(text, start_of(text, field)));
        SceneError { line, ..error }
    })
}

fn describe(table: SceneTable, standard: Option<&Scene>) -> Result<SceneBuilder, SceneError> {
    let (light, material) = (standard.map(Scene::light), standard.map(Scene::material));
    let surface = standard.and_then(Scene::surface);
    Ok(SceneBuilder {
        background: or(
            table.background,
            standard.map(Scene::background),
            "background",
        )?,
        light: Light {
            direction: or(
                table.light.direction,
                light.map(|light| light.direction),
                "light.direction",
            )?,
            intensity: or(
                table.light.intensity,
                light.map(|light| light.intensity),
                "light.intensity",
            )?,
            ambient_intensity: or(
                table.light.ambient_intensity,
                light.map(|light| light.ambient_intensity),
                "light.ambient_intensity",
            )?,
        },
        material: Material {
            ambient: or(
                table.material.ambient,
                material.map(|material| material.ambient),
                "material.ambient",
            )?,
            diffuse: or(
                table.material.diffuse,
                material.map(|material| material.diffuse),
                "material.diffuse",
            )?,
            specular: or(
                table.material.specular,
                material.map(|material| material.specular),
                "material.specular",
            )?,
            exponent: or(
                table.material.exponent.map(whole).transpose()?,
                material.map(|material| material.exponent),
                "material.exponent",
            )?,
        },
        surface: match table.surface {
            Some(given) => Some(Surface {
                height: given.height,
                half_width: given.half_width,
                color: or(
                    given.color,
                    surface.map(|surface| surface.color),
                    "surface.color",
                )?,
                reflectance: or(
                    given.reflectance,
                    surface.map(|surface| surface.reflectance),
                    "surface.reflectance",
                )?,
            }),
            None => None,
        },
        spheres: table.sphere.into_iter().map(Sphere::from).collect(),
        tetrahedra: table
            .tetrahedron
            .into_iter()
            .map(Tetrahedron::from)
            .collect(),
    })
}

/// What is given, else the standard; the built-in scene itself has none and gives every field.
fn or<T>(given: Option<impl Into<T>>, standard: Option<T>, field: &str) -> Result<T, SceneError> {
    given
        .map(Into::into)
        .or(standard)
        .ok_or_else(|| SceneError {
            line: None,
            field: Some(field.to_owned()),
            problem: "missing".to_owned(),
        })
}

/// An exponent as it is written: 1000.0 is not a whole number.
fn whole(given: Value) -> Result<u32, SceneError> {
    let whole = given.as_integer();
    whole
        .and_then(|whole| u32::try_from(whole).ok())
        .ok_or_else(|| no_exponent(given))
}

impl From<SphereTable> for Sphere {
    fn from(table: SphereTable) -> Sphere {
        Sphere {
            center: table.center.into(),
            radius: table.radius,
            color: table.color.into(),
        }
    }
}

impl From<TetrahedronTable> for Tetrahedron {
    fn from(table: TetrahedronTable) -> Tetrahedron {
        Tetrahedron {
            vertices: table.vertices.0.map(DVec3::from),
            color: table.color.into(),
        }
    }
}

/// How many characters of a name or a message are shown at each of its ends.
const SHOWN: usize = 120;

/// A text without its middle, where it is as long as a key of a file can be.
fn shortened(text: &str) -> String {
    let count = text.chars().count();
    if count <= 2 * SHOWN {
        return text.to_owned();
    }
    let first = text.chars().take(SHOWN);
    let last = text.chars().skip(count - SHOWN);
    first.chain(['…']).chain(last).collect()
}

/// The number of the line in which this byte of the text is.
fn line_at(text: &str, byte: usize) -> usize {
    line_after(&text.as_bytes()[..byte.min(text.len())])
}

fn line_after(bytes: &[u8]) -> usize {
    1 + bytes.iter().filter(|&&byte| byte == b'\n').count()
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

/// Where in the text the value of a field starts, or what holds it does.
fn start_of(text: &str, field: &str) -> usize {
    let Ok(table) = DeTable::parse(text) else {
        return 0;
    };
    let mut names = field.split(['.', '[', ']']).filter(|name| !name.is_empty());
    let mut value = names.next().and_then(|name| table.get_ref().get(name));
    let mut start = 0;
    while let Some(holder) = value {
        start = holder.span().start;
        value = names.next().and_then(|name| match holder.get_ref() {
            DeValue::Table(table) => table.get(name),
            DeValue::Array(array) => array.get(name.parse::<usize>().ok()?),
            _ => None,
        });
    }
    start
}

/// The scene as the text of a scene file that gives every field; each number is the shortest
/// decimal that reads back as the same f64.
pub(super) fn write(scene: &Scene) -> String {
    let three = |vector: DVec3| format!("{:?}", vector.to_array());
    let mut lines = vec![format!("background = {}", three(scene.background))];
    if let Some(surface) = scene.surface {
        lines.extend([
            "\n[surface]".to_owned(),
            format!("height = {:?}", surface.height),
            format!("half_width = {:?}", surface.half_width),
            format!("color = {}", three(surface.color)),
            format!("reflectance = {:?}", surface.reflectance),
        ]);
    }
    let (light, material) = (scene.light, scene.material);
    lines.extend([
        "\n[light]".to_owned(),
        format!("direction = {}", three(light.direction)),
        format!("intensity = {}", three(light.intensity)),
        format!("ambient_intensity = {}", three(light.ambient_intensity)),
        "\n[material]".to_owned(),
        format!("ambient = {}", three(material.ambient)),
        format!("diffuse = {}", three(material.diffuse)),
        format!("specular = {}", three(material.specular)),
        format!("exponent = {}", material.exponent),
    ]);
    for sphere in &scene.spheres {
        lines.extend([
            "\n[[sphere]]".to_owned(),
            format!("center = {}", three(sphere.center)),
            format!("radius = {:?}", sphere.radius),
            format!("color = {}", three(sphere.color)),
        ]);
    }
    for tetrahedron in &scene.tetrahedra {
        let vertices = tetrahedron.vertices.map(three).join(", ");
        lines.extend([
            "\n[[tetrahedron]]".to_owned(),
            format!("vertices = [{vertices}]"),
            format!("color = {}", three(tetrahedron.color)),
        ]);
    }
    lines.join("\n") + "\n"
}
