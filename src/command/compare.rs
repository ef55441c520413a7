//! `firsthit compare`: two pictures, sample by sample and pixel by pixel.

mod json;
mod text;

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use firsthit::difference::{
    Difference, PIXELS_PER_DEGREE, PIXELS_PER_DEGREE_RANGE, PixelDifference, flip, save_heat,
};
use firsthit::image::{Format, LoadError, LoadOptions, LoadedImage, Raster, Window};
use firsthit::report;
use firsthit::viewer::{self, Event, Picture};

use super::arguments::finite;
use super::streams::is_standard;
use super::watchdog::Watchdog;
use super::{Failure, escaped, print, wrong};

#[derive(Args)]
#[command(
    after_help = "Exit status: 0 if the pictures could be compared and are within every limit that is given, 1 if not, 2 for \
                  wrong usage"
)]
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
    /// Compare only the pixels that both have, where data windows of .exr files differ: a cropped
    /// picture with a whole one; if not given, a pixel that one of them lacks counts as black
    #[arg(long)]
    overlap: bool,
    /// Compute the mean error of FLIP, too, from 0 to 1: how different they look to whoever flips
    /// between them. Samples are taken as an sRGB display shows them, so that a renderer's light
    /// has to be encoded before
    #[arg(long)]
    flip: bool,
    /// Pixels per degree of the visual field, for --flip; 67.02 if not given, those of a display of
    /// 3840 pixels that is seen from as far away as it is wide
    #[arg(long, value_name = "N", requires = "flip", allow_hyphen_values = true, value_parser = pixels_per_degree)]
    pixels_per_degree: Option<f64>,
    /// A .png to write: where they differ and how much, in false colours above their scale
    #[arg(short, long, value_name = "HEAT.png")]
    output: Option<PathBuf>,
    /// A file to write the comparison to, as JSON; - is standard output, which has nothing else
    /// then
    #[arg(long, value_name = "PATH")]
    json: Option<PathBuf>,
    /// Fail where a sample is further off than this many f32 steps, or a NaN on one side only
    #[arg(long, value_name = "ULP", allow_hyphen_values = true, value_parser = steps)]
    threshold: Option<u32>,
    /// Fail where a sample is further off than this, or a NaN on one side only
    #[arg(long, value_name = "ABS", allow_hyphen_values = true, value_parser = most)]
    tolerance: Option<f64>,
    /// Fail where a sample is further off than this many times that of B, or a NaN on one side only
    #[arg(long, value_name = "REL", allow_hyphen_values = true, value_parser = most)]
    relative: Option<f64>,
    /// Open a window that shows A, B and where they differ, and what both are at a pixel
    #[arg(long)]
    show: bool,
}

/// Pictures and how far they are apart.
struct Compared {
    /// The pictures, of one window.
    pictures: [LoadedImage; 2],
    /// The data windows of their files.
    data_windows: [Window; 2],
    samples: Difference,
    pixels: PixelDifference,
    flip: Option<Flip>,
}

/// The mean error of FLIP.
struct Flip {
    mean: f64,
    pixels_per_degree: f64,
}

/// The most f32 steps that pass.
fn steps(text: &str) -> Result<u32, &'static str> {
    text.parse()
        .map_err(|_| "a whole number from 0 to 4294967295 is needed")
}

/// The largest error that passes.
fn most(text: &str) -> Result<f64, &'static str> {
    match finite(text)? {
        most @ 0.0.. => Ok(most),
        _ => Err("a number from 0 on is needed"),
    }
}

fn pixels_per_degree(text: &str) -> Result<f64, &'static str> {
    let number = finite(text)?;
    match PIXELS_PER_DEGREE_RANGE.contains(&number) {
        true => Ok(number),
        false => Err("a number from 1 to 1000 is needed"),
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.check_outputs()?;
    let compared = arguments.compare()?;
    let [a, b] = &compared.pictures;
    if let Some(path) = &arguments.output {
        save_heat(&a.image, &b.image, path)?;
    }
    let failure = arguments.limit_passed(&compared.samples);
    let json = || json::json(arguments, &compared, failure.is_none());
    match &arguments.json {
        Some(path) if is_standard(path) => print(&json())?,
        path => {
            if let Some(path) = path {
                report::save(&json(), path)?;
            }
            print(&text::text(arguments, &compared))?;
        }
    }
    if arguments.show {
        arguments.show(compared.pictures)?;
    }
    failure.map_or(Ok(()), Err)
}

impl Arguments {
    /// Shows the pictures in a window until that is closed.
    fn show(&self, pictures: [LoadedImage; 2]) -> Result<(), Failure> {
        let [a, b] = pictures;
        let mut opening = Some(Watchdog::for_driver(a.image.width(), a.image.height()));
        let picture = |path: &Path, loaded: LoadedImage| Picture {
            name: escaped(&path.display().to_string()),
            image: loaded.image,
        };
        let pictures = [picture(&self.a, a), picture(&self.b, b)];
        viewer::compare(pictures, &mut |event| match event {
            Event::Opened => opening = None,
            Event::Differs { .. } | Event::NotSaved(_) => super::say(&event.to_string()),
            _ => {}
        })?;
        Ok(())
    }

    fn paths(&self) -> [&Path; 2] {
        [&self.a, &self.b]
    }

    /// Refuses files to be written that are no pictures, or that are read or written as something
    /// else.
    fn check_outputs(&self) -> Result<(), Failure> {
        let refused = |path: &Path, message: &str| {
            let message = format!("{}: {message}", path.display());
            Err(wrong::<Arguments>("firsthit compare", message).into())
        };
        if let Some(path) = &self.output
            && !matches!(Format::of(path), Ok(Format::Png))
        {
            return refused(path, "a false-colour picture is a .png");
        }
        let json = self.json.as_ref().filter(|path| !is_standard(path));
        for path in [self.output.as_ref(), json].into_iter().flatten() {
            if self.paths().iter().any(|input| is_same(path, input)) {
                return refused(
                    path,
                    "this is a picture to be compared: choose another path",
                );
            }
        }
        match (&self.output, json) {
            (Some(output), Some(json)) if is_same(output, json) => {
                refused(json, "the false colours and the JSON need two files")
            }
            _ => Ok(()),
        }
    }

    /// Reads the pictures, which must show the same pixels.
    fn compare(&self) -> Result<Compared, Failure> {
        let options = LoadOptions {
            layer: self.layer.clone(),
            ignore_alpha: self.ignore_alpha,
        };
        let mut pictures = [load(&self.a, &options)?, load(&self.b, &options)?];
        let [a, b] = &pictures;
        if let Some(layer) = &self.layer
            && a.layer.is_empty()
            && b.layer.is_empty()
        {
            return Err(Failure::NoLayers {
                a: self.a.clone(),
                b: self.b.clone(),
                layer: layer.clone(),
            });
        }
        let data_windows = [a.data_window(), b.data_window()];
        if let Some(window) = self.window(a, b)? {
            for picture in &mut pictures {
                picture.image = picture.pixels_of(window)?;
                picture.corner = window.corner;
            }
        }
        let [a, b] = &pictures;
        let sizes = |reason| Failure::Sizes {
            a: self.a.clone(),
            b: self.b.clone(),
            reason,
        };
        let samples = Difference::of(&a.image, &b.image).map_err(sizes)?;
        let pixels = PixelDifference::of(&a.image, &b.image).map_err(sizes)?;
        if a.corner != b.corner {
            return Err(self.windows_differ(data_windows));
        }
        let flip = match self.flip {
            true => {
                let pixels_per_degree = self.pixels_per_degree.unwrap_or(PIXELS_PER_DEGREE);
                Some(Flip {
                    mean: flip(&a.image, &b.image, pixels_per_degree)?,
                    pixels_per_degree,
                })
            }
            false => None,
        };
        Ok(Compared {
            pictures,
            data_windows,
            flip,
            samples,
            pixels,
        })
    }

    /// The pixels to compare, where two data windows are parts of one display window; `None` where
    /// they are equal, or the display windows are not.
    fn window(&self, a: &LoadedImage, b: &LoadedImage) -> Result<Option<Window>, Failure> {
        let (data, display) = ([a.data_window(), b.data_window()], a.display_window);
        if data[0] == data[1] || display != b.display_window {
            return Ok(None);
        }
        let shown = data.map(|window| window.intersection(display));
        let window = match shown {
            [Some(a), Some(b)] if self.overlap => a.intersection(b),
            [Some(_), Some(_)] => Some(display),
            _ => None,
        };
        window.map(Some).ok_or_else(|| self.windows_differ(data))
    }

    fn windows_differ(&self, windows: [Window; 2]) -> Failure {
        Failure::Windows {
            a: self.a.clone(),
            b: self.b.clone(),
            windows,
        }
    }

    /// The first limit that the pictures are beyond.
    fn limit_passed(&self, difference: &Difference) -> Option<Failure> {
        let nans = difference.nan_against_number;
        let (steps, abs) = (difference.max_steps, difference.max_abs);
        let relative = difference.max_relative;
        let limits = [
            self.threshold.map(|most| {
                let found = format!("{steps} f32 steps apart");
                (steps > most, found, format!("threshold of {most}"))
            }),
            self.tolerance.map(|most| {
                let found = format!("{abs:e} apart");
                (abs > most, found, format!("tolerance of {most}"))
            }),
            self.relative.map(|most| {
                let found = format!("{relative:e} times the latter apart");
                (relative > most, found, format!("relative error of {most}"))
            }),
        ];
        let mut limits = limits.into_iter().flatten();
        let (_, found, limit) = limits.find(|&(beyond, ..)| beyond || nans > 0)?;
        Some(Failure::BeyondLimit {
            a: self.a.clone(),
            b: self.b.clone(),
            found,
            nans,
            limit,
        })
    }
}

/// Whether both are paths of one file, or would be.
fn is_same(a: &Path, b: &Path) -> bool {
    match (fs::canonicalize(a), fs::canonicalize(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}

fn load(path: &Path, options: &LoadOptions) -> Result<LoadedImage, LoadError> {
    let _watchdog = Watchdog::for_input(path);
    Raster::load_with(path, options)
}
