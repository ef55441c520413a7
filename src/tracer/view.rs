//! The scene as one frame sees it.
//!
//! # The mirror
//!
//! A mirrored ray meets what the straight continuation of the eye ray would meet in the mirror
//! image of the scene. So the mirror is a second view of the same kind, with reflected solids under
//! a reflected light, and every formula serves both.

use std::cmp::Ordering;

use bumpalo::Bump;

use super::arena::SliceAllocator;
use super::extent::ExtentsOfSolids;
use super::line::{Hit, Line};
use super::shading::{Shading, halfway};
use super::sphere::Sphere;
use super::tetrahedron::{EdgeFunctions, Tetrahedron, certain_face_signs};
use super::vector::Vector;
use super::view_space::{eye_direction, reflect};
use super::view_transform::ViewTransform;
use crate::number::{Bounded, DoubleDouble, Real, all, any};
use crate::scene::{Scene, Solid, Support};
use crate::stage::Stage;

impl<R: Real> ViewTransform<R> {
    /// The signs that a view of this frame needs. `plain` is the same frame in f64.
    pub(super) fn signs<'f>(
        &self,
        scene: &Scene,
        plain: &ViewTransform<f64>,
        mirrored: bool,
        arena: &'f Bump,
    ) -> Result<ViewSigns<'f>, R::Doubt> {
        let mirror_height = self.surface_height(scene).filter(|_| mirrored);
        let eye_direction_in_scene = plain.eye_direction_in_scene(mirrored);
        let solids = scene.tetrahedra().iter().zip(&scene.facts().right_handed);
        let face_signs = solids.enumerate().map(|(index, (solid, &right_handed))| {
            match certain_face_signs(&solid.vertices, right_handed, eye_direction_in_scene) {
                Some(signs) => Ok(signs),
                None => self
                    .tetrahedron(scene, index, mirror_height)
                    .face_signs(&eye_direction()),
            }
        });
        let eye = eye_direction::<R>().vector;
        let to_light = self.direction_to_light(scene, mirrored).vector;
        let across = eye.cross(to_light);
        let beside = [across.x, across.y, across.z];
        let parallel = beside.map(|x| x.sign().map(Ordering::is_eq));
        let same_way = eye.dot(to_light).sign().map(Ordering::is_gt);
        Ok(ViewSigns {
            face_signs: arena.alloc_slice_try_fill_iter(face_signs)?,
            halfway: if all(parallel.into_iter().chain([same_way]))? {
                Halfway::None
            } else {
                Halfway::Computed
            },
        })
    }
}

/// The sign of n·d for each face: an eye ray enters there (less), runs along the face (equal) or
/// leaves there (greater).
pub(super) type FaceSigns = [Ordering; 4];

/// Signs that all pixels of a view share. Once decided, they serve every number.
#[derive(Clone, Copy)]
pub(super) struct ViewSigns<'f> {
    /// The signs of each tetrahedron.
    face_signs: &'f [FaceSigns],
    /// How h is found.
    halfway: Halfway,
}

/// How the halfway vector h is found.
#[derive(Clone, Copy)]
enum Halfway {
    /// There is none: v + l = 0, the light comes straight into the eye.
    None,
    /// Every number computes it well enough.
    Computed,
    /// v + l nearly cancels, so this h was computed in arbitrary precision.
    Given(Vector<DoubleDouble>),
}

impl ViewSigns<'_> {
    /// The same, with h computed by `refine` if `transform` computes it with too large an error.
    pub(super) fn refined(
        self,
        scene: &Scene,
        transform: &ViewTransform<Bounded>,
        mirrored: bool,
        refine: impl FnOnce() -> Vector<DoubleDouble>,
    ) -> Self {
        let halfway = match self.halfway {
            Halfway::None => Halfway::None,
            other => {
                let h = transform.halfway(scene, mirrored);
                // 15 bits more than an f32 has leave few pixels in doubt.
                const ENOUGH: f64 = f32::EPSILON as f64 * f32::EPSILON as f64 * 128.0;
                let is_good = [h.x, h.y, h.z].iter().all(|x| x.error() < ENOUGH);
                if is_good {
                    other
                } else {
                    Halfway::Given(refine())
                }
            }
        };
        ViewSigns { halfway, ..self }
    }
}

/// The signs of a frame: of the scene itself, and of its mirror image if there is one.
pub(super) struct FrameSigns<'f> {
    pub(super) direct: ViewSigns<'f>,
    pub(super) mirrored: Option<ViewSigns<'f>>,
}

impl<'f> FrameSigns<'f> {
    /// `signs` decides those of the scene itself (false) or of its mirror image (true). The latter
    /// are needed if the surface `mirrors`.
    pub(super) fn decide<D>(
        mirrors: bool,
        signs: impl Fn(bool) -> Result<ViewSigns<'f>, D>,
    ) -> Result<Self, D> {
        Ok(FrameSigns {
            direct: signs(false)?,
            mirrored: if mirrors { Some(signs(true)?) } else { None },
        })
    }
}

/// All solids and the light, turned, scaled, and for the mirror reflected.
pub(super) struct View<'f, R> {
    /// The extent of each solid: spheres, then tetrahedra.
    pub(super) extents: ExtentsOfSolids<'f>,
    pub(super) spheres: &'f [Sphere<R>],
    pub(super) tetrahedra: &'f [TetrahedronInView<R>],
    pub(super) shading: Shading<R>,
}

/// A tetrahedron with its edge functions for eye rays and for rays to the light.
pub(super) struct TetrahedronInView<R> {
    pub(super) solid: Tetrahedron<R>,
    pub(super) eye_edges: EdgeFunctions<R>,
    pub(super) light_edges: EdgeFunctions<R>,
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

impl<'f, R: Real> View<'f, R> {
    /// The scene itself, or in the mirror.
    pub(super) fn new(
        scene: &Scene,
        transform: &ViewTransform<R>,
        signs: &ViewSigns<'_>,
        extents: ExtentsOfSolids<'f>,
        mirrored: bool,
        allocator: &impl SliceAllocator<'f>,
    ) -> Self {
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
        let spheres =
            scene
                .spheres()
                .iter()
                .zip(&scene.facts().spheres)
                .map(|(sphere, &support)| Sphere {
                    center: reflect(transform.point(sphere.center), mirror_height),
                    radius: R::exact(sphere.radius) * transform.scale,
                    support,
                });
        let tetrahedra = signs
            .face_signs
            .iter()
            .enumerate()
            .map(|(index, &face_signs)| {
                let solid = transform.tetrahedron(scene, index, mirror_height);
                let eye_edges = solid.edge_functions(&eye_direction(), face_signs);
                let light_edges = solid.edge_functions_to_light(&to_light);
                TetrahedronInView {
                    solid,
                    eye_edges,
                    light_edges,
                }
            });
        View {
            extents,
            spheres: allocator.slice_of(spheres),
            tetrahedra: allocator.slice_of(tetrahedra),
            shading: Shading::new(scene, to_light, halfway),
        }
    }

    /// The number of solids.
    pub(super) fn solid_count(&self) -> usize {
        self.spheres.len() + self.tetrahedra.len()
    }

    /// The solid of this number.
    #[inline]
    pub(super) fn solid(&self, number: usize) -> Solid<&'f Sphere<R>, &'f TetrahedronInView<R>> {
        Solid::numbered(number, self.spheres, self.tetrahedra)
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
        match self.solid(solid) {
            solid if !kinds.hold(&solid) => Ok(None),
            Solid::Sphere(sphere) if ahead && !sphere.is_ahead(ray)? => Ok(None),
            Solid::Sphere(sphere) => sphere.first_hit(ray),
            Solid::Tetrahedron(t) => {
                if ahead && !t.solid.is_ahead(&t.eye_edges, ray)? {
                    return Ok(None);
                }
                t.solid.first_hit(&t.eye_edges, ray)
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
        match self.solid(solid) {
            Solid::Sphere(sphere) => sphere.is_ahead(ray),
            Solid::Tetrahedron(t) => t.solid.is_ahead(&t.light_edges, ray),
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
