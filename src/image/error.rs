//! What can keep a picture from its file.

use std::io;
use std::path::{Path, PathBuf};

/// The most frames of an animation: the format numbers them, and each takes up to two of its 2³¹
/// sequence numbers.
pub(super) const MAX_FRAMES: u64 = 1 << 30;

/// A file that cannot be written. Nothing is left of it: what was there before is there still.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The extension names no format.
    #[error("{}: this extension names no format: choose .png, .exr or, for an animation, .apng", .0.display())]
    Extension(PathBuf),
    /// A single picture was to be saved as `.apng`.
    #[error("{}: an .apng holds an animation, not one picture: choose .png or .exr", .0.display())]
    Animation(PathBuf),
    /// An animation cannot have this many frames.
    #[error("{}: an animation of {frames} frames cannot be written: choose 1 to {}", path.display(), MAX_FRAMES)]
    Frames {
        /// The file.
        path: PathBuf,
        /// The number of frames asked for.
        frames: u64,
    },
    /// Something that is not a file has this name: a folder, a device, a pipe.
    #[error("{}: this is a folder or a device, not a file: choose another path", .0.display())]
    NotAFile(PathBuf),
    /// A file of this name is there, and it is write-protected.
    #[error("{}: this file is read-only: allow writing to it, or choose another path", .0.display())]
    ReadOnly(PathBuf),
    /// The system refused.
    #[error("{}: cannot be written: {reason}: {}", path.display(), advice(reason))]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
}

impl SaveError {
    pub(in crate::image) fn write(path: &Path, reason: io::Error) -> SaveError {
        let path = path.to_owned();
        SaveError::Write { path, reason }
    }
}

fn advice(reason: &io::Error) -> &'static str {
    match reason.kind() {
        io::ErrorKind::NotFound => "make the folder first",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "choose a folder that you may write to"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            "make room, or choose another disk"
        }
        io::ErrorKind::OutOfMemory => "choose a smaller size",
        _ => "choose another path",
    }
}
