//! Makes late faces, keeps their regions, and crosses them with bands.

use std::cell::Cell;
use std::iter;
use std::sync::atomic::Ordering::Relaxed;

use bumpalo::Bump;
use bumpalo_herd::Member;

use crate::image::MAX_SIZE;
use crate::scene::Solid;
use crate::tracer::arena::collect;
use crate::tracer::decision::Decision;
use crate::tracer::scanline::edges::band_columns::BandColumns;
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::edges::table::{Receiver, RegionKind, RegionKinds, Regions};
use crate::tracer::scanline::grid::ROWS;
use crate::tracer::scanline::prepare::appearance::Appearances;
use crate::tracer::scanline::prepare::builder::Builder;
use crate::tracer::scanline::prepare::depth::face_plane;
use crate::tracer::scanline::prepare::front_faces::FrontFaces;
use crate::tracer::scanline::prepare::late_faces::{
    Cast, KeptRegion, KeptRegions, LateFaces, LateSource, SplitFaces,
};
use crate::tracer::scanline::prepare::outline::OutlinedFaces;
use crate::tracer::scanline::prepare::shadows::shadows_on_face;
use crate::tracer::scanline::row_edges::{Added, RowEdges};
use crate::tracer::scanline::write::paint::AllPaints;
use crate::tracer::tetrahedron::entered;

/// In a solid of more rows, each shadow's own rows are found.
const FEW_ROWS: u32 = 4 * ROWS as u32;

/// Few solids have more creases and shadows.
const FEW_REGIONS: usize = 16;

// Rows are kept as u16.
const _: () = assert!(MAX_SIZE <= u16::MAX as u32);

impl<'f> LateFaces<'f> {
    /// The faces. The first call makes them; `spare` is memory for the work, free afterwards.
    pub(crate) fn get(&self, source: &LateSource<'f>, spare: &mut Bump) -> &SplitFaces<'f> {
        self.made.get_or_init(|| {
            spare.reset();
            let memory = source.threads.get();
            let color = |decision| source.pixels.color(decision);
            let (faces, regions, paints) = self.make(source, &color, spare);
            let has_memory = source.taken.load(Relaxed) < source.most;
            let is_ellipse = |region: &Region<'_>| region.ellipse().is_some();
            let is_kept = has_memory || !regions.all.iter().any(is_ellipse);
            SplitFaces {
                front_faces: FrontFaces {
                    all: memory.alloc_slice_copy(faces.all),
                    pairs: memory.alloc_slice_copy(faces.pairs),
                },
                kinds: RegionKinds {
                    all: memory.alloc_slice_copy(regions.kinds.all),
                    receivers: regions.kinds.receivers,
                },
                paints: paints.kept_in(&memory),
                regions: is_kept.then(|| self.keep((&regions, has_memory), source, &memory)),
            }
        })
    }

    /// The faces, their regions and their paints. `color` tells the colour of a decision.
    fn make<'s>(
        &self,
        source: &'s LateSource<'f>,
        color: &'s dyn Fn(Decision) -> [f32; 3],
        spare: &'s Bump,
    ) -> (FrontFaces<'s>, Regions<'s>, AllPaints<'s>) {
        let picture = source.pixels.bounded();
        let appearances = Appearances::new(picture, picture.view(self.mirrored), self.mirrored);
        let screen = (source.grid, source.level);
        let mut parts = Builder::new(screen, color, u64::MAX, FEW_REGIONS, spare);
        let faces = appearances.front_faces(&self.outlined, self.tetrahedron, &mut parts);
        (faces, parts.edge_table.regions(), parts.paints.all())
    }

    /// Copies regions to memory that the frame keeps, those of shadows whole only if it
    /// `has_memory`.
    fn keep(
        &self,
        (regions, has_memory): (&Regions<'_>, bool),
        source: &LateSource<'f>,
        memory: &Member<'f>,
    ) -> &'f [KeptRegion<'f>] {
        let picture = source.pixels.bounded();
        let view = picture.view(self.mirrored);
        // A tetrahedron's shadow has all rows of the solid. So each has a region, in the order of
        // the casters on its face; then comes that of the surface.
        let tetrahedra = |face: usize| {
            let casters = &picture.scene.facts().casters;
            let casters = casters.on(self.outlined.number, Some(face)).iter();
            casters
                .filter(|caster| matches!(view.solid(usize::from(**caster)), Solid::Tetrahedron(_)))
        };
        let mut faces = entered(self.tetrahedron.eye_signs);
        let mut casters = [(); 4].map(|()| faces.next().map(|face| (face, tetrahedra(face))));
        let (from, to) = self.outlined.rows;
        let is_high = to > from + FEW_ROWS;
        let taken = Cell::new(0);
        let take = |bytes: usize| taken.set(taken.get() + bytes);
        let shadow = |region: &Region<'_>, cast| {
            let half_planes = has_memory.then(|| {
                let borders = region
                    .half_planes()
                    .iter()
                    .map(|half_plane| *half_plane.border());
                let borders = &*memory.alloc_slice_fill_iter(borders);
                take(size_of_val(borders));
                borders
            });
            let (from, to) = if is_high {
                region.rows_between_sides(source.grid)
            } else {
                region.rows()
            };
            KeptRegion::Shadow {
                half_planes,
                cast,
                rows: (from as u16, to as u16),
            }
        };
        let regions = regions.all.iter().zip(regions.kinds.all);
        let regions = regions.map(|(region, kind)| {
            let cast = match kind {
                RegionKind::Shadow(Receiver(index)) if region.ellipse().is_none() => {
                    let of_face = casters[*index as usize].as_mut();
                    of_face.and_then(|(face, casters)| {
                        let (face, caster) = (*face as u8, *casters.next()?);
                        Some(Cast { face, caster })
                    })
                }
                _ => None,
            };
            let shadow = cast.map(|cast| shadow(region, cast));
            shadow.unwrap_or_else(|| {
                take(region.kept_size());
                KeptRegion::Whole(memory.alloc(region.kept_in(memory, self.outlined.outline)))
            })
        });
        let kept = memory.alloc_slice_fill_iter(regions);
        source
            .taken
            .fetch_add(taken.get() + size_of_val(kept), Relaxed);
        kept
    }

    /// Adds the edges of `faces`, those of this solid, in the band of rows from `first` on.
    pub(crate) fn cross(
        &self,
        faces: &SplitFaces<'f>,
        first: u32,
        edges: &mut RowEdges,
        source: &LateSource<'f>,
        spare: &mut Bump,
    ) -> Added {
        spare.reset();
        let reach = |(from, to): (u32, u32)| from < first + ROWS as u32 && first < to;
        let (level, grid) = (source.level, source.grid);
        let Some(regions) = faces.regions else {
            // Nobody asks for these paints.
            let (_, regions, _) = self.make(source, &|_| [0.0; 3], spare);
            let numbers = (0..).zip(regions.all);
            let numbers = numbers.filter(|(_, region)| reach(region.rows()));
            let numbers = collect(spare, numbers.map(|(number, _)| number));
            return edges.add(&regions, numbers, first, level, grid);
        };
        let numbers = (0..).zip(regions).filter(|(_, region)| match region {
            KeptRegion::Whole(region) => reach(region.rows()),
            KeptRegion::Shadow {
                rows: (from, to), ..
            } => reach((u32::from(*from), u32::from(*to))),
        });
        let numbers = collect(spare, numbers.map(|(number, _)| number));
        let again = |cast, band: &mut BandColumns| {
            let shadow = self.shadow(cast, source, spare);
            shadow.cross_at(level, first, grid, band);
        };
        let regions = KeptRegions {
            all: regions,
            outline: (self.outlined.outline, self.outlined.rows),
            again: &again,
        };
        edges.add(&regions, numbers, first, level, grid)
    }

    /// The shadow of a tetrahedron on a front face.
    fn shadow<'s>(
        &'s self,
        Cast { face, caster }: Cast,
        source: &LateSource<'f>,
        spare: &'s Bump,
    ) -> Region<'s> {
        let (grid, view) = (source.grid, source.pixels.bounded().view(self.mirrored));
        let face = self.tetrahedron.solid.inner_half_space(usize::from(face));
        let (plane, screen) = (face_plane(&face, grid), (grid, source.level));
        let casters = iter::once(caster);
        let mut shadows = shadows_on_face((&face, &plane), view, casters, screen, spare);
        // Every caster has one.
        let in_doubt = || Region::new(&[HalfPlane::IN_DOUBT], None, grid);
        let OutlinedFaces { outline, rows, .. } = self.outlined;
        let shadow = shadows.next().unwrap_or_else(in_doubt);
        shadow.within(rows).clipped(outline)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;
    use crate::stage::Stage;
    use crate::tracer::scanline::prepare::solids::Appearance;
    use crate::tracer::scanline::tests::{CROWDED, CROWDED_WITHOUT_MEMORY, slivers, with_tracer};

    #[test]
    fn kept_regions_have_the_columns_of_those_that_are_made_again() {
        let (text, size) = (slivers(60), 128);
        let crowds = [CROWDED, CROWDED_WITHOUT_MEMORY].into_iter();
        for (alpha, crowd) in crowds.flat_map(|crowd| [(0.0, crowd), (0.3, crowd)]) {
            with_tracer(&text, (Stage::Reflection, alpha, size), crowd, |tracer| {
                let (source, mut spare) = (&tracer.late, Bump::new());
                let (mut shadows, mut whole, mut edges) = (0, 0, 0);
                let solids = [false, true].map(|mirrored| tracer.frame.solids(mirrored).appearance);
                for appearance in solids.into_iter().flatten() {
                    let Appearance::LateFaces(late) = appearance else {
                        continue;
                    };
                    let faces = late.get(source, &mut spare);
                    for kept in faces.regions.into_iter().flatten() {
                        match kept {
                            KeptRegion::Whole(_) => whole += 1,
                            KeptRegion::Shadow { .. } => shadows += 1,
                        }
                    }
                    for first in (0..size).step_by(ROWS) {
                        let (mut kept, mut made) = (RowEdges::default(), RowEdges::default());
                        let of_kept = late.cross(faces, first, &mut kept, source, &mut spare);
                        spare.reset();
                        let (_, regions, _) = late.make(source, &|_| [0.0; 3], &spare);
                        let numbers: Vec<u32> = (0..regions.all.len() as u32).collect();
                        let of_made =
                            made.add(&regions, &numbers, first, source.level, source.grid);
                        for row in first..first + ROWS as u32 {
                            assert!(
                                kept.sorted(&of_kept, row).eq(made.sorted(&of_made, row)),
                                "α = {alpha}, row {row}"
                            );
                            edges += of_made.count(row);
                        }
                    }
                }
                let counts = (shadows, whole, edges);
                assert!(shadows > 500 && whole > 50 && edges > 2000, "{counts:?}");
            });
        }
    }
}
