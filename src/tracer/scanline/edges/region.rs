//! Regions: convex parts of the screen, and the columns that they have in a row.
//!
//! # Why rows
//!
//! Eye rays are parallel, and so are rays to the light. So the border of every region is made of
//! straight lines and of at most one ellipse: silhouettes, edges between faces, the surface's
//! sides, outlines of mirror images, shadows on the surface or on a face. Each line and each
//! ellipse is a polynomial in X and Y, the position on the screen in thirds of a pixel from its
//! centre. In a row of pixels Y is fixed, and the row's edges are roots of these polynomials.
//!
//! A root is computed in f32 with a bound on its error, derived where it is used. Columns beyond
//! the bound need no test. The columns within it, rarely one, are tested one by one, in f64.

use bumpalo_herd::Member;
use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x8};

use crate::tracer::scanline::edges::band_columns::BandColumns;
use crate::tracer::scanline::edges::border::Root;
use crate::tracer::scanline::edges::ellipse::Ellipse;
use crate::tracer::scanline::edges::enclosure::{ColumnEnclosure, Cut};
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::fetch::fetch;
use crate::tracer::scanline::grid::{Grid, ROWS};

/// So few columns are searched one by one as fast as in any other way. No more in doubt are passed
/// over: beside them are mostly columns that a region certainly has.
const FEW_COLUMNS: u32 = 8;

/// The intersection of half-planes and of an ellipse, if there is one.
pub(crate) struct Region<'f> {
    half_planes: &'f [HalfPlane<'f>],
    /// More half-planes: those of the region that this one is clipped to.
    clip: &'f [HalfPlane<'f>],
    ellipse: Option<&'f Ellipse>,
    /// The half-open range of rows outside of which the region has no pixels that matter.
    rows: (u32, u32),
}

impl<'f> Region<'f> {
    pub(crate) fn new(
        half_planes: &'f [HalfPlane<'f>],
        ellipse: Option<&'f Ellipse>,
        grid: Grid,
    ) -> Self {
        let rows = ellipse.map_or((0, grid.size), |ellipse| ellipse.rows(grid));
        Region {
            half_planes,
            clip: &[],
            ellipse,
            rows,
        }
    }

    /// The same region in other memory, clipped to `clip`.
    pub(crate) fn kept_in<'k>(&self, memory: &Member<'k>, clip: &'k [HalfPlane<'k>]) -> Region<'k> {
        Region {
            half_planes: HalfPlane::kept_in(self.half_planes, memory),
            clip,
            ellipse: self.ellipse.map(|ellipse| &*memory.alloc(*ellipse)),
            rows: self.rows,
        }
    }

    /// How many bytes [`Region::kept_in`] takes.
    pub(crate) fn kept_size(&self) -> usize {
        HalfPlane::kept_size(self.half_planes)
            + self.ellipse.map_or(0, size_of_val)
            + size_of_val(self)
    }

    /// The half-planes that the region is an intersection of, besides its ellipse.
    pub(crate) fn half_planes(&self) -> &'f [HalfPlane<'f>] {
        self.half_planes
    }

    /// The intersection with these half-planes, for a region that is not clipped yet.
    pub(crate) fn clipped(self, clip: &'f [HalfPlane<'f>]) -> Self {
        Region { clip, ..self }
    }

    /// The same region, of which only these rows matter.
    pub(crate) fn within(mut self, rows: (u32, u32)) -> Self {
        self.restrict(rows);
        self
    }

    /// Leaves out all rows but these.
    pub(crate) fn restrict(&mut self, rows: (u32, u32)) {
        self.rows = (self.rows.0.max(rows.0), self.rows.1.min(rows.1));
    }

    /// The rows in which the region may have pixels.
    pub(crate) fn rows(&self) -> (u32, u32) {
        self.rows
    }

    /// Its rows, without those in which a left side certainly lies to the right of a right side.
    pub(crate) fn rows_between_sides(&self, grid: Grid) -> (u32, u32) {
        let roots = || self.all_half_planes().filter_map(HalfPlane::root);
        let (mut low, mut high) = (-grid.max, grid.max);
        for left in roots().filter(|root| root.rightward) {
            for right in roots().filter(|root| !root.rightward) {
                // The right root lies at most so far to the right of the left one: `apart` +
                // `per_y` · Y. The bounds on a root are farther apart than rounding its terms again
                // takes, so that is taken twice.
                let doubt = |root: &Root| root.ends[1] - root.ends[0];
                let apart = right.ends[1] - left.ends[0] + doubt(&left) + doubt(&right);
                let per_y = right.per_y - left.per_y;
                if per_y > 0.0 {
                    low = low.max(-apart / per_y);
                } else if per_y < 0.0 {
                    high = high.min(-apart / per_y);
                }
            }
        }
        let (from, to) = grid.between(low, high);
        (self.rows.0.max(from), self.rows.1.min(to))
    }

    /// Whether there are none.
    pub(crate) fn is_nowhere(&self) -> bool {
        self.rows.0 >= self.rows.1
    }

    pub(crate) fn ellipse(&self) -> Option<&'f Ellipse> {
        self.ellipse
    }

    /// Asks for the memory that crossing it takes, but for what it is clipped to.
    #[inline(always)]
    pub(crate) fn fetch(&self) {
        let half_planes = self.half_planes;
        if let (Some(first), Some(last)) = (half_planes.first(), half_planes.last()) {
            fetch(first.border());
            fetch(last.border());
        }
        if let Some(ellipse) = self.ellipse {
            ellipse.fetch();
        }
    }

    /// Finds the region's columns in the band of rows from `row` on. They are written where the
    /// caller keeps them: who crosses several regions before it reads the first does not wait.
    #[inline(always)]
    pub(crate) fn cross<S: Simd>(&self, simd: S, row: u32, grid: Grid, band: &mut BandColumns) {
        self.enclose(simd, row, grid, band);
        if !band.is_certain {
            self.narrow(band, row, grid);
        }
    }

    /// As [`Region::cross`], but compiled once: for callers that cross regions between other work.
    #[inline(never)]
    pub(crate) fn cross_at(&self, level: Level, row: u32, grid: Grid, band: &mut BandColumns) {
        dispatch!(level, simd => self.cross(simd, row, grid, band));
    }

    /// The same as far as bounds on roots tell.
    #[inline(always)]
    fn enclose<S: Simd>(&self, simd: S, row: u32, grid: Grid, band: &mut BandColumns) {
        let half_planes = (self.half_planes, self.clip);
        enclose(
            simd,
            self.ellipse,
            half_planes,
            (self.rows, row),
            grid,
            band,
        );
    }

    /// Decides the columns in doubt one by one, from the outside in.
    fn narrow(&self, band: &mut BandColumns, row: u32, grid: Grid) {
        band.is_certain = true;
        for i in 0..ROWS {
            let (mut from, mut to) = (band.possible[0][i], band.possible[1][i]);
            let certain = (band.certain[0][i], band.certain[1][i]);
            if (from, to) == certain {
                continue;
            }
            let y = grid.coordinate(row + i as u32);
            let chord = self.ellipse.map(|ellipse| ellipse.enclose_row(y, grid));
            if let Some(ColumnEnclosure { possible, .. }) = chord {
                from = from.max(grid.ceil(possible[0]));
                to = to.min(grid.count(possible[1])).max(from);
            }
            if to > from + FEW_COLUMNS && self.misses((from, to), y, grid) {
                to = from;
            }
            let is_certain = |column: u32| certain.0 <= column && column < certain.1;
            let holds = |column: u32| match is_certain(column) {
                true => Some(true),
                false => self.decide(column, (y, chord.as_ref()), grid),
            };
            let (out, first) = search(from..to, holds);
            from += out;
            let (out, last) = search((from..to).rev(), holds);
            to -= out;
            // A region is convex: the columns between two of its columns are in it.
            let decided = [first, last].into_iter().flatten();
            let decided = decided.flat_map(|column| [column, column + 1]);
            let certain = [certain.0, certain.1]
                .into_iter()
                .filter(|_| certain.0 < certain.1);
            let ends = decided.chain(certain);
            let (begin, end) = ends.fold((u32::MAX, 0), |(begin, end), column| {
                (begin.min(column), end.max(column))
            });
            let certain = if begin < end {
                (begin, end)
            } else {
                (from, from)
            };
            (band.possible[0][i], band.possible[1][i]) = (from, to);
            (band.certain[0][i], band.certain[1][i]) = certain;
            band.is_certain &= (from, to) == certain;
            if from == to {
                band.filled &= !(1 << i);
            }
        }
    }

    /// Whether both ends of some columns in the row at Y lie beside one half-plane, and so all of
    /// them. A search from the ends would go through all.
    fn misses(&self, (from, to): (u32, u32), y: f64, grid: Grid) -> bool {
        let ends = [from, to - 1].map(|column| grid.coordinate(column));
        self.all_half_planes().any(|half_plane| {
            let is_beside = |&x: &f64| half_plane.decide_near(x, y, grid) == Some(false);
            ends.iter().all(is_beside)
        })
    }

    /// Its half-planes and those that it is clipped to.
    fn all_half_planes(&self) -> impl Iterator<Item = &'f HalfPlane<'f>> {
        self.half_planes.iter().chain(self.clip)
    }

    /// Whether a pixel of the row at Y is in the region; `None` where that is in doubt. `chord` is
    /// that of the ellipse.
    fn decide(
        &self,
        column: u32,
        (y, chord): (f64, Option<&ColumnEnclosure<f64>>),
        grid: Grid,
    ) -> Option<bool> {
        let mut all = match chord {
            Some(chord) => chord.holds(f64::from(column)),
            None => Some(true),
        };
        for half_plane in self.all_half_planes() {
            match half_plane.decide_near(grid.coordinate(column), y, grid) {
                Some(false) => return Some(false),
                Some(true) => {}
                None => all = None,
            }
        }
        all
    }
}

/// How many columns, from the first on, are certainly not in a region, and the first that certainly
/// is, if not too many in doubt lie before it.
fn search(
    columns: impl Iterator<Item = u32>,
    holds: impl Fn(u32) -> Option<bool>,
) -> (u32, Option<u32>) {
    let (mut out, mut doubts) = (0, 0);
    for column in columns {
        match holds(column) {
            Some(true) => return (out, Some(column)),
            Some(false) if doubts == 0 => out += 1,
            None if doubts < FEW_COLUMNS => doubts += 1,
            _ => break,
        }
    }
    (out, None)
}

/// Finds the columns of an intersection in the band of rows from `row` on, as far as bounds on
/// roots tell. Only `rows` matter.
#[inline(always)]
pub(crate) fn enclose<S: Simd>(
    simd: S,
    ellipse: Option<&Ellipse>,
    (half_planes, clip): (&[impl Cut], &[HalfPlane<'_>]),
    (rows, row): ((u32, u32), u32),
    grid: Grid,
    band: &mut BandColumns,
) {
    let y = grid.band(simd, row);
    let [from, to] = [rows.0, rows.1].map(|row| grid.coordinate(row) as f32);
    let is_crossed = y.simd_ge(from) & y.simd_lt(to);
    let zero = f32x8::splat(simd, 0.0);
    let all = [zero, zero + grid.size as f32];
    let mut enclosure = match ellipse {
        Some(ellipse) => ellipse.chords().enclose(simd, y),
        None => ColumnEnclosure {
            possible: all,
            certain: all,
        },
    };
    for half_plane in half_planes {
        half_plane.cut(simd, y, &mut enclosure);
    }
    for half_plane in clip {
        half_plane.cut(simd, y, &mut enclosure);
    }
    let ColumnEnclosure { possible, certain } = enclosure;
    let possible = [grid.ceil_all(possible[0]), grid.count_all(possible[1])];
    let certain = [grid.ceil_all(certain[0]), grid.count_all(certain[1])];
    band.store(simd, is_crossed, possible, certain);
}

#[cfg(test)]
mod tests {
    use bumpalo::Bump;
    use fearless_simd::{Level, dispatch};

    use super::*;
    use crate::number::{Bounded, Real as _};
    use crate::random::Random;
    use crate::tracer::scanline::edges::ellipses::SphereOutlines;
    use crate::tracer::vector::Vector;

    const SIZE: u32 = 24;

    /// constant + column · X + row · Y in whole numbers, and whether 0 belongs to it.
    type WholeLine = (i64, i64, i64, bool);

    /// Twice a sphere's center and radius in view space, in whole numbers.
    type WholeSphere = ([i64; 3], i64);

    /// Whether a pixel is in all of them: in whole numbers, so that there is nothing to round.
    fn holds(lines: &[WholeLine], sphere: Option<WholeSphere>, column: u32, row: u32) -> bool {
        let half = i64::from(SIZE / 2);
        let [x, y] = [column, row].map(|number| 3 * (i64::from(number) - half));
        let on_side = |&(constant, column, row, closed): &WholeLine| {
            let value = constant + column * x + row * y;
            value > 0 || closed && value == 0
        };
        // 109 (X − c_x)² + (10 (Y − c_y) − 3 (Z − c_z))² ≤ 109 R², four times, with Z = 3N/2.
        let in_outline = |([cx, cy, cz], radius): WholeSphere| {
            let across = 2 * x - cx;
            let along = 10 * (2 * y - cy) - 3 * (6 * half - cz);
            109 * across * across + along * along <= 109 * radius * radius
        };
        lines.iter().all(on_side) && sphere.is_none_or(in_outline)
    }

    #[test]
    fn certain_columns_are_in_a_region_and_impossible_ones_are_not() {
        let mut random = Random::new();
        let mut number = |most: i64| random.below(2 * most as usize + 1) as i64 - most;
        let grid = Grid::new(SIZE);
        let exact = |number: i64| Bounded::exact(number as f64);
        let (mut certain, mut doubtful) = (0, 0);
        for round in 0..3000 {
            let lines: Vec<WholeLine> = (0..round % 4)
                .map(|_| (3 * number(40), number(4), number(4), number(1) > 0))
                .collect();
            let sphere: Option<WholeSphere> = (round % 3 > 0).then(|| {
                let center = [number(90), number(90), number(90)];
                (center, number(60).abs() + 1)
            });
            let arena = Bump::new();
            let half_planes: Vec<HalfPlane<'_>> = lines
                .iter()
                .map(|&(constant, column, row, closed)| {
                    let [constant, column, row] = [constant, column, row].map(exact);
                    HalfPlane::new(constant, column, row, closed, (grid, &arena))
                })
                .collect();
            let ellipse = sphere.map(|([x, y, z], radius)| {
                let [x, y, z, radius] =
                    [x, y, z, radius].map(|twice| Bounded::exact(twice as f64 / 2.0));
                SphereOutlines::new(grid).of(Vector::new(x, y, z), radius)
            });
            let region = Region::new(&half_planes, ellipse.as_ref(), grid);
            for first in (0..SIZE).step_by(ROWS) {
                let level = Level::baseline();
                let mut enclosed = BandColumns::NONE;
                dispatch!(level, simd => region.enclose(simd, first, grid, &mut enclosed));
                let mut narrowed = enclosed.clone();
                region.narrow(&mut narrowed, first, grid);
                for band in [enclosed, narrowed] {
                    for row in 0..ROWS {
                        let within = |ends: &[[u32; ROWS]; 2], column: u32| {
                            ends[0][row] <= column && column < ends[1][row]
                        };
                        for column in 0..SIZE {
                            let truth = holds(&lines, sphere, column, first + row as u32);
                            let is_certain = within(&band.certain, column);
                            let is_possible = within(&band.possible, column);
                            let right = if truth { is_possible } else { !is_certain };
                            assert!(
                                right,
                                "{lines:?} {sphere:?} column {column}, row {}",
                                first as usize + row
                            );
                            certain += u32::from(is_certain == is_possible);
                            doubtful += u32::from(is_certain != is_possible);
                        }
                    }
                }
            }
        }
        // A region that is nowhere certain would pass, too.
        assert!(doubtful * 20 < certain, "{doubtful} against {certain}");
    }
}
