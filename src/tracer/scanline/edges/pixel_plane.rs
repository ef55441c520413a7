//! Where eye rays meet a plane, as a linear function of the pixel.

use crate::number::Bounded;
use crate::scene::Support;
use crate::tracer::vector::Vector;

/// The points at which eye rays meet a plane: `origin` + X · `per_x` + Y · `per_y`.
pub(crate) struct PixelPlane {
    pub(crate) origin: Vector<Bounded>,
    pub(crate) per_x: Vector<Bounded>,
    pub(crate) per_y: Vector<Bounded>,
    /// The support of the plane, if rays leave it.
    pub(crate) support: Option<Support>,
}
