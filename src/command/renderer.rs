//! What makes the pictures of a command: a kernel, or another program.

use firsthit::program::Program;
use firsthit::tracer::Progress;
use firsthit::{Image, Scene, Stage, Tracer};

use super::Failure;
use super::arguments::{PictureArguments, ProgramArguments};

/// A kernel's tracer, or the program of `--program`.
pub(crate) enum Renderer {
    Kernel(Tracer),
    Program {
        program: Box<Program>,
        /// How many samples of its pictures are NaNs.
        nans: usize,
        /// How many are infinities.
        infinities: usize,
    },
}

impl Renderer {
    pub(crate) fn new(
        picture: &PictureArguments,
        program: &ProgramArguments,
    ) -> Result<Renderer, Failure> {
        Ok(match program.start()? {
            Some(program) => Renderer::Program {
                program: Box::new(program),
                nans: 0,
                infinities: 0,
            },
            None => Renderer::Kernel(Tracer::new(
                picture.kernel.unwrap_or_default(),
                picture.threads(),
            )?),
        })
    }

    pub(crate) fn make(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
    ) -> Result<(), Failure> {
        match self {
            Renderer::Kernel(tracer) => tracer.trace(scene, stage, alpha, image)?,
            Renderer::Program {
                program,
                nans,
                infinities,
            } => {
                program.ask(scene, stage, alpha, image)?;
                let count =
                    |is: fn(f32) -> bool| image.samples().iter().filter(|s| is(**s)).count();
                *nans += count(f32::is_nan);
                *infinities += count(f32::is_infinite);
            }
        }
        Ok(())
    }

    /// How far a tracer is with its picture; of a program that is not known.
    pub(crate) fn progress(&self) -> Option<Progress> {
        match self {
            Renderer::Kernel(tracer) => Some(tracer.progress()),
            Renderer::Program { .. } => None,
        }
    }

    /// Ends the program, which must not have written more than its pictures.
    pub(crate) fn finish(&mut self) -> Result<(), Failure> {
        match self {
            Renderer::Kernel(_) => Ok(()),
            Renderer::Program { program, .. } => Ok(program.finish()?),
        }
    }

    /// How many samples of the program's pictures are not finite, if any.
    pub(crate) fn note(&self) -> Option<String> {
        match self {
            Renderer::Program {
                program,
                nans,
                infinities,
            } if nans + infinities > 0 => Some(format!(
                "{}: samples that are no numbers: {nans} NaN, {infinities} infinite: an EXR file keeps them, a PNG shows NaN as 0",
                program.name()
            )),
            _ => None,
        }
    }
}
