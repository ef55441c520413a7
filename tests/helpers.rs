//! What several promises need.

#[path = "../src/random.rs"]
mod random;

use std::fmt::Display;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::Mutex;
use std::thread;

use exr::prelude::{FlatSamples, read_all_flat_layers_from_file};
use firsthit::report::HARD_SCENES;
use firsthit::screen::{Offscreen, ScreenError, Through};
use firsthit::tracer::Decision;
use firsthit::{Image, Kernel, Scene, Stage, Tracer};
use tempfile::TempDir;

pub(crate) use random::Random;

/// A frame as a new tracer with one thread makes it.
pub(crate) fn trace(kernel: Kernel, scene: &Scene, stage: Stage, alpha: f64, size: u32) -> Image {
    let mut image = Image::new(size).unwrap();
    Tracer::new(kernel, 1)
        .unwrap()
        .trace(scene, stage, alpha, &mut image)
        .unwrap();
    image
}

/// The same, and what was decided for each pixel.
pub(crate) fn trace_with_decisions(
    kernel: Kernel,
    scene: &Scene,
    stage: Stage,
    alpha: f64,
    size: u32,
) -> (Image, Vec<Decision>) {
    let mut image = Image::new(size).unwrap();
    let decisions = Tracer::new(kernel, 1)
        .unwrap()
        .trace_with_decisions(scene, stage, alpha, &mut image)
        .unwrap();
    (image, decisions)
}

/// The samples' bits, which tell signed zeros and NaNs apart.
pub(crate) fn bits(image: &Image) -> Vec<u32> {
    image.samples().iter().map(|s| s.to_bits()).collect()
}

/// The samples of an EXR file as bits, in the order of [`Image::samples`].
pub(crate) fn exr_bits(path: &Path) -> Vec<u32> {
    let file = read_all_flat_layers_from_file(path).unwrap();
    let [layer] = &file.layer_data[..] else {
        panic!("{} parts", file.layer_data.len());
    };
    let (width, height) = (layer.size.width(), layer.size.height());
    let channels = &layer.channel_data.list;
    let mut bits = vec![0; width * height * 3];
    assert_eq!(channels.len(), 3);
    for channel in channels {
        let place = ["R", "G", "B"]
            .iter()
            .position(|name| channel.name.eq(name))
            .unwrap();
        let FlatSamples::F32(samples) = &channel.sample_data else {
            panic!("not 32-bit floats");
        };
        for (i, sample) in samples.iter().enumerate() {
            let (column, row) = (i % width, height - 1 - i / width);
            bits[(row * width + column) * 3 + place] = sample.to_bits();
        }
    }
    bits
}

/// The scene of that name in `tests/scenes`.
pub(crate) fn hard_scene(name: &str) -> Scene {
    let mut scenes = HARD_SCENES.iter();
    let (_, text) = scenes.find(|(found, _)| *found == name).unwrap();
    Scene::from_toml(text).unwrap()
}

/// What `work` makes of each item, on all cores, in the order in which it is done.
pub(crate) fn on_all_cores<T, R: Send>(
    items: impl Iterator<Item = T> + Send,
    work: impl Fn(T) -> R + Sync,
) -> Vec<R> {
    let (items, done) = (Mutex::new(items), Mutex::new(Vec::new()));
    let next = || items.lock().unwrap().next();
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().unwrap().get() {
            scope.spawn(|| {
                while let Some(item) = next() {
                    let result = work(item);
                    done.lock().unwrap().push(result);
                }
            });
        }
    });
    done.into_inner().unwrap()
}

/// Says that a test leaves something out for want of a library, which CI must have: there it fails.
#[expect(
    clippy::explicit_write,
    reason = "the test harness hides what `eprintln!` says in a test that passes"
)]
pub(crate) fn skipped(error: &dyn Display) {
    assert!(std::env::var_os("CI").is_none(), "{error}");
    writeln!(std::io::stderr(), "skipped: {error}").unwrap();
}

/// An offscreen for pictures of this size, or `None` where its library is not installed: never so in CI.
pub(crate) fn open(through: Through, size: u32) -> Option<Offscreen> {
    match Offscreen::open(through, size) {
        Ok(offscreen) => Some(offscreen),
        Err(error @ ScreenError::Missing { .. }) => {
            skipped(&error);
            None
        }
        Err(error) => panic!("{}: {error}", through.name()),
    }
}

pub(crate) const PROGRAM: &str = env!("CARGO_BIN_EXE_firsthit");

/// The words of `line` as arguments; an empty line has none.
pub(crate) fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(' ').filter(|_| !line.is_empty())
}

/// The program with the words of `line`, to be run in `folder`.
pub(crate) fn program(folder: &TempDir, line: &str) -> Command {
    let mut command = Command::new(PROGRAM);
    command.current_dir(folder).args(words(line));
    command
}

/// What the program prints; it must succeed and say nothing on standard error.
pub(crate) fn printed(folder: &TempDir, line: &str) -> String {
    succeeded(&program(folder, line).output().unwrap(), line)
}

/// What the program printed; it must have succeeded and said nothing on standard error.
pub(crate) fn succeeded(output: &Output, what: &str) -> String {
    assert_eq!(text(&output.stderr), "", "{what}");
    assert_eq!(output.status.code(), Some(0), "{what}");
    text(&output.stdout)
}

/// What the program said on standard error; it must have failed with this status, and in one line where that is not 2, which is for
/// wrong usage.
pub(crate) fn failed(output: &Output, status: i32, what: &str) -> String {
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{what}: {message}");
    if status != 2 {
        assert_eq!(message.lines().count(), 1, "{what}: {message}");
        assert!(message.ends_with('\n'), "{what}: {message}");
    }
    message
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}
