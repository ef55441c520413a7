//! Sorts the numbers of all rows of a band at once, by vector instructions.
//!
//! A bitonic sorting network (Batcher, Sorting networks and their applications, 1968): which
//! numbers it compares depends on nothing but how many there are. So it has no branches that no
//! processor predicts. Every comparison puts the smaller number first, so that numbers larger than
//! all others would stay at the end: those that are missing there need no place.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::tracer::scanline::grid::ROWS;

/// So many numbers of a row are sorted in registers.
pub(crate) const BLOCK: usize = 8;

/// Sorts the numbers of each row, of which there are whole blocks. None may be a NaN.
#[inline(always)]
pub(crate) fn sort_rows<S: Simd>(simd: S, numbers: &mut [[f64; ROWS]]) {
    debug_assert!(numbers.len().is_multiple_of(BLOCK));
    sort_blocks::<S, false>(simd, numbers);
    let mut sorted = BLOCK;
    while sorted < numbers.len() {
        for part in numbers.chunks_mut(2 * sorted) {
            merge(simd, part, sorted);
        }
        sorted *= 2;
    }
}

/// Merges the first `half` numbers of each row with the others, of which there are as many or
/// fewer. Both are sorted.
#[inline(always)]
fn merge<S: Simd>(simd: S, numbers: &mut [[f64; ROWS]], half: usize) {
    let Some((left, right)) = numbers.split_at_mut_checked(half) else {
        return;
    };
    // Afterwards each half is bitonic, and no number of the first is larger than one of the second.
    for (left, right) in left.iter_mut().rev().zip(right) {
        compare(simd, left, right);
    }
    let mut distance = half / 2;
    while distance >= BLOCK {
        for part in numbers.chunks_mut(2 * distance) {
            let (left, right) = part.split_at_mut(distance.min(part.len()));
            for (left, right) in left.iter_mut().zip(right) {
                compare(simd, left, right);
            }
        }
        distance /= 2;
    }
    sort_blocks::<S, true>(simd, numbers);
}

/// Exchanges the numbers of those rows in which they are out of order.
#[inline(always)]
fn compare<S: Simd>(simd: S, left: &mut [f64; ROWS], right: &mut [f64; ROWS]) {
    let pairs = left.chunks_exact_mut(S::f64s::LEN);
    for (left, right) in pairs.zip(right.chunks_exact_mut(S::f64s::LEN)) {
        let [a, b] = [&*left, &*right].map(|numbers| S::f64s::from_slice(simd, numbers));
        a.min(b).store_slice(left);
        a.max(b).store_slice(right);
    }
}

/// Sorts each block, or with `BITONIC` each bitonic one.
#[inline(always)]
fn sort_blocks<S: Simd, const BITONIC: bool>(simd: S, numbers: &mut [[f64; ROWS]]) {
    for block in numbers.as_chunks_mut::<BLOCK>().0 {
        for row in (0..ROWS).step_by(S::f64s::LEN) {
            let mut lanes = [S::f64s::splat(simd, 0.0); BLOCK];
            for (lanes, numbers) in lanes.iter_mut().zip(&*block) {
                *lanes = S::f64s::from_slice(simd, &numbers[row..row + S::f64s::LEN]);
            }
            match BITONIC {
                true => sort_bitonic_block::<S>(&mut lanes),
                false => sort_block::<S>(&mut lanes),
            }
            for (lanes, numbers) in lanes.iter().zip(&mut *block) {
                lanes.store_slice(&mut numbers[row..row + S::f64s::LEN]);
            }
        }
    }
}

/// Sorts a block by the fewest comparisons: section 5.3.4 of Knuth's The Art of Computer
/// Programming.
#[inline(always)]
fn sort_block<S: Simd>(lanes: &mut [S::f64s; BLOCK]) {
    compare_lanes::<S, _>(lanes, [(0, 2), (1, 3), (4, 6), (5, 7)]);
    compare_lanes::<S, _>(lanes, [(0, 4), (1, 5), (2, 6), (3, 7)]);
    compare_lanes::<S, _>(lanes, [(0, 1), (2, 3), (4, 5), (6, 7)]);
    compare_lanes::<S, _>(lanes, [(2, 4), (3, 5)]);
    compare_lanes::<S, _>(lanes, [(1, 4), (3, 6)]);
    compare_lanes::<S, _>(lanes, [(1, 2), (3, 4), (5, 6)]);
}

/// Sorts a bitonic block.
#[inline(always)]
fn sort_bitonic_block<S: Simd>(lanes: &mut [S::f64s; BLOCK]) {
    compare_lanes::<S, _>(lanes, [(0, 4), (1, 5), (2, 6), (3, 7)]);
    compare_lanes::<S, _>(lanes, [(0, 2), (1, 3), (4, 6), (5, 7)]);
    compare_lanes::<S, _>(lanes, [(0, 1), (2, 3), (4, 5), (6, 7)]);
}

/// Exchanges these pairs of numbers where they are out of order.
#[inline(always)]
fn compare_lanes<S: Simd, const N: usize>(
    lanes: &mut [S::f64s; BLOCK],
    pairs: [(usize, usize); N],
) {
    for (first, second) in pairs {
        let (a, b) = (lanes[first], lanes[second]);
        (lanes[first], lanes[second]) = (a.min(b), a.max(b));
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::dispatch;

    use super::*;
    use crate::random::Random;
    use crate::tracer;

    #[test]
    fn numbers_of_all_rows_are_sorted_each_by_itself() {
        let mut random = Random::new();
        for level in tracer::Simd::all().into_iter().map(|simd| simd.0) {
            for blocks in (0..20).chain([64, 65]) {
                let few = 1 + random.below(300);
                let mut number = || random.below(few) as f64;
                let numbers = (0..BLOCK * blocks).map(|_| [(); ROWS].map(|()| number()));
                let numbers: Vec<[f64; ROWS]> = numbers.collect();
                let mut sorted = numbers.clone();
                dispatch!(level, simd => sort_rows(simd, &mut sorted));
                for row in 0..ROWS {
                    let of_row = |all: &[[f64; ROWS]]| -> Vec<f64> {
                        all.iter().map(|numbers| numbers[row]).collect()
                    };
                    let mut expected = of_row(&numbers);
                    expected.sort_by(f64::total_cmp);
                    assert_eq!(of_row(&sorted), expected, "{blocks} blocks, row {row}");
                }
            }
        }
    }
}
