//! PFM, read: floats of colours (PF) or of grey (Pf), rows from the bottom.

use std::fs::File;
use std::io::BufReader;

use super::samples::Samples;
use super::tokens::Tokens;
use super::{LoadedImage, Problem};

pub(super) fn read(file: BufReader<File>) -> Result<LoadedImage, Problem> {
    let mut tokens = Tokens(file);
    let grey = match tokens.word()?.as_str() {
        "PF" => false,
        "Pf" => true,
        other => {
            let reason = format!("it begins with “{other}”, not with PF or Pf");
            return Err(Problem::Damaged(reason));
        }
    };
    let (width, height) = (tokens.number("its width")?, tokens.number("its height")?);
    let scale: f32 = tokens.number("its scale")?;
    let float = match scale {
        1.0 => f32::from_be_bytes,
        -1.0 => f32::from_le_bytes,
        _ => {
            let reason = format!(
                "its scale is {scale}, of which programs make different things: write it with 1 or -1"
            );
            return Err(Problem::Damaged(reason));
        }
    };
    let mut samples = Samples::new(width, height)?;
    for _ in 0..samples.pixels() {
        let mut next = || tokens.bytes().map(float);
        samples.push(match grey {
            true => [next()?; 3],
            false => [next()?, next()?, next()?],
        })?;
    }
    tokens.end()?;
    Ok(LoadedImage::of_floats(samples.image_from_bottom()?))
}
