//! An animated PNG: one picture after another, 200 ms each, without end.

use std::io;
use std::path::Path;

use ::png::{EncodingError, Writer};

use super::error::MAX_FRAMES;
use super::whole_file::{Output, WholeFile};
use super::{Image, SaveError, display_byte, png};
use crate::memory;

/// A frame stays for 1/5 s.
const DELAY: (u16, u16) = (1, 5);

/// An `.apng` file in the making: frames are given one by one, and the file appears, whole, with
/// [`Animation::finish`]; dropped before that, nothing of it is left.
pub struct Animation {
    writer: Writer<Output>,
    file: WholeFile,
    bytes: Vec<u8>,
}

impl Animation {
    /// The most frames that the format can number.
    pub const MAX_FRAMES: u64 = MAX_FRAMES;

    /// Starts an animation of `frames` frames, `size` × `size` pixels each, to be named `path`,
    /// whatever its extension.
    ///
    /// # Errors
    /// [`SaveError`] unless there are 1 to [`Animation::MAX_FRAMES`] frames, and where the file
    /// cannot be written.
    pub fn create(path: impl AsRef<Path>, size: u32, frames: u64) -> Result<Animation, SaveError> {
        let path = path.as_ref();
        let count = match u32::try_from(frames) {
            Ok(count) if (1..=Animation::MAX_FRAMES).contains(&frames) => count,
            _ => {
                let path = path.to_owned();
                return Err(SaveError::Frames { path, frames });
            }
        };
        let (file, output) = WholeFile::create(path)?;
        let start = || {
            let mut encoder = png::encoder(output, size, size);
            encoder.set_animated(count, 0)?;
            encoder.set_frame_delay(DELAY.0, DELAY.1)?;
            encoder.validate_sequence(true);
            encoder.write_header()
        };
        match start() {
            Ok(writer) => Ok(Animation {
                writer,
                file,
                bytes: Vec::new(),
            }),
            Err(error) => Err(file.error(error.into())),
        }
    }

    /// Adds the next frame, as [`display_byte`] shows it.
    ///
    /// # Errors
    /// [`SaveError`] where the file cannot be written, `image` is of another size, or all frames
    /// are there already.
    pub fn push(&mut self, image: &Image) -> Result<(), SaveError> {
        self.write(image).map_err(|error| self.file.error(error))
    }

    /// The encoder takes an animation's frames whole, not row by row as a single picture.
    fn write(&mut self, image: &Image) -> io::Result<()> {
        self.bytes.clear();
        memory::reserve(&mut self.bytes, image.samples().len())?;
        for row in image.rows_from_top() {
            self.bytes.extend(row.iter().copied().map(display_byte));
        }
        Ok(self.writer.write_image_data(&self.bytes)?)
    }

    /// Ends the animation and gives the file its name.
    ///
    /// # Errors
    /// [`SaveError`] where the file cannot be written, or frames are missing.
    pub fn finish(self) -> Result<(), SaveError> {
        let written = self.writer.finish().map_err(EncodingError::into);
        self.file.finish(written)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;

    #[test]
    fn only_as_many_frames_as_promised_of_the_size_promised_make_a_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.apng");
        let (right, wrong) = (Image::new(3).unwrap(), Image::new(4).unwrap());
        let start = || Animation::create(&path, 3, 2).unwrap();
        let is_empty = || folder.path().read_dir().unwrap().next().is_none();

        drop(start());
        assert!(is_empty(), "given up");

        let mut animation = start();
        animation.push(&right).unwrap();
        assert!(animation.push(&wrong).is_err());
        assert!(animation.finish().is_err());
        assert!(is_empty(), "a frame is missing");

        let mut animation = start();
        animation.push(&right).unwrap();
        animation.push(&right).unwrap();
        assert!(animation.push(&right).is_err());
        animation.finish().unwrap();
        assert!(path.is_file());

        for frames in [0, Animation::MAX_FRAMES + 1, u64::MAX] {
            assert!(matches!(
                Animation::create(&path, 3, frames),
                Err(SaveError::Frames { .. })
            ));
        }
    }
}
