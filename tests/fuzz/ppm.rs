//! Bytes as a `.ppm` → a picture, or a refusal in one line.

use super::picture;

/// Panics where it is neither. A picture takes no more memory than its bytes say.
pub(crate) fn run(bytes: &[u8]) {
    picture::check(bytes, ".ppm");
}
