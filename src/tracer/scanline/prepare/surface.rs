//! The surface, prepared for a frame's rows.

use std::cell::LazyCell;

use bumpalo::collections::Vec as Growing;

use crate::number::rounding::{INFLATION, U};
use crate::number::{Bounded, Real};
use crate::scene::{Side, Solid, SurfaceCasters};
use crate::tracer::decision::Decision;
use crate::tracer::pixel::{Picture, SeenSurface};
use crate::tracer::scanline::edges::ellipse::ParallelLines;
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::edges::pixel_plane::PixelPlane;
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::edges::table::{Receiver, RegionKind};
use crate::tracer::scanline::prepare::appearance::prepare_solids;
use crate::tracer::scanline::prepare::builder::Builder;
use crate::tracer::scanline::prepare::culling::Tiles;
use crate::tracer::scanline::prepare::outline::Outlines;
use crate::tracer::scanline::prepare::shadows::shadows_on;
use crate::tracer::scanline::prepare::solids::PreparedSolids;
use crate::tracer::scanline::write::paint::PaintNumber;
use crate::tracer::vector::Vector;
use crate::tracer::view_space::{EYE_Y, EYE_Z};

/// The surface of a frame, prepared for its rows.
pub(crate) struct PreparedSurface<'f> {
    /// The solids that are seen in it, if it mirrors.
    pub(crate) mirrored: Option<PreparedSolids<'f>>,
    depth: LevelDepth,
    /// What it shows in the light where it mirrors nothing.
    pub(crate) paint: PaintNumber,
    /// What it shows in shadow.
    pub(crate) in_shadow: PaintNumber,
    /// The receiver of its shadows.
    pub(crate) shadows: Receiver,
}

impl<'f> PreparedSurface<'f> {
    /// `tiles` tells where solids hide the surface, if the frame is culled.
    pub(crate) fn new(
        picture: &Picture<'_, Bounded>,
        surface: &SeenSurface<'_, Bounded>,
        tiles: Option<&Tiles<'f>>,
        parts: &mut Builder<'f, '_>,
    ) -> Self {
        let grid = parts.grid;
        let zero = Bounded::exact(0.0);
        let [one, three, ten] = [1.0, EYE_Y, EYE_Z].map(Bounded::exact);
        let third = one / three;
        // `ViewTransform::on_surface` as a linear function of X and Y: t = Y/3 − (N/2) · height,
        // and z is 3N/2 − 10 t.
        let height = surface.square.height_in_pixels;
        let plane = PixelPlane {
            origin: Vector::new(
                zero,
                surface.square.height,
                Bounded::exact(grid.max) + ten * height,
            ),
            per_x: Vector::new(one, zero, zero),
            per_y: Vector::new(zero, zero, -(ten * third)),
            support: Some(surface.square.support),
        };
        // Scaled by 3, no coefficient is a third, which would round: at α = 0 a side of the square
        // may pass through all pixels of a row exactly.
        let scaled = [
            plane.origin * three,
            plane.per_x * three,
            Vector::new(zero, zero, -ten),
        ];
        let sides = surface
            .square
            .sides(scaled, surface.square.half_width * three);
        let sides =
            sides.map(|[constant, column, row]| HalfPlane::new(constant, column, row, true, grid));
        let scene = picture.scene;
        let magnitude = height.value().abs() + grid.max;
        // A ray to the light that rises from the surface has all solids above the surface ahead. A
        // solid that touches the ray's origin is seen there itself, and not the surface.
        let rises = scene.light().rise().is_gt();
        let is_ahead = |caster: usize| rises && scene.facts().sides[caster] == Side::Above;
        let depth = LevelDepth {
            constant: -height.value(),
            per_y: third.value(),
            error: (height.error() + 8.0 * U * magnitude) * INFLATION,
        };
        let rows = surface.extent.rows(grid.size);
        let outline = Region::new(parts.arena.alloc(sides), None, grid).within(rows);
        let view = &picture.view;
        let casters = scene.facts().surface_casters.as_ref();
        let casters = casters.into_iter().flat_map(SurfaceCasters::all).copied();
        let cast = shadows_on(&plane, view, casters.clone(), is_ahead, grid, parts.arena);
        // The half-planes of a tetrahedron's shadow do not tell in which rows it lies.
        let lines = LazyCell::new(|| ParallelLines::new(&plane, view.shading.to_light));
        let rows_of = |caster: u16| match view.solid(usize::from(caster)) {
            Solid::Sphere(_) => rows,
            Solid::Tetrahedron(t) => lines.rows_through(t.solid.vertices(), grid),
        };
        let cast = casters
            .zip(cast)
            .map(|(caster, shadow)| shadow.within(rows_of(caster)).within(rows));
        let mut shadows = Growing::new_in(parts.arena);
        shadows.extend(cast);
        let mirror = surface.mirror.as_ref();
        let mut mirrored = mirror.map(|mirror| {
            let within = Some(&surface.extent);
            Outlines::new(picture, &mirror.view, within, grid, parts.arena)
        });
        if let Some(tiles) = tiles {
            let mut seen = tiles.seen_through(&outline, |y| depth.at(y).0, parts.arena);
            seen.restrict_shadows(&mut shadows, parts.arena);
            if let Some(mirrored) = &mut mirrored {
                mirrored.cull(&mut seen);
            }
        }
        parts.edge_table.add(outline, RegionKind::Surface);
        let shadows = parts.edge_table.add_receiver(shadows, rows);
        PreparedSurface {
            mirrored: mirror
                .zip(mirrored)
                .map(|(mirror, outlines)| prepare_solids(picture, &mirror.view, outlines, parts)),
            depth,
            paint: parts.paints.add(Decision::Surface),
            in_shadow: parts.paints.add(Decision::SurfaceInShadow),
            shadows,
        }
    }

    /// Bounds on the parameter at which the eye rays at Y reach the surface.
    pub(crate) fn depth_at(&self, y: f64) -> (f64, f64) {
        self.depth.at(y)
    }
}

/// The parameter at which eye rays reach a level plane: constant + per_y · Y.
struct LevelDepth {
    constant: f64,
    per_y: f64,
    /// A bound on the error in any row.
    error: f64,
}

impl LevelDepth {
    /// Bounds on the parameter at Y.
    fn at(&self, y: f64) -> (f64, f64) {
        let depth = self.constant + self.per_y * y;
        (depth - self.error, depth + self.error)
    }
}
