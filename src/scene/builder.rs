//! Scenes made in code.

use glam::DVec3;

use super::error::SceneError;
use super::exact::Facts;
use super::rules::{
    check_background, check_count, check_light, check_material, check_sphere, check_surface,
    check_tetrahedron,
};
use super::{Light, Material, Scene, Sphere, Surface, Tetrahedron};

/// A scene on its way, made by [`Scene::builder`].
///
/// ```
/// use firsthit::scene::{Material, Scene, Sphere};
/// use glam::DVec3;
///
/// let ball = Sphere { center: DVec3::ZERO, radius: 0.5, color: DVec3::new(1.0, 0.5, 0.0) };
/// let dull = Material { specular: DVec3::ZERO, ..*Scene::builtin().material() };
/// let scene = Scene::builder().sphere(ball).material(dull).build()?;
/// assert!(scene.surface().is_none());
///
/// let refused = Scene::builder().sphere(Sphere { radius: 0.0, ..ball }).build();
/// assert_eq!(refused.unwrap_err().field.as_deref(), Some("sphere[0].radius"));
/// # Ok::<(), firsthit::scene::SceneError>(())
/// ```
#[derive(Clone, Debug)]
pub struct SceneBuilder {
    pub(super) background: DVec3,
    pub(super) surface: Option<Surface>,
    pub(super) light: Light,
    pub(super) material: Material,
    pub(super) spheres: Vec<Sphere>,
    pub(super) tetrahedra: Vec<Tetrahedron>,
}

impl SceneBuilder {
    /// No solids and no surface; all else as in the scene `standard`.
    pub(super) fn like(standard: &Scene) -> SceneBuilder {
        SceneBuilder {
            background: standard.background,
            surface: None,
            light: standard.light,
            material: standard.material,
            spheres: Vec::new(),
            tetrahedra: Vec::new(),
        }
    }

    /// What is seen where nothing is hit.
    pub fn background(self, background: DVec3) -> SceneBuilder {
        SceneBuilder { background, ..self }
    }

    /// The glazed surface.
    pub fn surface(self, surface: Surface) -> SceneBuilder {
        let surface = Some(surface);
        SceneBuilder { surface, ..self }
    }

    /// The light.
    pub fn light(self, light: Light) -> SceneBuilder {
        SceneBuilder { light, ..self }
    }

    /// The material of all solids.
    pub fn material(self, material: Material) -> SceneBuilder {
        SceneBuilder { material, ..self }
    }

    /// One more sphere.
    pub fn sphere(mut self, sphere: Sphere) -> SceneBuilder {
        self.spheres.push(sphere);
        self
    }

    /// One more tetrahedron.
    pub fn tetrahedron(mut self, tetrahedron: Tetrahedron) -> SceneBuilder {
        self.tetrahedra.push(tetrahedron);
        self
    }

    /// The scene that was described.
    ///
    /// # Errors
    /// As [`Scene::from_toml`], for the same numbers, with the same words and fields, and without a
    /// line.
    pub fn build(self) -> Result<Scene, SceneError> {
        let SceneBuilder {
            background,
            surface,
            light,
            material,
            spheres,
            tetrahedra,
        } = self;
        check_count(spheres.len(), tetrahedra.len())?;
        let background = check_background(background)?;
        let light = check_light(light)?;
        let material = check_material(material)?;
        let surface = surface.map(check_surface).transpose()?;
        let spheres = spheres.into_iter().enumerate();
        let spheres: Vec<_> = spheres
            .map(|(number, sphere)| check_sphere(number, sphere))
            .collect::<Result<_, _>>()?;
        let tetrahedra = tetrahedra.into_iter().enumerate();
        let (tetrahedra, right_handed): (Vec<_>, _) = tetrahedra
            .map(|(number, tetrahedron)| check_tetrahedron(number, tetrahedron))
            .collect::<Result<_, _>>()?;
        let facts = Facts::new(
            &spheres,
            (&tetrahedra, right_handed),
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
}
