//! A picture into a file, in the format that the file's extension names.

use std::path::Path;

use super::whole_file::WholeFile;
use super::{Format, Raster, SaveError, exr, png};

impl Raster {
    /// Writes the picture to `path`: `.png` as [`display_byte`](super::display_byte) shows it,
    /// `.exr` bit for bit. The bytes of the file depend on nothing but the picture.
    ///
    /// The file appears whole or not at all, under a temporary name in the same folder until then.
    /// A file that is already there is replaced; a symbolic link is followed.
    ///
    /// # Errors
    /// [`SaveError`] where the extension is neither of the two, or the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let path = path.as_ref();
        match Format::of(path)? {
            Format::Png => WholeFile::write(path, |output| png::write(self, output)),
            Format::Exr => WholeFile::write(path, |output| exr::write(self, output)),
            Format::Apng => Err(SaveError::Animation(path.to_owned())),
        }
    }
}
