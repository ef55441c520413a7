//! A picture out of a file: floats as they are, whole numbers as the fractions that they stand for.

mod exr;
mod format;
mod layers;
mod pfm;
mod pixels;
mod png;
mod ppm;
mod samples;
mod tokens;

use std::fs::File;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};

use ::exr::compression::Compression;

use super::{MAX_SIZE, Raster, Window};
pub use format::InputFormat;

/// A file that no picture can be read from. Each message is one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The extension names no format that can be read.
    #[error("{}: this extension names no picture that can be read: convert it to .exr or .pfm (floats), .png or .ppm", .0.display())]
    Extension(PathBuf),
    /// The system does not let it be read.
    #[error("{}: cannot be read: {reason}: give the path of a picture", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// It is not what its extension says, or a part of it is missing.
    #[error("{}: is not a whole {} file of red, green and blue: {reason}", path.display(), format.extension())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What its extension says.
        format: InputFormat,
        /// What is wrong with it.
        reason: String,
    },
    /// It is an EXR, and no three of its channels are red, green and blue.
    #[error("{}: has no red, green and blue, but the channels {channels}: name three of them R, G and B", path.display())]
    NoColor {
        /// The file.
        path: PathBuf,
        /// The names of its channels, of the first ones where there are many.
        channels: String,
    },
    /// It is an EXR without the layer that was asked for.
    #[error("{}: has no layer {layer}: choose one of {layers}", path.display())]
    NoLayer {
        /// The file.
        path: PathBuf,
        /// What was asked for.
        layer: String,
        /// The names of its layers, of the first ones where there are many.
        layers: String,
    },
    /// It is an EXR whose compression is not read here: of a damaged file, its decoder could
    /// overflow or take all memory.
    #[error("{}: {compression} is not read: convert it to zip compression", path.display())]
    Compression {
        /// The file.
        path: PathBuf,
        /// Which one it is.
        compression: String,
    },
    /// Its width or its height is not from 1 to [`MAX_SIZE`].
    #[error("{}: is {width} × {height} pixels: give a picture of 1 to {MAX_SIZE} pixels a side", path.display())]
    Size {
        /// The file.
        path: PathBuf,
        /// Its pixels in a row.
        width: usize,
        /// Its rows.
        height: usize,
    },
    /// Some of its pixels are not opaque, so that their colours depend on what is behind: their
    /// alpha is not 1, or the largest whole number.
    #[error("{}: some pixels are transparent: give an opaque picture, or ignore its alpha (--ignore-alpha)", .0.display())]
    Transparent(PathBuf),
    /// There is not enough memory for three floats a pixel of it.
    #[error("{}: not enough memory for {width} × {height} pixels: give a smaller picture", path.display())]
    Memory {
        /// The file.
        path: PathBuf,
        /// Its pixels in a row.
        width: u32,
        /// Its rows.
        height: u32,
    },
}

/// What is chosen where a file leaves a choice.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// The layer to read: what the names of its channels begin with, or the name of its part.
    /// `None` is the first layer of channels that are named by a letter alone, else the first
    /// layer. A file whose only layer has no name, as a PNG's, leaves no choice.
    pub layer: Option<String>,
    /// Whether colours are read as they are stored where pixels are not opaque: multiplied by alpha
    /// in an EXR, not so in a PNG.
    pub ignore_alpha: bool,
}

/// A picture, and what its file says of it.
#[derive(Debug)]
pub struct LoadedImage {
    /// The picture.
    pub image: Raster,
    /// Where an EXR's data window begins: the column from the left and the row from the top of its
    /// upper left pixel, in the coordinates that all windows of EXRs have. `[0, 0]` in a file that
    /// has no windows.
    pub corner: [i32; 2],
    /// The pixels that are meant to be shown: an EXR's display window, all pixels of a file that
    /// has no windows.
    pub display_window: Window,
    /// The whole number that stands for 1; `None` in a file of floats.
    pub largest: Option<u16>,
    /// The name of its layer; empty where the file gives it none.
    pub layer: String,
    /// The names of the file's other layers of red, green and blue.
    pub other_layers: Vec<String>,
}

impl LoadedImage {
    /// A picture of fractions of `largest`, all that its file holds.
    fn of_whole_numbers(image: Raster, largest: u16) -> LoadedImage {
        LoadedImage {
            largest: Some(largest),
            ..LoadedImage::of_floats(image)
        }
    }

    /// A picture of floats, all that its file holds.
    fn of_floats(image: Raster) -> LoadedImage {
        let corner = [0, 0];
        let size = [image.width(), image.height()];
        LoadedImage {
            image,
            corner,
            display_window: Window { corner, size },
            largest: None,
            layer: String::new(),
            other_layers: Vec::new(),
        }
    }
}

impl Raster {
    /// Reads `path` as [`Raster::load_with`] does, with no choice made.
    ///
    /// # Errors
    /// As [`Raster::load_with`].
    pub fn load(path: impl AsRef<Path>) -> Result<Raster, LoadError> {
        Raster::load_with(path, &LoadOptions::default()).map(|loaded| loaded.image)
    }

    /// Reads `path`: red, green and blue of an `.exr`, every 32-bit float bit for bit, from
    /// channels named R, G, B or r, g, b, alone or behind a layer's name and a dot; a `.pfm`, bit
    /// for bit too, grey as three equal samples; a `.png`, where a sample is the byte / 255 (of a
    /// PNG of 16 bits: the number / 65535), rounded to f32; or a `.ppm`, P3 or P6, where it is the
    /// number / the largest that the file names.
    ///
    /// # Errors
    /// [`LoadError`] where the extension is none of these, or the file is not a whole picture
    /// of 1 to [`MAX_SIZE`] pixels a side and, unless its alpha is to be ignored, opaque, or it is
    /// an EXR compressed by B44 or DWA, or an EXR without that layer.
    pub fn load_with(
        path: impl AsRef<Path>,
        options: &LoadOptions,
    ) -> Result<LoadedImage, LoadError> {
        let path = path.as_ref();
        let format = InputFormat::of(path)?;
        let unreadable = |reason| LoadError::Unreadable {
            path: path.to_owned(),
            reason,
        };
        let file = BufReader::new(File::open(path).map_err(unreadable)?);
        let read = match format {
            InputFormat::Exr => exr::read(file, options),
            InputFormat::Pfm => pfm::read(file),
            InputFormat::Png => png::read(file, options),
            InputFormat::Ppm => ppm::read(file),
        };
        read.map_err(|problem| match problem {
            Problem::Io(reason) => unreadable(reason),
            Problem::Damaged(reason) => LoadError::Damaged {
                path: path.to_owned(),
                format,
                reason,
            },
            Problem::Compression(compression) => LoadError::Compression {
                path: path.to_owned(),
                compression: compression.to_string(),
            },
            Problem::NoColor(channels) => LoadError::NoColor {
                path: path.to_owned(),
                channels,
            },
            Problem::NoLayer(layer, layers) => LoadError::NoLayer {
                path: path.to_owned(),
                layer,
                layers,
            },
            Problem::Size(width, height) => LoadError::Size {
                path: path.to_owned(),
                width,
                height,
            },
            Problem::Transparent => LoadError::Transparent(path.to_owned()),
            Problem::Memory(width, height) => LoadError::Memory {
                path: path.to_owned(),
                width,
                height,
            },
        })
    }
}

/// A [`LoadError`] that does not know its file.
enum Problem {
    Io(io::Error),
    Damaged(String),
    Compression(Compression),
    /// What there is instead.
    NoColor(String),
    /// What was asked for, and what there is.
    NoLayer(String, String),
    Size(usize, usize),
    Transparent,
    Memory(u32, u32),
}

/// The width and the height that a file says it has: checked before anything of that size is
/// allocated.
fn checked_size(width: usize, height: usize) -> Result<[u32; 2], Problem> {
    match [width, height].map(|side| u32::try_from(side).unwrap_or(u32::MAX)) {
        size @ [1..=MAX_SIZE, 1..=MAX_SIZE] => Ok(size),
        _ => Err(Problem::Size(width, height)),
    }
}

/// A black picture of that size.
fn black(width: usize, height: usize) -> Result<Raster, Problem> {
    let [width, height] = checked_size(width, height)?;
    Raster::new(width, height).map_err(|_| Problem::Memory(width, height))
}
