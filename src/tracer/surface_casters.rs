//! Which solids may stand between a pixel of the surface and the light.

use super::frame::{EYE_Z, Frame, PIXEL};
use super::surface::Surface;
use super::vector::Vector;
use crate::number::{Bounded, Real};
use crate::scene::{Scene, SurfaceCasters};

/// Finds the casters of the surface at a pixel, from the pixel's point in f64 with bounds.
#[derive(Clone, Copy)]
pub(super) struct CastersOnSurface<'f> {
    casters: &'f SurfaceCasters,
    surface: Surface<Bounded>,
    /// 1 over the frame's scale.
    inverse: Bounded,
    /// N/2.
    half: f64,
    /// (N/2) · height.
    height_in_pixels: Bounded,
}

impl<'f> CastersOnSurface<'f> {
    /// `None` where there is no surface.
    pub(super) fn new(scene: &'f Scene, frame: &Frame<Bounded>, size: u32) -> Option<Self> {
        let half = f64::from(size) / 2.0;
        Some(CastersOnSurface {
            casters: scene.facts().surface_casters.as_ref()?,
            surface: frame.surface(scene)?,
            inverse: Bounded::exact(1.0) / frame.scale,
            half,
            height_in_pixels: Bounded::exact(scene.surface()?.height) * Bounded::exact(half),
        })
    }

    /// The casters at a pixel that shows the surface. Meaningless for others.
    pub(super) fn at(&self, (column, row): (u32, u32)) -> &'f [u16] {
        let [x, y] = [column, row].map(|number| f64::from(number) - self.half);
        let depth = Bounded::exact(y) - self.height_in_pixels;
        let point = Vector::new(
            Bounded::exact(PIXEL * x),
            self.surface.height,
            Bounded::exact(PIXEL * self.half) - Bounded::exact(EYE_Z) * depth,
        );
        let [x, z] = self.surface.along_sides(point).map(|along| {
            let along = along * self.inverse;
            (along.at_least(), along.at_most())
        });
        self.casters.near(x, z)
    }
}
