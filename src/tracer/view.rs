//! The scene as one frame sees it.
//!
//! # The mirror
//!
//! A mirrored ray meets what the straight continuation of the eye ray would meet in the mirror
//! image of the scene. So the mirror is a second view of the same kind, with reflected solids under
//! a reflected light, and every formula serves both.

use std::cmp::Ordering;

use fearless_simd::Level;

use super::arena::SliceAllocator;
use super::extent::ExtentsOfSolids;
use super::line::{Hit, Line};
use super::shading::{Shading, halfway};
use super::sphere::Sphere;
use super::vector::Vector;
use super::view_signs::{Halfway, ViewSigns};
use super::view_space::{eye_direction, reflect};
use super::view_tetrahedra::{EdgesInView, TetrahedraInView, TetrahedronInView};
use super::view_transform::ViewTransform;
use crate::number::{Bounded, Real, any};
use crate::scene::{Scene, Solid, Support};
use crate::stage::Stage;

/// All solids and the light, turned, scaled, and for the mirror reflected.
pub(super) struct View<'f, R> {
    /// The extent of each solid: spheres, then tetrahedra.
    pub(super) extents: ExtentsOfSolids<'f>,
    pub(super) spheres: &'f [Sphere<R>],
    pub(super) tetrahedra: TetrahedraInView<'f, R>,
    pub(super) shading: Shading<R>,
}

/// Which kinds of solids take part in a stage.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum SolidKinds {
    Spheres,
    Tetrahedra,
    All,
}

impl SolidKinds {
    /// Those of stages that show solids.
    pub(super) fn of(stage: Stage) -> Self {
        match stage {
            Stage::Spheres => SolidKinds::Spheres,
            Stage::Tetrahedron => SolidKinds::Tetrahedra,
            _ => SolidKinds::All,
        }
    }

    /// Whether a solid is among them.
    pub(super) fn hold<S, T>(self, solid: &Solid<S, T>) -> bool {
        match solid {
            Solid::Sphere(_) => self != SolidKinds::Tetrahedra,
            Solid::Tetrahedron(_) => self != SolidKinds::Spheres,
        }
    }
}

impl View<'_, Bounded> {
    /// Computes the solid of this number, unless it is computed: faster than [`View::solid`] does.
    pub(super) fn prepare(&self, number: usize, level: Level) {
        if let Solid::Tetrahedron(index) = Solid::index(number, self.spheres.len()) {
            self.tetrahedra.prepare(index, level);
        }
    }
}

impl<'f, R: Real> View<'f, R> {
    /// The view of the scene itself; or, given that view as `direct`, the view in the mirror.
    pub(super) fn new(
        scene: &'f Scene,
        transform: &ViewTransform<R>,
        signs: &ViewSigns<'f>,
        extents: ExtentsOfSolids<'f>,
        direct: Option<&View<'f, R>>,
        allocator: &impl SliceAllocator<'f>,
    ) -> Self {
        let mirrored = direct.is_some();
        let mirror_height = transform.surface_height(scene).filter(|_| mirrored);
        let to_light = transform.direction_to_light(scene, mirrored);
        let halfway = match signs.halfway {
            Halfway::None => None,
            Halfway::Given(given) => {
                let own = halfway(&eye_direction(), &to_light);
                Some(Vector::new(
                    own.x.or_better(given.x),
                    own.y.or_better(given.y),
                    own.z.or_better(given.z),
                ))
            }
            Halfway::Computed => Some(halfway(&eye_direction(), &to_light)),
        };
        let (spheres, supports) = (scene.spheres(), &scene.facts().spheres);
        let sphere = |index: usize| Sphere {
            center: match direct {
                None => transform.point(spheres[index].center),
                Some(direct) => reflect(direct.spheres[index].center, mirror_height),
            },
            radius: R::exact(spheres[index].radius) * transform.scale,
            support: supports[index],
        };
        View {
            spheres: allocator.slice_with(spheres.len(), sphere),
            tetrahedra: TetrahedraInView::new(
                scene,
                transform,
                mirror_height,
                signs.face_signs,
                to_light,
                &extents,
                allocator,
            ),
            shading: Shading::new(scene, to_light, halfway),
            extents,
        }
    }

    /// The number of solids.
    pub(super) fn solid_count(&self) -> usize {
        self.spheres.len() + self.tetrahedra.count()
    }

    /// The solid of this number.
    #[inline]
    pub(super) fn solid(&self, number: usize) -> Solid<&'f Sphere<R>, &'f TetrahedronInView<R>> {
        match Solid::index(number, self.spheres.len()) {
            Solid::Sphere(index) => Solid::Sphere(&self.spheres[index]),
            Solid::Tetrahedron(index) => Solid::Tetrahedron(self.tetrahedra.get(index)),
        }
    }

    /// The solid of this number, a tetrahedron with its edge functions.
    #[inline]
    fn solid_with_edges(
        &self,
        number: usize,
    ) -> Solid<&'f Sphere<R>, (&'f TetrahedronInView<R>, &'f EdgesInView<R>)> {
        match Solid::index(number, self.spheres.len()) {
            Solid::Sphere(index) => Solid::Sphere(&self.spheres[index]),
            Solid::Tetrahedron(index) => {
                Solid::Tetrahedron((self.tetrahedra.get(index), self.tetrahedra.edges(index)))
            }
        }
    }

    /// The first hit of the eye ray of a pixel, or of its continuation from the parameter `from`
    /// on, and the number of the solid; of solids hit at once, the first in the scene.
    pub(super) fn first_hit(
        &self,
        (column, row): (u32, u32),
        ray: &Line<R>,
        from: Option<R>,
        kinds: SolidKinds,
    ) -> Result<Option<(usize, Hit<R>)>, R::Doubt> {
        let y = self.extents.y_of(row);
        let mut first: Option<(usize, Hit<R>)> = None;
        for solid in self.extents.at((column, row)) {
            if let Some((_, hit)) = &first {
                let nearest = self.extents.min_depth(solid, y);
                let is_behind = nearest.is_finite() && {
                    let nearest = R::exact(nearest);
                    let nearest = from.map_or(nearest, |from| nearest - from);
                    (nearest - hit.depth).sign().is_ok_and(Ordering::is_gt)
                };
                if is_behind {
                    // All following solids are behind, too.
                    break;
                }
            }
            let Some(hit) = self.hit(solid, ray, from.is_some(), kinds)? else {
                continue;
            };
            let order = match &first {
                Some((_, other)) if other.support == hit.support => Ordering::Equal,
                Some((number, other)) => {
                    let order = (hit.depth - other.depth).sign();
                    order.or_else(|doubt| self.compare_abreast(solid, *number, ray, doubt))?
                }
                None => Ordering::Less,
            };
            let is_earlier = first.as_ref().is_some_and(|(number, _)| solid < *number);
            if order.is_lt() || (order.is_eq() && is_earlier) {
                first = Some((solid, hit));
            }
        }
        Ok(first)
    }

    /// How the depths of two solids compare if the sign of their difference is in doubt: certain
    /// for spheres whose centres lie abreast of the ray.
    fn compare_abreast(
        &self,
        one: usize,
        other: usize,
        ray: &Line<R>,
        doubt: R::Doubt,
    ) -> Result<Ordering, R::Doubt> {
        match (self.solid(one), self.solid(other)) {
            (Solid::Sphere(one), Solid::Sphere(other)) => {
                one.compare_abreast(other, ray)?.ok_or(doubt)
            }
            _ => Err(doubt),
        }
    }

    /// Where a ray meets a solid that takes part: anywhere on its line, or only `ahead`.
    pub(super) fn hit(
        &self,
        solid: usize,
        ray: &Line<R>,
        ahead: bool,
        kinds: SolidKinds,
    ) -> Result<Option<Hit<R>>, R::Doubt> {
        match self.solid_with_edges(solid) {
            solid if !kinds.hold(&solid) => Ok(None),
            Solid::Sphere(sphere) if ahead && !sphere.is_ahead(ray)? => Ok(None),
            Solid::Sphere(sphere) => sphere.first_hit(ray),
            Solid::Tetrahedron((t, edges)) => {
                if ahead && !t.solid.is_ahead(&edges.eye, ray)? {
                    return Ok(None);
                }
                t.solid.first_hit(&edges.eye, ray)
            }
        }
    }

    /// Every solid that takes part and that the ray of a pixel meets, in the scene's order.
    pub(super) fn hits(
        &self,
        pixel: (u32, u32),
        ray: &Line<R>,
        ahead: bool,
        kinds: SolidKinds,
    ) -> Result<Vec<(usize, Hit<R>)>, R::Doubt> {
        let mut all = Vec::new();
        for solid in self.extents.at(pixel) {
            if let Some(hit) = self.hit(solid, ray, ahead, kinds)? {
                all.push((solid, hit));
            }
        }
        all.sort_by_key(|(solid, _)| *solid);
        Ok(all)
    }

    /// All solids that stand between the ray's origin and the light.
    pub(super) fn casters(&self, ray: &Line<R>) -> Result<Vec<usize>, R::Doubt> {
        let mut all = Vec::new();
        for solid in 0..self.solid_count() {
            if self.occludes_light(solid, ray)? {
                all.push(solid);
            }
        }
        Ok(all)
    }

    /// Whether a solid stands between the ray's origin, which is in no solid's interior, and the
    /// light.
    pub(super) fn occludes_light(&self, solid: usize, ray: &Line<R>) -> Result<bool, R::Doubt> {
        match self.solid_with_edges(solid) {
            Solid::Sphere(sphere) => sphere.is_ahead(ray),
            Solid::Tetrahedron((t, edges)) => t.solid.is_ahead(&edges.light, ray),
        }
    }

    /// Whether any of these casters stands between the ray's origin and the light.
    pub(super) fn is_shadowed_by(&self, casters: &[u16], ray: &Line<R>) -> Result<bool, R::Doubt> {
        any(casters
            .iter()
            .map(|caster| self.occludes_light(usize::from(*caster), ray)))
    }

    /// The ray to the light from a point on the sphere or plane `support`.
    pub(super) fn ray_to_light(&self, origin: Vector<R>, support: Support) -> Line<R> {
        Line {
            origin,
            direction: self.shading.to_light,
            origin_support: Some(support),
        }
    }
}
