//! Which solids can cast a shadow on the surface, cell by cell.

use glam::DVec3;

use super::bounding_ball::{BoundingBall, MARGIN, bounding_balls};
use super::{Sphere, Surface, Tetrahedron};

/// Cells along a side of the surface.
const CELLS: usize = 32;

/// The casters of the surface, for each of its cells.
#[derive(Clone, Debug)]
pub(crate) struct SurfaceCasters {
    half_width: f64,
    /// For each cell, the index of its first caster in `casters`; then the length of `casters`.
    starts: Vec<u32>,
    casters: Vec<u16>,
    /// The casters of any cell.
    all: Vec<u16>,
}

/// Where the x or z of a point of the surface lies, counted in cells.
fn cell_at(x: f64, half_width: f64) -> f64 {
    (x / half_width + 1.0) / 2.0 * CELLS as f64
}

impl SurfaceCasters {
    /// The casters among the solids that are not enclosed.
    pub(super) fn new(
        spheres: &[Sphere],
        tetrahedra: &[Tetrahedron],
        surface: &Surface,
        to_light: DVec3,
        enclosed: &[bool],
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
        let bounds = bounding_balls(spheres, tetrahedra);
        let mut of_cells = vec![Vec::new(); CELLS * CELLS];
        let mut all = Vec::new();
        for (solid, ball) in bounds
            .iter()
            .enumerate()
            .filter(|(solid, _)| !enclosed[*solid])
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
