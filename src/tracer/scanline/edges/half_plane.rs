//! Pixels on one side of a straight line.

use bumpalo::Bump;
use bumpalo::collections::Vec as Growing;
use bumpalo_herd::Member;
use fearless_simd::{Level, Simd, dispatch, f32x8};

use crate::number::{Bounded, FourBounded, Real, Ring};
use crate::tracer::half_space::HalfSpace;
use crate::tracer::scanline::edges::border::{Border, Height, Root};
use crate::tracer::scanline::edges::enclosure::{ColumnEnclosure, Cut};
use crate::tracer::scanline::edges::pixel_plane::{PixelPlane, screen_origin};
use crate::tracer::scanline::grid::Grid;
use crate::tracer::tetrahedron::{Tetrahedron, WALLS_AT_ONCE, Wall, Walls};
use crate::tracer::vector::Vector;
use crate::tracer::view_space::number_at;

/// The pixels where constant + `per_x` X + `per_y` Y ≥ 0, or > 0.
#[derive(Clone, Copy)]
pub(crate) struct HalfPlane<'f> {
    border: Border,
    /// Kept apart, since few pixels need them: so the borders of many half-planes are at hand.
    terms: &'f Terms,
}

/// What decides on which side a pixel is.
#[derive(Clone, Copy)]
struct Terms {
    constant: Bounded,
    per_x: Bounded,
    per_y: Bounded,
    /// Whether pixels with a sum of 0 belong to the half-plane.
    closed: bool,
}

impl Terms {
    const IN_DOUBT: Terms = Terms {
        constant: Bounded::UNKNOWN,
        per_x: Bounded::UNKNOWN,
        per_y: Bounded::UNKNOWN,
        closed: false,
    };
}

impl<'f> HalfPlane<'f> {
    /// A half-plane of which every pixel is in doubt.
    pub(crate) const IN_DOUBT: HalfPlane<'static> = HalfPlane {
        border: Border::IN_DOUBT,
        terms: &Terms::IN_DOUBT,
    };

    pub(crate) fn new(
        constant: Bounded,
        per_x: Bounded,
        per_y: Bounded,
        closed: bool,
        (grid, arena): (Grid, &'f Bump),
    ) -> Self {
        let [border, ..] = dispatch!(Level::baseline(), simd => {
            let height = [constant, per_x, per_y].map(|term| FourBounded::splat(simd, term));
            Border::four(simd, &height, grid)
        });
        let terms = arena.alloc(Terms {
            constant,
            per_x,
            per_y,
            closed,
        });
        HalfPlane { border, terms }
    }

    /// Copies in other memory.
    pub(crate) fn kept_in<'k>(all: &[HalfPlane<'_>], memory: &Member<'k>) -> &'k [HalfPlane<'k>] {
        let copy = |half_plane: &HalfPlane<'_>| HalfPlane {
            border: half_plane.border,
            terms: memory.alloc(*half_plane.terms),
        };
        memory.alloc_slice_fill_iter(all.iter().map(copy))
    }

    /// How many bytes [`HalfPlane::kept_in`] takes.
    pub(crate) fn kept_size(all: &[HalfPlane<'_>]) -> usize {
        all.len() * (size_of::<HalfPlane<'_>>() + size_of::<Terms>())
    }

    /// The pixels whose points on the plane, or on the screen, lie in a half-space.
    pub(crate) fn of(
        half_space: &HalfSpace<Bounded>,
        plane: Option<&PixelPlane>,
        (grid, arena): (Grid, &'f Bump),
    ) -> HalfPlane<'f> {
        let closed = half_space.closed;
        if is_border(half_space, plane) {
            let zero = Bounded::exact(0.0);
            return HalfPlane::new(zero, zero, zero, closed, (grid, arena));
        }
        let changes = plane.map(|plane| [plane.per_x, plane.per_y]);
        let origin = origin(plane, grid) - half_space.at;
        let [constant, per_x, per_y] = height(half_space.normal, origin, changes);
        HalfPlane::new(constant, per_x, per_y, closed, (grid, arena))
    }

    /// The same for the half-spaces with these walls, four at once: for lines of one direction
    /// and the tetrahedron.
    pub(crate) fn all_of(
        (tetrahedron, direction): (&Tetrahedron<Bounded>, Vector<Bounded>),
        walls: &Walls,
        plane: Option<&PixelPlane>,
        (grid, level): (Grid, Level),
        arena: &'f Bump,
    ) -> &'f [HalfPlane<'f>] {
        let mut all = Growing::with_capacity_in(walls.count(), arena);
        let support = plane.and_then(|plane| plane.support);
        // All points of the plane may lie on the border of a wall: that is told one by one.
        let any_border = walls.any_face() && support.is_some_and(|it| tetrahedron.has_face_in(it));
        if any_border || tetrahedron.may_be_exact() {
            let each = walls
                .iter()
                .map(|wall| tetrahedron.half_space(wall, direction));
            all.extend(each.map(|half_space| HalfPlane::of(&half_space, plane, (grid, arena))));
        } else {
            for walls in walls.vectors() {
                let lines = (tetrahedron, direction);
                dispatch!(level, simd => {
                    HalfPlane::add_four(simd, lines, walls, plane, (grid, arena), &mut all);
                });
            }
        }
        all.into_bump_slice()
    }

    /// Adds those of the first `count` of four walls that do not hold the plane, of a tetrahedron
    /// without numbers that may be exact.
    #[inline(always)]
    fn add_four<S: Simd>(
        simd: S,
        (tetrahedron, direction): (&Tetrahedron<Bounded>, Vector<Bounded>),
        (walls, count): (&[Wall; WALLS_AT_ONCE], usize),
        plane: Option<&PixelPlane>,
        (grid, arena): (Grid, &'f Bump),
        all: &mut Growing<'f, HalfPlane<'f>>,
    ) {
        let [n, at] = tetrahedron.half_spaces_at_once(simd, walls, direction);
        #[allow(
            clippy::manual_map,
            reason = "a closure is compiled without vector instructions"
        )]
        let changes = match plane {
            Some(plane) => Some([
                Vector::splat(simd, plane.per_x),
                Vector::splat(simd, plane.per_y),
            ]),
            None => None,
        };
        let origin = Vector::splat(simd, origin(plane, grid)) - at;
        let height = height(n, origin, changes);
        let borders = Border::four(simd, &height, grid);
        let [constant, per_x, per_y] = height.map(FourBounded::to_array);
        let terms = arena.alloc_slice_fill_with(count, |i| Terms {
            constant: constant[i],
            per_x: per_x[i],
            per_y: per_y[i],
            closed: walls[i].is_closed(),
        });
        let each = borders.into_iter().zip(&*terms);
        all.extend(each.map(|(border, terms)| HalfPlane { border, terms }));
    }

    /// Whether the pixel at X, Y is in the half-plane; `None` where that is in doubt.
    fn decide(&self, x: f64, y: f64) -> Option<bool> {
        let Terms {
            constant,
            per_x,
            per_y,
            closed,
        } = *self.terms;
        let sum = constant + per_y * Bounded::exact(y) + per_x * Bounded::exact(x);
        let sign = sum.sign().ok()?;
        Some(sign.is_gt() || (closed && sign.is_eq()))
    }

    /// The same, with the sum computed only near the border.
    pub(crate) fn decide_near(&self, x: f64, y: f64, grid: Grid) -> Option<bool> {
        let Some(root) = self.root() else {
            return self.decide(x, y);
        };
        // Bounds that cover roundings to f32 cover those to f64.
        let column = number_at(x, grid.half);
        let [low, high] = root.ends.map(|end| y * root.per_y + end);
        if column < low || high < column {
            Some((high < column) == root.rightward)
        } else {
            self.decide(x, y)
        }
    }

    pub(crate) fn border(&self) -> &Border {
        &self.border
    }

    /// The border's root, if the border is not level.
    pub(super) fn root(&self) -> Option<Root> {
        self.border.root()
    }
}

impl Cut for HalfPlane<'_> {
    #[inline(always)]
    fn cut<S: Simd>(&self, simd: S, y: f32x8<S>, enclosure: &mut ColumnEnclosure<f32x8<S>>) {
        self.border.cut(simd, y, enclosure);
    }
}

/// Whether all points of a plane lie on the border of a half-space.
fn is_border(half_space: &HalfSpace<Bounded>, plane: Option<&PixelPlane>) -> bool {
    let support = plane.and_then(|plane| plane.support);
    support.is_some() && half_space.support == support
}

/// The point of a plane, or of the screen, at X = Y = 0.
fn origin(plane: Option<&PixelPlane>, grid: Grid) -> Vector<Bounded> {
    plane.map_or_else(|| screen_origin(grid), |plane| plane.origin)
}

/// The height of points over the border of a half-space with this normal. `origin` is the point at
/// X = Y = 0, seen from the border. `changes` are those of the points per X and per Y; `None` on the
/// screen.
#[inline(always)]
fn height<R: Ring>(n: Vector<R>, origin: Vector<R>, changes: Option<[Vector<R>; 2]>) -> Height<R> {
    let constant = n.dot(origin);
    match changes {
        Some([per_x, per_y]) => [constant, n.dot(per_x), n.dot(per_y)],
        None => [constant, n.x, n.y],
    }
}
