//! Points of a plane that pixels stand for.

use crate::number::Bounded;
use crate::scene::Support;
use crate::tracer::vector::Vector;

/// Points that the pixels' rays reach on a plane: `origin` + X · `per_column` + Y · `per_row`.
pub(crate) struct PixelPlane {
    pub(crate) origin: Vector<Bounded>,
    pub(crate) per_column: Vector<Bounded>,
    pub(crate) per_row: Vector<Bounded>,
    /// The plane, if rays leave it.
    pub(crate) plane: Option<Support>,
}
