//! Code 3-1 and 3-2: where a line meets a sphere, a triangle, a tetrahedron, the surface.

use glam::{DVec3, dvec3};

use super::unit::get_unit;
use crate::scene::{Sphere, Surface};

/// A face of a tetrahedron, its vertices counter-clockwise as seen from where `normal` points.
pub(super) struct Triangle {
    ver1: DVec3,
    ver2: DVec3,
    ver3: DVec3,
    pub(super) normal: DVec3,
}

impl Triangle {
    pub(super) fn new(ver1: DVec3, ver2: DVec3, ver3: DVec3) -> Triangle {
        let normal = get_unit((ver2 - ver1).cross(ver3 - ver1));
        Triangle {
            ver1,
            ver2,
            ver3,
            normal,
        }
    }
}

/// Code 3-1. `None` is the document's `IntSphere=false`.
pub(super) fn get_inter_point_sphere(pixel: DVec3, dir: DVec3, s: &Sphere) -> Option<DVec3> {
    let mut temp1 = dir.dot(pixel - s.center); // d*(e-c)
    temp1 *= temp1;
    let mut temp2 = dir.dot(dir) * ((pixel - s.center).dot(pixel - s.center) - s.radius * s.radius); // (d*d)((e-c)(e-c)-R2)
    if (temp1 - temp2) < 0.0 {
        None
    } else {
        temp1 = (temp1 - temp2).sqrt();
        temp2 = -dir.dot(pixel - s.center); // -d(e-c)
        let t1 = (temp2 + temp1) / dir.dot(dir);
        let t2 = (temp2 - temp1) / dir.dot(dir); // equation 3-1
        // Slip (Code 3-1): the first hit is the first point along the ray. Here it is the point
        // that is nearer to the pixel, on whichever side of it; a sphere behind the origin of a
        // mirrored or shadow ray (t < 0) is met too.
        let t = if t1.abs() > t2.abs() { t2 } else { t1 };
        Some(pixel + t * dir) // e+td
    }
}

/// Code 3-2, one face. `int_triangle` is the document's global, which this only ever sets.
fn get_inter_point_triangle(
    pixel: DVec3,
    dir: DVec3,
    t: &Triangle,
    int_triangle: &mut bool,
) -> DVec3 {
    let mut result = DVec3::ZERO;
    // Slip (Code 3-2): a line that runs along the face is divided by 0. The point becomes a NaN, of
    // which no comparison holds, so the face is missed. And nothing asks for t > 0 here either.
    let t1 = (t.ver1 - pixel).dot(t.normal) / dir.dot(t.normal); // equation 3-2
    let ab = t.ver2 - t.ver1;
    let bc = t.ver3 - t.ver2;
    let ca = t.ver1 - t.ver3;
    let temp = pixel + t1 * dir; // p+td
    // Slip (Code 3-2): a face owns its edges, but these tests, like Equation 3-3, are strict. A
    // line through the edge between two faces hits neither of them.
    if ab.cross(temp - t.ver1).dot(t.normal) > 0.0
        && bc.cross(temp - t.ver2).dot(t.normal) > 0.0
        && ca.cross(temp - t.ver3).dot(t.normal) > 0.0
    // equation 3-3
    {
        *int_triangle = true;
        result = temp;
    }
    result
}

/// Code 3-2. The point and the number of its face, from 0, where the document counts
/// `IntTriangle_No` from 1; `None` is its `IntTetrahedron=false`.
pub(super) fn get_inter_point_tetrahedron(
    pixel: DVec3,
    dir: DVec3,
    t: &[Triangle; 4],
) -> Option<(DVec3, usize)> {
    let mut result = DVec3::ZERO;
    let mut int_triangle_no = None;
    // Slip (Code 3-2): only the first triangle sets the distance that the others must fall below,
    // so where it is missed they are compared with whatever stood there before. That is 0 here, and
    // nothing is nearer: only lines through the first triangle, from either side, meet the
    // tetrahedron at all.
    let mut distance = 0.0;
    // Slip (Code 3-2): no line makes the flag false again for the next triangle. Once one is hit,
    // each one after it counts as hit too, and where it is missed, at the point that
    // GetInterPoint_Triangle's result starts with: the origin.
    let mut int_triangle = false;
    for (no, triangle) in t.iter().enumerate() {
        let result_temp = get_inter_point_triangle(pixel, dir, triangle, &mut int_triangle);
        if int_triangle {
            let distance_temp = pixel.distance(result_temp);
            if no == 0 || distance_temp < distance {
                result = result_temp;
                distance = distance_temp;
                int_triangle_no = Some(no);
            }
        }
    }
    int_triangle_no.map(|no| (result, no))
}

/// The document names this function and does not print it: Equation 3-2 for a level plane, and the
/// square's border.
pub(super) fn get_inter_point_surface(pixel: DVec3, dir: DVec3, sur: &Surface) -> Option<DVec3> {
    let t = (sur.height - pixel.y) / dir.y;
    let (x, z) = (pixel.x + t * dir.x, pixel.z + t * dir.z);
    let contains = x.abs() <= sur.half_width && z.abs() <= sur.half_width;
    contains.then_some(dvec3(x, sur.height, z))
}
