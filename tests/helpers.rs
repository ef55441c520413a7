//! What several promises need.

mod explanation;
#[cfg(all(feature = "program", target_os = "linux"))]
mod fault;
#[cfg(feature = "program")]
mod program;

#[path = "../src/random.rs"]
mod random;
#[cfg(all(feature = "program", target_os = "linux"))]
mod samples;
#[cfg(all(feature = "program", target_os = "linux"))]
mod terminal;

use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::thread;

use exr::prelude::{FlatSamples, read_all_flat_layers_from_file};
use firsthit::image::Raster;
use firsthit::tracer::Decision;
use firsthit::{Image, Kernel, Scene, Stage, Tracer};

#[cfg(feature = "program")]
pub(crate) use explanation::line;
pub(crate) use explanation::says_what_is_shown;
#[cfg(all(feature = "program", target_os = "linux"))]
pub(crate) use fault::with_fault;
#[cfg(all(feature = "program", unix))]
pub(crate) use program::program_after;
#[cfg(all(feature = "program", target_os = "linux"))]
pub(crate) use program::{NO_DRIVERS, backends};
#[cfg(feature = "program")]
pub(crate) use program::{
    PROGRAM, failed, names, open, printed, program, skipped, succeeded, text, without_drivers,
    words,
};
pub(crate) use random::Random;
#[cfg(all(feature = "program", target_os = "linux"))]
pub(crate) use samples::{compiled, interpreted};
#[cfg(all(feature = "program", target_os = "linux"))]
pub(crate) use terminal::terminal;

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
pub(crate) fn bits(image: &Raster) -> Vec<u32> {
    image.samples().iter().map(|s| s.to_bits()).collect()
}

/// Whether two pictures have the same samples, bit for bit. It copies neither.
pub(crate) fn same_bits(one: &Raster, other: &Raster) -> bool {
    let [one, other] = [one, other].map(|image| image.samples().iter().map(|s| s.to_bits()));
    one.eq(other)
}

/// The samples of an EXR file as bits, in the order of [`Raster::samples`].
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

/// The folder of the scenes that are hard to trace.
const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes");

/// The names of the hard scenes, in the order of the alphabet.
pub(crate) fn hard_scenes() -> Vec<String> {
    let files = fs::read_dir(SCENES).unwrap();
    let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names
        .map(|name| name.strip_suffix(".toml").unwrap().to_owned())
        .collect();
    names.sort_unstable();
    names
}

/// The text of the hard scene of that name.
pub(crate) fn hard_scene_text(name: &str) -> String {
    fs::read_to_string(format!("{SCENES}/{name}.toml")).unwrap()
}

/// The hard scene of that name.
pub(crate) fn hard_scene(name: &str) -> Scene {
    Scene::from_toml(&hard_scene_text(name)).unwrap()
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
