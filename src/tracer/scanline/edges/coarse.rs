//! Half-planes in a fifth of the memory: enough for most bands, where very many are kept.

use fearless_simd::Simd;

use crate::number::rounding::INFLATION;
use crate::tracer::scanline::edges::enclosure::{ColumnEnclosure, Cut};
use crate::tracer::scanline::edges::half_plane::{HalfPlane, Root};
use crate::tracer::scanline::grid::Grid;

/// A half-plane whose root is rounded to f32, with a bound that covers that, too. It cannot decide
/// a pixel in doubt.
#[derive(Clone, Copy)]
pub(crate) struct CoarseHalfPlane {
    at: f32,
    per_y: f32,
    slack: f32,
    /// Whether it lies to the right of the root.
    rightward: bool,
}

impl CoarseHalfPlane {
    /// A coarse copy, if the border is not level and f32 holds its numbers.
    pub(crate) fn new(half_plane: &HalfPlane, grid: Grid) -> Option<CoarseHalfPlane> {
        let root = half_plane.root()?;
        let (at, per_y) = (root.at as f32, root.per_y as f32);
        // Both differences are exact. The terms grow by 2⁻²³ of themselves at most, or by less than
        // 2⁻¹⁴⁹, and what the slack allows for the rounding of their sum is more than that larger
        // than the rounding.
        let moved =
            (root.at - f64::from(at)).abs() + (root.per_y - f64::from(per_y)).abs() * grid.max;
        // Rounding to f32 takes away half as much as the factor adds.
        let slack = (root.slack + moved) * INFLATION * (1.0 + f64::from(f32::EPSILON));
        let slack = slack as f32;
        slack.is_finite().then_some(CoarseHalfPlane {
            at,
            per_y,
            slack,
            rightward: root.rightward,
        })
    }
}

impl Cut for CoarseHalfPlane {
    #[inline(always)]
    fn cut<S: Simd>(&self, _: S, y: S::f64s, enclosure: &mut ColumnEnclosure<S::f64s>) {
        let [at, per_y, slack] = [self.at, self.per_y, self.slack].map(f64::from);
        let rightward = self.rightward;
        let root = Root {
            at,
            per_y,
            slack,
            rightward,
        };
        root.cut::<S>(y, enclosure);
    }
}
