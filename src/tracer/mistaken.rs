//! Pictures of tracers that make one mistake, for comparison with the picture of a tracer that may
//! make it.
//!
//! The pixels are those of the true picture by other [`Rules`], in f64.

use std::convert::Infallible;

use super::arena::Arena;
use super::ladder::{Pixels, Plain};
use super::line::{Direction, Hit, Line};
use super::pixel::{Picture, Rules, SeenSurface};
use super::vector::Vector;
use super::view::View;
use crate::scene::{Scene, Solid};
use crate::stage::Stage;

/// The mistake of a tracer; the default is none.
#[derive(Clone, Copy, Default)]
pub(crate) struct Mistake {
    /// n·l has the wrong sign.
    pub(crate) shading_reversed: bool,
    /// Where the solids stand that cast a shadow on a point.
    pub(crate) solids: Toward,
    /// Where the surface lies if it casts a shadow on a point of a solid.
    pub(crate) surface: Toward,
    /// Every solid casts a shadow on itself.
    pub(crate) own_shadow: bool,
    /// Which solids are hit where a ray leaves them.
    pub(crate) far: Far,
}

/// Where something stands, seen from a point along the line to the light.
#[derive(Clone, Copy, Default, PartialEq)]
pub(crate) enum Toward {
    #[default]
    Light,
    /// Away from the light.
    Away,
    /// Anywhere on the line.
    Either,
}

/// Which solids are hit where a ray leaves them.
#[derive(Clone, Copy, Default, PartialEq)]
pub(crate) enum Far {
    #[default]
    None,
    Spheres,
    All,
}

/// A frame: a scene in a stage at a finite angle α, of N × N pixels.
type Framed<'s> = (&'s Scene, Stage, f64, u32);

/// Does `work` with the true pixels of a frame, in f64, each by its column and row.
pub(crate) fn with_pixels<T>(
    (scene, stage, alpha, size): Framed<'_>,
    work: impl FnOnce(&dyn Fn(u32, u32) -> [f32; 3]) -> T,
) -> T {
    let arena = Arena::default();
    let frame = Plain::<f64>::new(scene, stage, alpha, size, &arena);
    work(&|column, row| frame.pixel(column, row).0.1)
}

/// A frame, and the same frame in light from the opposite side.
pub(crate) struct Mistaken<'f> {
    right: Picture<'f, f64>,
    reversed: Picture<'f, f64>,
}

impl Mistaken<'_> {
    /// Does `work` with a frame.
    pub(crate) fn with<T>(
        (scene, stage, alpha, size): Framed<'_>,
        work: impl FnOnce(&Mistaken<'_>) -> T,
    ) -> T {
        let reversed = &scene.with_light_reversed();
        let (arena, other) = (Arena::default(), Arena::default());
        work(&Mistaken {
            right: Plain::new(scene, stage, alpha, size, &arena).picture,
            reversed: Plain::new(reversed, stage, alpha, size, &other).picture,
        })
    }

    /// The samples of the pixel at a column and a row, by a tracer that makes this mistake.
    pub(crate) fn pixel(&self, mistake: Mistake, column: u32, row: u32) -> [f32; 3] {
        let rules = MistakenRules {
            mistake,
            reversed: &self.reversed,
        };
        let Ok((decision, normal)) = self.right.decide_by(&rules, column, row);
        let shading = if mistake.shading_reversed {
            &self.reversed
        } else {
            &self.right
        };
        let Ok(color) = shading.color(decision, normal.as_ref());
        color
    }
}

/// The rules of a tracer with a mistake.
struct MistakenRules<'m, 'f> {
    mistake: Mistake,
    reversed: &'m Picture<'f, f64>,
}

impl Rules<f64> for MistakenRules<'_, '_> {
    fn hit(
        &self,
        view: &View<'_, f64>,
        solid: usize,
        ray: &Line<f64>,
        first: Hit<f64>,
    ) -> Result<Hit<f64>, Infallible> {
        let is_far = match self.mistake.far {
            Far::None => false,
            Far::Spheres => first.face.is_none(),
            Far::All => true,
        };
        let far = if is_far {
            last_hit(view, solid, ray)?
        } else {
            None
        };
        Ok(far.unwrap_or(first))
    }

    fn is_in_shadow(
        &self,
        picture: &Picture<'_, f64>,
        mirrored: bool,
        solid: usize,
        hit: &Hit<f64>,
    ) -> Result<bool, Infallible> {
        let Mistake {
            shading_reversed,
            solids,
            surface,
            own_shadow,
            ..
        } = self.mistake;
        let (view, reversed) = (picture.view(mirrored), self.reversed.view(mirrored));
        let facing = view.shading.facing_light(&hit.normal)?;
        let turned_away = if shading_reversed {
            facing.is_ge()
        } else {
            facing.is_le()
        };
        let to_light = view.ray_to_light(hit.point, hit.support);
        let away = reversed.ray_to_light(hit.point, hit.support);
        let by_surface = |ray| match &picture.surface {
            Some(surface) => surface.square.is_ahead(ray),
            None => Ok(false),
        };
        Ok(turned_away
            || own_shadow
            || surface.includes_light_side() && by_surface(&to_light)?
            || surface.includes_far_side() && by_surface(&away)?
            || solids.includes_light_side() && is_in_shadow(view, &to_light, Some(solid))?
            || solids.includes_far_side() && is_in_shadow(reversed, &away, Some(solid))?)
    }

    fn surface_is_in_shadow(
        &self,
        picture: &Picture<'_, f64>,
        surface: &SeenSurface<'_, f64>,
        _: (u32, u32),
        point: Vector<f64>,
    ) -> Result<bool, Infallible> {
        let (solids, support) = (self.mistake.solids, surface.square.support);
        let to_light = picture.view.ray_to_light(point, support);
        let away = self.reversed.view.ray_to_light(point, support);
        Ok(
            solids.includes_light_side() && is_in_shadow(&picture.view, &to_light, None)?
                || solids.includes_far_side() && is_in_shadow(&self.reversed.view, &away, None)?,
        )
    }
}

impl Toward {
    fn includes_light_side(self) -> bool {
        self != Toward::Away
    }

    fn includes_far_side(self) -> bool {
        self != Toward::Light
    }
}

/// Whether any solid but this one stands between the ray's origin and the light of a view.
fn is_in_shadow(
    view: &View<'_, f64>,
    ray: &Line<f64>,
    but: Option<usize>,
) -> Result<bool, Infallible> {
    for solid in 0..view.solid_count() {
        if Some(solid) != but && view.occludes_light(solid, ray)? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The hit where a line leaves a solid: the first hit of the reversed line.
fn last_hit(
    view: &View<'_, f64>,
    solid: usize,
    line: &Line<f64>,
) -> Result<Option<Hit<f64>>, Infallible> {
    let direction = Direction {
        vector: -line.direction.vector,
        ..line.direction
    };
    let back = Line { direction, ..*line };
    let hit = match view.solid(solid) {
        Solid::Sphere(sphere) => sphere.first_hit(&back)?,
        Solid::Tetrahedron(t) => {
            let face_signs = t.solid.face_signs(&direction)?;
            let functions = t.solid.edge_functions(&direction, face_signs);
            t.solid.first_hit(&functions, &back)?
        }
    };
    Ok(hit.map(|hit| Hit {
        depth: -hit.depth,
        ..hit
    }))
}
