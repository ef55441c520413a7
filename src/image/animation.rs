//! An animated PNG: one picture after another, as many a second, without end.

use std::io::{self, Write};
use std::num::NonZeroU16;
use std::path::Path;

use ::png::{EncodingError, Writer};

use super::error::MAX_FRAMES;
use super::whole_file::{Output, WholeFile};
use super::{Image, SaveError, png};
use crate::memory;

/// An animated PNG on its way into any output: frames are given one by one.
pub struct AnimationWriter<W: Write> {
    encoder: Writer<W>,
    bytes: Vec<u8>,
}

impl<W: Write> AnimationWriter<W> {
    /// Starts an animation of `frames` frames, `size` × `size` pixels each, `fps` frames a second.
    ///
    /// # Errors
    /// Those of `output`; `InvalidInput` unless there are 1 to [`Animation::MAX_FRAMES`] frames.
    pub fn new(
        output: W,
        size: u32,
        frames: u64,
        fps: NonZeroU16,
    ) -> io::Result<AnimationWriter<W>> {
        let count = count(frames).ok_or(io::ErrorKind::InvalidInput)?;
        let mut encoder = png::encoder(output, size, size);
        encoder.set_animated(count, 0)?;
        encoder.set_frame_delay(1, fps.get())?;
        encoder.validate_sequence(true);
        Ok(AnimationWriter {
            encoder: encoder.write_header()?,
            bytes: Vec::new(),
        })
    }

    /// Adds the next frame, as [`display_byte`](super::display_byte) shows it.
    ///
    /// # Errors
    /// Those of the output; another one where `image` is of another size, or all frames are there
    /// already.
    pub fn push(&mut self, image: &Image) -> io::Result<()> {
        // The encoder takes an animation's frames whole, not row by row as a single picture.
        self.bytes.clear();
        memory::reserve(&mut self.bytes, image.samples().len())?;
        image.write_rgb24(&mut self.bytes)?;
        Ok(self.encoder.write_image_data(&self.bytes)?)
    }

    /// Ends the animation, and flushes the output.
    ///
    /// # Errors
    /// Those of the output; another one where frames are missing.
    pub fn finish(self) -> io::Result<()> {
        self.encoder.finish().map_err(EncodingError::into)
    }
}

/// The number of frames as the format numbers them, if it can.
fn count(frames: u64) -> Option<u32> {
    let count = u32::try_from(frames).ok()?;
    (1..=Animation::MAX_FRAMES)
        .contains(&frames)
        .then_some(count)
}

/// An `.apng` file in the making: frames are given one by one, and the file appears, whole, with
/// [`Animation::finish`]; dropped before that, nothing of it is left.
pub struct Animation {
    writer: AnimationWriter<Output>,
    file: WholeFile,
}

impl Animation {
    /// The most frames that the format can number.
    pub const MAX_FRAMES: u64 = MAX_FRAMES;

    /// Starts an animation of `frames` frames, `size` × `size` pixels each, `fps` frames a second,
    /// to be named `path`, whatever its extension.
    ///
    /// # Errors
    /// [`SaveError`] unless there are 1 to [`Animation::MAX_FRAMES`] frames, and where the file
    /// cannot be written.
    pub fn create(
        path: impl AsRef<Path>,
        size: u32,
        frames: u64,
        fps: NonZeroU16,
    ) -> Result<Animation, SaveError> {
        let path = path.as_ref();
        if count(frames).is_none() {
            let path = path.to_owned();
            return Err(SaveError::Frames { path, frames });
        }
        let (file, output) = WholeFile::create(path)?;
        match AnimationWriter::new(output, size, frames, fps) {
            Ok(writer) => Ok(Animation { writer, file }),
            Err(error) => Err(file.error(error)),
        }
    }

    /// Adds the next frame, as [`display_byte`](super::display_byte) shows it.
    ///
    /// # Errors
    /// [`SaveError`] where the file cannot be written, `image` is of another size, or all frames
    /// are there already.
    pub fn push(&mut self, image: &Image) -> Result<(), SaveError> {
        let pushed = self.writer.push(image);
        pushed.map_err(|error| self.file.error(error))
    }

    /// Ends the animation and gives the file its name.
    ///
    /// # Errors
    /// [`SaveError`] where the file cannot be written, or frames are missing.
    pub fn finish(self) -> Result<(), SaveError> {
        self.file.finish(self.writer.finish())
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
        let start = || Animation::create(&path, 3, 2, NonZeroU16::MIN).unwrap();
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
                Animation::create(&path, 3, frames, NonZeroU16::MIN),
                Err(SaveError::Frames { .. })
            ));
        }
    }
}
