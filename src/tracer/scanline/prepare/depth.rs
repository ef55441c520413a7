//! The parameter at which eye rays enter a solid, bounded over parts of the screen.

use crate::number::rounding::{INFLATION, U};
use crate::number::{Bounded, Real};
use crate::scene::Support;
use crate::tracer::half_space::HalfSpace;
use crate::tracer::scanline::edges::ellipse::{Ellipse, RowOffset};
use crate::tracer::scanline::edges::pixel_plane::{PixelPlane, screen_origin};
use crate::tracer::scanline::grid::Grid;
use crate::tracer::vector::Vector;
use crate::tracer::view_space::{EYE_SQUARED, EYE_Y, along_eye_ray, eye_direction};

/// The parameter at which eye rays enter a solid.
pub(crate) enum Depth<'f> {
    /// along/109 − s/√109, with along = (c − o)·d, and s² = R² − m² − q² as in `shade/sphere.rs`.
    Sphere {
        /// m of each row.
        m: RowOffset,
        /// R².
        squared_radius: f64,
        /// c_x.
        center_x: f64,
        /// (c − o)·d as a linear function of Y: its constant and its slope.
        along: [f64; 2],
        /// A bound on the error of the depth, without that of s².
        error: f64,
        /// A bound on the error of s².
        squared_error: f64,
        support: Support,
    },
    /// The largest depth of all front faces: eye rays enter the solid where they enter the last.
    FrontFaces(&'f [FaceDepth]),
}

/// The parameter at which eye rays meet the plane of a face: constant + per_x · X + per_y · Y.
pub(crate) struct FaceDepth {
    constant: f64,
    per_x: f64,
    per_y: f64,
    /// A bound on the error anywhere on the screen.
    error: f64,
    /// The plane.
    support: Option<Support>,
}

/// A rectangle of the screen: an interval of X and one of Y, whose ends are included.
#[derive(Clone, Copy)]
pub(crate) struct Rectangle {
    pub(crate) x: [f64; 2],
    pub(crate) y: [f64; 2],
}

/// An interval of depths; an end that is not a number says nothing.
fn bounds(lower: f64, upper: f64) -> (f64, f64) {
    if lower.is_nan() || upper.is_nan() {
        (f64::NEG_INFINITY, f64::INFINITY)
    } else {
        (lower, upper)
    }
}

/// The smallest and the largest |x| in an interval.
fn magnitudes([a, b]: [f64; 2]) -> [f64; 2] {
    let (low, high) = (a.abs().min(b.abs()), a.abs().max(b.abs()));
    [if a * b <= 0.0 { 0.0 } else { low }, high]
}

impl FaceDepth {
    /// The depth of the plane of a face.
    pub(crate) fn new(face: &HalfSpace<Bounded>, grid: Grid) -> Self {
        let depths = depths(face, grid);
        let sum = |of: &dyn Fn(&Bounded) -> f64| -> f64 {
            let factors = [1.0, grid.max, grid.max];
            let terms = depths.iter().zip(factors);
            terms.map(|(depth, factor)| of(depth) * factor).sum()
        };
        let (magnitudes, errors) = (
            sum(&|depth| depth.value().abs()),
            sum(&|depth| depth.error()),
        );
        let [constant, per_x, per_y] = depths.map(Bounded::value);
        FaceDepth {
            constant,
            per_x,
            per_y,
            error: (errors + 8.0 * U * magnitudes) * INFLATION,
            support: face.support,
        }
    }

    /// Bounds on the depth in a rectangle.
    pub(crate) fn bounds(&self, Rectangle { x, y }: Rectangle) -> (f64, f64) {
        // Rounding keeps order: the extremes of a linear function are at corners.
        let [left, right] = x.map(|x| self.constant + self.per_x * x);
        let [low, high] = y.map(|y| self.per_y * y);
        bounds(
            left.min(right) + low.min(high) - self.error,
            left.max(right) + low.max(high) + self.error,
        )
    }
}

impl Depth<'_> {
    /// Bounds on the depth in a rectangle; `front_face` is the one that is seen there, if known.
    pub(crate) fn bounds(&self, front_face: Option<usize>, rectangle: Rectangle) -> (f64, f64) {
        match self {
            Depth::Sphere {
                m,
                squared_radius,
                center_x,
                along,
                error,
                squared_error,
                ..
            } => {
                let m = magnitudes(rectangle.y.map(|y| m.at(y)));
                let q = magnitudes(rectangle.x.map(|x| x - center_x));
                let squared = |end: usize| (squared_radius - m[end] * m[end]) - q[end] * q[end];
                let min_s = (squared(1) - squared_error).max(0.0).sqrt();
                let max_s = (squared(0) + squared_error).max(0.0).sqrt() * INFLATION;
                // 1/√109, from below and from above.
                const ROOT: f64 = 0.095_782_628_522_115_14;
                let [low, high] = rectangle.y.map(|y| (along[0] + along[1] * y) / EYE_SQUARED);
                bounds(
                    low - max_s * ROOT * INFLATION - error,
                    high - min_s * ROOT / INFLATION / INFLATION + error,
                )
            }
            Depth::FrontFaces(front_faces) => {
                match front_face.and_then(|front_face| front_faces.get(front_face)) {
                    Some(front_face) => front_face.bounds(rectangle),
                    None => front_faces.iter().fold(
                        (f64::NEG_INFINITY, f64::NEG_INFINITY),
                        |(low, high), front_face| {
                            let (lower, upper) = front_face.bounds(rectangle);
                            (low.max(lower), high.max(upper))
                        },
                    ),
                }
            }
        }
    }

    /// The front face that is seen in all of a rectangle, if the bounds tell: the one entered last.
    pub(crate) fn front_face(&self, rectangle: Rectangle) -> Option<usize> {
        let Depth::FrontFaces(front_faces) = self else {
            return None;
        };
        let bounds = |face: usize| front_faces[face].bounds(rectangle);
        (0..front_faces.len()).find(|&face| {
            let mut others = (0..front_faces.len()).filter(|other| *other != face);
            others.all(|other| bounds(other).1 < bounds(face).0)
        })
    }

    /// The sphere, or the plane of a front face: solids of one support have the same depth there.
    pub(crate) fn support(&self, front_face: Option<usize>) -> Option<Support> {
        match self {
            Depth::Sphere { support, .. } => Some(*support),
            Depth::FrontFaces(front_faces) => front_faces.get(front_face?)?.support,
        }
    }

    /// The depth of a sphere with this outline.
    pub(crate) fn of_sphere(
        center: Vector<Bounded>,
        outline: &Ellipse,
        support: Support,
        grid: Grid,
    ) -> Depth<'static> {
        let constant = along_eye_ray(center, grid.half);
        let magnitude = constant.value().abs() + EYE_Y * grid.max;
        let q = center.x.error() + 2.0 * U * (center.x.value().abs() + grid.max);
        let radius = outline.squared_radius.max(0.0).sqrt() * INFLATION;
        let max_q = radius + q;
        Depth::Sphere {
            m: outline.m,
            squared_radius: outline.squared_radius,
            center_x: center.x.value(),
            along: [constant.value(), EYE_Y],
            error: (constant.error() + 8.0 * U * (magnitude + radius)) * INFLATION,
            squared_error: (outline.chord_error + (2.0 * max_q + q) * q + 8.0 * U * max_q * max_q)
                * INFLATION,
            support,
        }
    }
}

/// The parameter at which eye rays meet the plane of a face: at X = Y = 0, and its change per X and
/// per Y.
fn depths(face: &HalfSpace<Bounded>, grid: Grid) -> [Bounded; 3] {
    // t = −n·(o − a)/(n·d), linear in o.
    let n = face.normal;
    let n_dot_d = n.dot(eye_direction::<Bounded>().vector);
    let constant = n.dot(screen_origin(grid) - face.at);
    [constant, n.x, n.y].map(|term| -(term / n_dot_d))
}

/// The points of the plane of a face that eye rays enter.
pub(crate) fn face_plane(face: &HalfSpace<Bounded>, grid: Grid) -> PixelPlane {
    let d = eye_direction::<Bounded>().vector;
    let [zero, one] = [0.0, 1.0].map(Bounded::exact);
    let depths = depths(face, grid);
    PixelPlane {
        origin: screen_origin(grid) + d * depths[0],
        per_x: Vector::new(one, zero, zero) + d * depths[1],
        per_y: Vector::new(zero, one, zero) + d * depths[2],
        support: face.support,
    }
}
