//! Which solids can throw a shadow on which: no turning of the scene changes that, and most cannot.

use glam::DVec3;

use super::hull::{Hull, MORE, each_pair_along, hulls};
use super::{Sphere, Surface, Tetrahedron};

/// For each solid, spheres first, the other solids that may stand between a point of it and the
/// light; all others certainly do not. Nobody asks of hidden ones: what these shade, what hides
/// them does.
pub(super) fn casters(
    spheres: &[Sphere],
    tetrahedra: &[Tetrahedron],
    to_light: DVec3,
    hidden: &[bool],
) -> Vec<Vec<u16>> {
    let hulls = hulls(spheres, tetrahedra);
    let l = to_light.normalize();
    let mut all: Vec<Vec<u16>> = vec![Vec::new(); hulls.len()];
    each_pair_along(&hulls, l.any_orthonormal_vector(), |a, b| {
        if hidden[a] || hidden[b] {
            return;
        }
        let Hull { center, radius } = hulls[a];
        let other = &hulls[b];
        let between = other.center - center;
        let slack = (other.center.abs() + center.abs()).element_sum() * (MORE - 1.0);
        let reach = (other.radius + radius) * MORE + slack;
        if between.cross(l).length_squared() <= reach * reach * MORE {
            let ahead = between.dot(l);
            if ahead >= -reach {
                all[a].push(b as u16);
            }
            if ahead <= reach {
                all[b].push(a as u16);
            }
        }
    });
    for casters in &mut all {
        casters.sort_unstable();
    }
    all
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
