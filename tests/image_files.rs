//! Promise: a file of a picture keeps what its format can hold.

use std::fs;
use std::num::NonZeroU16;
use std::path::Path;

use exr::image::write::WritableImage;
use exr::image::{Encoding, Image as Part, SpecificChannels};
use exr::math::Vec2;
use exr::meta::MetaData;
use exr::prelude::{Blocks, Compression, LineOrder, f16};
use firsthit::Image;
use firsthit::image::{Animation, AnimationWriter, LoadError, Raster, display_byte};

use crate::helpers::{bits, exr_bits, same_bits};

/// NaNs with their payloads and signs, signed zeros, subnormals, infinities, and numbers that a
/// half float would not hold.
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
fn a_picture_need_not_be_square() {
    let folder = tempfile::tempdir().unwrap();
    for (width, height) in [(1, 33), (33, 1), (40, 17)] {
        let mut image = Raster::new(width, height).unwrap();
        for (i, sample) in image.samples_mut().iter_mut().enumerate() {
            *sample = f32::from_bits((i as u32).wrapping_mul(0x9e37_79b1));
        }
        let path = folder.path().join("a.exr");
        image.save(&path).unwrap();
        assert!(exr_bits(&path) == bits(&image), "{width} × {height}");
        assert!(same_bits(&Raster::load(&path).unwrap(), &image));
        let path = folder.path().join("a.png");
        image.save(&path).unwrap();
        let read = Raster::load(&path).unwrap();
        assert_eq!((read.width(), read.height()), (width, height));
        let bytes = image.samples().iter().copied().map(display_byte);
        let read = read.samples().iter().copied().map(display_byte);
        assert!(read.eq(bytes), "{width} × {height}");
    }
    for (width, height) in [(0, 1), (1, 0), (16385, 1), (1, 16385)] {
        let said = Raster::new(width, height).unwrap_err().to_string();
        let size = format!("a picture of {width} × {height} pixels cannot be made");
        assert!(said.starts_with(&size), "{said}");
    }
}

#[test]
fn a_png_holds_bytes_and_says_that_they_are_srgb() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hard.png");
    for size in [1, 3, 200] {
        hard(size).save(&path).unwrap();
        let file = fs::read(&path).unwrap();
        let mut rest = &file[8..];
        let mut kinds = Vec::new();
        while let [a, b, c, d, tail @ ..] = rest {
            let length = u32::from_be_bytes([*a, *b, *c, *d]) as usize;
            let kind = &tail[..4];
            assert!(kind != b"sRGB" || tail[4..4 + length] == [1]);
            kinds.push(kind.to_vec());
            rest = &tail[4 + length + 4..];
        }
        kinds.dedup();
        assert_eq!(kinds, [b"IHDR", b"sRGB", b"IDAT", b"IEND"]);
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

#[test]
fn an_output_gets_the_bytes_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for size in [1, 17, 200] {
        let image = hard(size);
        let (mut png, mut exr, mut bytes) = (Vec::new(), Vec::new(), Vec::new());
        image.write_png(&mut png).unwrap();
        image.write_exr(&mut exr).unwrap();
        image.write_rgb24(&mut bytes).unwrap();
        for (name, written) in [("a.png", png), ("a.exr", exr)] {
            image.save(path(name)).unwrap();
            assert!(fs::read(path(name)).unwrap() == written, "{name} {size}");
        }
        let rows = image.samples().chunks(3 * size as usize).rev();
        let expected: Vec<u8> = rows.flatten().copied().map(display_byte).collect();
        assert!(bytes == expected, "{size}");

        let mut apng = Vec::new();
        let mut writer = AnimationWriter::new(&mut apng, size, 2, NonZeroU16::MAX).unwrap();
        let mut animation = Animation::create(path("a.apng"), size, 2, NonZeroU16::MAX).unwrap();
        for frame in [&image, &Image::new(size).unwrap()] {
            writer.push(frame).unwrap();
            animation.push(frame).unwrap();
        }
        writer.finish().unwrap();
        animation.finish().unwrap();
        assert!(fs::read(path("a.apng")).unwrap() == apng, "{size}");
    }
    for frames in [0, Animation::MAX_FRAMES + 1] {
        assert!(AnimationWriter::new(Vec::new(), 1, frames, NonZeroU16::MIN).is_err());
    }
}

/// The halves that [`write_halves`] writes, as floats.
fn half(column: usize, row_from_top: usize, channel: usize) -> f32 {
    [0.0, 0.25, -1.5, 60000.0, 5.0][(column / 6 + row_from_top / 4 + channel) % 5]
}

/// An EXR of 11 × 9 pixels as another program may write it.
fn write_halves(path: &Path, compression: Compression, blocks: Blocks) {
    let encoding = Encoding {
        compression,
        blocks,
        line_order: LineOrder::Increasing,
    };
    let channels = SpecificChannels::rgb(|Vec2(column, row_from_top): Vec2<usize>| {
        let half = |channel| f16::from_f32(half(column, row_from_top, channel));
        (half(0), half(1), half(2))
    });
    Part::from_encoded_channels((11, 9), encoding, channels)
        .write()
        .to_file(path)
        .unwrap();
}

/// That of B44 and of DWA, which have halves in mind, panics or aborts on what the next test
/// writes.
#[test]
fn the_compressions_whose_decoder_is_safe_are_read_and_no_other() {
    use Compression::{B44, B44A, DWAA, DWAB, PIZ, PXR24, RLE, Uncompressed, ZIP1, ZIP16};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("half.exr");
    for compression in [Uncompressed, RLE, ZIP1, ZIP16, PIZ, PXR24] {
        write_halves(&path, compression, Blocks::ScanLines);
        let image = Raster::load(&path).unwrap();
        assert_eq!((image.width(), image.height()), (11, 9));
        for (i, sample) in image.samples().iter().enumerate() {
            let (column, row) = (i / 3 % 11, i / 3 / 11);
            let expected = half(column, 8 - row, i % 3);
            assert_eq!(sample.to_bits(), expected.to_bits(), "{compression} {i}");
        }
    }
    for compression in [B44, B44A, DWAA(None), DWAB(None)] {
        write_halves(&path, compression, Blocks::ScanLines);
        let said = Raster::load(&path).unwrap_err().to_string();
        let expected =
            format!("half.exr: {compression} is not read: convert it to zip compression");
        assert!(said.ends_with(&expected), "{said}");
    }
}

/// Of these files, the headers are sound and the only block is not: in that of B44, the first
/// number of 16 is less than what is taken from it; that of DWA says that it has 2^63 − 1
/// coefficients.
#[test]
fn no_decoder_sees_a_block_that_it_would_break_at() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("crafted.exr");
    let crafted = |compression, craft: fn(&mut [u8])| {
        write_halves(&path, compression, Blocks::ScanLines);
        let mut file = fs::read(&path).unwrap();
        // The only place that the table of one place names is behind the table.
        let is_table = |&place: &usize| file[place..place + 8] == (place as u64 + 8).to_le_bytes();
        let table = (0..file.len() - 8).find(is_table).unwrap();
        // Behind its first row and its length.
        craft(&mut file[table + 16..]);
        fs::write(&path, file).unwrap();
        let refused = Raster::load(&path);
        assert!(
            matches!(refused, Err(LoadError::Compression { .. })),
            "{refused:?}"
        );
    };
    crafted(Compression::B44, |block| block[..14].fill(0));
    crafted(Compression::DWAA(None), |block| {
        block[64..72].copy_from_slice(&i64::MAX.to_le_bytes());
    });
}

/// The numbers of an attribute are changed, and nothing else.
#[test]
fn what_takes_too_much_memory_is_refused_first() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("crafted.exr");
    let load = |blocks, attribute: &[u8], numbers: &[i32]| {
        write_halves(&path, Compression::PIZ, blocks);
        let mut file = fs::read(&path).unwrap();
        let mut places = file.windows(attribute.len());
        let place = places.position(|window| window == attribute).unwrap() + attribute.len();
        let numbers: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        file[place..place + numbers.len()].copy_from_slice(&numbers);
        fs::write(&path, file).unwrap();
        Raster::load(&path).unwrap_err().to_string()
    };
    let window = b"dataWindow\0box2i\0\x10\0\0\0";
    let wide = load(Blocks::ScanLines, window, &[-(1 << 29), 0, 10, 10]);
    assert!(wide.contains("is 536870923 × 11 pixels"), "{wide}");
    let tile = Vec2(16, 16);
    let tiles = b"tiles\0tiledesc\0\x09\0\0\0";
    let tile = load(Blocks::Tiles(tile), tiles, &[1 << 29, 1 << 29]);
    assert!(tile.contains("a block of it has"), "{tile}");
}

#[test]
fn a_palette_is_one_of_whole_colours() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("indexed.png");
    let load = |palette: &[u8]| {
        let mut encoder = png::Encoder::new(fs::File::create(&path).unwrap(), 1, 1);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&[1]).unwrap();
        writer.finish().unwrap();
        Raster::load(&path)
    };
    let image = load(&[0, 0, 0, 255, 0, 51]).unwrap();
    assert_eq!(image.samples(), [1.0, 0.0, 0.2]);
    // The decoder would panic at what is left of it.
    for palette in [&[0, 0, 0, 255][..], &[0, 0, 0, 255, 0]] {
        let said = load(palette).unwrap_err().to_string();
        let length = palette.len();
        let expected = format!("its palette has {length} bytes, not 3 for each colour");
        assert!(said.ends_with(&expected), "{said}");
    }
}
