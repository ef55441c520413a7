//! Bytes as an `.exr` → a picture, or a refusal in one line.

use super::picture;

/// What comes before the four numbers of a data window: its name, its type and its length.
const DATA_WINDOW: &[u8] = b"dataWindow\0box2i\0\x10\0\0\0";

/// Panics where it is neither.
pub(crate) fn run(bytes: &[u8]) {
    let name = DATA_WINDOW.len();
    let windows = bytes.windows(name + 16).filter_map(|window| {
        let (start, numbers) = window.split_at(name);
        let corner = |i: usize| {
            let number = [0, 1, 2, 3].map(|byte| numbers[4 * i + byte]);
            i64::from(i32::from_le_bytes(number))
        };
        (start == DATA_WINDOW).then(|| [corner(2) - corner(0), corner(3) - corner(1)])
    });
    let mut sizes = windows.map(|size| size.map(|less| less + 1));
    if sizes.all(|[width, height]| !picture::is_large(width, height)) {
        picture::check(bytes, ".exr");
    }
}
