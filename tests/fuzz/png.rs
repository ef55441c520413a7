//! Bytes as a `.png` → a picture, or a refusal in one line.

use super::picture;

/// Panics where it is neither.
pub(crate) fn run(bytes: &[u8]) {
    let number = |at: usize| {
        let number = bytes.get(at..at + 4)?.try_into().ok()?;
        Some(i64::from(u32::from_be_bytes(number)))
    };
    if let (Some(width), Some(height)) = (number(16), number(20))
        && picture::is_large(width, height)
    {
        return;
    }
    picture::check(bytes, ".png");
    picture::check(&repaired(bytes), ".png");
}

/// The same with the checksum that each chunk should have, which chance hardly finds.
fn repaired(bytes: &[u8]) -> Vec<u8> {
    let mut repaired = bytes.to_vec();
    let mut rest = repaired.get_mut(8..).unwrap_or_default();
    while let Some(length) = rest.first_chunk() {
        let length = u32::from_be_bytes(*length) as usize;
        let Some((chunk, after)) = rest[4..].split_at_mut_checked(4 + length) else {
            break;
        };
        let Some((checksum, after)) = after.split_first_chunk_mut() else {
            break;
        };
        *checksum = crc32(chunk).to_be_bytes();
        rest = after;
    }
    repaired
}

/// As PNG defines it.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| match crc & 1 {
            1 => crc >> 1 ^ 0xedb8_8320,
            _ => crc >> 1,
        })
    })
}
