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

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test stops at the first surprise"
)]
mod tests {
    use std::fs;

    use ::exr::prelude::{Compression, FlatSamples, read_all_flat_layers_from_file};

    use super::*;

    /// NaNs with their payloads and signs, signed zeros, subnormals, infinities, and numbers that a half float would not hold.
    const HARD: [u32; 12] = [
        0x7fc0_0000,
        0xffc0_1234,
        0x7f80_0001,
        0x8000_0000,
        0x0000_0000,
        0x0000_0001,
        0x807f_ffff,
        0x7f80_0000,
        0xff80_0000,
        0x3f80_0001,
        0x7f7f_ffff,
        0xbf00_0000,
    ];

    fn hard(size: u32) -> Image {
        let mut image = Image::new(size).unwrap();
        for (i, sample) in image.samples_mut().iter_mut().enumerate() {
            *sample = f32::from_bits(HARD[(i * 7 + i / 36) % 12]);
        }
        image
    }

    #[test]
    fn an_exr_keeps_every_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hard.exr");
        for size in [1, 2, 15, 16, 17, 65] {
            let image = hard(size);
            image.save(&path).unwrap();
            let file = read_all_flat_layers_from_file(&path).unwrap();
            let [part] = &file.layer_data[..] else {
                panic!("{} parts", file.layer_data.len());
            };
            assert_eq!(part.encoding.compression, Compression::ZIP16);
            for (name, place) in [("R", 0), ("G", 1), ("B", 2)] {
                let channel = part
                    .channel_data
                    .list
                    .iter()
                    .find(|channel| channel.name.eq(name))
                    .unwrap();
                let FlatSamples::F32(samples) = &channel.sample_data else {
                    panic!("{name} is not of 32-bit floats");
                };
                let read = samples.iter().map(|sample| sample.to_bits());
                let traced = image
                    .rows_from_top()
                    .flat_map(|row| row.iter().skip(place).step_by(3))
                    .map(|sample| sample.to_bits());
                assert!(read.eq(traced), "{name} at {size}");
            }
        }
    }

    #[test]
    fn a_png_holds_bytes_and_says_nothing_about_colour() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hard.png");
        for size in [1, 3, 200] {
            hard(size).save(&path).unwrap();
            let file = fs::read(&path).unwrap();
            let mut rest = &file[8..];
            let mut kinds = Vec::new();
            while let [a, b, c, d, tail @ ..] = rest {
                let length = u32::from_be_bytes([*a, *b, *c, *d]) as usize;
                kinds.push(tail[..4].to_vec());
                rest = &tail[4 + length + 4..];
            }
            kinds.dedup();
            assert_eq!(kinds, [b"IHDR", b"IDAT", b"IEND"]);
        }
    }

    #[test]
    fn a_display_byte_is_rounded_to_even_in_f32() {
        let ties = (0..255_u8)
            .map(|byte| (byte, (f32::from(byte) + 0.5) / 255.0))
            .filter(|&(byte, sample)| sample * 255.0 == f32::from(byte) + 0.5);
        let mut met = [false; 2];
        for (byte, sample) in ties {
            assert_eq!(crate::image::display_byte(sample), byte + byte % 2);
            met[usize::from(byte % 2)] = true;
        }
        assert_eq!(met, [true; 2]);
        for (sample, byte) in [
            (-0.0, 0),
            (-1.0, 0),
            (f32::NEG_INFINITY, 0),
            (f32::NAN, 0),
            (-f32::NAN, 0),
            (f32::from_bits(1), 0),
            (1.0, 255),
            (f32::INFINITY, 255),
        ] {
            assert_eq!(crate::image::display_byte(sample), byte, "{sample}");
        }
    }
}
