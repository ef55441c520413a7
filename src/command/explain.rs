//! `firsthit explain`: one pixel, worked through.

use clap::Args;
use firsthit::diagnosis::{Examination, TOLERANCE};
use firsthit::{Image, Stage, Tracer};

use super::arguments::{AngleArguments, PictureArguments, ProgramArguments, stage, tolerance};
use super::{Failure, print};

#[derive(Args)]
pub(crate) struct Arguments {
    /// The pixel's column, counted from 0 at the left
    column: u32,
    /// The pixel's row, counted from 0 at the bottom
    row: u32,
    /// The stage, 1 to 7
    #[arg(long, value_name = "STAGE", value_parser = stage)]
    stage: Stage,
    #[command(flatten)]
    angle: AngleArguments,
    #[command(flatten)]
    picture: PictureArguments,
    #[command(flatten)]
    program: ProgramArguments,
    /// How far the program's sample may be from the true one, or from that of another decision;
    /// 1/255 if not given
    #[arg(long, value_name = "ABS", requires = "program", value_parser = tolerance)]
    tolerance: Option<f32>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (picture, stage) = (&arguments.picture, arguments.stage);
    let (scene, alpha) = (picture.scene()?, arguments.angle.alpha());
    let (column, row) = (arguments.column, arguments.row);
    let tracer = Tracer::new(picture.kernel.unwrap_or_default(), picture.threads())?;
    let mut text = String::new();
    if let Some(mut program) = arguments.program.start()? {
        let mut image = Image::new(picture.size)?;
        program.ask(&scene, stage, alpha, &mut image)?;
        program.finish()?;
        let tolerance = arguments.tolerance.unwrap_or(TOLERANCE);
        let threads = picture.threads();
        let examination = Examination::new(&scene, stage, alpha, &image, tolerance, threads)?;
        if let Some(pixel) = examination.pixel(column, row) {
            text += &pixel.to_string();
        }
        for hint in examination.hints(&examination.diagnosis()?) {
            text += &format!("{:<12} {hint}\n", "hint");
        }
    }
    text += &tracer.explain(&scene, stage, alpha, picture.size, (column, row))?;
    print(&text)
}
