//! What exists: solids, a surface, a light, one material.
//!
//! Lengths have no unit. A coordinate is 0 or of magnitude 1e-30 to 1e6. The three amounts of a
//! colour, an intensity or a coefficient are red, green and blue, each 0 or 1e-30 to 1e6, linear
//! and not clamped. [`Scene::from_toml`] lists all rules, and [`SceneBuilder::build`] keeps them,
//! too.

mod bounding_ball;
mod builder;
mod casters;
mod enclosed;
mod error;
mod exact;
mod faces;
mod file;
mod rational;
mod rules;
mod solid;
mod surface_casters;

use std::cmp::Ordering;
use std::io::Read;
use std::path::Path;
use std::sync::LazyLock;

use glam::DVec3;

pub use builder::SceneBuilder;
pub use error::{SceneError, SceneFileError};
pub(crate) use exact::{Facts, Side, Support};
pub(crate) use faces::{EDGES, FACES};
pub use rules::MAX_SOLIDS;
pub(crate) use solid::Solid;
pub(crate) use surface_casters::SurfaceCasters;

/// The built-in scene, as the TOML text that it is read from.
pub const BUILTIN_TOML: &str = include_str!("scene/builtin.toml");

/// A sphere: all points at most `radius` from `center`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre.
    pub center: DVec3,
    /// Its radius, 1e-30 to 1e6.
    pub radius: f64,
    /// Its colour c.
    pub color: DVec3,
}

/// A tetrahedron that is not flat. Face k is the one opposite vertex k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tetrahedron {
    /// Its vertices, in any order.
    pub vertices: [DVec3; 4],
    /// Its colour c.
    pub color: DVec3,
}

/// The glazed surface: the square y = `height`, |x| ≤ `half_width`, |z| ≤ `half_width`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Its y.
    pub height: f64,
    /// Half the length of its sides, 1e-30 to 1e6.
    pub half_width: f64,
    /// Its colour where it mirrors nothing.
    pub color: DVec3,
    /// The weight of the mirrored colour, 0 or 1e-30 to 1e6.
    pub reflectance: f64,
}

/// The light: infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The way the light travels: any length but 0; components that are not 0 differ by at most a
    /// factor 1e30.
    pub direction: DVec3,
    /// I of equation 4-1.
    pub intensity: DVec3,
    /// I_a of equation 4-1.
    pub ambient_intensity: DVec3,
}

impl Light {
    /// The sign of the rise of rays to the light.
    pub(crate) fn rise(&self) -> Ordering {
        0.0.partial_cmp(&self.direction.y)
            .unwrap_or(Ordering::Equal)
    }

    /// The direction, times the power of two that makes its largest component at least 1 and less
    /// than 2: exactly the same direction, and its square neither overflows nor underflows.
    pub(crate) fn scaled_direction(&self) -> DVec3 {
        let exponent = libm::ilogb(self.direction.abs().max_element());
        DVec3::from_array(
            self.direction
                .to_array()
                .map(|component| libm::scalbn(component, -exponent)),
        )
    }
}

/// The coefficients of equation 4-1, shared by all solids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// k_a.
    pub ambient: DVec3,
    /// k_d.
    pub diffuse: DVec3,
    /// k_s.
    pub specular: DVec3,
    /// n, 1 to 1 000 000.
    pub exponent: u32,
}

/// A scene that keeps every rule of the file format, wherever it comes from.
#[derive(Clone, Debug)]
pub struct Scene {
    background: DVec3,
    surface: Option<Surface>,
    light: Light,
    material: Material,
    spheres: Vec<Sphere>,
    tetrahedra: Vec<Tetrahedron>,
    /// These follow from the other fields.
    facts: Facts,
}

impl PartialEq for Scene {
    fn eq(&self, other: &Scene) -> bool {
        let given = |scene: &Scene| {
            let Scene {
                background,
                surface,
                light,
                material,
                spheres: _,
                tetrahedra: _,
                facts: _,
            } = *scene;
            (background, surface, light, material)
        };
        given(self) == given(other)
            && self.spheres == other.spheres
            && self.tetrahedra == other.tetrahedra
    }
}

impl Scene {
    /// The document's scene: two spheres and a tetrahedron on a glazed surface.
    ///
    /// ```
    /// let scene = firsthit::Scene::builtin();
    /// assert_eq!((scene.spheres().len(), scene.tetrahedra().len()), (2, 1));
    /// ```
    pub fn builtin() -> Scene {
        static BUILTIN: LazyLock<Scene> = LazyLock::new(|| {
            #[expect(clippy::expect_used, reason = "a constant text, which a test reads")]
            file::read(BUILTIN_TOML, None).expect("the built-in scene is a scene")
        });
        BUILTIN.clone()
    }

    /// Reads a scene file.
    ///
    /// What the text leaves out is as in the built-in scene: `background`, `[light]`, `[material]`,
    /// `surface.color` and `surface.reflectance`, whole or in part. Geometry cannot be left
    /// out, and without `[surface]` there is none.
    ///
    /// ```
    /// use firsthit::Scene;
    /// let ball = Scene::from_toml("[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = 0.5\ncolor = [1.0, 0.5, 0.0]")?;
    /// assert!(ball.surface().is_none());
    /// let refused = Scene::from_toml("[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = 0.0\ncolor = [1.0, 0.5, 0.0]");
    /// assert_eq!(refused.unwrap_err().field.as_deref(), Some("sphere[0].radius"));
    /// # Ok::<(), firsthit::scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// A text that is not TOML; an unknown key; a missing field; a NaN or an infinity; a coordinate
    /// or height that is neither 0 nor of magnitude 1e-30 to 1e6; a radius or half width
    /// outside of that range; a colour, intensity, coefficient or reflectance that is neither 0
    /// nor within it; a flat tetrahedron; a light direction of 0, or with components that
    /// differ by more than a factor 1e30; an exponent that is not a whole number from 1 to 1 000
    /// 000; more than [`MAX_SOLIDS`] solids.
    pub fn from_toml(text: &str) -> Result<Scene, SceneError> {
        file::read(text, Some(&Scene::builtin()))
    }

    /// Reads the scene file `path`, as [`Scene::from_toml`] reads its text.
    ///
    /// # Errors
    /// [`SceneFileError`] where the file cannot be read, or its scene is refused.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Scene, SceneFileError> {
        file::load(path.as_ref(), &Scene::builtin())
    }

    /// Reads a scene from `input` to its end, as [`Scene::from_toml`] reads its text. Errors call
    /// `name` what is read.
    ///
    /// # Errors
    /// [`SceneFileError`] where the input cannot be read, or its scene is refused.
    pub fn from_reader(input: impl Read, name: impl AsRef<Path>) -> Result<Scene, SceneFileError> {
        file::load_from(input, name.as_ref(), &Scene::builtin())
    }

    /// A scene to be made in code: without solids and surface, and with the background, the light
    /// and the material of the built-in scene, until they are given.
    pub fn builder() -> SceneBuilder {
        SceneBuilder::like(&Scene::builtin())
    }

    /// The scene as TOML that gives every field, in the order of the built-in scene's text; each
    /// number is the shortest decimal that reads back as the same f64.
    ///
    /// ```
    /// use firsthit::Scene;
    /// let scene = Scene::builtin();
    /// assert_eq!(Scene::from_toml(&scene.to_toml())?, scene);
    /// # Ok::<(), firsthit::scene::SceneError>(())
    /// ```
    pub fn to_toml(&self) -> String {
        file::write(self)
    }

    /// What is seen where nothing is hit.
    pub fn background(&self) -> DVec3 {
        self.background
    }

    /// The surface, if there is one.
    pub fn surface(&self) -> Option<&Surface> {
        self.surface.as_ref()
    }

    /// The light.
    pub fn light(&self) -> &Light {
        &self.light
    }

    /// The material of all solids.
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// The spheres, in the file's order.
    pub fn spheres(&self) -> &[Sphere] {
        &self.spheres
    }

    /// The tetrahedra, in the file's order.
    pub fn tetrahedra(&self) -> &[Tetrahedron] {
        &self.tetrahedra
    }

    /// The number of solids.
    pub(crate) fn solid_count(&self) -> usize {
        self.spheres.len() + self.tetrahedra.len()
    }

    /// The solid of this number.
    pub(crate) fn solid(&self, number: usize) -> Solid<&Sphere, &Tetrahedron> {
        Solid::numbered(number, &self.spheres, &self.tetrahedra)
    }

    /// The same scene in light that travels the opposite way.
    pub(crate) fn with_light_reversed(&self) -> Scene {
        let light = Light {
            // No −0.
            direction: DVec3::ZERO - self.light.direction,
            ..self.light
        };
        let facts = Facts::new(
            &self.spheres,
            (&self.tetrahedra, self.facts.right_handed.clone()),
            self.surface.as_ref(),
            light.scaled_direction(),
        );
        Scene {
            light,
            facts,
            ..self.clone()
        }
    }

    /// What was found out about the scene once, when it was made.
    pub(crate) fn facts(&self) -> &Facts {
        &self.facts
    }
}
