//! What holds of every file that a picture may be read from.

use std::fs;

use firsthit::Image;

/// Whether a picture of this size takes more memory than is allowed here. What is not square is
/// refused before it takes any.
pub(crate) fn is_large(width: i64, height: i64) -> bool {
    width == height && width > 512
}

/// A file of these bytes, whose name ends in that, is a picture that can be written as EXR and read
/// again with every bit, or is refused in one line.
pub(crate) fn check(bytes: &[u8], extension: &str) {
    let file = |extension| tempfile::Builder::new().suffix(extension).tempfile();
    let path = file(extension).unwrap().into_temp_path();
    fs::write(&path, bytes).unwrap();
    match Image::load(&path) {
        Ok(image) if image.size() <= 32 => {
            let copy = file(".exr").unwrap().into_temp_path();
            image.save(&copy).unwrap();
            assert!(bits(&Image::load(&copy).unwrap()) == bits(&image));
        }
        Ok(_) => {}
        Err(error) => {
            let said = error.to_string();
            assert!(!said.contains(['\n', '\r']), "{said:?}");
        }
    }
}

fn bits(image: &Image) -> Vec<u32> {
    image.samples().iter().map(|s| s.to_bits()).collect()
}
