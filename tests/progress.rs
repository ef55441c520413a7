//! Promise: however long a frame takes, it says how far it is, and ends soon where nobody wants it.

use std::thread;

use firsthit::tracer::TraceError;
use firsthit::{Image, Kernel, Scene, Stage, Tracer};

use crate::helpers::{Random, trace};

/// Large spheres that all overlap, which no kernel finds easy.
fn crowd(spheres: usize) -> Scene {
    let mut random = Random::new();
    let mut text = String::new();
    for _ in 0..spheres {
        let [x, y, z] = [(); 3].map(|()| 1.2 * random.fraction() - 0.6);
        let radius = 0.1 + 0.3 * random.fraction();
        text += &format!(
            "[[sphere]]\ncenter = [{x}, {y}, {z}]\nradius = {radius}\ncolor = [1.0, 0.5, 0.0]\n"
        );
    }
    Scene::from_toml(&text).unwrap()
}

#[test]
fn a_cancelled_frame_ends_and_the_next_one_is_whole() {
    let scene = crowd(60);
    // Enough to be in the middle of it when it is cancelled.
    let mut images = [600, 4000].map(|size| Image::new(size).unwrap());
    for kernel in Kernel::ALL {
        let scene = match kernel {
            Kernel::Listing => Scene::builtin(),
            _ => scene.clone(),
        };
        let image = match kernel {
            Kernel::Reference | Kernel::Listing => &mut images[0],
            _ => &mut images[1],
        };
        for threads in [1, 3] {
            let mut tracer = Tracer::new(kernel, threads).unwrap();
            let progress = tracer.progress();
            let cancelled = thread::scope(|scope| {
                scope.spawn(|| {
                    while progress.rows() < 8 {
                        thread::yield_now();
                    }
                    progress.cancel();
                });
                tracer.retrace(&scene, Stage::Reflection, 0.3, image)
            });
            assert!(
                matches!(cancelled, Err(TraceError::Cancelled)),
                "{kernel:?}: {cancelled:?}"
            );
            assert!(progress.rows() < image.size(), "{kernel:?}");
            // What the image shows is not taken for a frame.
            let mut image = Image::new(50).unwrap();
            tracer
                .retrace(&scene, Stage::Reflection, 0.3, &mut image)
                .unwrap();
            assert!(image == trace(kernel, &scene, Stage::Reflection, 0.3, 50));
            assert_eq!(progress.rows(), 50);
        }
    }
}

#[test]
fn an_image_that_a_cancelled_frame_has_left_is_written_whole() {
    let scene = Scene::builtin();
    let mut tracer = Tracer::new(Kernel::Reference, 1).unwrap();
    let mut image = Image::new(300).unwrap();
    tracer
        .retrace(&scene, Stage::Reflection, 0.0, &mut image)
        .unwrap();
    let progress = tracer.progress();
    thread::scope(|scope| {
        scope.spawn(|| {
            while progress.rows() > 200 || progress.rows() < 5 {
                thread::yield_now();
            }
            progress.cancel();
        });
        tracer
            .retrace(&scene, Stage::Shadow, 1.0, &mut image)
            .unwrap_err()
    });
    tracer
        .retrace(&scene, Stage::Reflection, 0.0, &mut image)
        .unwrap();
    assert!(image == trace(Kernel::Reference, &scene, Stage::Reflection, 0.0, 300));
}
