//! What a scene must keep to, wherever it comes from: ranges of numbers, solids with a volume.

use std::fmt::Display;
use std::ops::RangeInclusive;

use glam::DVec3;

use super::error::SceneError;
use super::exact::orientation;
use super::{Light, Material, Sphere, Surface, Tetrahedron};

/// The most solids that a scene can have.
pub const MAX_SOLIDS: usize = 4096;

/// The smallest and the largest magnitude of a number that is not 0.
const MAGNITUDES: RangeInclusive<f64> = 1e-30..=1e6;

/// The refusal of a field, such as `sphere[1].center[0]`.
fn refusal(field: String, problem: impl Into<String>) -> SceneError {
    SceneError {
        line: None,
        field: Some(field),
        problem: problem.into(),
    }
}

pub(super) fn check_count(spheres: usize, tetrahedra: usize) -> Result<(), SceneError> {
    let count = spheres + tetrahedra;
    if count <= MAX_SOLIDS {
        return Ok(());
    }
    let field = match spheres.checked_sub(MAX_SOLIDS + 1) {
        Some(_) => format!("sphere[{MAX_SOLIDS}]"),
        None => format!("tetrahedron[{}]", MAX_SOLIDS - spheres),
    };
    let problem = format!("{count} solids are too many: leave at most {MAX_SOLIDS}");
    Err(refusal(field, problem))
}

pub(super) fn check_background(background: DVec3) -> Result<DVec3, SceneError> {
    triple("background", background, amount)
}

pub(super) fn check_light(light: Light) -> Result<Light, SceneError> {
    Ok(Light {
        direction: direction(light.direction)
            .map_err(|problem| refusal("light.direction".to_owned(), problem))?,
        intensity: triple("light.intensity", light.intensity, amount)?,
        ambient_intensity: triple("light.ambient_intensity", light.ambient_intensity, amount)?,
    })
}

pub(super) fn check_material(material: Material) -> Result<Material, SceneError> {
    Ok(Material {
        ambient: triple("material.ambient", material.ambient, amount)?,
        diffuse: triple("material.diffuse", material.diffuse, amount)?,
        specular: triple("material.specular", material.specular, amount)?,
        exponent: match material.exponent {
            exponent @ 1..=1_000_000 => exponent,
            exponent => return Err(no_exponent(exponent)),
        },
    })
}

/// The refusal of an exponent, which may not even be a number.
pub(super) fn no_exponent(given: impl Display) -> SceneError {
    let problem = format!("{given} is not an exponent: give a whole number from 1 to 1000000");
    refusal("material.exponent".to_owned(), problem)
}

pub(super) fn check_surface(surface: Surface) -> Result<Surface, SceneError> {
    Ok(Surface {
        height: number("surface.height", surface.height, coordinate)?,
        half_width: number("surface.half_width", surface.half_width, length)?,
        color: triple("surface.color", surface.color, amount)?,
        reflectance: number("surface.reflectance", surface.reflectance, amount)?,
    })
}

pub(super) fn check_sphere(index: usize, sphere: Sphere) -> Result<Sphere, SceneError> {
    let field = |name| move || format!("sphere[{index}].{name}");
    Ok(Sphere {
        center: triple(field("center"), sphere.center, coordinate)?,
        radius: number(field("radius"), sphere.radius, length)?,
        color: triple(field("color"), sphere.color, amount)?,
    })
}

/// The tetrahedron, and whether its edges 0→1, 0→2, 0→3 are right-handed.
pub(super) fn check_tetrahedron(
    index: usize,
    tetrahedron: Tetrahedron,
) -> Result<(Tetrahedron, bool), SceneError> {
    let mut vertices = tetrahedron.vertices;
    for (corner, vertex) in vertices.iter_mut().enumerate() {
        let field = move || format!("tetrahedron[{index}].vertices[{corner}]");
        *vertex = triple(field, *vertex, coordinate)?;
    }
    let color = move || format!("tetrahedron[{index}].color");
    let color = triple(color, tetrahedron.color, amount)?;
    let orientation = orientation(vertices);
    if orientation.is_eq() {
        return Err(refusal(
            format!("tetrahedron[{index}].vertices"),
            "the tetrahedron is flat: move a vertex out of the plane of the others",
        ));
    }
    Ok((Tetrahedron { vertices, color }, orientation.is_gt()))
}

/// The name of a field, which only a refusal spells out.
trait Field {
    fn name(self) -> String;
}

impl Field for &str {
    fn name(self) -> String {
        self.to_owned()
    }
}

impl<F: FnOnce() -> String> Field for F {
    fn name(self) -> String {
        self()
    }
}

/// What is wrong with a number, or the number; a −0 becomes +0.
type Rule = fn(f64) -> Result<f64, String>;

fn number(field: impl Field, value: f64, rule: Rule) -> Result<f64, SceneError> {
    rule(value).map_err(|problem| refusal(field.name(), problem))
}

fn triple(field: impl Field, value: DVec3, rule: Rule) -> Result<DVec3, SceneError> {
    let mut checked = value.to_array();
    for (index, value) in checked.iter_mut().enumerate() {
        match rule(*value) {
            Ok(right) => *value = right,
            Err(problem) => {
                return Err(refusal(format!("{}[{index}]", field.name()), problem));
            }
        }
    }
    Ok(DVec3::from_array(checked))
}

fn coordinate(value: f64) -> Result<f64, String> {
    if value != 0.0 && !MAGNITUDES.contains(&value.abs()) {
        return Err(format!(
            "{value:?} is out of range: a coordinate is 0 or of magnitude 1e-30 to 1e6"
        ));
    }
    Ok(value + 0.0)
}

fn length(value: f64) -> Result<f64, String> {
    if !MAGNITUDES.contains(&value) {
        return Err(format!(
            "{value:?} is out of range: a length is from 1e-30 to 1e6"
        ));
    }
    Ok(value)
}

/// A colour's, an intensity's or a coefficient's number.
fn amount(value: f64) -> Result<f64, String> {
    if value != 0.0 && !MAGNITUDES.contains(&value) {
        return Err(format!(
            "{value:?} is out of range: it must be 0 or from 1e-30 to 1e6"
        ));
    }
    Ok(value + 0.0)
}

fn direction(given: DVec3) -> Result<DVec3, String> {
    let values = given.to_array();
    if let Some(bad) = values.into_iter().find(|value| !value.is_finite()) {
        return Err(format!(
            "{bad:?} is not a direction's component: give finite numbers"
        ));
    }
    let magnitudes = values.map(f64::abs).into_iter();
    let (smallest, largest) = magnitudes
        .filter(|&magnitude| magnitude != 0.0)
        .fold((f64::INFINITY, 0.0), |(s, l), m| (m.min(s), m.max(l)));
    if largest == 0.0 {
        return Err(
            "light of direction 0 goes nowhere: give at least one component that is not 0"
                .to_owned(),
        );
    }
    if largest / smallest > 1e30 {
        return Err(
            "the components that are not 0 differ by more than a factor 1e30: make one of them 0"
                .to_owned(),
        );
    }
    Ok(given + 0.0)
}
