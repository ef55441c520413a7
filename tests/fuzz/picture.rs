//! What holds of every file that a picture may be read from.

use std::fs;

use firsthit::image::{MAX_SIZE, Raster};

/// Whether a picture of this size takes more memory than is allowed here. One that is wider or
/// higher than any picture is refused before it takes any.
pub(crate) fn is_large(width: i64, height: i64) -> bool {
    let can_be_read = |side| (1..=i64::from(MAX_SIZE)).contains(&side);
    can_be_read(width) && can_be_read(height) && width * height > 512 * 512
}

/// A file of these bytes, whose name ends in that, is a picture that can be written as EXR and read
/// again with every bit, or is refused in one line.
pub(crate) fn check(bytes: &[u8], extension: &str) {
    let file = |extension| tempfile::Builder::new().suffix(extension).tempfile();
    let path = file(extension).unwrap().into_temp_path();
    fs::write(&path, bytes).unwrap();
    match Raster::load(&path) {
        Ok(image) if image.width().max(image.height()) <= 32 => {
            let copy = file(".exr").unwrap().into_temp_path();
            image.save(&copy).unwrap();
            assert!(bits(&Raster::load(&copy).unwrap()) == bits(&image));
        }
        Ok(_) => {}
        Err(error) => {
            let said = error.to_string();
            assert!(!said.contains(['\n', '\r']), "{said:?}");
        }
    }
}

fn bits(image: &Raster) -> Vec<u32> {
    image.samples().iter().map(|s| s.to_bits()).collect()
}
