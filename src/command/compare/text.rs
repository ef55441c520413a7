//! A comparison for people.

use std::fmt::Write as _;

use firsthit::difference::{Difference, PixelDifference, WorstPixel, limit};
use firsthit::image::{LoadedImage, Window};

use super::{Arguments, Compared, Flip};

/// Some lines, each with what it tells of at its beginning.
pub(super) fn text(arguments: &Arguments, compared: &Compared) -> String {
    let Difference {
        samples,
        wrong,
        nans: [nans_a, nans_b],
        nan_against_number,
        max_steps,
        max_abs,
        max_relative,
        eight_bit,
        ..
    } = compared.samples;
    let PixelDifference {
        pixels,
        beyond_steps,
        beyond_bytes,
        worst,
    } = &compared.pixels;
    let [a, b] = arguments.paths().map(|path| path.display());
    let image = &compared.pictures[0].image;
    let (width, height) = (image.width(), image.height());
    let mut text = format!(
        "pictures           {a} and {b}, {width} × {height} pixels\n\
         wrong samples      {wrong} of {samples} ({:.3} %)\n\
         error in f32 steps {max_steps} at most, {:.4} in the mean\n\
         absolute error     {max_abs:.4e} at most, {:.4e} in the mean\n\
         relative error     {max_relative:.4e} at most, by the samples of {b}\n\
         8-bit differences  {eight_bit}\n\
         PSNR               {}\n\
         NaN                {nans_a} and {nans_b}; {nan_against_number} against a number, in no error above\n\
         worst pixel        {}\n\
         pixels by steps    of {pixels}, {}\n\
         pixels by bytes    of {pixels}, {}\n",
        100.0 * wrong as f64 / samples as f64,
        compared.samples.mean_steps(),
        compared.samples.mean_abs(),
        match compared.samples.psnr() {
            f64::INFINITY => "infinite: no number differs from another".to_owned(),
            ratio => format!("{ratio:.2} dB for a peak of 1"),
        },
        worst.map_or_else(
            || "none: no number differs from another".to_owned(),
            |worst| pixel(worst, height)
        ),
        beyond(beyond_steps),
        beyond(beyond_bytes),
    );
    if let Some(Flip {
        mean,
        pixels_per_degree,
    }) = compared.flip
    {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "FLIP               {mean:.6} in the mean, at {pixels_per_degree:.2} pixels per degree, of samples taken for sRGB"
        );
    }
    let pictures = compared.pictures.iter().zip(compared.data_windows);
    for (path, (picture, data_window)) in [a, b].into_iter().zip(pictures) {
        let window = missing(data_window, picture.data_window());
        let notes = [window, layers(picture), rounding(picture)];
        for note in notes.into_iter().flatten() {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "note               {path}{note}");
        }
    }
    text
}

fn pixel(pixel: WorstPixel, height: u32) -> String {
    let WorstPixel {
        column,
        row,
        colors: [a, b],
        steps,
    } = pixel;
    let from_top = height - 1 - row;
    let steps = steps.map_or_else(
        || "a NaN against a number".to_owned(),
        |steps| format!("{steps} f32 steps"),
    );
    format!(
        "column {column}, row {from_top} from the top, {row} from the bottom: {a:?} and {b:?}, {steps}"
    )
}

/// How many pixels are beyond each limit, up to the first that none is beyond.
fn beyond(counts: &[u64]) -> String {
    let none = counts.iter().position(|&count| count == 0);
    let counts = counts[..none.map_or(counts.len(), |none| none + 1)].iter();
    let counts = counts.enumerate();
    let counts = counts.map(|(place, count)| format!("{count} beyond {}", limit(place)));
    counts.collect::<Vec<_>>().join(", ")
}

/// Which pixels the data window holds, where others are compared.
fn missing(data_window: Window, compared: Window) -> Option<String> {
    (data_window != compared).then(|| {
        let consequence = match data_window.intersection(compared) == Some(compared) {
            true => format!("only {compared} are compared"),
            false => {
                format!("of {compared} those it lacks count as black: --overlap leaves them out")
            }
        };
        format!(" holds the pixels {data_window}: {consequence}")
    })
}

/// Which layer was read, where there are others.
fn layers(picture: &LoadedImage) -> Option<String> {
    fn name(name: &str) -> &str {
        if name.is_empty() {
            "the nameless layer"
        } else {
            name
        }
    }
    let others: Vec<_> = picture
        .other_layers
        .iter()
        .map(|other| name(other))
        .collect();
    (!others.is_empty()).then(|| {
        format!(
            ": {} is read of {} layers: --layer chooses another: {}",
            name(&picture.layer),
            1 + others.len(),
            others.join(", ")
        )
    })
}

/// What whole numbers were taken for.
fn rounding(picture: &LoadedImage) -> Option<String> {
    let largest = picture.largest?;
    Some(format!(
        " holds whole numbers from 0 to {largest}: read as number / {largest}, so that an error below 1/{} can be its rounding",
        2 * u32::from(largest)
    ))
}
