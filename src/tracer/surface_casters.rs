//! Which solids may stand between a pixel of the surface and the light.

use super::surface::Surface;
use super::view_transform::ViewTransform;
use crate::number::{Bounded, Real};
use crate::scene::{Scene, SurfaceCasters};

/// Finds the casters of the surface at a pixel, from the pixel's point in f64 with bounds.
#[derive(Clone, Copy)]
pub(super) struct SurfaceCasterLookup<'f> {
    casters: &'f SurfaceCasters,
    surface: Surface<Bounded>,
    /// 1 over the frame's scale.
    inverse: Bounded,
    transform: ViewTransform<Bounded>,
}

impl<'f> SurfaceCasterLookup<'f> {
    /// `None` where there is no surface.
    pub(super) fn new(scene: &'f Scene, transform: &ViewTransform<Bounded>) -> Option<Self> {
        Some(SurfaceCasterLookup {
            casters: scene.facts().surface_casters.as_ref()?,
            surface: transform.surface(scene)?,
            inverse: Bounded::exact(1.0) / transform.scale,
            transform: *transform,
        })
    }

    /// The casters at a pixel that shows the surface. Meaningless for others.
    pub(super) fn at(&self, (column, row): (u32, u32)) -> &'f [u16] {
        let ray = self.transform.eye_ray(column, row);
        let (_, point) = self.transform.on_surface(&self.surface, &ray, row);
        let [x, z] = self.surface.along_sides(point).map(|along| {
            let along = along * self.inverse;
            (along.at_least(), along.at_most())
        });
        self.casters.near(x, z)
    }
}
