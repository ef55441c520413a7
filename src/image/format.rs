//! What a file holds.

use std::path::Path;

use super::SaveError;

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
