//! The outlines and depths of a view's solids, before culling.

use bumpalo::Bump;

use crate::number::Bounded;
use crate::scene::{Scene, Side, Solid};
use crate::stage::Stage;
use crate::tracer::arena::{bucketed, collect};
use crate::tracer::extent::Extent;
use crate::tracer::pixel::Picture;
use crate::tracer::scanline::edges::ellipse::Ellipse;
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::grid::{Grid, ROWS};
use crate::tracer::scanline::prepare::culling::Tiles;
use crate::tracer::scanline::prepare::depth::{Depth, FaceDepth};
use crate::tracer::view::{SolidKinds, View};

/// The outline of a solid, and its depth.
pub(crate) struct Outlined<'f> {
    /// Its number in the scene.
    pub(crate) number: usize,
    pub(crate) side: Side,
    pub(crate) outline: Region<'f>,
    pub(crate) depth: Depth<'f>,
    /// The face numbers of a tetrahedron's front faces.
    pub(crate) front_faces: &'f [usize],
}

/// The solids that are seen directly, or in the mirror, within an extent of the screen.
pub(crate) struct Outlines<'f> {
    pub(crate) mirrored: bool,
    pub(crate) all: bumpalo::collections::Vec<'f, Outlined<'f>>,
    /// The sum of the areas of their extents, in pixels.
    area: u64,
}

/// What the front faces of a tetrahedron are prepared from.
#[derive(Clone, Copy)]
pub(crate) struct OutlinedFaces<'f> {
    /// The number of the solid in the scene.
    pub(crate) number: usize,
    /// The half-planes of the outline, and its rows.
    pub(crate) outline: &'f [HalfPlane],
    pub(crate) rows: (u32, u32),
    /// The numbers of the front faces.
    pub(crate) front_faces: &'f [usize],
}

impl<'f> Outlined<'f> {
    /// What the front faces are prepared from.
    pub(crate) fn faces(&self) -> OutlinedFaces<'f> {
        OutlinedFaces {
            number: self.number,
            outline: self.outline.half_planes(),
            rows: self.outline.rows(),
            front_faces: self.front_faces,
        }
    }
}

impl<'f> Outlines<'f> {
    /// The outlines of a view. `within` is the extent of the surface, for the view in the mirror.
    pub(crate) fn new(
        picture: &Picture<'_, Bounded>,
        view: &View<'_, Bounded>,
        within: Option<&Extent>,
        grid: Grid,
        arena: &'f Bump,
    ) -> Self {
        let (facts, stage) = (picture.scene.facts(), picture.stage);
        let mirrored = within.is_some();
        let kinds = SolidKinds::of(stage);
        let mut outlines = Outlines {
            mirrored,
            all: bumpalo::collections::Vec::with_capacity_in(view.solid_count(), arena),
            area: 0,
        };
        // What a band of rows shows lies side by side in memory if it is prepared in the order of
        // bands.
        let numbers =
            (0..view.solid_count()).filter(|number| kinds.hold(&picture.scene.solid(*number)));
        let numbers = numbers.map(|number| {
            let (first, _) = view.extents.of(number).rows;
            (first as usize / ROWS, number)
        });
        let bands = (grid.size as usize).div_ceil(ROWS);
        let (numbers, _) = bucketed(arena, bands + 1, numbers);
        for &number in numbers {
            let (side, extent) = (facts.sides[number], view.extents.of(number));
            let (mut first, mut end) = extent.rows;
            if let Some(within) = within {
                (first, end) = (first.max(within.rows.0), end.min(within.rows.1));
            }
            let area = extent.area();
            let is_seen = area > 0
                // From this stage on all solids take part, and a hidden one is never seen.
                && !(facts.enclosed[number] && stage >= Stage::Shading)
                // The surface mirrors nothing that is below.
                && !(mirrored && side == Side::Below)
                && within.is_none_or(|within| extent.meets(within));
            if !is_seen {
                continue;
            }
            outlines.area += area;
            let rows = (first, end);
            outlines.all.push(match view.solid(number) {
                Solid::Sphere(sphere) => {
                    let ellipse = Ellipse::outline(sphere.center, sphere.radius, grid);
                    let ellipse = &*arena.alloc(ellipse);
                    Outlined {
                        number,
                        side,
                        depth: Depth::of_sphere(sphere.center, ellipse, sphere.support, grid),
                        outline: Region::new(&[], Some(ellipse), grid).within(rows),
                        front_faces: &[],
                    }
                }
                Solid::Tetrahedron(t) => {
                    let met = t.solid.met(&t.eye_edges);
                    let met = met.map(|half_space| HalfPlane::on_screen(&half_space, grid));
                    let front_faces = collect(arena, t.eye_edges.entered());
                    let faces = front_faces.iter();
                    let depths =
                        faces.map(|face| FaceDepth::new(&t.solid.inner_half_space(*face), grid));
                    Outlined {
                        number,
                        side,
                        outline: Region::new(collect(arena, met), None, grid).within(rows),
                        depth: Depth::FrontFaces(collect(arena, depths)),
                        front_faces,
                    }
                }
            });
        }
        outlines
    }

    /// The mean number of extents that hold a pixel.
    pub(crate) fn depth_complexity(&self, grid: Grid) -> u64 {
        self.area / (u64::from(grid.size) * u64::from(grid.size))
    }

    /// The mean number of shadows on front faces that a row may meet; in a crowd of which not all
    /// casters are found, as many as there can be.
    pub(crate) fn face_shadows(&self, scene: &Scene, grid: Grid) -> u64 {
        let casters = &scene.facts().casters;
        if !casters.are_found() {
            return u64::MAX;
        }
        let of_solid = |solid: &Outlined<'_>| {
            let (from, to) = solid.outline.rows();
            let faces = solid.front_faces.iter();
            let shadows = faces.map(|face| casters.on(solid.number, Some(*face)).len() as u64);
            u64::from(to.saturating_sub(from)) * shadows.sum::<u64>()
        };
        self.all.iter().map(of_solid).sum::<u64>() / u64::from(grid.size)
    }

    /// Leaves out the solids that others hide in all tiles.
    pub(crate) fn cull(&mut self, tiles: &mut Tiles<'_>) {
        for solid in &self.all {
            // Mirrored rays begin at the surface, and may miss a solid that goes through it.
            if !self.mirrored || solid.side == Side::Above {
                tiles.hide_behind(&solid.outline, &solid.depth);
            }
        }
        for solid in &mut self.all {
            let rows = tiles.rows_of_solid(&solid.outline, &solid.depth);
            solid.outline.restrict(rows);
        }
        self.all.retain(|solid| !solid.outline.is_nowhere());
    }
}
