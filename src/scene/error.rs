//! Why there is no scene.

use std::io;
use std::path::PathBuf;

/// A scene that is refused: where, and why.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}{}{problem}",
    .line.map(|line| format!("line {line}: ")).unwrap_or_default(),
    .field.as_ref().map(|field| format!("{field}: ")).unwrap_or_default())]
pub struct SceneError {
    /// The line, counted from 1, of a scene that is read as text.
    pub line: Option<usize>,
    /// The field, such as `sphere[1].radius` (counted from 0), where the problem lies in one.
    pub field: Option<String>,
    /// What is wrong and what would be right, in one line.
    pub problem: String,
}

/// A scene file that gives no scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneFileError {
    /// The file is not there, or cannot be read, or is not a text of at most 64 MiB.
    #[error("{}: cannot be read: {reason}: give the path of a scene file", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What keeps it from being read.
        reason: io::Error,
    },
    /// The scene is refused.
    #[error("{}: {reason}", path.display())]
    Scene {
        /// The file.
        path: PathBuf,
        /// Where in it, and why.
        reason: SceneError,
    },
}
