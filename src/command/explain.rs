//! `firsthit explain`: one pixel, worked through.

use clap::Args;
use firsthit::{Stage, Tracer};

use super::arguments::{AngleArguments, PictureArguments, stage};
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
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let picture = &arguments.picture;
    let tracer = Tracer::new(picture.kernel.unwrap_or_default(), picture.threads())?;
    let pixel = (arguments.column, arguments.row);
    let alpha = arguments.angle.alpha();
    print(&tracer.explain(
        &picture.scene()?,
        arguments.stage,
        alpha,
        picture.size,
        pixel,
    )?)
}
