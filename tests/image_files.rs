//! Promise: a file of a picture keeps what its format can hold.

use std::fs;

use exr::meta::MetaData;
use exr::prelude::Compression;
use firsthit::Image;
use firsthit::image::display_byte;

use crate::helpers::{bits, exr_bits};

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
        assert!(exr_bits(&path) == bits(&image), "{size}");
        let meta = MetaData::read_from_file(&path, true).unwrap();
        assert_eq!(meta.headers[0].compression, Compression::ZIP16);
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
        assert_eq!(display_byte(sample), byte + byte % 2);
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
        assert_eq!(display_byte(sample), byte, "{sample}");
    }
}
