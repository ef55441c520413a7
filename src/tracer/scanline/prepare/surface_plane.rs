//! The surface's plane and square, as linear functions of X and Y.
//!
//! They follow from `ViewTransform::on_surface`: an eye ray meets the plane at t = Y/3 − (N/2) ·
//! height, where x is X and z is 3N/2 − 10 t.

use bumpalo::Bump;

use crate::number::rounding::{INFLATION, U};
use crate::number::{Bounded, Real};
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::edges::pixel_plane::PixelPlane;
use crate::tracer::scanline::grid::Grid;
use crate::tracer::surface::Surface;
use crate::tracer::vector::Vector;
use crate::tracer::view_space::{EYE_Y, EYE_Z};

/// The points at which eye rays meet the plane.
pub(crate) fn surface_plane(square: &Surface<Bounded>, grid: Grid) -> PixelPlane {
    let zero = Bounded::exact(0.0);
    let [one, three, ten] = [1.0, EYE_Y, EYE_Z].map(Bounded::exact);
    let z = Bounded::exact(grid.max) + ten * square.height_in_pixels;
    PixelPlane {
        origin: Vector::new(zero, square.height, z),
        per_x: Vector::new(one, zero, zero),
        per_y: Vector::new(zero, zero, -(ten * (one / three))),
        support: Some(square.support),
    }
}

/// The half-planes whose intersection is the square on the screen. `plane` is the surface's.
pub(crate) fn sides_on_screen<'f>(
    square: &Surface<Bounded>,
    plane: &PixelPlane,
    screen: (Grid, &'f Bump),
) -> [HalfPlane<'f>; 4] {
    // Scaled by 3, no coefficient is a third, which would round: at α = 0 a side of the square may
    // pass through all pixels of a row exactly.
    let [zero, three, ten] = [0.0, EYE_Y, EYE_Z].map(Bounded::exact);
    let scaled = [
        plane.origin * three,
        plane.per_x * three,
        Vector::new(zero, zero, -ten),
    ];
    let sides = square.sides(scaled, square.half_width * three);
    sides.map(|[constant, per_x, per_y]| HalfPlane::new(constant, per_x, per_y, true, screen))
}

/// The parameter at which eye rays meet the plane: constant + per_y · Y.
pub(crate) struct SurfaceDepth {
    constant: f64,
    per_y: f64,
    /// A bound on the error in any row.
    error: f64,
}

impl SurfaceDepth {
    pub(crate) fn new(square: &Surface<Bounded>, grid: Grid) -> Self {
        let height = square.height_in_pixels;
        // A third, its product with Y, and the sum round by u of what they give: the first two of
        // |Y|/3 ≤ N/2, the sum of no more than `magnitude`.
        let magnitude = height.value().abs() + grid.half;
        SurfaceDepth {
            constant: -height.value(),
            per_y: 1.0 / EYE_Y,
            error: (height.error() + 4.0 * U * magnitude) * INFLATION,
        }
    }

    /// Bounds on the parameter at Y.
    pub(crate) fn at(&self, y: f64) -> (f64, f64) {
        let depth = self.constant + self.per_y * y;
        (depth - self.error, depth + self.error)
    }
}
