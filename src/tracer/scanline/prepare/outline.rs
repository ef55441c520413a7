//! The outlines and depths of a view's solids that may be seen.

use bumpalo::Bump;
use bumpalo::collections::Vec as Growing;
use fearless_simd::Level;

use crate::number::Bounded;
use crate::scene::{Scene, Side, Solid};
use crate::stage::Stage;
use crate::tracer::arena::collect;
use crate::tracer::extent::Extent;
use crate::tracer::pixel::Picture;
use crate::tracer::scanline::edges::ellipses::SphereOutlines;
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::grid::Grid;
use crate::tracer::scanline::prepare::culling::Tiles;
use crate::tracer::scanline::prepare::depth::{Depth, FaceDepth};
use crate::tracer::tetrahedron::Passage;
use crate::tracer::view::{SolidKinds, View};
use crate::tracer::view_space::eye_direction;

/// The outline of a solid, and its depth.
pub(crate) struct Outlined<'f> {
    /// Its number in the scene.
    pub(crate) number: usize,
    pub(crate) outline: Region<'f>,
    pub(crate) depth: Depth<'f>,
}

/// The solids that are seen directly, or in the mirror, within an extent of the screen.
pub(crate) struct Outlines<'v, 'f> {
    pub(crate) mirrored: bool,
    view: &'v View<'f, Bounded>,
    scene: &'f Scene,
    grid: Grid,
    level: Level,
    arena: &'f Bump,
    /// The rows of the extent.
    rows: (u32, u32),
    /// The numbers of the solids in the scene, in the order of bands.
    pub(crate) numbers: &'f [usize],
    /// The sum of the areas of their extents, in pixels.
    area: u64,
    of_spheres: SphereOutlines,
    /// The outlines of these solids, once they are culled.
    culled: Option<Growing<'f, Outlined<'f>>>,
}

/// What the front faces of a tetrahedron are prepared from.
#[derive(Clone, Copy)]
pub(crate) struct OutlinedFaces<'f> {
    /// The number of the solid in the scene.
    pub(crate) number: usize,
    /// The half-planes of the outline, and its rows.
    pub(crate) outline: &'f [HalfPlane<'f>],
    pub(crate) rows: (u32, u32),
}

impl<'f> Outlined<'f> {
    /// What the front faces are prepared from.
    pub(crate) fn faces(&self) -> OutlinedFaces<'f> {
        OutlinedFaces {
            number: self.number,
            outline: self.outline.half_planes(),
            rows: self.outline.rows(),
        }
    }
}

impl<'v, 'f> Outlines<'v, 'f> {
    /// The solids of a view. `within` is the extent of the surface, for the view in the mirror.
    pub(crate) fn new(
        picture: &Picture<'f, Bounded>,
        view: &'v View<'f, Bounded>,
        within: Option<&Extent>,
        (grid, level): (Grid, Level),
        arena: &'f Bump,
    ) -> Self {
        let (scene, stage) = (picture.scene, picture.stage);
        let facts = scene.facts();
        let mirrored = within.is_some();
        let kinds = SolidKinds::of(stage);
        let is_seen = |&number: &usize| {
            let extent = view.extents.of(number);
            kinds.hold(&scene.solid(number))
                && extent.area() > 0
                // From this stage on all solids take part, and a hidden one is never seen.
                && !(facts.enclosed[number] && stage >= Stage::Shading)
                // The surface mirrors nothing that is below.
                && !(mirrored && facts.sides[number] == Side::Below)
                && within.is_none_or(|within| extent.meets(within))
        };
        let numbers = view.extents.in_bands.iter().copied().map(usize::from);
        let numbers = collect(arena, numbers.filter(is_seen));
        Outlines {
            mirrored,
            view,
            scene,
            grid,
            level,
            arena,
            rows: within.map_or((0, grid.size), |within| within.rows),
            numbers,
            area: numbers
                .iter()
                .map(|&number| view.extents.of(number).area())
                .sum(),
            of_spheres: SphereOutlines::new(grid),
            culled: None,
        }
    }

    /// The mean number of extents that hold a pixel.
    pub(crate) fn depth_complexity(&self) -> u64 {
        self.area / (u64::from(self.grid.size) * u64::from(self.grid.size))
    }

    /// The mean number of shadows on front faces that a row may meet, where half of all faces are
    /// front faces; in a crowd of which not all casters are found, as many as there can be.
    pub(crate) fn face_shadows(&self) -> u64 {
        let casters = &self.scene.facts().casters;
        if !casters.are_found() {
            return u64::MAX;
        }
        let of_solid = |&number: &usize| match self.scene.solid(number) {
            Solid::Sphere(_) => 0,
            Solid::Tetrahedron(_) => {
                let (from, to) = self.rows_of(number);
                let shadows = (0..4).map(|face| casters.on(number, Some(face)).len() as u64);
                u64::from(to.saturating_sub(from)) * shadows.sum::<u64>()
            }
        };
        self.numbers.iter().map(of_solid).sum::<u64>() / (2 * u64::from(self.grid.size))
    }

    /// Leaves out the solids that others hide in all tiles.
    pub(crate) fn cull(&mut self, tiles: &mut Tiles<'_>) {
        let mut all = Growing::with_capacity_in(self.numbers.len(), self.arena);
        all.extend(self.numbers.iter().map(|&number| self.outline(number)));
        for solid in &all {
            // Mirrored rays begin at the surface, and may miss a solid that goes through it.
            if !self.mirrored || self.side(solid.number) == Side::Above {
                tiles.hide_behind(&solid.outline, &solid.depth);
            }
        }
        for solid in &mut all {
            let rows = tiles.rows_of_solid(&solid.outline, &solid.depth);
            solid.outline.restrict(rows);
        }
        all.retain(|solid| !solid.outline.is_nowhere());
        self.numbers = collect(self.arena, all.iter().map(|solid| solid.number));
        self.culled = Some(all);
    }

    /// Calls `each` with the outlines of the solids of `numbers`. Those that are not culled are made
    /// one by one: each is used while the processor has it at hand, and without a copy, which would
    /// wait for what was just written (`edges/ellipses.rs`).
    pub(crate) fn for_each(mut self, mut each: impl FnMut(Outlined<'f>)) {
        match self.culled.take() {
            Some(culled) => culled.into_iter().for_each(each),
            None => {
                for &number in self.numbers {
                    each(self.outline(number));
                }
            }
        }
    }

    /// The side of the surface that a solid is on.
    pub(crate) fn side(&self, number: usize) -> Side {
        self.scene.facts().sides[number]
    }

    /// The rows in which a solid may be seen.
    fn rows_of(&self, number: usize) -> (u32, u32) {
        let (from, to) = self.view.extents.of(number).rows;
        (from.max(self.rows.0), to.min(self.rows.1))
    }

    /// The outline of a solid.
    fn outline(&self, number: usize) -> Outlined<'f> {
        let (grid, arena, rows) = (self.grid, self.arena, self.rows_of(number));
        self.view.prepare(number, self.level);
        match self.view.solid(number) {
            Solid::Sphere(sphere) => {
                let outline = || self.of_spheres.of(sphere.center, sphere.radius);
                let ellipse = &*arena.alloc_with(outline);
                Outlined {
                    number,
                    depth: Depth::of_sphere(sphere.center, ellipse, sphere.support, grid),
                    outline: Region::new(&[], Some(ellipse), grid).within(rows),
                }
            }
            Solid::Tetrahedron(t) => {
                let lines = (&t.solid, eye_direction().vector);
                let passage = Passage::of(t.eye_signs);
                let screen = (grid, self.level);
                let met = HalfPlane::all_of(lines, &passage.met, None, screen, arena);
                let depths = passage
                    .entered()
                    .map(|face| FaceDepth::new(&t.solid.inner_half_space(face), grid));
                Outlined {
                    number,
                    outline: Region::new(met, None, grid).within(rows),
                    depth: Depth::FrontFaces(collect(arena, depths)),
                }
            }
        }
    }
}
