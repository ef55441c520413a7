//! What a pixel shows, in every stage and every arithmetic: the definition of the picture.

use std::cmp::Ordering;
use std::iter;

use glam::DVec3;

use super::arena::SliceAllocator;
use super::decision::{Decision, Seen};
use super::extent::{Extent, Extents};
use super::line::{Hit, Line, Normal};
use super::surface::Surface;
use super::surface_casters::SurfaceCasterLookup;
use super::vector::Vector;
use super::view::{SolidKinds, View};
use super::view_signs::FrameSigns;
use super::view_transform::ViewTransform;
use crate::number::{Real, all, any};
use crate::scene::{Scene, Solid};
use crate::stage::Stage;

/// What all pixels of a frame share.
pub(super) struct Picture<'f, R> {
    pub(super) scene: &'f Scene,
    pub(super) stage: Stage,
    pub(super) size: u32,
    pub(super) transform: ViewTransform<R>,
    pub(super) view: View<'f, R>,
    /// From stage 5 on, if the scene has a surface.
    pub(super) surface: Option<SeenSurface<'f, R>>,
}

/// The surface as pixels show it.
pub(super) struct SeenSurface<'f, R> {
    /// The geometry.
    pub(super) square: Surface<R>,
    /// The pixels that may show it.
    pub(super) extent: Extent,
    casters: SurfaceCasterLookup<'f>,
    color: Vector<R>,
    pub(super) mirror: Option<Mirror<'f, R>>,
}

/// What the surface mirrors, from stage 6 on.
pub(super) struct Mirror<'f, R> {
    pub(super) view: View<'f, R>,
    pub(super) reflectance: R,
}

/// Whether this stage has mirror images.
pub(super) fn mirrors(scene: &Scene, stage: Stage) -> bool {
    stage >= Stage::Reflection && scene.surface().is_some()
}

/// A pixel: its decision and its samples.
pub(super) type Pixel = (Decision, [f32; 3]);

/// A decision, with the normal of a sphere in the light.
type Decided<R> = Result<(Decision, Option<Normal<R>>), <R as Real>::Doubt>;

/// The rules that hits and shadows follow: the right ones, unless a method is overridden by a
/// mistake.
pub(super) trait Rules<R: Real> {
    /// The hit of the solid that a ray hits first.
    fn hit(
        &self,
        _view: &View<'_, R>,
        _solid: usize,
        _ray: &Line<R>,
        first: Hit<R>,
    ) -> Result<Hit<R>, R::Doubt> {
        Ok(first)
    }

    /// Whether a point of a solid is in shadow, in the mirror's view or in the direct one.
    fn is_in_shadow(
        &self,
        picture: &Picture<'_, R>,
        mirrored: bool,
        solid: usize,
        hit: &Hit<R>,
    ) -> Result<bool, R::Doubt> {
        picture.is_in_shadow(mirrored, solid, hit)
    }

    /// Whether the point of the surface that a pixel shows is in shadow.
    fn surface_is_in_shadow(
        &self,
        picture: &Picture<'_, R>,
        surface: &SeenSurface<'_, R>,
        pixel: (u32, u32),
        point: Vector<R>,
    ) -> Result<bool, R::Doubt> {
        picture.surface_is_in_shadow(surface, pixel, point)
    }
}

/// The right rules.
struct Right;

impl<R: Real> Rules<R> for Right {}

impl<'f, R: Real> Picture<'f, R> {
    /// `signs` and `extents` must be those of the same frame.
    pub(super) fn new(
        scene: &'f Scene,
        stage: Stage,
        transform: &ViewTransform<R>,
        size: u32,
        signs: &FrameSigns<'f>,
        extents: &Extents<'f>,
        allocator: &impl SliceAllocator<'f>,
    ) -> Self {
        let view = |signs, extents, direct: Option<&View<'f, R>>| {
            View::new(scene, transform, signs, extents, direct, allocator)
        };
        let direct = view(&signs.direct, extents.direct, None);
        let mirror = |reflectance| {
            let signs = signs.mirrored.as_ref()?;
            Some(Mirror {
                view: view(signs, extents.mirrored, Some(&direct)),
                reflectance: R::exact(reflectance),
            })
        };
        let seen = extents.surface.as_ref().zip(extents.casters_on_surface);
        let surface = match (scene.surface(), transform.surface(scene), seen) {
            (Some(described), Some(square), Some((extent, casters))) if stage >= Stage::Shadow => {
                Some(SeenSurface {
                    square,
                    extent: *extent,
                    casters,
                    color: Vector::exact(described.color),
                    mirror: mirror(described.reflectance),
                })
            }
            _ => None,
        };
        Picture {
            scene,
            stage,
            size,
            transform: *transform,
            view: direct,
            surface,
        }
    }

    /// The decision of the pixel at `column` from the left and `row` from the bottom. If it shows a
    /// sphere in the light, also the normal: all other decisions have one colour.
    pub(super) fn decide(&self, column: u32, row: u32) -> Decided<R> {
        self.decide_by(&Right, column, row)
    }

    /// The same, for a pixel that is known to show the sphere of `shown`, in shadow or not.
    pub(super) fn decide_on_sphere(&self, shown: Decision, column: u32, row: u32) -> Decided<R> {
        if let Some((mirrored, sphere)) = solid_of(shown)
            && let Some(hit) = self.hit_on_line(mirrored, sphere, (column, row))?
        {
            self.solid_at(&Right, mirrored, sphere, &hit)
        } else {
            // There is no such pixel: a sphere that is shown is hit.
            self.decide(column, row)
        }
    }

    /// Where the line of a pixel first hits a solid, directly or in the mirror, whatever hides that.
    fn hit_on_line(
        &self,
        mirrored: bool,
        solid: usize,
        (column, row): (u32, u32),
    ) -> Result<Option<Hit<R>>, R::Doubt> {
        // The eye's ray goes on straight into the reflected scene.
        let ray = self.transform.eye_ray(column, row);
        self.view(mirrored).hit(solid, &ray, false, SolidKinds::All)
    }

    /// The same by other rules.
    pub(super) fn decide_by(&self, rules: &impl Rules<R>, column: u32, row: u32) -> Decided<R> {
        match self.stage {
            Stage::Image => Ok((Decision::Quadrant(quadrant(column, row, self.size)), None)),
            Stage::Spheres | Stage::Tetrahedron | Stage::Shading => {
                self.solid_alone(rules, column, row)
            }
            Stage::Shadow | Stage::Reflection | Stage::Animation => self.traced(rules, column, row),
        }
    }

    /// The samples of the pixel if it shows a sphere in the light, as `decision` says, whatever
    /// hides that; `None` where its line misses the sphere or, in the stages with shadows, the
    /// sphere is turned away from the light.
    pub(super) fn color_if(
        &self,
        decision: Decision,
        column: u32,
        row: u32,
    ) -> Result<Option<[f32; 3]>, R::Doubt> {
        let Some((mirrored, solid)) = solid_of(decision) else {
            return Ok(None);
        };
        let Some(hit) = self.hit_on_line(mirrored, solid, (column, row))? else {
            return Ok(None);
        };
        let shading = &self.view(mirrored).shading;
        if self.stage >= Stage::Shadow && shading.facing_light(&hit.normal)?.is_le() {
            return Ok(None);
        }
        self.color(decision, Some(&hit.normal)).map(Some)
    }

    /// The samples of a decision: with `normal`, of one pixel; without, of all that show it.
    pub(super) fn color(
        &self,
        decision: Decision,
        normal: Option<&Normal<R>>,
    ) -> Result<[f32; 3], R::Doubt> {
        let color = match (decision, &self.surface) {
            (Decision::Quadrant(number), _) => Vector::exact(QUADRANTS[usize::from(number)]),
            (Decision::Solid(seen), _) => self.color_of_solid(&self.view, seen, normal)?,
            (Decision::Surface, Some(surface)) => surface.color,
            (Decision::SurfaceInShadow, _) => self.view.shading.ambient(),
            (Decision::Mirrored(seen), _) => {
                self.reflected(self.color_of_solid(self.view(true), seen, normal)?)
            }
            // The background: nothing else is decided.
            _ => Vector::exact(self.scene.background()),
        };
        Ok([
            color.x.to_sample()?,
            color.y.to_sample()?,
            color.z.to_sample()?,
        ])
    }

    fn color_of_solid(
        &self,
        view: &View<'_, R>,
        seen: Seen,
        normal: Option<&Normal<R>>,
    ) -> Result<Vector<R>, R::Doubt> {
        let solid = view.solid(seen.solid.into());
        let color = match solid {
            Solid::Sphere(_) => self.solid_color(usize::from(seen.solid)),
            Solid::Tetrahedron(t) => Vector::exact(t.color),
        };
        if self.stage < Stage::Shading {
            return Ok(color);
        }
        let face = match (solid, seen.face) {
            (Solid::Tetrahedron(t), Some(face)) if !seen.in_shadow => {
                Some(t.solid.normal(face.into()))
            }
            _ => None,
        };
        let light = match normal.or(face.as_ref()) {
            Some(normal) if !seen.in_shadow => view.shading.lit(normal)?,
            _ => view.shading.ambient(),
        };
        Ok(color.times(light))
    }

    /// Stages 2 to 4: the first hit, without shadows.
    fn solid_alone(&self, rules: &impl Rules<R>, column: u32, row: u32) -> Decided<R> {
        let ray = self.transform.eye_ray(column, row);
        let kinds = SolidKinds::of(self.stage);
        let hit = self.view.first_hit((column, row), &ray, None, kinds)?;
        Ok(match hit {
            Some((solid, hit)) => {
                let hit = rules.hit(&self.view, solid, &ray, hit)?;
                let seen = seen(solid, &hit, false);
                let normal = normal_of(seen, &hit).filter(|_| self.stage == Stage::Shading);
                (Decision::Solid(seen), normal)
            }
            None => (Decision::Background, None),
        })
    }

    /// Stages 5 to 7: the first hit among the solids and the surface.
    fn traced(&self, rules: &impl Rules<R>, column: u32, row: u32) -> Decided<R> {
        let ray = self.transform.eye_ray(column, row);
        let first = self
            .view
            .first_hit((column, row), &ray, None, SolidKinds::All)?;
        let hit = match first {
            Some((solid, hit)) => Some((solid, rules.hit(&self.view, solid, &ray, hit)?)),
            None => None,
        };
        if let Some(surface) = self
            .surface
            .as_ref()
            .filter(|surface| surface.extent.holds(column, row))
        {
            let (depth, point) = self.transform.on_surface(&surface.square, &ray, row);
            let hides = || match &hit {
                // At equal depths, the solid is seen, and not the surface.
                Some((_, hit)) if hit.support == surface.square.support => Ok(false),
                Some((_, hit)) => (hit.depth - depth).sign().map(Ordering::is_gt),
                None => Ok(true),
            };
            let contains = || surface.square.contains(point);
            if all(iter::once_with(hides).chain(iter::once_with(contains)))? {
                return self.surface_at(rules, surface, (column, row), depth, point);
            }
        }
        match hit {
            Some((solid, hit)) => self.solid_at(rules, false, solid, &hit),
            None => Ok((Decision::Background, None)),
        }
    }

    /// The decision where a solid is in front, directly or in the mirror.
    fn solid_at(
        &self,
        rules: &impl Rules<R>,
        mirrored: bool,
        solid: usize,
        hit: &Hit<R>,
    ) -> Decided<R> {
        let has_shadows = self.stage >= Stage::Shadow;
        let in_shadow = has_shadows && rules.is_in_shadow(self, mirrored, solid, hit)?;
        let seen = seen(solid, hit, in_shadow);
        let decision = if mirrored {
            Decision::Mirrored(seen)
        } else {
            Decision::Solid(seen)
        };
        Ok((decision, normal_of(seen, hit)))
    }

    /// The decision where the surface is in front: in shadow, mirroring, or plain.
    fn surface_at(
        &self,
        rules: &impl Rules<R>,
        surface: &SeenSurface<'_, R>,
        pixel: (u32, u32),
        depth: R,
        point: Vector<R>,
    ) -> Decided<R> {
        if rules.surface_is_in_shadow(self, surface, pixel, point)? {
            return Ok((Decision::SurfaceInShadow, None));
        }
        if let Some(mirror) = &surface.mirror {
            let ray = surface.square.mirrored_ray(point);
            if let Some((solid, hit)) =
                mirror
                    .view
                    .first_hit(pixel, &ray, Some(depth), SolidKinds::All)?
            {
                let hit = rules.hit(&mirror.view, solid, &ray, hit)?;
                return self.solid_at(rules, true, solid, &hit);
            }
        }
        Ok((Decision::Surface, None))
    }

    /// Whether a point of the surface is in shadow.
    fn surface_is_in_shadow(
        &self,
        surface: &SeenSurface<'_, R>,
        pixel: (u32, u32),
        point: Vector<R>,
    ) -> Result<bool, R::Doubt> {
        let to_light = self.view.ray_to_light(point, surface.square.support);
        self.view
            .is_shadowed_by(surface.casters.at(pixel), &to_light)
    }

    /// The mirror's view, or the direct one.
    pub(super) fn view(&self, mirrored: bool) -> &View<'f, R> {
        let mirror = self.mirror().filter(|_| mirrored);
        mirror.map_or(&self.view, |mirror| &mirror.view)
    }

    fn mirror(&self) -> Option<&Mirror<'f, R>> {
        let surface = self.surface.as_ref()?;
        surface.mirror.as_ref()
    }

    /// Whether a point of a solid is in shadow.
    fn is_in_shadow(&self, mirrored: bool, solid: usize, hit: &Hit<R>) -> Result<bool, R::Doubt> {
        let view = self.view(mirrored);
        let ray = view.ray_to_light(hit.point, hit.support);
        let turned_away = || view.shading.facing_light(&hit.normal).map(Ordering::is_le);
        let casters = &self.scene.facts().casters;
        let casters = casters.on(solid, hit.face.map(usize::from));
        let by_solid = || view.is_shadowed_by(casters, &ray);
        let by_surface = || {
            self.surface
                .as_ref()
                .map_or(Ok(false), |surface| surface.square.is_ahead(&ray))
        };
        any(iter::once_with(turned_away)
            .chain(iter::once_with(by_solid))
            .chain(iter::once_with(by_surface)))
    }

    /// What the surface reflects of a colour.
    pub(super) fn reflected(&self, color: Vector<R>) -> Vector<R> {
        self.mirror()
            .map_or(color, |mirror| color * mirror.reflectance)
    }

    /// The colour c of a solid.
    pub(super) fn solid_color(&self, solid: usize) -> Vector<R> {
        Vector::exact(match self.scene.solid(solid) {
            Solid::Sphere(sphere) => sphere.color,
            Solid::Tetrahedron(tetrahedron) => tetrahedron.color,
        })
    }
}

/// Whether a pixel shows a solid in the mirror, and the number of the solid, if it shows one.
fn solid_of(decision: Decision) -> Option<(bool, usize)> {
    match decision {
        Decision::Solid(seen) => Some((false, seen.solid.into())),
        Decision::Mirrored(seen) => Some((true, seen.solid.into())),
        _ => None,
    }
}

fn seen<R>(solid: usize, hit: &Hit<R>, in_shadow: bool) -> Seen {
    // A scene has at most 4096 solids.
    Seen {
        solid: solid as u16,
        face: hit.face,
        in_shadow,
    }
}

/// The normal, if the colour depends on it: that of a sphere in the light.
fn normal_of<R: Copy>(seen: Seen, hit: &Hit<R>) -> Option<Normal<R>> {
    seen.is_lit_sphere().then_some(hit.normal)
}

/// The colours of the quadrants of Code 2-1, in the order of its branches.
pub(super) const QUADRANTS: [DVec3; 4] = [
    DVec3::new(0.3, 0.3, 0.0),
    DVec3::new(0.0, 0.3, 0.3),
    DVec3::new(0.3, 0.0, 0.3),
    DVec3::ZERO,
];

/// The number of columns in the left half of Code 2-1, and of rows in its lower half, with 250 read
/// as N/2. The first of its `<=` and `>=` that holds decides: what lies at N/2 is to the left, and
/// below.
pub(super) fn left_half(size: u32) -> u32 {
    size / 2 + 1
}

/// The quadrant of Code 2-1, in the order of its branches.
pub(super) fn quadrant(column: u32, row: u32, size: u32) -> u8 {
    let half = left_half(size);
    match (column < half, row < half) {
        (true, true) => 0,
        (true, false) => 1,
        (false, true) => 2,
        (false, false) => 3,
    }
}
