//! The surface, prepared for a frame's rows.

use std::cell::LazyCell;

use bumpalo::collections::Vec as Growing;

use crate::number::Bounded;
use crate::scene::{Side, Solid, SurfaceCasters};
use crate::tracer::decision::Decision;
use crate::tracer::pixel::{Picture, SeenSurface};
use crate::tracer::scanline::edges::ellipses::ParallelLines;
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::edges::table::{Receiver, RegionKind};
use crate::tracer::scanline::prepare::appearance::prepare_solids;
use crate::tracer::scanline::prepare::builder::Builder;
use crate::tracer::scanline::prepare::culling::Tiles;
use crate::tracer::scanline::prepare::outline::Outlines;
use crate::tracer::scanline::prepare::shadows::shadows_on;
use crate::tracer::scanline::prepare::solids::PreparedSolids;
use crate::tracer::scanline::prepare::surface_plane::{
    SurfaceDepth, sides_on_screen, surface_plane,
};
use crate::tracer::scanline::write::paint::PaintNumber;

/// The surface of a frame, prepared for its rows.
pub(crate) struct PreparedSurface<'f> {
    /// The solids that are seen in it, if it mirrors.
    pub(crate) mirrored: Option<PreparedSolids<'f>>,
    depth: SurfaceDepth,
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
        picture: &Picture<'f, Bounded>,
        surface: &SeenSurface<'f, Bounded>,
        tiles: Option<&Tiles<'f>>,
        parts: &mut Builder<'f, '_>,
    ) -> Self {
        let grid = parts.grid;
        let plane = surface_plane(&surface.square, grid);
        let scene = picture.scene;
        // A ray to the light that rises from the surface has all solids above the surface ahead. A
        // solid that touches the ray's origin is seen there itself, and not the surface.
        let rises = scene.light().rise().is_gt();
        let is_ahead = |caster: usize| rises && scene.facts().sides[caster] == Side::Above;
        let depth = SurfaceDepth::new(&surface.square, grid);
        let rows = surface.extent.rows;
        let screen = (grid, parts.arena);
        let sides = parts
            .arena
            .alloc(sides_on_screen(&surface.square, &plane, screen));
        let outline = Region::new(sides, None, grid).within(rows);
        let view = &picture.view;
        let casters = scene.facts().surface_casters.as_ref();
        let casters = casters.into_iter().flat_map(SurfaceCasters::all).copied();
        let cast = shadows_on(
            &plane,
            view,
            casters.clone(),
            is_ahead,
            (grid, parts.level),
            parts.arena,
        );
        // The half-planes of a tetrahedron's shadow do not tell in which rows it lies.
        let lines = LazyCell::new(|| ParallelLines::new(&plane, view.shading.to_light, grid));
        let rows_of = |caster: u16| match view.solid(usize::from(caster)) {
            Solid::Sphere(_) => rows,
            Solid::Tetrahedron(t) => lines.rows_through(*t.solid.vertices()),
        };
        let cast = casters
            .zip(cast)
            .map(|(caster, shadow)| shadow.within(rows_of(caster)).within(rows));
        let mut shadows = Growing::new_in(parts.arena);
        shadows.extend(cast);
        let mirror = surface.mirror.as_ref();
        let mut mirrored = mirror.map(|mirror| {
            let within = Some(&surface.extent);
            Outlines::new(
                picture,
                &mirror.view,
                within,
                (grid, parts.level),
                parts.arena,
            )
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
