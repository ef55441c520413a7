//! The surface as a frame's rows cross it.

use super::border::Border;
use super::half_plane::HalfPlane;
use super::paint::PaintNumber;
use super::parts::Parts;
use super::rounding::{MORE, U};
use super::shape::Shape;
use super::sheet::Sheet;
use super::solids::{Solids, shadows_on};
use crate::number::{Bounded, Real};
use crate::scene::Side;
use crate::tracer::decision::Decision;
use crate::tracer::pixel::{self, Picture};
use crate::tracer::vector::Vector;

/// The surface, from stage 5 on.
pub(super) struct Floor<'f> {
    pub(super) mirrored: Option<Solids<'f>>,
    /// The parameter of eye rays that reach it at Y = 0, how it changes with Y, and a bound on its error.
    depth: [f64; 3],
    pub(super) paint: PaintNumber,
    pub(super) in_shadow: PaintNumber,
}

impl<'f> Floor<'f> {
    pub(super) fn new(
        picture: &Picture<'_, Bounded>,
        floor: &pixel::Floor<'_, Bounded>,
        parts: &mut Parts<'f, '_>,
    ) -> Self {
        let screen = parts.screen;
        let zero = Bounded::exact(0.0);
        let [one, three, ten] = [1.0, 3.0, 10.0].map(Bounded::exact);
        let third = one / three;
        // An eye ray reaches the surface at t = Y/3 − (N/2) · height, and z = Z − 10 t there.
        let height = floor.height_in_pixels;
        let sheet = Sheet {
            origin: Vector::new(
                zero,
                floor.surface.height,
                Bounded::exact(screen.reach) + ten * height,
            ),
            per_column: Vector::new(one, zero, zero),
            per_row: Vector::new(zero, zero, -(ten * third)),
            plane: Some(floor.surface.support),
        };
        // Three times as large, nothing is a third and rounds: of a surface that is level with the rows, the border may lie on
        // all pixels of one.
        let scaled = [
            sheet.origin * three,
            sheet.per_column * three,
            Vector::new(zero, zero, -ten),
        ];
        let sides = floor
            .surface
            .sides(scaled, floor.surface.half_width * three);
        let sides = sides
            .map(|[constant, column, row]| HalfPlane::new(constant, column, row, true, screen));
        let scene = picture.scene;
        let solids = scene.spheres().len() + scene.tetrahedra().len();
        let magnitude = height.value().abs() + screen.reach;
        // Rays that rise from the surface meet what is above it ahead. They may touch it at their very beginning, but there the solid is
        // seen, and not the surface.
        let rises = scene.light().direction.y < 0.0;
        let is_ahead = |caster: usize| rises && scene.facts().sides[caster] == Side::Above;
        let rows = floor.extent.rows(screen.size);
        let outline = Shape::new(parts.arena.alloc(sides), None, screen);
        parts.borders.add(outline.within(rows), Border::Surface);
        let casters = 0..solids as u16;
        let view = &picture.view;
        for shadow in shadows_on(&sheet, view, casters, is_ahead, screen, parts.arena) {
            let shadow = shadow.within(rows);
            parts.borders.add(shadow, Border::ShadowOnSurface);
        }
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
        }
    }

    /// The parameter at which the eye rays at Y reach it, from the least to the most that it can be.
    pub(super) fn depth_at(&self, y: f64) -> (f64, f64) {
        let [constant, per_row, error] = self.depth;
        let depth = constant + per_row * y;
        (depth - error, depth + error)
    }
}
