//! The surface as a frame's rows cross it.

use crate::number::{Bounded, Real};
use crate::scene::Side;
use crate::tracer::decision::Decision;
use crate::tracer::pixel::{self, Picture};
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::edges::pixel_plane::PixelPlane;
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::edges::table::{Edge, Receiver};
use crate::tracer::scanline::prepare::prepared::Builder;
use crate::tracer::scanline::prepare::solids::{Solids, shadows_on};
use crate::tracer::scanline::rounding::{MORE, U};
use crate::tracer::scanline::write::paint::PaintNumber;
use crate::tracer::vector::Vector;

/// The surface, from stage 5 on.
pub(crate) struct Floor<'f> {
    pub(crate) mirrored: Option<Solids<'f>>,
    /// The parameter of eye rays that reach it at Y = 0, how it changes with Y, and a bound on its
    /// error.
    depth: [f64; 3],
    pub(crate) paint: PaintNumber,
    pub(crate) in_shadow: PaintNumber,
    pub(crate) shadows: Receiver,
}

impl<'f> Floor<'f> {
    pub(crate) fn new(
        picture: &Picture<'_, Bounded>,
        floor: &pixel::Floor<'_, Bounded>,
        parts: &mut Builder<'f, '_>,
    ) -> Self {
        let grid = parts.grid;
        let zero = Bounded::exact(0.0);
        let [one, three, ten] = [1.0, 3.0, 10.0].map(Bounded::exact);
        let third = one / three;
        // An eye ray reaches the surface at t = Y/3 − (N/2) · height, and z = Z − 10 t there.
        let height = floor.height_in_pixels;
        let plane = PixelPlane {
            origin: Vector::new(
                zero,
                floor.surface.height,
                Bounded::exact(grid.reach) + ten * height,
            ),
            per_column: Vector::new(one, zero, zero),
            per_row: Vector::new(zero, zero, -(ten * third)),
            plane: Some(floor.surface.support),
        };
        // Three times as large, nothing is a third and rounds: of a surface that is level with the
        // rows, the edge may lie on all pixels of one.
        let scaled = [
            plane.origin * three,
            plane.per_column * three,
            Vector::new(zero, zero, -ten),
        ];
        let sides = floor
            .surface
            .sides(scaled, floor.surface.half_width * three);
        let sides =
            sides.map(|[constant, column, row]| HalfPlane::new(constant, column, row, true, grid));
        let scene = picture.scene;
        let solids = scene.spheres().len() + scene.tetrahedra().len();
        let magnitude = height.value().abs() + grid.reach;
        // Rays that rise from the surface meet what is above it ahead. They may touch it at their
        // very beginning, but there the solid is seen, and not the surface.
        let rises = scene.light().direction.y < 0.0;
        let is_ahead = |caster: usize| rises && scene.facts().sides[caster] == Side::Above;
        let rows = floor.extent.rows(grid.size);
        let outline = Region::new(parts.arena.alloc(sides), None, grid);
        parts.edges.add(outline.within(rows), Edge::Surface);
        let casters = 0..solids as u16;
        let view = &picture.view;
        let shadows = shadows_on(&plane, view, casters, is_ahead, grid, parts.arena);
        let shadows = parts.edges.add_receiver(shadows, rows);
        Floor {
            mirrored: floor
                .mirror
                .as_ref()
                .map(|mirror| Solids::new(picture, &mirror.view, true, parts)),
            depth: [
                -height.value(),
                third.value(),
                (height.error() + 8.0 * U * magnitude) * MORE,
            ],
            paint: parts.paints.of(Decision::Surface),
            in_shadow: parts.paints.of(Decision::SurfaceInShadow),
            shadows,
        }
    }

    /// The parameter at which the eye rays at Y reach it, from the least to the most that it can
    /// be.
    pub(crate) fn depth_at(&self, y: f64) -> (f64, f64) {
        let [constant, per_row, error] = self.depth;
        let depth = constant + per_row * y;
        (depth - error, depth + error)
    }
}
