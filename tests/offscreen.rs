//! A picture that goes through OpenGL without a window comes back bit for bit, whatever library
//! made the context.

use std::ffi::c_void;

use firsthit::screen::{Backend, Offscreen, ScreenError};
use firsthit::{Image, Kernel, Scene, Stage, Tracer};
use glam::UVec2;
use glutin::api::egl::device::Device;
use glutin::api::egl::display::Display;

use crate::helpers::{Random, hard_scene, open};

const BACKENDS: [Backend; 2] = [Backend::Egl, Backend::OsMesa];

/// A picture whose sample `i` has the bits `bits(i)`.
fn image(size: u32, bits: impl Fn(u32) -> u32) -> Image {
    let mut image = Image::new(size).unwrap();
    for (i, sample) in image.samples_mut().iter_mut().enumerate() {
        *sample = f32::from_bits(bits(i as u32));
    }
    image
}

/// Bits that no two samples nearby share; all kinds of floats occur.
fn scattered(seed: u32) -> impl Fn(u32) -> u32 {
    move |i| (i.wrapping_add(seed)).wrapping_mul(0x9E37_79B1)
}

#[track_caller]
fn assert_same_bits(shown: &Image, image: &Image, what: &str) {
    assert_eq!(shown.size(), image.size(), "{what}");
    let pairs = shown.samples().iter().zip(image.samples());
    for (i, (shown, sample)) in pairs.enumerate() {
        let (shown, sample) = (shown.to_bits(), sample.to_bits());
        assert_eq!(
            shown, sample,
            "{what}: sample {i}: {shown:#010x} for {sample:#010x}"
        );
    }
}

#[test]
fn every_stage_comes_back_bit_for_bit() {
    let scene = Scene::builtin();
    let mut tracer = Tracer::new(Kernel::default(), 0).unwrap();
    for backend in BACKENDS {
        for size in [1, 7, 499, 500] {
            let Some(mut offscreen) = open(backend, size) else {
                break;
            };
            let mut image = Image::new(size).unwrap();
            for stage in Stage::ALL {
                tracer.trace(&scene, stage, 0.3, &mut image).unwrap();
                let shown = offscreen.show(&image).unwrap();
                assert_same_bits(
                    &shown,
                    &image,
                    &format!("{} {stage} {size}", backend.name()),
                );
            }
        }
    }
}

/// Both zeros, the smallest and largest of every kind of float, and NaNs quiet and signalling, of
/// either sign, with payloads.
const SPECIAL: [u32; 24] = [
    0x0000_0000,
    0x8000_0000,
    0x0000_0001,
    0x8000_0001,
    0x0000_0700,
    0x007F_FFFF,
    0x807F_FFFF,
    0x0080_0000,
    0x8080_0000,
    0x3F80_0000,
    0x3F80_0001,
    0x3F7F_FFFF,
    0xBF80_0000,
    0x7F7F_FFFF,
    0xFF7F_FFFF,
    0x7F80_0000,
    0xFF80_0000,
    0x7FC0_0000,
    0xFFC0_0000,
    0x7FC1_2345,
    0x7FFF_FFFF,
    0x7F80_0001,
    0xFFA5_5AA5,
    0x7FBF_FFFF,
];

#[test]
fn every_kind_of_float_comes_back_bit_for_bit() {
    for backend in BACKENDS {
        let Some(mut offscreen) = open(backend, 64) else {
            continue;
        };
        // Shifted by one from row to row, so that each value gets into each channel.
        let special = image(64, |i| SPECIAL[((i + i / 192) % 24) as usize]);
        let shown = offscreen.show(&special).unwrap();
        assert_same_bits(&shown, &special, backend.name());
    }
}

/// A picture that is traced over the last one, by one tracer or another, and only its changed rows
/// uploaded.
#[test]
fn the_rows_that_changed_are_all_that_need_be_uploaded() {
    let size = 61;
    let scenes = [
        Scene::builtin(),
        hard_scene("shared_faces"),
        hard_scene("light_from_below"),
    ];
    let kernels = [
        (Kernel::Exact, 1),
        (Kernel::Exact, 3),
        (Kernel::Fast, 2),
        (Kernel::Listing, 1),
    ];
    let mut tracers = kernels.map(|(kernel, threads)| Tracer::new(kernel, threads).unwrap());
    let mut image = Image::new(size).unwrap();
    let mut offscreens = BACKENDS.map(|backend| open(backend, size));
    for offscreen in offscreens.iter_mut().flatten() {
        offscreen.show(&image).unwrap();
    }
    let mut random = Random::new();
    let mut choose = |count| random.below(count);
    let (mut alpha, mut rows_uploaded) = (0.0, 0);
    let (mut tracer, mut scene, mut stage) = (0, 0, Stage::Reflection);
    for step in 0..1000 {
        match choose(8) {
            0 => tracer = choose(4),
            1 => scene = choose(3),
            2 => stage = Stage::ALL[choose(7)],
            3 => {}
            _ => alpha += [0.01, 0.3][choose(2)],
        }
        // The document's listings trace the document's scene.
        let scene = if tracer == 3 { 0 } else { scene };
        let rows = tracers[tracer]
            .retrace(&scenes[scene], stage, alpha, &mut image)
            .unwrap();
        rows_uploaded += rows.len();
        for (offscreen, backend) in offscreens.iter_mut().zip(BACKENDS) {
            let Some(offscreen) = offscreen else { continue };
            let shown = offscreen.show_rows(&image, rows.clone()).unwrap();
            let what = format!("{} step {step} rows {rows:?}", backend.name());
            assert_same_bits(&shown, &image, &what);
        }
    }
    // Rows that show only the background need not be uploaded again.
    assert!(
        rows_uploaded < 1000 * size as usize * 9 / 10,
        "{rows_uploaded}"
    );
}

#[test]
fn rows_that_no_picture_has_are_left_out() {
    for backend in BACKENDS {
        let Some(mut offscreen) = open(backend, 9) else {
            continue;
        };
        let [before, after] = [image(9, scattered(0)), image(9, scattered(1))];
        offscreen.show(&before).unwrap();
        for rows in [9..12, 4..4, 12..u32::MAX] {
            let shown = offscreen.show_rows(&after, rows).unwrap();
            assert_same_bits(&shown, &before, backend.name());
        }
        let shown = offscreen.show_rows(&after, 3..u32::MAX).unwrap();
        let width = 3 * 9;
        let mut expected = before.clone();
        expected.samples_mut()[3 * width..].copy_from_slice(&after.samples()[3 * width..]);
        assert_same_bits(&shown, &expected, backend.name());
    }
}

#[test]
fn no_sample_of_an_earlier_picture_stays() {
    for backend in BACKENDS {
        let Some(mut offscreen) = open(backend, 33) else {
            continue;
        };
        let same = |_| 0x3F80_0000;
        let pictures = [
            image(33, scattered(0)),
            image(33, same),
            image(33, scattered(1)),
            image(33, scattered(0)),
        ];
        for picture in &pictures {
            let shown = offscreen.show(picture).unwrap();
            assert_same_bits(&shown, picture, backend.name());
        }
    }
}

#[test]
fn a_picture_too_large_for_one_framebuffer_comes_back_in_bands() {
    // Not much too large: the last band is lower than the others.
    let picture = image(2049, scattered(0));
    for backend in BACKENDS {
        let Some(mut offscreen) = open(backend, 2049) else {
            continue;
        };
        let shown = offscreen.show(&picture).unwrap();
        assert_same_bits(&shown, &picture, backend.name());
    }
}

#[test]
fn several_live_in_one_thread_and_die_in_any_order() {
    for order in [[0, 1, 2, 3], [3, 2, 1, 0], [1, 3, 0, 2]] {
        let mut alive: Vec<_> = [
            (Backend::Egl, 20),
            (Backend::OsMesa, 30),
            (Backend::Egl, 30),
            (Backend::OsMesa, 20),
        ]
        .into_iter()
        .map(|(backend, size)| open(backend, size).map(|offscreen| (offscreen, size)))
        .collect();
        for dies in order {
            // Twice: the second time, another one has been current since.
            for seed in 0..2 {
                for (i, (offscreen, size)) in alive.iter_mut().flatten().enumerate() {
                    let picture = image(*size, scattered(seed * 4 + i as u32));
                    let shown = offscreen.show(&picture).unwrap();
                    assert_same_bits(&shown, &picture, &format!("{i} of {order:?}"));
                }
            }
            alive[dies] = None;
        }
    }
}

/// Whether this thread has a context of this kind.
fn is_any_current(backend: Backend) -> bool {
    match backend {
        Backend::Egl => {
            let device = Device::query_devices().unwrap().next().unwrap();
            // SAFETY: no native display is passed, and asking for the current context has no
            // conditions.
            let current = unsafe {
                let display = Display::with_device(&device, None).unwrap();
                display.egl().GetCurrentContext()
            };
            !current.is_null()
        }
        Backend::OsMesa => {
            // SAFETY: the library is loaded already, and this is the function's type in
            // GL/osmesa.h.
            let current = unsafe {
                let library = libloading::Library::new("libOSMesa.so.8").unwrap();
                let get_current = library
                    .get::<unsafe extern "C" fn() -> *const c_void>(b"OSMesaGetCurrentContext")
                    .unwrap();
                get_current()
            };
            !current.is_null()
        }
    }
}

#[test]
fn no_context_is_left_current() {
    for backend in BACKENDS {
        let Some(mut offscreen) = open(backend, 5) else {
            continue;
        };
        assert!(!is_any_current(backend), "{}: opened", backend.name());
        offscreen.show(&image(5, scattered(0))).unwrap();
        assert!(!is_any_current(backend), "{}: shown", backend.name());
        offscreen.show(&image(6, scattered(0))).unwrap_err();
        assert!(!is_any_current(backend), "{}: refused", backend.name());
        drop(offscreen);
        assert!(!is_any_current(backend), "{}: dropped", backend.name());
        Offscreen::open(backend, 0).err().unwrap();
        assert!(!is_any_current(backend), "{}: not opened", backend.name());
    }
}

#[test]
fn a_picture_of_another_size_is_refused_and_the_next_one_is_not() {
    for backend in BACKENDS {
        let Some(mut offscreen) = open(backend, 5) else {
            continue;
        };
        for size in [4, 6] {
            match offscreen.show(&image(size, scattered(0))) {
                Err(ScreenError::Size { image, screen }) => {
                    assert_eq!((image, screen), (UVec2::splat(size), UVec2::splat(5)));
                }
                other => panic!("{}: {other:?}", backend.name()),
            }
        }
        let picture = image(5, scattered(0));
        let shown = offscreen.show(&picture).unwrap();
        assert_same_bits(&shown, &picture, backend.name());
    }
}

#[test]
fn a_size_that_no_picture_has_is_refused() {
    for backend in BACKENDS {
        if open(backend, 1).is_none() {
            continue;
        }
        for size in [0, 16_385, u32::MAX] {
            let error = Offscreen::open(backend, size).err().unwrap();
            assert!(matches!(error, ScreenError::Image(_)), "{error}");
        }
    }
}
