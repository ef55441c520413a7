//! The depth test: which of several solids is nearest where no plane keeps them apart.
//!
//! The test bounds the depth of each solid over an interval of columns. If the bounds overlap, the
//! interval is halved, down to single pixels, which are then decided by themselves. A half is
//! tested only against the solids that can be in front there.

use std::ops::Range;

use crate::scene::Side;
use crate::tracer::scanline::edges::table::SolidIndex;
use crate::tracer::scanline::grid::Columns;
use crate::tracer::scanline::prepare::depth::Rectangle;
use crate::tracer::scanline::prepare::frame::PreparedFrame;
use crate::tracer::scanline::visibility::visible::{Shown, Visible};

/// A solid that may be in front.
#[derive(Clone, Copy)]
pub(crate) struct Candidate {
    pub(crate) solid: SolidIndex,
    /// The index of the front face that is seen of a tetrahedron, if known.
    pub(crate) front_face: Option<usize>,
    /// What it shows where it is in front.
    pub(crate) shown: Shown,
}

/// A depth test among several solids.
pub(crate) struct DepthTest {
    /// Whether the solids are seen in the mirror.
    pub(crate) mirrored: bool,
    /// The range of its candidates among those of all tests.
    candidates: Range<usize>,
    /// Whether the surface may be in front of them.
    pub(crate) surface: bool,
    /// What is visible where none of them is in front.
    pub(crate) rest: Visible,
}

/// Beyond so many tests all are forgotten, and those still needed are made anew.
const MANY: usize = 4096;

/// The depth tests of all gaps.
#[derive(Default)]
pub(crate) struct DepthTests {
    tests: Vec<DepthTest>,
    candidates: Vec<Candidate>,
}

impl DepthTests {
    pub(crate) fn clear(&mut self) {
        self.tests.clear();
        self.candidates.clear();
    }

    /// The number of tests.
    pub(crate) fn count(&self) -> usize {
        self.tests.len()
    }

    /// Forgets all but the first `count` tests.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.tests.truncate(count);
        let end = self.tests.last().map_or(0, |test| test.candidates.end);
        self.candidates.truncate(end);
    }

    /// Whether all tests should be forgotten: most of so many are not needed any more.
    pub(crate) fn is_full(&self) -> bool {
        self.tests.len() > MANY
    }

    /// Adds a test, which leaves it to each row what is in front of the candidates, given in any
    /// order.
    pub(crate) fn defer(
        &mut self,
        mirrored: bool,
        candidates: impl Iterator<Item = Candidate>,
        surface: bool,
        rest: Visible,
    ) -> Visible {
        let first = self.candidates.len();
        self.candidates.extend(candidates);
        self.candidates[first..].sort_unstable_by_key(|candidate| candidate.solid);
        self.tests.push(DepthTest {
            mirrored,
            candidates: first..self.candidates.len(),
            surface,
            rest,
        });
        Visible::DepthTest(self.tests.len() as u32 - 1)
    }

    /// The test of this number, and its candidates.
    pub(crate) fn test(&self, number: u32) -> (&DepthTest, &[Candidate]) {
        let test = &self.tests[number as usize];
        (test, &self.candidates[test.candidates.clone()])
    }
}

/// The parts of a span, each decided by the depth test, and memory that is kept from span to span.
#[derive(Default)]
pub(crate) struct DepthTester {
    parts: Vec<(Columns, Shown)>,
    /// A stack: for each halving that is under way, the solids that can be in front.
    near: Vec<Near>,
}

/// A candidate, by its index in the test, and a lower bound on its depth in an interval.
struct Near {
    index: usize,
    lower: f64,
}

/// What is in front of all else in some columns.
enum Front {
    /// The candidate of this index in the test.
    Candidate(usize),
    /// The surface, or where that is not met either, the background.
    Rest,
    /// In doubt: whatever is in front begins before this depth.
    Before(f64),
}

/// The frame, its tests, and Y of a row.
type Row<'a, 'f> = (&'a PreparedFrame<'f>, &'a DepthTests, f64);

impl DepthTester {
    /// What a row shows in the columns of a span, from the left.
    pub(crate) fn test(
        &mut self,
        row: Row<'_, '_>,
        visible: Visible,
        columns: Columns,
    ) -> impl Iterator<Item = (Columns, Shown)> {
        self.parts.clear();
        self.add(row, visible, columns);
        self.parts.drain(..)
    }

    fn add(&mut self, row: Row<'_, '_>, visible: Visible, columns: Columns) {
        match visible {
            Visible::Only(shows) => self.push(columns, shows),
            Visible::DepthTest(test) => {
                let test = row.1.test(test);
                let first = self.near.len();
                let indices = 0..test.1.len();
                self.near
                    .extend(indices.map(|index| Near { index, lower: 0.0 }));
                self.add_first(row, test, first, columns);
                self.near.truncate(first);
            }
        }
    }

    /// Settles columns by a test among the solids in `near` from number `first` on.
    fn add_first(
        &mut self,
        row: Row<'_, '_>,
        test: (&DepthTest, &[Candidate]),
        first: usize,
        columns: Columns,
    ) {
        let end = self.near.len();
        let before = match front(row, test, &mut self.near[first..], columns) {
            Front::Candidate(index) => return self.push(columns, test.1[index].shown),
            Front::Rest => return self.add(row, test.0.rest, columns),
            Front::Before(depth) => depth,
        };
        let Some(halves) = halves(columns) else {
            return self.push(columns, Shown::InDoubt);
        };
        for i in first..end {
            let Near { index, lower } = self.near[i];
            if lower <= before {
                self.near.push(Near { index, lower });
            }
        }
        for half in halves {
            self.add_first(row, test, end, half);
        }
        self.near.truncate(end);
    }

    fn push(&mut self, columns: Columns, shows: Shown) {
        match self.parts.last_mut() {
            Some((before, same)) if *same == shows => before.1 = columns.1,
            _ => self.parts.push((columns, shows)),
        }
    }
}

/// What is in front in all these columns, among the solids `near`. Updates their lower bounds.
fn front(
    (frame, _, y): Row<'_, '_>,
    (test, candidates): (&DepthTest, &[Candidate]),
    near: &mut [Near],
    columns: Columns,
) -> Front {
    let solids = frame.solids(test.mirrored);
    let surface = frame.surface.as_ref().map(|surface| surface.depth_at(y));
    let interval = Rectangle {
        x: [columns.0, columns.1 - 1].map(|column| frame.grid.coordinate(column)),
        y: [y, y],
    };
    // The candidate has the smallest upper bound. It is in front if all other lower bounds are
    // larger.
    let nothing = (f64::INFINITY, f64::INFINITY);
    let rest = surface.filter(|_| test.surface).unwrap_or(nothing);
    let mut candidate = (Front::Rest, rest);
    let mut others_begin = f64::INFINITY;
    let support = |candidate: &Candidate| {
        let depth = solids.depth(candidate.solid);
        let front_face = match candidate.shown {
            Shown::Faces { .. } => depth.front_face(interval),
            _ => candidate.front_face,
        };
        depth.support(front_face)
    };
    for Near { index, lower: kept } in near {
        let other = &candidates[*index];
        let depth = solids.depth(other.solid);
        let (lower, upper) = depth.bounds(other.front_face, interval);
        let (front, (begins, ends_first)) = &mut candidate;
        // Of two solids with one support, the first in the scene is seen.
        if let Front::Candidate(index_of_first) = front
            && let first = &candidates[*index_of_first]
            && lower <= *ends_first
            && *begins <= upper
            && let own = support(other)
            && own.is_some()
            && own == support(first)
        {
            if solids.number(other.solid) < solids.number(first.solid) {
                *index_of_first = *index;
            }
            *kept = *begins;
            continue;
        }
        *kept = lower;
        // Mirrored rays begin at the surface, and miss a solid that ends before.
        if let Some((from, to)) =
            surface.filter(|_| test.mirrored && solids.side(other.solid) == Side::Across)
            && lower <= to
        {
            if upper >= from {
                others_begin = others_begin.min(lower.max(from));
            } else {
                *kept = f64::INFINITY;
            }
            continue;
        }
        if upper < *ends_first {
            others_begin = others_begin.min(*begins);
            candidate = (Front::Candidate(*index), (lower, upper));
        } else {
            others_begin = others_begin.min(lower);
        }
    }
    let (front, (_, upper)) = candidate;
    // The background is in front if nothing else is there.
    let is_alone = others_begin == f64::INFINITY;
    if others_begin > upper || (is_alone && matches!(front, Front::Rest)) {
        front
    } else {
        Front::Before(upper)
    }
}

/// Both halves of an interval of more than one column.
fn halves((from, to): Columns) -> Option<[Columns; 2]> {
    let middle = from + (to - from) / 2;
    (to - from > 1).then_some([(from, middle), (middle, to)])
}
