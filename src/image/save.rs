//! A picture into a file, in the format that the file's extension names.

use std::io;
use std::path::{Path, PathBuf};

use super::whole_file::WholeFile;
use super::{Animation, Image, exr, png};

/// What a file holds; its extension says which.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// `.png`: 8 bits a sample, what the display shows.
    Png,
    /// `.exr`: every 32-bit float as it is.
    Exr,
    /// `.apng`: an animation of 8 bits a sample.
    Apng,
}

impl Format {
    /// Every format.
    pub const ALL: [Format; 3] = [Format::Png, Format::Exr, Format::Apng];

    /// Its extension, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Png => "png",
            Format::Exr => "exr",
            Format::Apng => "apng",
        }
    }

    /// The format that the extension of `path` names, in small letters or capitals.
    ///
    /// # Errors
    /// [`SaveError::Extension`] for any other extension, and for none.
    ///
    /// ```
    /// use firsthit::image::Format;
    /// assert_eq!(Format::of("out/picture.EXR".as_ref()).unwrap(), Format::Exr);
    /// assert!(Format::of("picture.jpeg".as_ref()).is_err());
    /// ```
    pub fn of(path: &Path) -> Result<Format, SaveError> {
        let extension = path.extension().unwrap_or_default();
        Format::ALL
            .into_iter()
            .find(|format| extension.eq_ignore_ascii_case(format.extension()))
            .ok_or_else(|| SaveError::Extension(path.to_owned()))
    }
}

/// A file that cannot be written. Nothing is left of it: what was there before is there still.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The extension names no format.
    #[error("{}: this extension names no format: choose .png, .exr or, for an animation, .apng", .0.display())]
    Extension(PathBuf),
    /// A single picture was to be saved as `.apng`.
    #[error("{}: an .apng holds an animation, not one picture: choose .png or .exr", .0.display())]
    Animation(PathBuf),
    /// An animation cannot have this many frames.
    #[error("{}: an animation of {frames} frames cannot be written: choose 1 to {}", path.display(), Animation::MAX_FRAMES)]
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
    pub(super) fn write(path: &Path, reason: io::Error) -> SaveError {
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

impl Image {
    /// Writes the picture to `path`: `.png` as [`display_byte`](super::display_byte) shows it, `.exr` bit for bit. The bytes of the file depend on nothing but the picture.
    ///
    /// The file appears whole or not at all, under a temporary name in the same folder until then. A file that is already there is replaced; a symbolic
    /// link is followed.
    ///
    /// # Errors
    /// [`SaveError`] where the extension is neither of the two, or the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let path = path.as_ref();
        let write = match Format::of(path)? {
            Format::Png => png::write,
            Format::Exr => exr::write,
            Format::Apng => return Err(SaveError::Animation(path.to_owned())),
        };
        WholeFile::write(path, |output| write(self, output))
    }
}
