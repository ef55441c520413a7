//! Whatever makes pictures of scenes: the tracer, or somebody else's in its place.

use std::path::PathBuf;

use crate::{Image, Scene, Stage, Tracer};

/// Makes pictures of scenes.
///
/// [`Tracer`] does. Whoever writes a ray tracer of their own implements it, too, and can be shown
/// and measured beside the truth, as this one that knows spheres only:
///
/// ```
/// use firsthit::diagnosis::{Examination, TOLERANCE};
/// use firsthit::scene::Sphere;
/// use firsthit::{Image, Render, RenderError, Scene, Stage};
/// use glam::DVec3;
///
/// struct Mine;
///
/// impl Render for Mine {
///     fn name(&self) -> &str {
///         "mine"
///     }
///
///     fn render(&mut self, scene: &Scene, stage: Stage, alpha: f64, image: &mut Image) -> Result<(), RenderError> {
///         if stage != Stage::Shading || !scene.tetrahedra().is_empty() {
///             return Err("only spheres, in stage 4".into());
///         }
///         let (light, material) = (scene.light(), scene.material());
///         let to_light = -light.direction.normalize();
///         let (size, (sin, cos)) = (image.size(), alpha.sin_cos());
///         let to_eye = DVec3::new(sin, 0.3, cos).normalize();
///         let half_way = (to_eye + to_light).normalize();
///         let half = f64::from(size) / 2.0;
///         for (index, pixel) in image.samples_mut().chunks_exact_mut(3).enumerate() {
///             let (x, y) = (index as u32 % size, index as u32 / size);
///             let (u, v) = ((f64::from(x) - half) / half, (f64::from(y) - half) / half);
///             let eye = DVec3::new(sin + u * cos, v, cos - u * sin);
///             // Where the line eye − t·to_eye enters a sphere, at the least t.
///             let enters = |sphere: &Sphere| {
///                 let away = eye - sphere.center;
///                 let b = away.dot(to_eye);
///                 let discriminant = b * b - away.length_squared() + sphere.radius * sphere.radius;
///                 (discriminant >= 0.0).then(|| b - discriminant.sqrt())
///             };
///             let hits = scene.spheres().iter().filter_map(|sphere| Some((enters(sphere)?, sphere)));
///             let color = match hits.min_by(|(a, _), (b, _)| a.total_cmp(b)) {
///                 Some((t, sphere)) => {
///                     let normal = (eye - t * to_eye - sphere.center) / sphere.radius;
///                     let diffuse = normal.dot(to_light).max(0.0);
///                     let specular = normal.dot(half_way).max(0.0).powf(material.exponent.into());
///                     // Equation 4-1.
///                     let lit = material.ambient * light.ambient_intensity
///                         + light.intensity * (material.diffuse * diffuse + material.specular * specular);
///                     sphere.color * lit
///                 }
///                 None => scene.background(),
///             };
///             pixel.copy_from_slice(&color.to_array().map(|sample| sample as f32));
///         }
///         Ok(())
///     }
/// }
///
/// let spheres = Scene::builtin().spheres().to_vec();
/// let scene = spheres.into_iter().fold(Scene::builder(), |scene, sphere| scene.sphere(sphere)).build()?;
/// let mut image = Image::new(100)?;
/// Mine.render(&scene, Stage::Shading, 0.3, &mut image)?;
/// let examination = Examination::new(&scene, Stage::Shading, 0.3, &image, TOLERANCE, 1)?;
/// assert_eq!(examination.diagnosis()?.summary.wrong(), 0);
/// # Ok::<(), Box<dyn std::error::Error + Send + Sync>>(())
/// ```
pub trait Render {
    /// What it is called: a word or two, on one line.
    fn name(&self) -> &str;

    /// Makes the picture of `scene` in `stage`, seen at angle `alpha` in radians, and writes all of
    /// `image` with it: N × N pixels of red, green and blue, rows from the bottom. N is the size of
    /// `image`, and stays so.
    ///
    /// # Errors
    /// [`RenderError`] where there is no such picture; what is in `image` then is not looked at.
    fn render(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
    ) -> Result<(), RenderError>;

    /// Files that its pictures depend on, such as the program that makes them: none, if not said
    /// otherwise.
    fn files(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    /// Called when the last picture has been there for a while and nothing else has been asked for.
    ///
    /// # Errors
    /// [`RenderError`] where something has been found to be wrong with that picture since: such as
    /// that a program wrote more than the picture. Nothing is, if not said otherwise.
    fn recheck(&mut self) -> Result<(), RenderError> {
        Ok(())
    }

    /// What ends the picture that is being made: after it is called, on any thread,
    /// [`Render::render`] returns an error soon, and the next picture is made as ever. `None` where
    /// a picture that has begun has to be waited for.
    fn canceller(&self) -> Option<Canceller> {
        None
    }

    /// One of its [`files`](Render::files) has changed: the next picture is to be made with what is
    /// there now.
    fn reload(&mut self) {}
}

/// Ends the picture that a renderer makes.
pub type Canceller = Box<dyn Fn() + Send>;

/// Why there is no picture, in one line: any error, or a text.
pub type RenderError = Box<dyn std::error::Error + Send + Sync>;

impl Render for Tracer {
    fn name(&self) -> &str {
        self.kernel().name()
    }

    fn render(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
    ) -> Result<(), RenderError> {
        Ok(self.trace(scene, stage, alpha, image)?)
    }
}
