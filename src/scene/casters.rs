//! Which solids can cast a shadow on which: most cannot, and turning the scene does not change
//! that.

use std::cmp::Ordering;

use glam::DVec3;

use super::bounding_ball::{BoundingBall, MARGIN, bounding_balls, each_overlapping_pair};
use super::{Sphere, Surface, Tetrahedron};

/// The casters of each sphere and each face: the solids that may stand between a point of it and
/// the light.
///
/// Hidden solids are neither casters nor receivers: their shadows lie within the shadows of the
/// solids that hide them, and no ray meets them first. Faces turned away from the light have no
/// casters: they are dark anyway.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Casters {
    on_spheres: Vec<Vec<u16>>,
    on_faces: Vec<[Vec<u16>; 4]>,
}

impl Casters {
    /// `facing_light` tells the sign of n·l for each face.
    pub(super) fn new(
        spheres: &[Sphere],
        tetrahedra: &[Tetrahedron],
        to_light: DVec3,
        hidden: &[bool],
        facing_light: &[[Ordering; 4]],
    ) -> Self {
        let balls = bounding_balls(spheres, tetrahedra);
        let l = to_light.normalize();
        let lit_faces = |(tetrahedron, facing): (&Tetrahedron, &[Ordering; 4])| {
            [0, 1, 2, 3].map(|k: usize| facing[k].is_gt().then(|| LitFace::new(tetrahedron, k, l)))
        };
        let faces: Vec<[Option<LitFace>; 4]> =
            tetrahedra.iter().zip(facing_light).map(lit_faces).collect();
        let mut casters = Casters {
            on_spheres: vec![Vec::new(); spheres.len()],
            on_faces: vec![Default::default(); tetrahedra.len()],
        };
        each_overlapping_pair(&balls, l.any_orthonormal_vector(), |a, b| {
            if hidden[a] || hidden[b] {
                return;
            }
            let BoundingBall { center, radius } = balls[a];
            let other = &balls[b];
            let between = other.center - center;
            let slack = (other.center.abs() + center.abs()).element_sum() * (MARGIN - 1.0);
            let touching = (other.radius + radius) * MARGIN + slack;
            if between.cross(l).length_squared() > touching * touching * MARGIN {
                return;
            }
            let ahead = between.dot(l);
            let pairs = [(a, b, ahead >= -touching), (b, a, ahead <= touching)];
            for (receiver, caster, may) in pairs {
                if !may {
                    continue;
                }
                match receiver.checked_sub(spheres.len()) {
                    None => casters.on_spheres[receiver].push(caster as u16),
                    Some(tetrahedron) => {
                        let lists = casters.on_faces[tetrahedron].iter_mut();
                        for (list, face) in lists.zip(&faces[tetrahedron]) {
                            if face
                                .as_ref()
                                .is_some_and(|face| face.may_be_shadowed_by(&balls[caster]))
                            {
                                list.push(caster as u16);
                            }
                        }
                    }
                }
            }
        });
        let on_faces = casters.on_faces.iter_mut().flatten();
        for list in casters.on_spheres.iter_mut().chain(on_faces) {
            list.sort_unstable();
        }
        casters
    }

    /// The casters of a sphere, or of a face of a tetrahedron.
    pub(crate) fn on(&self, solid: usize, face: Option<usize>) -> &[u16] {
        match (self.on_spheres.get(solid), face) {
            (Some(casters), _) => casters,
            (None, Some(face)) => &self.on_faces[solid - self.on_spheres.len()][face],
            (None, None) => &[],
        }
    }
}

/// A face that is turned to the light. Its casters reach into the prism that stands on the face and
/// extends toward the light.
struct LitFace {
    /// The planes of the prism: the face's own, and one along each of its edges. `None` where f64
    /// does not tell which side is inside.
    planes: [Option<PrismPlane>; 4],
}

/// A plane of a prism.
struct PrismPlane {
    at: DVec3,
    /// Out of the prism, of length `length`.
    normal: DVec3,
    length: f64,
    /// A bound on the error of `normal`.
    error: f64,
}

impl PrismPlane {
    /// The plane through `at` along two vectors, each of length 1 or the difference of two points
    /// at most `magnitude` from the origin; `inner` lies on the inner side. `None` where f64 does
    /// not tell which side that is.
    fn new(at: DVec3, [a, b]: [DVec3; 2], inner: DVec3, magnitude: f64) -> Option<Self> {
        let normal = a.cross(b);
        // A difference rounds by u of its points, which the product multiplies by the other factor;
        // a cross product rounds three times. 32 u of these magnitudes is more than the sum.
        let magnitudes =
            magnitude * (a.abs() + b.abs()).element_sum() + (a.length() + magnitude) * b.length();
        let error = 16.0 * f64::EPSILON * magnitudes;
        let plane = PrismPlane {
            at,
            length: normal.length() * MARGIN,
            normal,
            error,
        };
        let inside = plane.height(inner)?;
        Some(if inside > 0.0 { plane.flipped() } else { plane })
    }

    fn flipped(self) -> Self {
        PrismPlane {
            normal: -self.normal,
            ..self
        }
    }

    /// The height of a point above the plane, times `length`; `None` where its sign is in doubt.
    fn height(&self, point: DVec3) -> Option<f64> {
        let from = point - self.at;
        let height = self.normal.dot(from);
        (height.abs() > self.slack(point)).then_some(height)
    }

    fn slack(&self, point: DVec3) -> f64 {
        let magnitudes = (point.abs() + self.at.abs()).element_sum();
        (self.error + 8.0 * f64::EPSILON * self.length) * magnitudes * 2.0
    }

    /// Whether a ball certainly lies above the plane.
    fn is_outside(&self, ball: &BoundingBall) -> bool {
        let height = self.normal.dot(ball.center - self.at);
        height > ball.radius * MARGIN * (self.length + self.error) + self.slack(ball.center)
    }
}

impl LitFace {
    /// Face `k`, with `l` of length 1.
    fn new(tetrahedron: &Tetrahedron, k: usize, l: DVec3) -> Self {
        let v = tetrahedron.vertices;
        let [a, b, c] = [(k + 1) % 4, (k + 2) % 4, (k + 3) % 4].map(|i| v[i]);
        let magnitude = v.iter().map(|v| v.abs().element_sum()).fold(0.0, f64::max);
        let edge = |from: DVec3, to: DVec3, third: DVec3| {
            PrismPlane::new(from, [to - from, l], third, magnitude.max(1.0))
        };
        // The prism lies on the other side of the face than the solid.
        let own = PrismPlane::new(a, [b - a, c - a], v[k], magnitude).map(PrismPlane::flipped);
        LitFace {
            planes: [own, edge(a, b, c), edge(b, c, a), edge(c, a, b)],
        }
    }

    fn may_be_shadowed_by(&self, caster: &BoundingBall) -> bool {
        let mut planes = self.planes.iter().flatten();
        !planes.any(|plane| plane.is_outside(caster))
    }
}

/// Cells along a side of the surface.
const CELLS: usize = 32;

/// The casters of the surface, for each cell of a grid on it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SurfaceCasters {
    half_width: f64,
    /// For each cell, the index of its first caster in `casters`; then the length of `casters`.
    starts: Vec<u32>,
    casters: Vec<u16>,
    /// The casters of any cell.
    all: Vec<u16>,
}

/// Where the x or z of a point of the surface lies in the grid, counted in cells.
fn cell_at(x: f64, half_width: f64) -> f64 {
    (x / half_width + 1.0) / 2.0 * CELLS as f64
}

impl SurfaceCasters {
    /// The casters among the solids that are not hidden.
    pub(super) fn new(
        spheres: &[Sphere],
        tetrahedra: &[Tetrahedron],
        surface: &Surface,
        to_light: DVec3,
        hidden: &[bool],
    ) -> Self {
        let Surface {
            height, half_width, ..
        } = *surface;
        let l = to_light.normalize();
        // The cells that a solid's shadow may reach, and their neighbours: so `near` may take a
        // neighbour for the cell of a point.
        let cells = |ball: &BoundingBall| {
            let up = (ball.center.y - height) * l.y.signum();
            let slack = (ball.center.y.abs() + height.abs()) * (MARGIN - 1.0);
            if up < -(ball.radius * MARGIN + slack) {
                return None;
            }
            // The ball's shadow is an ellipse; half its length is the radius over the light's rise.
            let distance = (ball.center.y - height) / l.y;
            let middle = ball.center - l * distance;
            let magnitudes = ball.center.abs().element_sum() + distance.abs();
            let half = (ball.radius / l.y.abs()) * MARGIN + magnitudes * (MARGIN - 1.0);
            let ends = |middle: f64| {
                let [from, to] = [middle - half, middle + half].map(|x| cell_at(x, half_width));
                let (from, to) = (from - 2.0, to + 2.0);
                if from.is_nan() || to.is_nan() {
                    return 0..CELLS;
                }
                // Less than 0 converts to 0.
                (from as usize).min(CELLS)..(to.ceil() as usize).min(CELLS)
            };
            Some((ends(middle.x), ends(middle.z)))
        };
        let balls = bounding_balls(spheres, tetrahedra);
        let mut of_cells = vec![Vec::new(); CELLS * CELLS];
        let mut all = Vec::new();
        for (solid, ball) in balls
            .iter()
            .enumerate()
            .filter(|(solid, _)| !hidden[*solid])
        {
            if let Some((columns, rows)) = cells(ball)
                && !columns.is_empty()
                && !rows.is_empty()
            {
                all.push(solid as u16);
                for row in rows {
                    for column in columns.clone() {
                        of_cells[row * CELLS + column].push(solid as u16);
                    }
                }
            }
        }
        let mut starts = vec![0];
        let mut casters = Vec::new();
        for cell in of_cells {
            casters.extend(cell);
            starts.push(casters.len() as u32);
        }
        SurfaceCasters {
            half_width,
            starts,
            casters,
            all,
        }
    }

    /// The casters of all points.
    pub(crate) fn all(&self) -> &[u16] {
        &self.all
    }

    /// The casters of a point of the surface whose x and z lie between these bounds.
    pub(crate) fn near(&self, x: (f64, f64), z: (f64, f64)) -> &[u16] {
        let only_cell = |(from, to): (f64, f64)| {
            let [from, to] = [from, to].map(|x| cell_at(x, self.half_width));
            // The point is in this cell or in a neighbour.
            (to - from < 1.0).then(|| (from.max(0.0) as usize).min(CELLS - 1))
        };
        match (only_cell(x), only_cell(z)) {
            (Some(column), Some(row)) => {
                let cell = row * CELLS + column;
                &self.casters[self.starts[cell] as usize..self.starts[cell + 1] as usize]
            }
            _ => &self.all,
        }
    }
}
