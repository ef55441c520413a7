//! Which solids can throw a shadow on which: no turning of the scene changes that, and most cannot.

use std::cmp::Ordering;

use glam::DVec3;

use super::hull::{Hull, MORE, each_pair_along, hulls};
use super::{Sphere, Surface, Tetrahedron};

/// For each sphere and each face, the other solids that may stand between a point of it and the
/// light; all others certainly do not.
///
/// Hidden solids are left out: what these shade, what hides them does, and nobody sees a shadow on
/// them. So are faces turned away from the light.
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
        let hulls = hulls(spheres, tetrahedra);
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
        each_pair_along(&hulls, l.any_orthonormal_vector(), |a, b| {
            if hidden[a] || hidden[b] {
                return;
            }
            let Hull { center, radius } = hulls[a];
            let other = &hulls[b];
            let between = other.center - center;
            let slack = (other.center.abs() + center.abs()).element_sum() * (MORE - 1.0);
            let reach = (other.radius + radius) * MORE + slack;
            if between.cross(l).length_squared() > reach * reach * MORE {
                return;
            }
            let ahead = between.dot(l);
            let pairs = [(a, b, ahead >= -reach), (b, a, ahead <= reach)];
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
                                .is_some_and(|face| face.may_be_shaded_by(&hulls[caster]))
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

    /// Those on a sphere, or on a face of a tetrahedron.
    pub(crate) fn on(&self, solid: usize, face: Option<usize>) -> &[u16] {
        match (self.on_spheres.get(solid), face) {
            (Some(casters), _) => casters,
            (None, Some(face)) => &self.on_faces[solid - self.on_spheres.len()][face],
            (None, None) => &[],
        }
    }
}

/// A face that is turned to the light: what shades it is within these planes or crosses them.
struct LitFace {
    /// The face's own, and those of its edges along the way to the light: outward, but for the
    /// first.
    planes: [Option<OuterPlane>; 4],
}

/// A plane, of which a side holds nothing that matters.
struct OuterPlane {
    at: DVec3,
    /// Toward that side, of any length.
    way: DVec3,
    length: f64,
    /// A bound on the error of `way`.
    error: f64,
}

impl OuterPlane {
    /// The plane through `at` along two vectors, each the difference of two points that are no
    /// farther away than `reach`, or of length 1; `inner` lies on the side that matters. `None`
    /// where f64 does not tell which side that is.
    fn new(at: DVec3, [a, b]: [DVec3; 2], inner: DVec3, reach: f64) -> Option<Self> {
        let way = a.cross(b);
        // Each difference is off by u of its points, a product of two by that of either times the
        // other; a cross product rounds three times. 16 u of these magnitudes is more than that.
        let magnitudes =
            reach * (a.abs() + b.abs()).element_sum() + (a.length() + reach) * b.length();
        let error = 16.0 * f64::EPSILON * magnitudes;
        let plane = OuterPlane {
            at,
            length: way.length() * MORE,
            way,
            error,
        };
        let inside = plane.height(inner)?;
        Some(OuterPlane {
            way: if inside > 0.0 { -plane.way } else { plane.way },
            ..plane
        })
    }

    /// How far a point is on the outer side, times `length`; `None` where the sign of that is not
    /// certain.
    fn height(&self, point: DVec3) -> Option<f64> {
        let from = point - self.at;
        let height = self.way.dot(from);
        (height.abs() > self.slack(point)).then_some(height)
    }

    fn slack(&self, point: DVec3) -> f64 {
        let magnitudes = (point.abs() + self.at.abs()).element_sum();
        (self.error + 8.0 * f64::EPSILON * self.length) * magnitudes * 2.0
    }

    /// Whether all of a ball is on the outer side.
    fn is_outside(&self, ball: &Hull) -> bool {
        let height = self.way.dot(ball.center - self.at);
        height > ball.radius * MORE * (self.length + self.error) + self.slack(ball.center)
    }
}

impl LitFace {
    /// Face `k`, where `l` is the way to the light, of length 1.
    fn new(tetrahedron: &Tetrahedron, k: usize, l: DVec3) -> Self {
        let v = tetrahedron.vertices;
        let [a, b, c] = [(k + 1) % 4, (k + 2) % 4, (k + 3) % 4].map(|i| v[i]);
        let reach = v.iter().map(|v| v.abs().element_sum()).fold(0.0, f64::max);
        let edge = |from: DVec3, to: DVec3, third: DVec3| {
            OuterPlane::new(from, [to - from, l], third, reach.max(1.0))
        };
        // What shades a face lies on the other side of it than the solid does.
        let own = OuterPlane::new(a, [b - a, c - a], v[k], reach).map(|plane| OuterPlane {
            way: -plane.way,
            ..plane
        });
        LitFace {
            planes: [own, edge(a, b, c), edge(b, c, a), edge(c, a, b)],
        }
    }

    fn may_be_shaded_by(&self, caster: &Hull) -> bool {
        let mut planes = self.planes.iter().flatten();
        !planes.any(|plane| plane.is_outside(caster))
    }
}

/// Cells along a side of the surface.
const CELLS: usize = 32;

/// The solids that may throw a shadow on the surface, by where they may.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SurfaceCasters {
    half_width: f64,
    /// Where each cell's solids begin, and where the last one's end.
    starts: Vec<u32>,
    solids: Vec<u16>,
    /// Those of all cells.
    all: Vec<u16>,
}

impl SurfaceCasters {
    /// Of all solids but the hidden ones.
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
        // The cells that a solid may shade any point of, or of a neighbour: which cell a point is
        // in need not be known better than that.
        let cells = |hull: &Hull| {
            let up = (hull.center.y - height) * l.y.signum();
            let slack = (hull.center.y.abs() + height.abs()) * (MORE - 1.0);
            if up < -(hull.radius * MORE + slack) {
                return None;
            }
            // The hull's shadow is an ellipse, as long as a diameter divided by the light's rise.
            let way = (hull.center.y - height) / l.y;
            let middle = hull.center - l * way;
            let magnitudes = hull.center.abs().element_sum() + way.abs();
            let reach = (hull.radius / l.y.abs()) * MORE + magnitudes * (MORE - 1.0);
            let ends = |middle: f64| {
                let cell = |x: f64| (x / half_width + 1.0) / 2.0 * CELLS as f64;
                let (from, to) = (cell(middle - reach) - 2.0, cell(middle + reach) + 2.0);
                if from.is_nan() || to.is_nan() {
                    return 0..CELLS;
                }
                // Less than 0 converts to 0.
                (from as usize).min(CELLS)..(to.ceil() as usize).min(CELLS)
            };
            Some((ends(middle.x), ends(middle.z)))
        };
        let hulls = hulls(spheres, tetrahedra);
        let mut of_cells = vec![Vec::new(); CELLS * CELLS];
        let mut all = Vec::new();
        for (solid, hull) in hulls
            .iter()
            .enumerate()
            .filter(|(solid, _)| !hidden[*solid])
        {
            if let Some((columns, rows)) = cells(hull)
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
        let mut solids = Vec::new();
        for cell in of_cells {
            solids.extend(cell);
            starts.push(solids.len() as u32);
        }
        SurfaceCasters {
            half_width,
            starts,
            solids,
            all,
        }
    }

    /// Those that may shade any point.
    pub(crate) fn all(&self) -> &[u16] {
        &self.all
    }

    /// Those that may shade a point of the surface of which x and z are known to lie between two
    /// numbers.
    pub(crate) fn near(&self, x: (f64, f64), z: (f64, f64)) -> &[u16] {
        let cell = |(from, to): (f64, f64)| {
            let cell = |x: f64| (x / self.half_width + 1.0) / 2.0 * CELLS as f64;
            let is_known = cell(to) - cell(from) < 1.0;
            // A point of the surface is in one of its cells, or less than a cell beside it.
            is_known.then(|| (cell(from).max(0.0) as usize).min(CELLS - 1))
        };
        match (cell(x), cell(z)) {
            (Some(column), Some(row)) => {
                let cell = row * CELLS + column;
                &self.solids[self.starts[cell] as usize..self.starts[cell + 1] as usize]
            }
            _ => &self.all,
        }
    }
}
