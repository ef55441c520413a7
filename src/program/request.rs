//! What a program is asked for: one picture.

use std::fmt;

use crate::Stage;

/// A picture but for its scene, as errors name it: `stage 6, α = 0.3, 500 × 500`.
#[derive(Clone, Copy)]
pub(super) struct Request {
    pub(super) stage: Stage,
    pub(super) alpha: f64,
    pub(super) size: u32,
}

impl Request {
    /// The line that asks for it, of the scene in the file of path `scene`.
    pub(super) fn line(&self, scene: &str) -> String {
        let Request { stage, alpha, size } = self;
        // The shortest decimal that reads back as the same f64, which is JSON, too.
        format!(
            "{{\"scene\": {}, \"stage\": {}, \"alpha\": {alpha:?}, \"size\": {size}}}\n",
            serde_json::Value::from(scene),
            stage.number(),
        )
    }
}

impl fmt::Display for Request {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Request { stage, alpha, size } = self;
        write!(
            f,
            "stage {}, α = {alpha:?}, {size} × {size}",
            stage.number()
        )
    }
}
