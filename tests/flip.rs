//! Promise: FLIP is the number that its authors' program gives, on every machine.

use firsthit::difference::{FlipError, PIXELS_PER_DEGREE, flip};
use firsthit::image::Raster;

const WIDTH: u32 = 90;
const HEIGHT: u32 = 60;

/// The picture whose sample of a column, a row from the bottom and a channel is that.
fn picture(mut sample: impl FnMut(u32, u32, u32) -> f32) -> Raster {
    let mut picture = Raster::new(WIDTH, HEIGHT).unwrap();
    for (i, value) in (0..).zip(picture.samples_mut()) {
        *value = sample(i / 3 % WIDTH, i / 3 / WIDTH, i % 3);
    }
    picture
}

fn byte(number: u32) -> f32 {
    number as f32 / 255.0
}

fn ramp_byte(column: u32, row: u32, channel: u32) -> u32 {
    (3 * column + 2 * row + 40 * channel) % 256
}

fn box_at(left: u32, bottom: u32) -> Raster {
    picture(|column, row, channel| {
        let inside = (left..left + 30).contains(&column) && (bottom..bottom + 25).contains(&row);
        match (channel, inside) {
            (2, _) => 0.25,
            (_, inside) => f32::from(inside),
        }
    })
}

/// The high bytes of a linear congruential generator.
fn noise(mut state: u32) -> impl FnMut() -> u32 {
    move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 24
    }
}

/// Two pictures, their mean errors at each number of [`DEGREES`] by the published program, and the
/// first of them in 64 bits.
struct Pair {
    name: &'static str,
    pictures: [Raster; 2],
    published: [f64; 3],
    mean: f64,
}

const DEGREES: [f64; 3] = [PIXELS_PER_DEGREE, 20.0, 150.0];

/// The published means are those of the maps that flip_evaluator 1.7, from the Python package
/// index, makes of the same pictures in 32 bits: `evaluate(truth, image, "LDR", applyMagma=False)`,
/// the first with its default parameters, the others with `parameters={"ppd": …}`.
fn pairs() -> [Pair; 6] {
    let ramp = || picture(|column, row, channel| byte(ramp_byte(column, row, channel)));
    let moved = picture(|column, row, channel| byte(ramp_byte(column + 1, row, channel)));
    let noisy = |seed| {
        let mut next = noise(seed);
        picture(move |_, _, _| byte(next()))
    };
    let mut next = noise(3);
    let noisy_ramp = picture(|column, row, channel| {
        let more = u32::from(next() > 127);
        byte((ramp_byte(column, row, channel) + more).min(255))
    });
    let primary = |number| picture(move |_, _, channel| f32::from(channel == number));
    let beyond_columns = picture(|column, _, _| -3.0 + column as f32 / 8.0);
    let beyond_rows = picture(|_, row, _| -3.0 + row as f32 / 8.0);
    [
        Pair {
            name: "a ramp, moved by a pixel",
            pictures: [ramp(), moved],
            published: [0.1792070225874583, 0.15534918938108064, 0.16570524533624176],
            mean: 0.1792070162848917,
        },
        Pair {
            name: "a box, moved by two pixels",
            pictures: [box_at(20, 15), box_at(22, 16)],
            published: [0.1362180390266224, 0.07402650112174915, 0.16805656873331287],
            mean: 0.13621791101378458,
        },
        Pair {
            name: "noise",
            pictures: [noisy(1), noisy(2)],
            published: [0.44980226214837143, 0.8456141174087922, 0.28646054726576914],
            mean: 0.449802244526076,
        },
        Pair {
            name: "a ramp, and noise of the last bit",
            pictures: [ramp(), noisy_ramp],
            published: [
                0.024756588250985024,
                0.031260944691813265,
                0.023854782461637147,
            ],
            mean: 0.024756578161452922,
        },
        Pair {
            name: "blue and green",
            pictures: [primary(2), primary(1)],
            published: [1.0; 3],
            mean: 1.0,
        },
        Pair {
            name: "what is darker than black and lighter than white",
            pictures: [beyond_columns, beyond_rows],
            published: [0.570598760627555, 0.542350588470187, 0.6177605992961289],
            mean: 0.5705962940337955,
        },
    ]
}

#[test]
fn means_are_those_of_the_published_program() {
    for pair in pairs() {
        let [image, truth] = &pair.pictures;
        for (degrees, published) in DEGREES.into_iter().zip(pair.published) {
            let mean = flip(image, truth, degrees).unwrap();
            let what = format!("{}, {degrees}: {mean}", pair.name);
            assert!((mean - published).abs() < 1e-5, "{what}");
            assert_eq!(flip(truth, image, degrees).unwrap(), mean, "{what}");
        }
    }
}

#[test]
fn a_mean_is_the_same_number_on_every_machine() {
    for pair in pairs() {
        let [image, truth] = &pair.pictures;
        let mean = flip(image, truth, PIXELS_PER_DEGREE).unwrap();
        assert_eq!(mean, pair.mean, "{}", pair.name);
    }
}

#[test]
fn what_is_shown_alike_is_no_error() {
    let image = picture(|column, row, _| match (column % 4, row) {
        (0, _) => f32::NAN,
        (1, _) => f32::INFINITY,
        (2, _) => f32::NEG_INFINITY,
        _ => 7.0,
    });
    let shown = picture(|column, _, _| f32::from(column % 2 == 1));
    assert_eq!(flip(&image, &shown, PIXELS_PER_DEGREE), Ok(0.0));
    // As wide as a pixel, and less high than there may be threads.
    for (width, height) in [(1, 1), (1, 3), (3, 1)] {
        let black = Raster::new(width, height).unwrap();
        let mut white = black.clone();
        white.samples_mut().fill(1.0);
        assert_eq!(flip(&black, &black, 1.0), Ok(0.0));
        let mean = flip(&white, &black, 1000.0).unwrap();
        assert!(mean > 0.9 && mean <= 1.0, "{mean}");
    }
}

#[test]
fn what_has_no_mean_is_refused() {
    let image = Raster::new(3, 2).unwrap();
    let other = Raster::new(2, 3).unwrap();
    let refused = flip(&image, &other, 67.0);
    assert!(matches!(refused, Err(FlipError::Sizes(_))), "{refused:?}");
    for degrees in [0.0, 0.99, 1000.1, -67.0, f64::NAN, f64::INFINITY] {
        let said = flip(&image, &image, degrees).unwrap_err().to_string();
        let expected = format!("no display has {degrees} pixels per degree: choose a number from");
        assert!(said.starts_with(&expected), "{said}");
    }
}
