//! `firsthit compare`: two pictures, sample by sample.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use firsthit::Image;
use firsthit::difference::{Difference, save_heat};
use firsthit::image::{Format, LoadError};

use super::watchdog::Watchdog;
use super::{Failure, print, wrong};

#[derive(Args)]
pub(crate) struct Arguments {
    /// A picture: .exr (every float bit for bit) or .png (each byte taken as byte / 255)
    a: PathBuf,
    /// The picture to compare it with, of the same size
    b: PathBuf,
    /// A .png to write: where they differ and how much, in false colours above their scale
    #[arg(short, long, value_name = "HEAT.png")]
    output: Option<PathBuf>,
    /// Fail where a sample is further off than this many f32 steps, or a NaN on one side only
    #[arg(long, value_name = "ULP")]
    threshold: Option<u32>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(path) = &arguments.output
        && !matches!(Format::of(path), Ok(Format::Png))
    {
        let message = format!("{}: a false-colour picture is a .png", path.display());
        return Err(wrong::<Arguments>("firsthit compare", message).into());
    }
    let (a, b) = (load(&arguments.a)?, load(&arguments.b)?);
    let sizes = |reason| Failure::Sizes {
        a: arguments.a.clone(),
        b: arguments.b.clone(),
        reason,
    };
    let difference = Difference::of(&a, &b).map_err(sizes)?;
    if let Some(path) = &arguments.output {
        save_heat(&a, &b, path)?;
    }
    print(&text(arguments, a.size(), &difference))?;
    match arguments.threshold {
        Some(threshold)
            if difference.max_steps > threshold || difference.nan_against_number > 0 =>
        {
            Err(Failure::BeyondThreshold {
                a: arguments.a.clone(),
                b: arguments.b.clone(),
                steps: difference.max_steps,
                nans: difference.nan_against_number,
                threshold,
            })
        }
        _ => Ok(()),
    }
}

fn text(arguments: &Arguments, size: u32, difference: &Difference) -> String {
    let Difference {
        samples,
        wrong,
        nans: [nans_a, nans_b],
        nan_against_number,
        max_steps,
        max_abs,
        eight_bit,
        ..
    } = difference;
    let percent = 100.0 * *wrong as f64 / *samples as f64;
    let mut text = format!(
        "pictures           {} and {}, {size} × {size} pixels\n\
         wrong samples      {wrong} of {samples} ({percent:.3} %)\n\
         error in f32 steps {max_steps} at most, {:.4} in the mean\n\
         absolute error     {max_abs:.4e} at most, {:.4e} in the mean\n\
         8-bit differences  {eight_bit}\n\
         PSNR               {}\n\
         NaN                {nans_a} and {nans_b}; {nan_against_number} against a number, in no error above\n",
        arguments.a.display(),
        arguments.b.display(),
        difference.mean_steps(),
        difference.mean_abs(),
        match difference.psnr() {
            f64::INFINITY => "infinite: no number differs from another".to_owned(),
            ratio => format!("{ratio:.2} dB for a peak of 1"),
        },
    );
    for path in [&arguments.a, &arguments.b] {
        if let Ok(Format::Png) = Format::of(path) {
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "note               {} holds whole numbers, of 8 bits as a rule: read as byte / 255, so that an error below 1/510 can be its rounding",
                path.display()
            );
        }
    }
    text
}

fn load(path: &Path) -> Result<Image, LoadError> {
    let _watchdog = Watchdog::for_input(path);
    Image::load(path)
}
