//! PPM, read: whole numbers as bytes (P6) or as text (P3).

use std::fs::File;
use std::io::BufReader;

use super::samples::Samples;
use super::tokens::Tokens;
use super::{LoadedImage, Problem};

pub(super) fn read(file: BufReader<File>) -> Result<LoadedImage, Problem> {
    let mut tokens = Tokens(file);
    let as_text = match tokens.word()?.as_str() {
        "P3" => true,
        "P6" => false,
        other => {
            let reason = format!("it begins with “{other}”, not with P3 or P6");
            return Err(Problem::Damaged(reason));
        }
    };
    let (width, height) = (tokens.number("its width")?, tokens.number("its height")?);
    let largest: u16 = tokens.number("its largest number")?;
    if largest == 0 {
        return Err(Problem::Damaged("its largest number is 0".to_owned()));
    }
    let mut samples = Samples::new(width, height)?;
    for _ in 0..samples.pixels() {
        let mut pixel = [0.0; 3];
        for sample in &mut pixel {
            let number = match (as_text, largest) {
                (true, _) => tokens.number("a sample")?,
                (false, ..256) => u16::from(tokens.bytes::<1>()?[0]),
                (false, _) => u16::from_be_bytes(tokens.bytes()?),
            };
            if number > largest {
                let reason = format!("a sample is {number}, more than its largest, {largest}");
                return Err(Problem::Damaged(reason));
            }
            *sample = f32::from(number) / f32::from(largest);
        }
        samples.push(pixel)?;
    }
    tokens.end()?;
    Ok(LoadedImage::of_whole_numbers(
        samples.image_from_top()?,
        largest,
    ))
}
