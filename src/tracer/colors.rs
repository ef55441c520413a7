//! The colours that the decisions of a frame give, whether a pixel takes them or not.

use super::arena::Arena;
use super::decision::{Decision, Seen};
use super::ladder::{Ladder, RowPixels, Rung};
use super::pixel::SeenSurface;
use super::view::SolidKinds;
use crate::number::Bounded;
use crate::scene::{Scene, Solid};
use crate::stage::Stage;

/// The most solids that are looked at in a pixel: where thousands lie one behind the other, looking
/// at all of them would take minutes.
const NEAREST: usize = 32;

/// What every decision that a stage knows looks like in a frame, in exact arithmetic.
pub(crate) struct Colors<'f> {
    scene: &'f Scene,
    stage: Stage,
    ladder: Ladder<'f>,
}

/// Does `work` with the colours of a frame: a scene in a stage at a finite angle α, of N × N
/// pixels.
pub(crate) fn with_colors<T>(
    (scene, stage, alpha, size): (&Scene, Stage, f64, u32),
    work: impl FnOnce(&Colors<'_>) -> T,
) -> T {
    let arena = Arena::default();
    work(&Colors {
        scene,
        stage,
        ladder: Ladder::new(scene, stage, alpha, size, Rung::Hardware, &arena),
    })
}

impl Colors<'_> {
    /// The samples of the pixel at a column and a row if it shows what `decision` says; `None`
    /// where that is a lit sphere which its line misses, or meets where the sphere is turned away
    /// from the light.
    pub(crate) fn color(&self, decision: Decision, (column, row): (u32, u32)) -> Option<[f32; 3]> {
        if self.is_shared(decision) {
            Some(self.ladder.color(decision))
        } else {
            self.ladder.color_if(decision, column, row)
        }
    }

    /// Every decision whose colour all its pixels share. Face 0 stands for all four faces where
    /// they have one colour.
    pub(crate) fn shared(&self) -> impl Iterator<Item = Decision> + '_ {
        let solids = || 0..self.scene.solid_count();
        let mirrored = self.mirrors().then(solids).into_iter().flatten();
        self.apart_from_solids()
            .chain(
                self.surface()
                    .is_some()
                    .then_some(SURFACE)
                    .into_iter()
                    .flatten(),
            )
            .chain(self.of_solids(solids(), Decision::Solid))
            .chain(self.of_solids(mirrored, Decision::Mirrored))
            .filter(|decision| self.is_shared(*decision))
    }

    /// The decisions that the line of a pixel can lead to: those of the solids and the surface
    /// whose extents hold the pixel, hidden or not. The nearest solids come first, and solids
    /// behind very many others are left out.
    pub(crate) fn near(&self, pixel: (u32, u32)) -> impl Iterator<Item = Decision> + '_ {
        let picture = self.ladder.bounded();
        let solids = picture.view.extents.at(pixel).take(NEAREST);
        let surface = self
            .surface()
            .filter(|surface| surface.extent.holds(pixel.0, pixel.1));
        let mirrored = surface.and_then(|surface| surface.mirror.as_ref());
        let mirrored = mirrored.map(|mirror| mirror.view.extents.at(pixel).take(NEAREST));
        self.of_solids(solids, Decision::Solid)
            .chain(surface.map(|_| SURFACE).into_iter().flatten())
            .chain(self.of_solids(mirrored.into_iter().flatten(), Decision::Mirrored))
            .chain(self.apart_from_solids())
    }

    /// The quadrants or the background.
    fn apart_from_solids(&self) -> impl Iterator<Item = Decision> + use<> {
        let quadrants = if self.stage == Stage::Image {
            0..4
        } else {
            0..0
        };
        let background = (self.stage != Stage::Image).then_some(Decision::Background);
        quadrants.map(Decision::Quadrant).chain(background)
    }

    fn surface(&self) -> Option<&SeenSurface<'_, Bounded>> {
        self.ladder.bounded().surface.as_ref()
    }

    fn mirrors(&self) -> bool {
        self.surface()
            .is_some_and(|surface| surface.mirror.is_some())
    }

    fn of_solids<'a>(
        &'a self,
        solids: impl Iterator<Item = usize> + 'a,
        decision: fn(Seen) -> Decision,
    ) -> impl Iterator<Item = Decision> + 'a {
        solids
            .flat_map(|solid| self.ways_to_see(solid))
            .map(decision)
    }

    /// The ways in which this stage shows a solid.
    fn ways_to_see(&self, solid: usize) -> impl Iterator<Item = Seen> + use<'_> {
        let index = Solid::index(solid, self.scene.spheres().len());
        let has_shadows = self.stage >= Stage::Shadow;
        let is_seen = self.stage != Stage::Image && SolidKinds::of(self.stage).hold(&index);
        let facts = self.scene.facts();
        let (sphere, dark_face, facing_light) = match index {
            Solid::Sphere(_) => (Some(None), None, None),
            Solid::Tetrahedron(index) => (None, Some(0), Some(facts.facing_light[index])),
        };
        // In flat colour one face looks like the others.
        let faces = if self.stage == Stage::Tetrahedron {
            1
        } else {
            4
        };
        let facing_light = (0..).zip(facing_light.into_iter().flatten()).take(faces);
        let lit_faces = facing_light.filter(move |(_, facing)| !has_shadows || facing.is_gt());
        let lit_faces = lit_faces.map(|(face, _)| Some(face));
        // A scene has at most 4096 solids.
        let seen = move |face, in_shadow| Seen {
            solid: solid as u16,
            face,
            in_shadow,
        };
        let in_shadow = has_shadows.then(|| seen(dark_face, true));
        let lit = sphere.into_iter().chain(lit_faces);
        lit.map(move |face| seen(face, false))
            .chain(in_shadow)
            .filter(move |_| is_seen)
    }

    /// Whether all pixels of a decision share one colour: only those of lit spheres do not.
    fn is_shared(&self, decision: Decision) -> bool {
        match decision {
            Decision::Solid(seen) | Decision::Mirrored(seen) => {
                self.stage < Stage::Shading || !seen.is_lit_sphere()
            }
            _ => true,
        }
    }
}

/// The surface where it mirrors nothing.
const SURFACE: [Decision; 2] = [Decision::Surface, Decision::SurfaceInShadow];
