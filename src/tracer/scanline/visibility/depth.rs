//! The depth test: which of several solids is nearest where no plane keeps them apart.
//!
//! It bounds the depths of each solid over a run of columns. Where the bounds overlap, the run is
//! halved, down to single pixels, which are then asked by themselves.

use crate::scene::Side;
use crate::tracer::scanline::grid::Columns;
use crate::tracer::scanline::prepare::prepared::Prepared;
use crate::tracer::scanline::visibility::visible::{DepthTest, DepthTests, Shown, Visible};

/// What is in front of all else in some columns.
enum Front {
    /// One of the solids in question.
    Solid(usize),
    /// The surface, or where that is not met either, the background.
    Rest,
    Unknown,
}

/// What a row shows where it has to decide about that, from the left.
pub(crate) fn settle(
    frame: &Prepared<'_>,
    depth_tests: &DepthTests,
    visible: Visible,
    y: f64,
    columns: Columns,
    settled: &mut Vec<(Columns, Shown)>,
) {
    let shows = match visible {
        Visible::Only(shows) => shows,
        Visible::First(test) => {
            let test = depth_tests.test(test);
            match (front(frame, &test, y, columns), halves(columns)) {
                (Front::Solid(place), _) => test.solids[place].1,
                (Front::Rest, _) => {
                    return settle(frame, depth_tests, test.rest, y, columns, settled);
                }
                (Front::Unknown, Some(halves)) => {
                    for half in halves {
                        settle(frame, depth_tests, visible, y, half, settled);
                    }
                    return;
                }
                (Front::Unknown, None) => Shown::Unknown,
            }
        }
    };
    match settled.last_mut() {
        Some((before, same)) if *same == shows => before.1 = columns.1,
        _ => settled.push((columns, shows)),
    }
}

/// What is in front in all these columns.
fn front(frame: &Prepared<'_>, test: &DepthTest<'_>, y: f64, columns: Columns) -> Front {
    let view = frame.solids(test.mirrored);
    let surface = frame.floor.as_ref().map(|floor| floor.depth_at(y));
    let ends = [columns.0, columns.1 - 1].map(|column| frame.grid.place(column));
    // The candidate is what ends first; it is in front if all others begin behind that.
    let nothing = (f64::INFINITY, f64::INFINITY);
    let rest = surface.filter(|_| test.surface).unwrap_or(nothing);
    let mut candidate = (Front::Rest, rest);
    let mut others_begin = f64::INFINITY;
    for (place, &(solid, _)) in test.solids.iter().enumerate() {
        let solid = &view.solids[solid];
        let (front, (begins, ends_first)) = &candidate;
        // Of a sphere that is listed twice the first is seen.
        if let Front::Solid(first) = front
            && view.solids[test.solids[*first].0].is_same_sphere(solid)
        {
            continue;
        }
        let (least, most) = solid.depth(y, ends);
        // The rays that the surface mirrors begin there.
        if let Some((from, to)) = surface.filter(|_| test.mirrored && solid.side == Side::Across)
            && least <= to
        {
            if most < from {
                continue;
            }
            return Front::Unknown;
        }
        if most < *ends_first {
            others_begin = others_begin.min(*begins);
            candidate = (Front::Solid(place), (least, most));
        } else {
            others_begin = others_begin.min(least);
        }
    }
    let (front, (_, most)) = candidate;
    if most.is_finite() && others_begin > most {
        front
    } else {
        Front::Unknown
    }
}

/// Both halves of some columns, if there are more than one.
fn halves((from, to): Columns) -> Option<[Columns; 2]> {
    let middle = from + (to - from) / 2;
    (to - from > 1).then_some([(from, middle), (middle, to)])
}
