//! Work on a frame in the arithmetic of a kernel.

use super::arena::Arena;
use super::error::TraceError;
use super::kernel::Kernel;
use super::ladder::{Ladder, Pixels, Plain, RowPixels, Rung};
use super::listing::Listing;
use super::scanline::Precision;
use crate::scene::Scene;
use crate::stage::Stage;

/// Work on a frame, generic over the arithmetic.
pub(super) trait FrameWork {
    type Output;

    /// Does the work for a kernel that traces rows. `arena` holds what lives as long as the frame.
    fn by_rows(self, pixels: &dyn RowPixels, precision: Precision, arena: &Arena) -> Self::Output;

    /// Does the work for a kernel that traces pixel by pixel.
    fn by_pixels(self, pixels: &impl Pixels) -> Self::Output;
}

/// Does `work` on a frame: a scene in a stage at an angle α, of N × N pixels.
///
/// # Errors
/// [`TraceError::Listing`] where the kernel is [`Kernel::Listing`] and the scene not of the
/// document's shape; then no work is done.
pub(super) fn with_frame<W: FrameWork>(
    kernel: Kernel,
    (scene, stage, alpha, size): (&Scene, Stage, f64, u32),
    arena: &Arena,
    work: W,
) -> Result<W::Output, TraceError> {
    let ladder = |lowest| Ladder::new(scene, stage, alpha, size, lowest, arena);
    Ok(match kernel {
        Kernel::Exact => work.by_rows(&ladder(Rung::Hardware), Precision::Certified, arena),
        Kernel::Fast => {
            let plain = Plain::<f32>::new(scene, stage, alpha, size, arena);
            work.by_rows(&plain, Precision::Single, arena)
        }
        Kernel::Double => {
            let plain = Plain::<f64>::new(scene, stage, alpha, size, arena);
            work.by_rows(&plain, Precision::Double, arena)
        }
        Kernel::Listing => work.by_pixels(&Listing::new(scene, stage, alpha, size)?),
        Kernel::Reference => work.by_pixels(&ladder(Rung::DoubleDouble)),
    })
}
