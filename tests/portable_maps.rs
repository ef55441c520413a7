//! Promise: a PFM or a PPM is read as it is meant, and one that is not whole is refused in one
//! line.

use std::fs;

use firsthit::Image;
use firsthit::image::{LoadOptions, Raster};

/// What the bytes are read as, as a file whose name ends in that.
fn load(bytes: &[u8], extension: &str) -> Result<Raster, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("a.{extension}"));
    fs::write(&path, bytes).unwrap();
    let said = Raster::load(&path).map_err(|error| error.to_string());
    if let Err(said) = &said {
        assert!(!said.contains(['\n', '\r']), "{said:?}");
    }
    said
}

/// The same, with what comes after the header.
fn load_with_data(header: &str, data: &[u8], extension: &str) -> Result<Raster, String> {
    load(&[header.as_bytes(), data].concat(), extension)
}

/// A file of 2 × 2 pixels whose rows come from the top: its samples, where a picture has them.
fn from_top(samples: [f32; 12]) -> Vec<f32> {
    [&samples[6..], &samples[..6]].concat()
}

#[test]
fn a_ppm_is_numbers_over_its_largest() {
    let numbers: [u8; 12] = [0, 1, 2, 3, 4, 5, 60, 70, 80, 253, 254, 255];
    let expected = from_top(numbers.map(|number| f32::from(number) / 255.0));
    let bytes = load_with_data("P6\n2 2\n255\n", &numbers, "ppm").unwrap();
    assert_eq!(bytes.samples(), expected);
    // Comments, any white space, and what text leaves at the end.
    let header = "P6 # a student's\n# 9 9\n2\t2\r\n255\n";
    let bytes = load_with_data(header, &[&numbers[..], b"\n"].concat(), "PPM").unwrap();
    assert_eq!(bytes.samples(), expected);
    let text = "P3\n2 2 255\n0 1 2  3 4 5 # the top\n60 70 80\n253 254\n255";
    assert_eq!(load(text.as_bytes(), "ppm").unwrap().samples(), expected);

    let wide = [
        0, 1, 255, 256, 257, 1000, 1001, 1002, 1003, 998, 997, 996_u16,
    ];
    let bytes: Vec<u8> = wide
        .iter()
        .flat_map(|number| number.to_be_bytes())
        .collect();
    let expected = from_top(wide.map(|number| f32::from(number) / 1003.0));
    let read = load_with_data("P6 2 2 1003 ", &bytes, "ppm").unwrap();
    assert_eq!(read.samples(), expected);
    let text = wide.map(|number| number.to_string()).join(" ");
    let read = load_with_data("P3 2 2 1003 ", text.as_bytes(), "ppm").unwrap();
    assert_eq!(read.samples(), expected);
    let read = load(b"P3 1 1 65535 0 1 65535", "ppm").unwrap();
    assert_eq!(read.samples(), [0.0, 1.0 / 65535.0, 1.0]);
}

#[test]
fn a_pfm_is_read_bit_for_bit() {
    // Rows come from the bottom, as in a picture.
    let bits = [
        0x7fc0_0001_u32,
        0xffc0_1234,
        0x7f80_0000,
        0xff80_0000,
        0x8000_0000,
        0,
        1,
        0x807f_ffff,
        0x3f80_0001,
        0xbf00_0000,
        0x7f7f_ffff,
        0x0a0d_2000,
    ];
    type Bytes = fn(u32) -> [u8; 4];
    let orders: [(&str, Bytes); 2] = [("-1.0", u32::to_le_bytes), ("1", u32::to_be_bytes)];
    for (scale, bytes) in orders {
        let header = format!("PF\n2 2\n{scale}\n");
        let data: Vec<u8> = bits.iter().flat_map(|&bits| bytes(bits)).collect();
        let image = load_with_data(&header, &data, "pfm").unwrap();
        let read: Vec<u32> = image.samples().iter().map(|s| s.to_bits()).collect();
        assert_eq!(read, bits, "{scale}");

        let header = format!("Pf\n2 2\n{scale}\n");
        let image = load_with_data(&header, &data[..16], "pfm").unwrap();
        let read: Vec<u32> = image.samples().iter().map(|s| s.to_bits()).collect();
        let grey: Vec<u32> = bits[..4].iter().flat_map(|&bits| [bits; 3]).collect();
        assert_eq!(read, grey, "{scale}");
    }
}

#[test]
fn rows_are_as_long_as_the_picture_is_wide() {
    let numbers = [
        0, 1, 2, 3, 4, 5, 60, 70, 80, 253, 254, 255, 7, 8, 9, 10, 11, 12,
    ];
    let samples = numbers.map(|number| f32::from(number) / 255.0);
    for (width, height) in [(3, 2), (2, 3), (6, 1), (1, 6)] {
        let row = 3 * width as usize;
        let from_top: Vec<f32> = samples.chunks(row).rev().flatten().copied().collect();
        let header = format!("P6 {width} {height} 255 ");
        let text = numbers.map(|number| number.to_string()).join(" ");
        let bytes: Vec<u8> = samples.iter().flat_map(|s| s.to_le_bytes()).collect();
        for (read, expected) in [
            (load_with_data(&header, &numbers, "ppm"), &from_top[..]),
            (
                load_with_data(&header.replace("P6", "P3"), text.as_bytes(), "ppm"),
                &from_top,
            ),
            (
                load_with_data(&format!("PF {width} {height} -1 "), &bytes, "pfm"),
                &samples,
            ),
        ] {
            let read = read.unwrap();
            assert_eq!((read.width(), read.height()), (width, height));
            assert_eq!(read.samples(), expected, "{width} × {height}");
        }
    }
}

#[test]
fn what_stands_for_one_is_known_of_whole_numbers_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("a.ppm"), "P3 1 1 7 0 3 7").unwrap();
    fs::write(path("a.pfm"), "Pf 1 1 1 0000").unwrap();
    Image::new(1).unwrap().save(path("a.png")).unwrap();
    for (name, largest) in [("a.ppm", Some(7)), ("a.pfm", None), ("a.png", Some(255))] {
        let loaded = Raster::load_with(path(name), &LoadOptions::default()).unwrap();
        assert_eq!(loaded.largest, largest, "{name}");
        assert_eq!((loaded.corner, &*loaded.layer), ([0, 0], ""), "{name}");
    }
}

#[test]
fn what_is_not_whole_is_refused_in_one_line() {
    for (bytes, says) in [
        ("", "it begins with “”, not with P3 or P6"),
        ("P5 1 1 255 0", "it begins with “P5”, not with P3 or P6"),
        (
            "P6\u{1b}\n1 1 255\n000",
            "it begins with “P6\\u{1b}”, not with P3 or P6",
        ),
        (
            "P3 1 one 255 0 0 0",
            "its height is “one”, not such a number",
        ),
        ("P3 -1 -1 255 0 0 0", "its width is “-1”, not such a number"),
        (
            "P3 1 1 65536 0 0 0",
            "its largest number is “65536”, not such a number",
        ),
        ("P3 1 1 0 0 0 0", "its largest number is 0"),
        ("P3 1 1 255 0 0", "it ends before a sample"),
        (
            "P3 1 1 255 0 0 256",
            "a sample is 256, more than its largest, 255",
        ),
        (
            "P6 1 1 7 \x01\x02\x08",
            "a sample is 8, more than its largest, 7",
        ),
        ("P3 1 1 255 0 0 0 0", "it goes on after its last pixel"),
        ("P6 1 1 255 ab", "it ends before its last pixel"),
        ("P6 1 1 255 abcd", "it goes on after its last pixel"),
        // The second character of the line break was the first byte of the picture.
        ("P6 1 1 255\r\nabc", "it goes on after its last pixel"),
        (
            "P3 0 0 255 ",
            "is 0 × 0 pixels: give a picture of 1 to 16384 pixels a side",
        ),
        (
            "P3 16385 16385 255 ",
            "is 16385 × 16385 pixels: give a picture of 1",
        ),
        ("P3 2 0 255 ", "is 2 × 0 pixels: give a picture of 1"),
        (
            "P3 1 16385 255 ",
            "is 1 × 16385 pixels: give a picture of 1",
        ),
        ("P3 2 1 255 0 0 0 0 0", "it ends before a sample"),
        ("P6 1 2 255 abcdefg", "it goes on after its last pixel"),
        ("P6 16384 16384 255 a", "it ends before its last pixel"),
    ] {
        let said = load(bytes.as_bytes(), "ppm").unwrap_err();
        assert!(said.contains(says), "{bytes:?}: {said}");
    }
    for (bytes, says) in [
        ("PF4 1 1 1 0000", "it begins with “PF4”, not with PF or Pf"),
        ("Pf 1 1 2 0000", "its scale is 2, of which"),
        ("Pf 1 1 0 0000", "its scale is 0, of which"),
        ("Pf 1 1 NaN 0000", "its scale is NaN, of which"),
        ("PF 1 1 1 0000", "it ends before its last pixel"),
        ("Pf 1 1 1 00000", "it goes on after its last pixel"),
        ("Pf 16384 16384 -1 0000", "it ends before its last pixel"),
    ] {
        let said = load(bytes.as_bytes(), "pfm").unwrap_err();
        assert!(said.contains(says), "{bytes:?}: {said}");
    }
    let long = [b"P3 1".to_vec(), vec![b'1'; 1000]].concat();
    let said = load(&long, "ppm").unwrap_err();
    assert!(said.contains("more than 64 characters"), "{said}");
}
