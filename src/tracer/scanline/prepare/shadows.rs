//! Shadows on planes, as regions, and on spheres, as casters.

use std::cell::LazyCell;
use std::cmp::Ordering;

use bumpalo::Bump;
use fearless_simd::Level;

use crate::number::Bounded;
use crate::scene::{Side, Solid};
use crate::tracer::arena::collect;
use crate::tracer::half_space::HalfSpace;
use crate::tracer::pixel::Picture;
use crate::tracer::scanline::edges::ellipses::ParallelLines;
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::edges::pixel_plane::PixelPlane;
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::grid::Grid;
use crate::tracer::scanline::shade::caster::{Caster, ShadowCylinder};
use crate::tracer::scanline::shade::light::Lighting;
use crate::tracer::scanline::shade::sphere::{HitBounds, LinearForm};
use crate::tracer::surface::Surface;
use crate::tracer::tetrahedron::Passage;
use crate::tracer::vector::Vector;
use crate::tracer::view::View;

/// The shadow of the surface on the solids of a view.
pub(crate) struct SurfaceShadow<'p> {
    /// `None` in stages without the surface.
    surface: Option<&'p Surface<Bounded>>,
    /// By the numbers of the solids in the scene.
    sides: &'p [Side],
    to_light: Vector<Bounded>,
    /// The sign of the rise of `to_light`. In the mirror it is reversed.
    rise: Ordering,
    mirrored: bool,
}

impl<'p> SurfaceShadow<'p> {
    pub(crate) fn new(
        picture: &'p Picture<'_, Bounded>,
        view: &View<'_, Bounded>,
        mirrored: bool,
    ) -> Self {
        let rise = picture.scene.light().rise();
        SurfaceShadow {
            surface: picture.surface.as_ref().map(|surface| &surface.square),
            sides: &picture.scene.facts().sides,
            to_light: view.shading.to_light.vector,
            rise: if mirrored { rise.reverse() } else { rise },
            mirrored,
        }
    }

    /// The half-spaces whose intersection holds the shadow; `None` if it does not reach the solid.
    fn on(&self, solid: usize) -> Option<impl Iterator<Item = HalfSpace<Bounded>>> {
        // A reflected solid is on the other side.
        let is_reached = match (self.sides[solid], self.mirrored) {
            (Side::Across, _) => true,
            (Side::Above, false) | (Side::Below, true) => self.rise.is_le(),
            (Side::Above, true) | (Side::Below, false) => self.rise.is_ge(),
        };
        let surface = self.surface.filter(|_| is_reached)?;
        Some(surface.shadow(self.to_light, self.rise))
    }

    /// Whether the shadow may reach a solid.
    pub(crate) fn reaches(&self, solid: usize) -> bool {
        self.on(solid).is_some()
    }

    /// The surface as a caster on a sphere.
    pub(crate) fn on_sphere<'f>(
        &self,
        solid: usize,
        bounds: &HitBounds,
        lighting: &Lighting,
        arena: &'f Bump,
    ) -> Option<Caster<'f>> {
        let forms = self.on(solid)?;
        let forms = forms.map(|half_space| bounds.inside(&half_space, lighting));
        let in_doubt = self.rise.is_eq().then_some(LinearForm::IN_DOUBT);
        Some(Caster::Polyhedron(collect(arena, forms.chain(in_doubt))))
    }

    /// The shadow as a region: the pixels whose points on a plane are in it.
    pub(crate) fn on_plane<'f>(
        &self,
        solid: usize,
        plane: &PixelPlane,
        grid: Grid,
        arena: &'f Bump,
    ) -> Option<Region<'f>> {
        let planes = self.on(solid)?;
        let planes =
            planes.map(|half_space| HalfPlane::of(&half_space, Some(plane), (grid, arena)));
        let in_doubt = self.rise.is_eq().then_some(HalfPlane::IN_DOUBT);
        Some(Region::new(
            collect(arena, planes.chain(in_doubt)),
            None,
            grid,
        ))
    }
}

/// The shadows of `casters` on a plane, each as a region: the pixels whose points are in it. A
/// caster for which `is_ahead` is true lies ahead of all rays from the plane to the light.
pub(crate) fn shadows_on<'f>(
    plane: &PixelPlane,
    view: &View<'_, Bounded>,
    casters: impl Iterator<Item = u16>,
    is_ahead: impl Fn(usize) -> bool,
    (grid, level): (Grid, Level),
    arena: &'f Bump,
) -> impl Iterator<Item = Region<'f>> {
    let to_light = view.shading.to_light;
    let lines = LazyCell::new(move || ParallelLines::new(plane, to_light, grid));
    let shape = move |caster: u16| {
        let caster = usize::from(caster);
        view.prepare(caster, level);
        let is_ahead = is_ahead(caster);
        match view.solid(caster) {
            Solid::Sphere(sphere) => {
                let before = (!is_ahead).then(|| sphere.before(&to_light));
                let before = before
                    .iter()
                    .map(|half_space| HalfPlane::of(half_space, Some(plane), (grid, arena)));
                let ellipse = arena.alloc_with(|| lines.meet(sphere));
                Region::new(collect(arena, before), Some(ellipse), grid)
            }
            Solid::Tetrahedron(t) => {
                let lines = (&t.solid, to_light.vector);
                let (plane, screen, signs) = (Some(plane), (grid, level), t.solid.facing_light);
                let passage = Passage::of(signs);
                let walls = if is_ahead {
                    &passage.met
                } else {
                    &passage.ahead
                };
                let planes = HalfPlane::all_of(lines, walls, plane, screen, arena);
                Region::new(planes, None, grid)
            }
        }
    };
    casters.map(shape)
}

/// The shadows of `casters` on the plane of a face, which is the border of the half-space `behind`
/// it, as [`shadows_on`] has them.
pub(crate) fn shadows_on_face<'f>(
    (behind, plane): (&HalfSpace<Bounded>, &PixelPlane),
    view: &View<'_, Bounded>,
    casters: impl Iterator<Item = u16>,
    (grid, level): (Grid, Level),
    arena: &'f Bump,
) -> impl Iterator<Item = Region<'f>> {
    // Rays to the light leave the face.
    let is_ahead = move |caster: usize| match view.solid(caster) {
        Solid::Sphere(_) => false,
        Solid::Tetrahedron(t) => behind.misses(t.solid.vertices(), level),
    };
    shadows_on(plane, view, casters, is_ahead, (grid, level), arena)
}

/// The casters of a sphere.
pub(crate) fn casters_on<'f>(
    bounds: &HitBounds,
    index: usize,
    view: &View<'_, Bounded>,
    lighting: &Lighting,
    casters: &[u16],
    arena: &'f Bump,
) -> impl Iterator<Item = Caster<'f>> {
    let support = view.spheres[index].support;
    casters.iter().filter_map(move |&caster| {
        let caster = usize::from(caster);
        match view.solid(caster) {
            // No sphere shadows itself, nor a sphere that is listed twice.
            Solid::Sphere(sphere) if sphere.support == support => None,
            Solid::Sphere(sphere) => {
                let cylinder = ShadowCylinder::new(bounds, sphere, lighting);
                Some(Caster::Sphere(cylinder))
            }
            Solid::Tetrahedron(t) => {
                let to_light = view.shading.to_light.vector;
                let walls = Passage::of(t.solid.facing_light).ahead.iter();
                let forms =
                    walls.map(|wall| bounds.inside(&t.solid.half_space(wall, to_light), lighting));
                Some(Caster::Polyhedron(collect(arena, forms)))
            }
        }
    })
}
