//! What a window shows, and what it should show.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;

use firsthit::image::display_byte;
use firsthit::{Image, Kernel, Scene, Stage, Tracer};

use super::DEADLINE;
use super::program::pause;

/// The document's glClearColor, as bytes.
const BLUE: [u8; 3] = [0, 0, 255];

/// The bytes of a drawn window or of what should be drawn: red, green, blue, rows from the top.
#[derive(PartialEq)]
pub struct Pixels {
    pub width: usize,
    pub height: usize,
    pub bytes: Vec<[u8; 3]>,
}

impl Pixels {
    /// How many pixels of some rows, counted from the top, are not those of `other`; all of them
    /// where the sizes differ.
    pub fn differences(&self, other: &Pixels, rows: Range<usize>) -> usize {
        let range = rows.start * self.width..rows.end * self.width;
        if (self.width, self.height) != (other.width, other.height) {
            return range.len();
        }
        let pairs = self.bytes[range.clone()].iter().zip(&other.bytes[range]);
        pairs.filter(|(a, b)| a != b).count()
    }

    /// The rectangle of `width` × `height` pixels whose top left one is at `left` and `top`; as
    /// much of it as there is.
    pub fn part(&self, [left, top]: [usize; 2], [width, height]: [usize; 2]) -> Pixels {
        let width = width.min(self.width.saturating_sub(left));
        let rows = self.bytes.chunks(self.width).skip(top).take(height);
        let bytes: Vec<_> = rows
            .flat_map(|row| &row[left..left + width])
            .copied()
            .collect();
        Pixels {
            width,
            height: bytes.len() / width.max(1),
            bytes,
        }
    }

    /// How many pixels have this colour.
    pub fn count(&self, color: [u8; 3]) -> usize {
        self.bytes.iter().filter(|&&pixel| pixel == color).count()
    }

    pub fn save(&self, path: &Path) {
        let file = fs::File::create(path).unwrap();
        let mut encoder = png::Encoder::new(
            file,
            u32::try_from(self.width).unwrap(),
            u32::try_from(self.height).unwrap(),
        );
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::Fastest);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&self.bytes.concat()).unwrap();
    }
}

/// What is expected of a width and a height, made as rarely as these change.
pub struct Expected<F> {
    make: F,
    known: Option<Pixels>,
}

impl<F: Fn(usize, usize) -> Pixels> Expected<F> {
    pub fn new(make: F) -> Expected<F> {
        Expected { make, known: None }
    }

    pub fn of(&mut self, width: usize, height: usize) -> &Pixels {
        let fits = |known: &Pixels| (known.width, known.height) == (width, height);
        let known = self.known.take().filter(fits);
        self.known
            .insert(known.unwrap_or_else(|| (self.make)(width, height)))
    }
}

/// Waits until what is shown, if it can be seen, is what is expected of its width and height.
#[track_caller]
pub fn wait_to_show(shown: impl Fn() -> Option<Pixels>, expected: impl Fn(usize, usize) -> Pixels) {
    let start = Instant::now();
    let mut expected = Expected::new(expected);
    loop {
        let shown = shown();
        if let Some(shown) = &shown
            && shown == expected.of(shown.width, shown.height)
        {
            return;
        }
        if start.elapsed() > DEADLINE {
            let kept = shown.map(|shown| keep(&shown, expected.of(shown.width, shown.height)));
            panic!("this is not what the window shows: {kept:?}");
        }
        pause(start);
    }
}

/// Keeps two pictures that should be the same, to be looked at.
fn keep(shown: &Pixels, expected: &Pixels) -> [PathBuf; 2] {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    [(shown, "shown"), (expected, "expected")].map(|(pixels, name)| {
        let path = folder.join(format!("viewer-{}-{name}.png", std::process::id()));
        pixels.save(&path);
        path
    })
}

/// The picture as the library traces it.
pub fn traced(size: u32, stage: Stage, alpha: f64) -> Image {
    let mut image = Image::new(size).unwrap();
    let mut tracer = Tracer::new(Kernel::default(), 1).unwrap();
    tracer
        .trace(&Scene::builtin(), stage, alpha, &mut image)
        .unwrap();
    image
}

/// `picture` in a window: in the middle, in whole multiples where they fit, with blue around it.
pub fn letterboxed(picture: &Image, width: usize, height: usize) -> Pixels {
    let size = picture.size() as usize;
    let side = width.min(height);
    let extent = if side < size {
        side
    } else {
        side / size * size
    };
    let corner = [(width - extent) / 2, (height - extent) / 2].map(|margin| margin as i64);
    placed(picture, width, height, corner, extent)
}

/// `picture` in a window as a square of `extent` pixels with its bottom left corner at `left` and
/// `bottom`, and blue around it.
pub fn placed(
    picture: &Image,
    width: usize,
    height: usize,
    [left, bottom]: [i64; 2],
    extent: usize,
) -> Pixels {
    let size = picture.size() as usize;
    let texel = |pixel: usize, start: i64| {
        let pixel = usize::try_from(pixel as i64 - start).ok()?;
        // The one that the centre of the pixel lies in.
        let texel = (2 * pixel + 1) * size / (2 * extent);
        (pixel < extent).then_some(texel)
    };
    let columns: Vec<_> = (0..width).map(|x| texel(x, left)).collect();
    let (pixels, _) = picture.samples().as_chunks();
    let shown = |row: usize, column: Option<usize>| match column {
        Some(column) => {
            let [red, green, blue]: [f32; 3] = pixels[row * size + column];
            [display_byte(red), display_byte(green), display_byte(blue)]
        }
        None => BLUE,
    };
    let mut bytes = Vec::with_capacity(width * height);
    // A row of texels is a row of pixels, many times over.
    let (mut last, mut line) = (None, vec![BLUE; width]);
    for y in (0..height).rev() {
        let row = texel(y, bottom);
        if row != last {
            let columns = columns.iter();
            line = match row {
                Some(row) => columns.map(|&column| shown(row, column)).collect(),
                None => vec![BLUE; width],
            };
            last = row;
        }
        bytes.extend_from_slice(&line);
    }
    Pixels {
        width,
        height,
        bytes,
    }
}
