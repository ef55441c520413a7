//! Renderers that are none of the kernels: one picture of each frame, timed, and what is wrong with
//! it.

use std::collections::BTreeSet;
use std::time::Instant;

use super::measure::{Filler, Spread};
use crate::diagnosis::{Examination, ExaminationError, Hint, Summary};
use crate::difference::Difference;
use crate::{Image, Render, Scene, Stage};

/// A renderer on a scene in a stage.
#[derive(Clone, Debug)]
pub(super) struct RendererRow {
    /// The scene's name.
    pub(super) scene: String,
    pub(super) stage: Stage,
    /// What the renderer is called.
    pub(super) renderer: String,
    /// What was measured, or why a picture is missing.
    pub(super) measured: Result<Measured, String>,
}

/// Times and errors, over all frames.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    /// Milliseconds a frame.
    pub(super) ms: Spread,
    /// Milliseconds to fill the picture with one colour, after each frame.
    pub(super) fill_ms: Spread,
    /// The time of a frame by that of filling.
    pub(super) fill_ratio: Spread,
    /// What is wrong with the pixels.
    pub(super) summary: Summary,
    /// How far all samples are from the true ones.
    pub(super) difference: Difference,
    /// The mistakes that explain a frame.
    pub(super) hints: BTreeSet<Hint>,
}

/// What is measured on: a scene, a stage, the angles of the frames.
pub(super) struct Frames<'a> {
    /// The scene's name.
    pub(super) name: &'a str,
    pub(super) scene: &'a Scene,
    pub(super) stage: Stage,
    pub(super) angles: &'a [f64],
    /// How far a sample may be from the one that a decision gives.
    pub(super) tolerance: f32,
    /// Threads that trace the truth.
    pub(super) threads: usize,
}

/// The names of renderers; the second one of a name gets a (2), and so on.
pub(super) fn names(renderers: &[&mut dyn Render]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (number, renderer) in renderers.iter().enumerate() {
        let name = renderer.name();
        let before = renderers[..number].iter();
        let same = before.filter(|other| other.name() == name).count();
        names.push(match same {
            0 => name.to_owned(),
            same => format!("{name} ({})", same + 1),
        });
    }
    names
}

/// Measures `renderer`, which goes by a name, and calls `next` before each frame.
pub(super) fn measure(
    (renderer, name): (&mut (impl Render + ?Sized), &str),
    frames: &Frames<'_>,
    image: &mut Image,
    filler: &mut Filler,
    next: &mut dyn FnMut(&str),
) -> Result<RendererRow, ExaminationError> {
    let of_this = format!("{}, {name}", frames.name);
    let (mut ms, mut fill_ms, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    let (mut summary, mut difference) = (Summary::default(), Difference::default());
    let (mut hints, mut failure) = (BTreeSet::new(), None);
    for &alpha in frames.angles {
        next(&of_this);
        let start = Instant::now();
        if let Err(error) = renderer.render(frames.scene, frames.stage, alpha, image) {
            failure = Some(error.to_string());
            break;
        }
        // A clock that stood still must not make a ratio infinite.
        let time = start.elapsed().as_secs_f64().max(1e-9);
        let examination = Examination::new(
            frames.scene,
            frames.stage,
            alpha,
            image,
            frames.tolerance,
            frames.threads,
        )?;
        let diagnosis = examination.diagnosis()?;
        summary = summary.and(&diagnosis.summary);
        hints.extend(examination.hints(&diagnosis));
        let pairs = image.samples().iter().zip(examination.truth().samples());
        pairs.for_each(|(&sample, &truth)| difference.add(sample, truth));
        let fill = filler.seconds(image);
        ms.push(1e3 * time);
        fill_ms.push(1e3 * fill);
        ratios.push(time / fill);
    }
    let measured = match (failure, [ms, fill_ms, ratios].map(Spread::of)) {
        (None, [Some(ms), Some(fill_ms), Some(fill_ratio)]) => Ok(Measured {
            ms,
            fill_ms,
            fill_ratio,
            summary,
            difference,
            hints,
        }),
        (failure, _) => Err(failure.unwrap_or_else(|| "no frame".to_owned())),
    };
    Ok(RendererRow {
        scene: frames.name.to_owned(),
        stage: frames.stage,
        renderer: name.to_owned(),
        measured,
    })
}
