//! Whatever makes pictures of scenes: the tracer, or somebody else's in its place.

use std::path::PathBuf;

use crate::{Image, Scene, Stage, Tracer};

/// Makes pictures of scenes.
///
/// [`Tracer`] does. Whoever writes a ray tracer of their own implements it, too, and can be shown
/// and measured beside the truth.
pub trait Render {
    /// What it is called: a word or two, on one line.
    fn name(&self) -> &str;

    /// Makes the picture of `scene` in `stage`, seen at angle `alpha` in radians, and writes all of
    /// `image` with it: N × N pixels of red, green and blue, rows from the bottom.
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

    /// One of its [`files`](Render::files) has changed: the next picture is to be made with what is
    /// there now.
    fn reload(&mut self) {}
}

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
