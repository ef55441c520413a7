//! The certified shader alone, against the pixels' own definition.

use std::cell::OnceCell;

use fearless_simd::{Level, dispatch};

use crate::stage::Stage;
use crate::tracer::decision::Decision;
use crate::tracer::pixel::Pixel;
use crate::tracer::scanline::RowTracer;
use crate::tracer::scanline::prepare::solids::Appearance;
use crate::tracer::scanline::shade::columns::SphereCache;
use crate::tracer::scanline::shade::policy::Certified;
use crate::tracer::scanline::shade::run::{Run, RunColumns, shade};
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::tests::{NOT_CROWDED, each_frame, lit, with_tracer};

const SIZE: u32 = 70;

/// Pixels that see a sphere: those that the shader is certain of, and those in doubt.
#[derive(Default)]
struct Counts {
    certain: usize,
    in_doubt: usize,
    /// Casters whose shadow certainly misses a row.
    missing: usize,
}

/// Shades all of a sphere, hidden or not, by its columns or pixel by pixel: each row with all
/// casters, and with those that may cast a shadow on the row's box. Certain samples are compared
/// with those of pixels that show the sphere. `pixels` keeps what each pixel shows.
fn check(
    tracer: &RowTracer<'_>,
    pixels: &[OnceCell<Pixel>],
    shaded: &ShadedSphere<'_>,
    by_columns: bool,
    (level, name): (Level, &str),
    counts: &mut Counts,
) {
    let frame = &tracer.frame;
    let mut cache = SphereCache::default();
    cache.begin(frame.shaded_spheres);
    let rows = (0..SIZE).flat_map(|row| [(row, false), (row, true)]);
    for (row, only_near) in rows {
        let columns = cache.of(shaded, row, level, frame.grid);
        let (mut from, mut to) = columns.shadeable;
        if from == to {
            continue;
        }
        if !by_columns {
            // Pixels beyond the zones, and beyond the sphere, are in doubt.
            (from, to) = (from.saturating_sub(1), (to + 1).min(SIZE));
        }
        let count = (to - from) as usize;
        // What follows the run stays as it is.
        let after = 3 * (row as usize % 20);
        let mut samples = vec![2.0; 3 * count + after];
        let mut decisions = vec![Decision::Background; count];
        let mut doubts = Vec::new();
        let x = [from, to - 1].map(|column| frame.grid.coordinate(column));
        let y = frame.grid.coordinate(row);
        let hits = shaded.constants.hit_box((x[0], x[1]), (y, y));
        let casters = shaded.casters.iter().enumerate();
        let casters: Vec<_> = casters
            .filter(|(_, caster)| !only_near || !caster.misses(shaded.constants.lighting, &hits))
            .map(|(number, _)| number)
            .collect();
        counts.missing += shaded.casters.len() - casters.len();
        let mut run = Run {
            grid: frame.grid,
            y,
            from,
            count,
            columns: by_columns.then_some(RunColumns {
                zones: columns.zones,
                bright: columns.bright,
            }),
            is_facing: !shaded.constants.has_shadows,
            casters: only_near.then_some(&casters),
            samples: &mut samples,
            decisions: Some(&mut decisions),
            doubts: &mut doubts,
        };
        dispatch!(level, simd => shade::<_, Certified>(simd, shaded, &mut run));
        assert!(samples[3 * count..].iter().all(|&sample| sample == 2.0));
        for (column, (samples, decided)) in (from..).zip(samples.chunks(3).zip(decisions)) {
            let pixel = || tracer.pixels.pixel(column, row).0;
            let (decision, color) = *pixels[(row * SIZE + column) as usize].get_or_init(pixel);
            if lit(decision) != shaded.in_light {
                continue;
            }
            if doubts.contains(&column) {
                counts.in_doubt += 1;
                continue;
            }
            assert_eq!(
                (decided, samples),
                (decision, &color[..]),
                "{name}, {level:?}, ({column}, {row})"
            );
            counts.certain += 1;
        }
    }
}

#[test]
fn what_is_certain_is_what_pixels_are_defined_to_show() {
    let levels = [Level::baseline(), Level::new()];
    let mut counts = <[[Counts; 2]; 2]>::default();
    each_frame(SIZE, |name, tracer| {
        let pixels = vec![OnceCell::new(); (SIZE * SIZE) as usize];
        for mirrored in [false, true] {
            let solids = tracer.frame.solids(mirrored);
            if solids.mirrored != mirrored {
                continue;
            }
            for appearance in solids.appearance {
                let Appearance::Sphere(shaded) = appearance else {
                    continue;
                };
                for (level, counts) in levels.into_iter().zip(&mut counts) {
                    for by_columns in [true, false] {
                        let counts = &mut counts[usize::from(by_columns)];
                        check(tracer, &pixels, shaded, by_columns, (level, name), counts);
                    }
                }
            }
        }
    });
    // A shader that is certain of nothing would pass, too.
    for Counts {
        certain,
        in_doubt,
        missing,
    } in counts.into_iter().flatten()
    {
        assert!(
            certain > 1000 && in_doubt < certain / 50,
            "{certain}, {in_doubt}"
        );
        assert!(missing > 1000, "{missing}");
    }
}

#[test]
fn a_channel_that_a_sphere_does_not_have_is_certain() {
    for color in ["1.0, 0.0, 0.0", "0.0, 1.0, 1.0", "0.0, 0.0, 0.0"] {
        let scene =
            format!("[[sphere]]\ncenter = [0.125, 0.0, 0.0]\nradius = 0.75\ncolor = [{color}]\n");
        let frame = (Stage::Shadow, 0.3, SIZE);
        let mut counts = Counts::default();
        with_tracer(&scene, frame, NOT_CROWDED, |tracer| {
            let pixels = vec![OnceCell::new(); (SIZE * SIZE) as usize];
            for appearance in tracer.frame.solids(false).appearance {
                if let Appearance::Sphere(shaded) = appearance {
                    let level = (Level::new(), color);
                    check(tracer, &pixels, shaded, true, level, &mut counts);
                }
            }
        });
        let Counts {
            certain, in_doubt, ..
        } = counts;
        assert!(
            certain > 1000 && in_doubt < certain / 50,
            "{color}: {certain}, {in_doubt}"
        );
    }
}
