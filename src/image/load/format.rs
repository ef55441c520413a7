//! What a picture is read from.

use std::path::Path;

use super::LoadError;

/// What a file to be read holds; its extension says which.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputFormat {
    /// `.exr`: floats as they are.
    Exr,
    /// `.pfm`: floats as they are, without compression.
    Pfm,
    /// `.png`: whole numbers of up to 16 bits.
    Png,
    /// `.ppm`: whole numbers of up to 16 bits, as bytes or as text.
    Ppm,
}

impl InputFormat {
    /// Every format.
    pub const ALL: [InputFormat; 4] = [
        InputFormat::Exr,
        InputFormat::Pfm,
        InputFormat::Png,
        InputFormat::Ppm,
    ];

    /// Its extension, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            InputFormat::Exr => "exr",
            InputFormat::Pfm => "pfm",
            InputFormat::Png => "png",
            InputFormat::Ppm => "ppm",
        }
    }

    /// The format that the extension of `path` names, in small letters or capitals.
    ///
    /// # Errors
    /// [`LoadError::Extension`] for any other extension, and for none.
    ///
    /// ```
    /// use firsthit::image::InputFormat;
    /// assert_eq!(InputFormat::of("picture.PFM".as_ref()).unwrap(), InputFormat::Pfm);
    /// assert!(InputFormat::of("picture.jpeg".as_ref()).is_err());
    /// ```
    pub fn of(path: &Path) -> Result<InputFormat, LoadError> {
        let extension = path.extension().unwrap_or_default();
        InputFormat::ALL
            .into_iter()
            .find(|format| extension.eq_ignore_ascii_case(format.extension()))
            .ok_or_else(|| LoadError::Extension(path.to_owned()))
    }
}
