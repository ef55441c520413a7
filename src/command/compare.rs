//! `firsthit compare`: two pictures, sample by sample.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use firsthit::difference::{Difference, save_heat};
use firsthit::image::{Format, Image, LoadError, LoadOptions, LoadedImage};

use super::watchdog::Watchdog;
use super::{Failure, print, wrong};

#[derive(Args)]
pub(crate) struct Arguments {
    /// A picture: .exr or .pfm (every float bit for bit), .png or .ppm (each whole number as a
    /// fraction of the largest, a byte as byte / 255)
    a: PathBuf,
    /// The picture to compare it with, of the same size
    b: PathBuf,
    /// The layer to read of an .exr that has several: what its channels' names begin with, or the
    /// name of its part; the first if not given
    #[arg(long, value_name = "NAME")]
    layer: Option<String>,
    /// Compare colours as they are stored where pixels are not opaque, which is refused otherwise
    #[arg(long)]
    ignore_alpha: bool,
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
    let options = LoadOptions {
        layer: arguments.layer.clone(),
        ignore_alpha: arguments.ignore_alpha,
    };
    let (a, b) = (load(&arguments.a, &options)?, load(&arguments.b, &options)?);
    if let Some(layer) = &arguments.layer
        && a.layer.is_empty()
        && b.layer.is_empty()
    {
        return Err(Failure::NoLayers {
            a: arguments.a.clone(),
            b: arguments.b.clone(),
            layer: layer.clone(),
        });
    }
    let sizes = |reason| Failure::Sizes {
        a: arguments.a.clone(),
        b: arguments.b.clone(),
        reason,
    };
    let difference = Difference::of(&a.image, &b.image).map_err(sizes)?;
    if a.corner != b.corner {
        return Err(Failure::Windows {
            a: arguments.a.clone(),
            b: arguments.b.clone(),
            corners: [a.corner, b.corner],
            size: a.image.size(),
        });
    }
    if let Some(path) = &arguments.output {
        save_heat(&a.image, &b.image, path)?;
    }
    print(&text(arguments, [&a, &b], &difference))?;
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

fn text(arguments: &Arguments, pictures: [&LoadedImage; 2], difference: &Difference) -> String {
    let size = pictures[0].image.size();
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
    for (path, picture) in [&arguments.a, &arguments.b].into_iter().zip(pictures) {
        if !picture.other_layers.is_empty() {
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "note               {}: {} is read of {} layers: --layer chooses another: {}",
                path.display(),
                layer_name(&picture.layer),
                1 + picture.other_layers.len(),
                picture
                    .other_layers
                    .iter()
                    .map(|name| layer_name(name))
                    .collect::<Vec<_>>()
                    .join(", ")
            );
        }
        if let Some(largest) = picture.largest {
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "note               {} holds whole numbers from 0 to {largest}: read as number / {largest}, so that an error below 1/{} can be its rounding",
                path.display(),
                2 * u32::from(largest),
            );
        }
    }
    text
}

fn layer_name(name: &str) -> &str {
    if name.is_empty() {
        "the nameless layer"
    } else {
        name
    }
}

fn load(path: &Path, options: &LoadOptions) -> Result<LoadedImage, LoadError> {
    let _watchdog = Watchdog::for_input(path);
    Image::load_with(path, options)
}
