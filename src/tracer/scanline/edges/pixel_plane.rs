//! Where eye rays meet a plane, as a linear function of the pixel.

use crate::number::{Bounded, Real};
use crate::scene::Support;
use crate::tracer::scanline::grid::Grid;
use crate::tracer::vector::Vector;

/// The points at which eye rays meet a plane: `origin` + X · `per_x` + Y · `per_y`.
pub(crate) struct PixelPlane {
    pub(crate) origin: Vector<Bounded>,
    pub(crate) per_x: Vector<Bounded>,
    pub(crate) per_y: Vector<Bounded>,
    /// The support of the plane, if rays leave it.
    pub(crate) support: Option<Support>,
}

/// Where eye rays begin at X = Y = 0: others begin at this point plus (X, Y, 0).
pub(crate) fn screen_origin(grid: Grid) -> Vector<Bounded> {
    let [zero, z] = [0.0, grid.max].map(Bounded::exact);
    Vector::new(zero, zero, z)
}
