//! Known mistakes as hypotheses: the picture of each mistake is compared with the given one.
//!
//! Pictures are compared in a sample of their pixels, spread evenly, so that a large picture and a
//! scene of many solids take no longer than others.

use std::f64::consts::PI;

use super::WrongDecision;
use super::fits::is_within;
use super::hint::Hint;
use super::verdict::Verdict;
use crate::Image;
use crate::scene::Scene;
use crate::stage::Stage;
use crate::tracer::{Decision, Far, Mistake, Mistaken, Toward, with_pixels};

/// The fewest pixels that can tell a hypothesis from the truth: fewer might agree by chance.
const MIN_TELLING: u32 = 16;

/// The least share of the telling pixels and of the wrong ones that must agree with a hypothesis.
/// All would, but people make a mistake in slightly different ways.
const MIN_SHARE: f64 = 0.9;

/// The most pixels of a sample: a border one pixel wide around a solid is hundreds of them.
const SAMPLE: usize = 1 << 15;

/// The most pixels of a sample, times solids, for shadow rays are tested against all solids: so
/// many tests take a fraction of a second.
const TESTS: usize = 1 << 22;

/// The number of wrong pixels after which a hypothesis is given up that explains less than half.
const GIVE_UP_AFTER: u32 = 64;

/// Pixels of a picture, each with what is given and what is true.
pub(super) struct Sample {
    pixels: Vec<Sampled>,
    tolerance: f32,
}

struct Sampled {
    at: (u32, u32),
    given: [f32; 3],
    truth: [f32; 3],
}

impl Sample {
    pub(super) fn new(given: &Image, truth: &Image, tolerance: f32, scene: &Scene) -> Sample {
        let solids = scene.solid_count();
        let (size, all) = (u64::from(given.size()), given.samples().len() / 3);
        let count = SAMPLE.min(TESTS / solids.max(1)).min(all);
        // A prime larger than any size is coprime with the number of pixels: no pixel comes twice.
        const STRIDE: u64 = 2_654_435_761;
        let pixels = (0..count as u64).filter_map(|number| {
            let index = number * STRIDE % (size * size);
            let at = ((index % size) as u32, (index / size) as u32);
            Some(Sampled {
                at,
                given: given.pixel(at.0, at.1)?,
                truth: truth.pixel(at.0, at.1)?,
            })
        });
        Sample {
            pixels: pixels.collect(),
            tolerance,
        }
    }

    /// The share of the pixels that are not as `hypothesis` has them; `None` where the hypothesis
    /// is rejected. `scale` is how large its samples are, compared with true ones.
    fn unlike(
        &self,
        scale: f32,
        hypothesis: impl Fn((u32, u32)) -> Option<[f32; 3]>,
    ) -> Option<f64> {
        let tolerance = self.tolerance * scale;
        let (mut telling, mut shown, mut wrong, mut explained) = (0, 0, 0, 0);
        let (mut all, mut unlike) = (0, 0);
        for pixel in &self.pixels {
            let Some(other) = hypothesis(pixel.at) else {
                continue;
            };
            let is_shown = is_within(tolerance, pixel.given, other);
            all += 1;
            unlike += u32::from(!is_shown);
            // A pixel that can tell: nothing is within the tolerance of both.
            if !is_within(2.0 * tolerance, other, pixel.truth) {
                telling += 1;
                shown += u32::from(is_shown);
            }
            if !is_within(self.tolerance, pixel.given, pixel.truth) {
                wrong += 1;
                explained += u32::from(is_shown);
            }
            if wrong >= GIVE_UP_AFTER && 2 * explained < wrong {
                return None;
            }
        }
        let is_most = |part: u32, of: u32| f64::from(part) >= MIN_SHARE * f64::from(of);
        let is_earned =
            telling >= MIN_TELLING && is_most(shown, telling) && is_most(explained, wrong);
        is_earned.then(|| f64::from(unlike) / f64::from(all))
    }
}

/// The hints at the known mistakes that explain the given picture of a frame best.
pub(super) fn hints_of_known_mistakes(
    frame: (&Scene, Stage, f64, u32),
    truth: &Image,
    sample: &Sample,
) -> Vec<Hint> {
    let mut earned: Vec<(Hint, f64)> = Vec::new();
    let mut test = |hint, scale, picture: &dyn Fn((u32, u32)) -> Option<[f32; 3]>| {
        if let Some(unlike) = sample.unlike(scale, picture) {
            earned.push((hint, unlike));
        }
    };
    test_rearrangements(truth, &mut test);
    test_geometries(frame, &mut test);
    test_shadings(frame, &mut test);
    let least = earned.iter().map(|(_, unlike)| *unlike);
    let least = least.fold(1.0, f64::min);
    let hints = earned.into_iter().filter(|(_, unlike)| *unlike <= least);
    let mut hints: Vec<Hint> = hints.map(|(hint, _)| hint).collect();
    hints.sort_unstable();
    hints.dedup();
    hints
}

/// Tests a hint by the picture that its mistake makes, given how large the samples of that picture
/// are, compared with true ones.
type Test<'t> = dyn FnMut(Hint, f32, &dyn Fn((u32, u32)) -> Option<[f32; 3]>) + 't;

/// Tests mistakes that rearrange or encode the true samples.
fn test_rearrangements(truth: &Image, test: &mut Test<'_>) {
    let at = |column, row| truth.pixel(column, row);
    let rows = truth.size();
    test(Hint::UpsideDown, 1.0, &|(x, y)| at(x, rows - 1 - y));
    // Where v has the wrong sign, row 0 shows what would be above the true picture.
    test(Hint::UpsideDown, 1.0, &|(x, y)| at(x, rows - y));
    test(Hint::Transposed, 1.0, &|(x, y)| at(y, x));
    test(Hint::Bgr, 1.0, &|(x, y)| {
        at(x, y).map(|[r, g, b]| [b, g, r])
    });
    const LARGEST_BYTE: f32 = 255.0;
    test(Hint::Bytes, LARGEST_BYTE, &|(x, y)| {
        Some(at(x, y)?.map(|sample| LARGEST_BYTE * sample))
    });
    for encode in [srgb, |sample: f64| libm::pow(sample, 1.0 / 2.2)] {
        test(Hint::Gamma, 1.0, &|(x, y)| {
            Some(at(x, y)?.map(|sample| encode(f64::from(sample)) as f32))
        });
    }
}

/// The transfer function of sRGB.
fn srgb(sample: f64) -> f64 {
    if sample <= 0.003_130_8 {
        12.92 * sample
    } else {
        1.055 * libm::pow(sample, 1.0 / 2.4) - 0.055
    }
}

/// Tests mistakes that turn the eye or move the pixels.
fn test_geometries((scene, stage, alpha, size): (&Scene, Stage, f64, u32), test: &mut Test<'_>) {
    // The middles of pixels are corners of pixels in a picture of twice the size.
    with_pixels((scene, stage, alpha, 2 * size), |twice| {
        test(Hint::HalfPixelOff, 1.0, &|(x, y)| {
            Some(twice(2 * x + 1, 2 * y + 1))
        });
    });
    for alpha in [alpha * PI / 180.0, alpha * 180.0 / PI] {
        if alpha.is_finite() {
            with_pixels((scene, stage, alpha, size), |turned| {
                test(Hint::Degrees, 1.0, &|(x, y)| Some(turned(x, y)));
            });
        }
    }
}

/// Tests mistakes in hits, shading and shadows.
fn test_shadings(frame: (&Scene, Stage, f64, u32), test: &mut Test<'_>) {
    let right = Mistake::default();
    let reversed = Mistake {
        shading_reversed: true,
        ..right
    };
    let away = Mistake {
        solids: Toward::Away,
        ..right
    };
    let either = Mistake {
        solids: Toward::Either,
        ..right
    };
    let mistakes = [
        (Hint::LightSign, reversed),
        // A wrong l may also serve for the surface's shadow on solids, or for all shadows.
        (
            Hint::LightSign,
            Mistake {
                surface: Toward::Away,
                ..reversed
            },
        ),
        (
            Hint::LightSign,
            Mistake {
                solids: Toward::Away,
                surface: Toward::Away,
                ..reversed
            },
        ),
        (Hint::ShadowDirection, away),
        (
            Hint::ShadowDirection,
            Mistake {
                surface: Toward::Away,
                ..away
            },
        ),
        (Hint::ShadowBehind, either),
        (
            Hint::ShadowBehind,
            Mistake {
                surface: Toward::Either,
                ..either
            },
        ),
        (
            Hint::ShadowBehind,
            Mistake {
                own_shadow: true,
                ..either
            },
        ),
        (
            Hint::FarRoot,
            Mistake {
                far: Far::Spheres,
                ..right
            },
        ),
        (
            Hint::FarRoot,
            Mistake {
                far: Far::All,
                ..right
            },
        ),
    ];
    Mistaken::with(frame, |mistaken| {
        for (hint, mistake) in mistakes {
            test(hint, 1.0, &|(x, y)| Some(mistaken.pixel(mistake, x, y)));
        }
    });
}

/// Shadow acne puts at least one in so many of its pixels between two right ones, mostly one in
/// three. Along the border of a misplaced shadow it is one in fifty.
const SCATTERED: u32 = 8;

/// Whether shadow is scattered over lit pixels.
pub(super) fn is_scattered_with_shadow(
    verdicts: &[Verdict],
    decisions: &[Decision],
    size: u32,
) -> bool {
    let size = size as usize;
    let is_shaded = |index: usize| match (verdicts.get(index), decisions.get(index)) {
        (Some(Verdict::Shows(decision)), Some(truth)) => {
            is_in_shadow(*decision)
                && WrongDecision::of(*decision, *truth) == Some(WrongDecision::Shadow)
        }
        _ => false,
    };
    let is_between = |index: usize| {
        let is_right = |other: Option<usize>| {
            other.is_some_and(|other| {
                decisions.get(other) == decisions.get(index)
                    && matches!(
                        verdicts.get(other),
                        Some(Verdict::Right | Verdict::Rounding)
                    )
            })
        };
        [1, size]
            .into_iter()
            .any(|step| is_right(index.checked_sub(step)) && is_right(index.checked_add(step)))
    };
    let (mut shaded, mut between) = (0, 0);
    for index in (0..decisions.len()).filter(|index| is_shaded(*index)) {
        shaded += 1;
        between += u32::from(is_between(index));
    }
    shaded >= MIN_TELLING && SCATTERED * between >= shaded
}

fn is_in_shadow(decision: Decision) -> bool {
    match decision {
        Decision::SurfaceInShadow => true,
        Decision::Solid(seen) => seen.in_shadow,
        _ => false,
    }
}
