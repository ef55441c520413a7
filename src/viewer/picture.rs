//! The picture that is shown, traced only when it changes.

use crate::{Image, Scene, Stage, Tracer};

use super::{Options, ViewerError};

/// The scene, its tracer, and what was traced last.
pub(super) struct Picture {
    scene: Scene,
    tracer: Tracer,
    image: Image,
    /// The stage and α in `image`.
    traced: Option<(Stage, f64)>,
}

impl Picture {
    pub(super) fn new(options: &Options) -> Result<Picture, ViewerError> {
        Ok(Picture {
            scene: options.scene.clone(),
            tracer: Tracer::new(options.kernel, options.threads)?,
            image: Image::new(options.size)?,
            traced: None,
        })
    }

    /// Makes the image the one of `stage` at `alpha`; whether that took tracing it.
    pub(super) fn bring(&mut self, stage: Stage, alpha: f64) -> Result<bool, ViewerError> {
        if self.is((stage, alpha)) {
            return Ok(false);
        }
        // While it is being traced it is neither picture.
        self.traced = None;
        self.tracer
            .trace(&self.scene, stage, alpha, &mut self.image)?;
        self.traced = Some((stage, alpha));
        Ok(true)
    }

    /// Whether the image is that of this stage and α.
    pub(super) fn is(&self, wanted: (Stage, f64)) -> bool {
        self.traced == Some(wanted)
    }

    pub(super) fn image(&self) -> &Image {
        &self.image
    }
}
