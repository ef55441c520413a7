//! Bounding rectangles on the screen: most pixels need not be tested against most solids.

use bumpalo::Bump;

use super::arena::{Arena, OnDemand, bucketed, collect};
use super::surface_casters::SurfaceCasterLookup;
use super::tiles::Tiles;
use super::vector::Vector;
use super::view_space::{
    EYE_SQUARED, EYE_Y, EYE_Z, PIXEL, along_eye_ray, coordinate, number_at, reflect,
};
use super::view_transform::ViewTransform;
use crate::number::Bounded;
use crate::scene::Scene;

/// The pixels of a picture whose eye ray can meet a solid; all others certainly miss it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// A half-open range, as `rows` is.
    pub(super) columns: (u32, u32),
    pub(super) rows: (u32, u32),
}

/// The extents of a frame: of every solid, of every solid in the mirror, and of the surface; and
/// the casters of the surface.
pub(super) struct Extents<'f> {
    pub(super) direct: ExtentsOfSolids<'f>,
    pub(super) mirrored: ExtentsOfSolids<'f>,
    pub(super) surface: Option<Extent>,
    pub(super) casters_on_surface: Option<SurfaceCasterLookup<'f>>,
}

/// So many questions about the pixels of a view look at all solids before tiles are made.
const FEW: u32 = 16;

/// The most solids at a pixel that are sorted without tiles.
const MOST: usize = 32;

/// The rows of the bands in whose order solids are put: as many as `scanline` traces together. With
/// another number, the order would serve it less well.
const BAND: usize = 8;

/// The extents of all solids.
#[derive(Clone, Copy)]
pub(super) struct ExtentsOfSolids<'f> {
    all: &'f [SolidExtent],
    /// The numbers of all solids in the order of the bands of rows that they begin in: what a band
    /// shows lies side by side in memory if it is prepared, and stored, in this order.
    pub(super) in_bands: &'f [u16],
    /// By the index of a tetrahedron, its place among the tetrahedra in this order.
    pub(super) places: &'f [u16],
    /// N.
    size: u32,
    /// Made after [`FEW`] questions: rows leave few pixels in doubt, and mostly none.
    tiles: &'f OnDemand<Tiles>,
}

/// The extent of a solid, and how near it is.
struct SolidExtent {
    extent: Extent,
    entry: Entry,
}

/// Bounds on 109 t − 3 Y where eye rays enter a solid: t is a ray's parameter, Y the coordinate of
/// the pixel's row. t is (that + 3 Y)/109: so one number bounds the entry in every row.
#[derive(Clone, Copy)]
pub(super) struct Entry {
    pub(super) nearest: f64,
    pub(super) farthest: f64,
}

impl<'f> ExtentsOfSolids<'f> {
    /// Y of a row.
    pub(super) fn y_of(&self, row: u32) -> f64 {
        coordinate(row, f64::from(self.size) / 2.0)
    }

    /// The extent of a solid.
    pub(super) fn of(&self, solid: usize) -> &'f Extent {
        &self.all[solid].extent
    }

    /// Where eye rays enter a solid.
    pub(super) fn entry(&self, solid: usize) -> Entry {
        self.all[solid].entry
    }

    /// A lower bound on the parameter at which the eye ray of a pixel meets a solid. The bounds of
    /// the solids of [`ExtentsOfSolids::at`] are in increasing order.
    pub(super) fn min_depth(&self, solid: usize, y: f64) -> f64 {
        let depth = (self.all[solid].entry.nearest + EYE_Y * y) / EYE_SQUARED;
        // 3 Y is a whole number of halves; the sum and the quotient round by u each.
        depth - 2.0 * f64::EPSILON * depth.abs()
    }

    /// The solids that can be seen in a pixel, the nearest first.
    pub(super) fn at(&self, pixel: (u32, u32)) -> impl Iterator<Item = usize> + use<'f> {
        let (all, size) = (self.all, self.size);
        let holds = move |solid: &u16| all[usize::from(*solid)].extent.holds(pixel.0, pixel.1);
        let few = match self.tiles.pays_after(FEW) {
            true => None,
            false => nearest_first((0..all.len() as u16).filter(holds), all),
        };
        let (few, count, listed) = match few {
            Some((few, count)) => (few, count, &[][..]),
            None => {
                let tiles = self.tiles.get(|tiles| find_tiles(tiles, all, size));
                ([0; MOST], 0, tiles.solids_at(pixel))
            }
        };
        let listed = listed.iter().copied().filter(holds);
        listed.chain(few.into_iter().take(count)).map(usize::from)
    }
}

/// These solids, given by increasing number, and how many they are: the nearest first, and of
/// several as near, the first in the scene. `None` if they are more than [`MOST`].
fn nearest_first(
    solids: impl Iterator<Item = u16>,
    all: &[SolidExtent],
) -> Option<([u16; MOST], usize)> {
    let nearest = |solid: u16| all[usize::from(solid)].entry.nearest;
    let (mut sorted, mut count) = ([0; MOST], 0);
    for solid in solids {
        let is_nearer = |other: &u16| nearest(solid).total_cmp(&nearest(*other)).is_lt();
        *sorted.get_mut(count)? = solid;
        let at = sorted[..count].iter().position(is_nearer).unwrap_or(count);
        count += 1;
        sorted[at..count].rotate_right(1);
    }
    Some((sorted, count))
}

/// The numbers of solids in the order of the bands that they begin in, and the places of those from
/// `first` on among them.
fn order<'f>(
    all: &[SolidExtent],
    first: usize,
    size: u32,
    arena: &'f Bump,
) -> (&'f [u16], &'f [u16]) {
    let band = |solid: &SolidExtent| solid.extent.rows.0 as usize / BAND;
    let by_band = all.iter().enumerate();
    let by_band = by_band.map(|(number, solid)| (band(solid), number as u16));
    // An extent without rows may begin above the picture.
    let bands = size as usize / BAND + 1;
    let (in_bands, _) = bucketed(arena, bands, by_band);
    let places = arena.alloc_slice_fill_copy(all.len() - first, 0);
    let indices = in_bands.iter().map(|number| usize::from(*number));
    let indices = indices.filter_map(|number| number.checked_sub(first));
    for (place, index) in (0..).zip(indices) {
        places[index] = place;
    }
    (in_bands, places)
}

/// Finds the tiles that solids reach.
fn find_tiles(tiles: &mut Tiles, all: &[SolidExtent], size: u32) {
    let extent = |solid: usize| [all[solid].extent.columns, all[solid].extent.rows];
    tiles.find(all.len(), extent, |solid| all[solid].entry.nearest, size);
}

impl Extent {
    #[inline]
    pub(super) fn holds(&self, column: u32, row: u32) -> bool {
        let within = |(from, to): (u32, u32), number: u32| from <= number && number < to;
        within(self.columns, column) && within(self.rows, row)
    }

    /// Whether both extents have a pixel in common.
    pub(super) fn meets(&self, other: &Extent) -> bool {
        let meet = |a: (u32, u32), b: (u32, u32)| a.0.max(b.0) < a.1.min(b.1);
        meet(self.columns, other.columns) && meet(self.rows, other.rows)
    }

    /// The number of its pixels.
    pub(super) fn area(&self) -> u64 {
        let length = |(from, to): (u32, u32)| u64::from(to - from);
        length(self.columns) * length(self.rows)
    }

    /// The smallest extent that holds the projections of all `points` onto the screen, each
    /// enlarged by `half_width` to the left and right and by `half_height` up and down, in view
    /// space, and by `rounding` to all sides.
    fn of<const POINTS: usize>(
        points: [Vector<f64>; POINTS],
        (half_width, half_height): (f64, f64),
        rounding: f64,
        size: u32,
    ) -> Extent {
        let half = f64::from(size) / 2.0;
        let range = |coordinates: [f64; POINTS], half_length: f64| {
            let least = coordinates.into_iter().fold(f64::INFINITY, f64::min);
            let most = coordinates.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let low = number_at(least - half_length - rounding, half);
            let high = number_at(most + half_length + rounding, half);
            // Conversions round down from 0 on, and give 0 below.
            ((low as u32).min(size), ((high + 2.0) as u32).min(size))
        };
        Extent {
            columns: range(points.map(|p| p.x), half_width),
            // The ray through a point p meets the screen, z = 3N/2, at y = p.y + (3N/2 − p.z) ·
            // 3/10.
            rows: range(
                points.map(|p| p.y + (PIXEL * half - p.z) * (EYE_Y / EYE_Z)),
                half_height,
            ),
        }
    }
}

impl<'f> Extents<'f> {
    pub(super) fn new(
        scene: &'f Scene,
        transform: &ViewTransform<f64>,
        bounded: &ViewTransform<Bounded>,
        size: u32,
        arena: &'f Arena,
    ) -> Self {
        // To turn, scale, reflect and project a point takes fewer than 32 roundings, each by at
        // most u = 2⁻⁵³ of these magnitudes: 2⁻⁴⁰ of them is more than all roundings, and far less
        // than a pixel.
        let least =
            PIXEL * f64::from(size) + 2.0 * transform.surface_height(scene).unwrap_or(0.0).abs();
        let rounding = |points: &[Vector<f64>], radius: f64| {
            let magnitudes = points.iter().map(|p| p.x.abs() + p.y.abs() + p.z.abs());
            let largest = magnitudes.fold(0.0, f64::max);
            (largest + 2.0 * radius + least) / (1_u64 << 40) as f64
        };
        let solids = |mirror_height: Option<f64>| {
            let point = |p| reflect(transform.point(p), mirror_height);
            let root = EYE_SQUARED.sqrt();
            let along = |p| along_eye_ray(p, f64::from(size) / 2.0);
            let spheres = scene.spheres().iter().map(|sphere| {
                let center = point(sphere.center);
                let radius = sphere.radius * transform.scale;
                let rounding = rounding(&[center], radius);
                // A sphere is as wide as its diameter; slanting rays √109/10 times as high.
                let half = (radius, radius * root / EYE_Z);
                SolidExtent {
                    extent: Extent::of([center], half, rounding, size),
                    entry: Entry {
                        nearest: along(center) - radius * root - 16.0 * rounding,
                        // Rays that touch the sphere enter it last.
                        farthest: along(center) + 16.0 * rounding,
                    },
                }
            });
            let tetrahedra = scene.tetrahedra().iter().map(|t| {
                let vertices = t.vertices.map(point);
                let rounding = rounding(&vertices, 0.0);
                let depths = vertices.map(along).into_iter();
                SolidExtent {
                    extent: Extent::of(vertices, (0.0, 0.0), rounding, size),
                    entry: Entry {
                        nearest: depths.clone().fold(f64::INFINITY, f64::min) - 16.0 * rounding,
                        farthest: depths.fold(f64::NEG_INFINITY, f64::max) + 16.0 * rounding,
                    },
                }
            });
            let all = collect(&arena.setup, spheres.chain(tetrahedra));
            let (in_bands, places) = order(all, scene.spheres().len(), size, &arena.setup);
            ExtentsOfSolids {
                all,
                in_bands,
                places,
                size,
                tiles: &arena.tiles[usize::from(mirror_height.is_some())],
            }
        };
        let surface = scene.surface().map(|surface| {
            let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(x, z)| {
                transform.point(glam::DVec3::new(
                    x * surface.half_width,
                    surface.height,
                    z * surface.half_width,
                ))
            });
            Extent::of(corners, (0.0, 0.0), rounding(&corners, 0.0), size)
        });
        let direct = solids(None);
        // A scene without a surface has no mirror images.
        let mirror_height = transform.surface_height(scene);
        let mirrored = mirror_height.map_or(direct, |height| solids(Some(height)));
        Extents {
            direct,
            mirrored,
            surface,
            casters_on_surface: SurfaceCasterLookup::new(scene, bounded),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    const SIZE: u32 = 100;

    fn random_extents(random: &mut Random, count: usize) -> Vec<SolidExtent> {
        let mut range = || {
            let from = random.below(SIZE as usize) as u32;
            (from, (from + random.below(20) as u32).min(SIZE))
        };
        let extents = (0..count).map(|_| Extent {
            columns: range(),
            rows: range(),
        });
        // Some are as near as others.
        let entry = |solid: usize| Entry {
            nearest: (solid * 7 % count / 4) as f64,
            farthest: count as f64,
        };
        let solids = extents.enumerate();
        solids
            .map(|(solid, extent)| SolidExtent {
                extent,
                entry: entry(solid),
            })
            .collect()
    }

    #[test]
    fn tiles_list_the_solids_that_reach_them_nearest_first_in_each_frame() {
        let mut random = Random::new();
        let mut tiles = Tiles::default();
        // Each frame reuses the memory of the one before.
        for count in [300, 10, 40, 500, 17, 16, 300] {
            let all = random_extents(&mut random, count);
            find_tiles(&mut tiles, &all, SIZE);
            for pixel in (0..SIZE).flat_map(|row| (0..SIZE).map(move |column| (column, row))) {
                let holds = |solid: &usize| all[*solid].extent.holds(pixel.0, pixel.1);
                let mut expected: Vec<usize> = (0..count).filter(holds).collect();
                expected.sort_by_key(|&solid| solid * 7 % count / 4);
                let listed = tiles.solids_at(pixel).iter();
                let listed = listed.map(|solid| usize::from(*solid));
                assert_eq!(listed.filter(holds).collect::<Vec<_>>(), expected);
            }
            let starts = tiles.starts.iter().copied();
            assert_eq!(starts.max(), Some(tiles.solids.len() as u32));
        }
    }

    #[test]
    fn solids_are_in_the_order_of_bands() {
        let (arena, first) = (Bump::new(), 100);
        let mut all = random_extents(&mut Random::new(), 300);
        all[7].extent.rows = (SIZE, SIZE);
        let (in_bands, places) = order(&all, first, SIZE, &arena);
        let band = |number: u16| all[usize::from(number)].extent.rows.0 as usize / BAND;
        assert!(in_bands.is_sorted_by_key(|number| (band(*number), *number)));
        assert_eq!(in_bands.len(), all.len());
        let in_places = |number: &u16| usize::from(*number) >= first;
        for (place, number) in in_bands.iter().copied().filter(in_places).enumerate() {
            assert_eq!(usize::from(places[usize::from(number) - first]), place);
        }
    }

    #[test]
    fn the_first_pixels_find_the_same_solids_as_all_others() {
        let all = random_extents(&mut Random::new(), 300);
        for column in 0..SIZE {
            let tiles = OnDemand::default();
            let extents = ExtentsOfSolids {
                all: &all,
                in_bands: &[],
                places: &[],
                size: SIZE,
                tiles: &tiles,
            };
            let first: Vec<usize> = extents.at((column, SIZE / 2)).collect();
            for _ in 0..2 * FEW {
                let solids = extents.at((column, SIZE / 2));
                assert_eq!(solids.collect::<Vec<_>>(), first);
            }
        }
    }
}
