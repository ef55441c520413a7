//! Where eye rays meet a plane, as a linear function of the pixel.

use crate::number::Bounded;
use crate::scene::Support;
use crate::tracer::vector::Vector;

/// The points at which eye rays meet a plane: `origin` + X · `per_column` + Y · `per_row`.
pub(crate) struct PixelPlane {
    pub(crate) origin: Vector<Bounded>,
    pub(crate) per_column: Vector<Bounded>,
    pub(crate) per_row: Vector<Bounded>,
    /// The support of the plane, if rays leave it.
    pub(crate) plane: Option<Support>,
}
