//! The bounds on edges and depths, compared with double-doubles: each holds the truth, and the
//! largest error is no small part of its bound.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use bumpalo::Bump;
use fearless_simd::{Level, dispatch};

use crate::number::{Bounded, DoubleDouble, Real};
use crate::random::Random;
use crate::scene::Scene;
use crate::stage::Stage;
use crate::tracer::arena::Arena;
use crate::tracer::ladder::{Ladder, RowPixels as _, Rung};
use crate::tracer::pixel::Picture;
use crate::tracer::scanline::edges::ellipses::SphereOutlines;
use crate::tracer::scanline::edges::enclosure::ColumnEnclosure;
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::grid::Grid;
use crate::tracer::scanline::prepare::depth::{Depth, FaceDepth, Rectangle};
use crate::tracer::scanline::prepare::surface_plane::{SurfaceDepth, surface_plane};
use crate::tracer::tetrahedron::Passage;
use crate::tracer::view_space::eye_direction;

const SIZE: u32 = 500;

/// The largest errors, as shares of their bounds.
#[derive(Debug, Default)]
struct Shares {
    outline: f64,
    chords: f64,
    half_plane: f64,
    sphere_depth: f64,
    face_depth: f64,
    surface_depth: f64,
    surface_point: f64,
}

/// The distance of the truth from the middle of an enclosure, over half its width; 0 where it is
/// unbounded.
fn share(truth: DoubleDouble, low: f64, high: f64) -> f64 {
    let apart = |end: f64| (truth - DoubleDouble::exact(end)).to_f64();
    assert!(
        apart(low) >= 0.0 && apart(high) <= 0.0,
        "{:e} is not from {low:e} to {high:e}",
        truth.to_f64()
    );
    let half = (high - low) / 2.0;
    if half > 0.0 && half.is_finite() {
        (apart(low) / half - 1.0).abs()
    } else {
        0.0
    }
}

/// X in columns.
fn column_of(x: DoubleDouble, grid: Grid) -> DoubleDouble {
    x / DoubleDouble::exact(3.0) + DoubleDouble::exact(grid.half)
}

fn check_spheres(
    bounded: &Picture<'_, Bounded>,
    truth: &Picture<'_, DoubleDouble>,
    grid: Grid,
    shares: &mut Shares,
) {
    let outlines = SphereOutlines::new(grid);
    for (sphere, exact) in bounded.view.spheres.iter().zip(truth.view.spheres) {
        let outline = outlines.of(sphere.center, sphere.radius);
        let depth = Depth::of_sphere(sphere.center, &outline, sphere.support, grid);
        for row in (0..SIZE).step_by(7) {
            let y = grid.coordinate(row);
            let ColumnEnclosure { possible, certain } = outline.enclose_row(y, grid);
            // No column lies there.
            if certain[0] >= certain[1] || certain[1] <= 0.0 {
                continue;
            }
            let [three, ten] = [3.0, 10.0].map(DoubleDouble::exact);
            let z = DoubleDouble::exact(grid.max) - exact.center.z;
            let y_off = DoubleDouble::exact(y) - exact.center.y;
            let m = (ten * y_off - three * z) / DoubleDouble::exact(109.0).sqrt();
            let half = (exact.radius.squared() - m.squared()).sqrt();
            let ends = [exact.center.x - half, exact.center.x + half];
            let [begin, end] = ends.map(|x| column_of(x, grid));
            // Near the outline's top the root carries more error than the bound's slack.
            shares.outline = shares.outline.max(share(begin, possible[0], certain[0]));
            shares.outline = shares.outline.max(share(end, certain[1], possible[1]));
            let ColumnEnclosure { possible, certain } = outline.chords().enclose_row(y);
            if certain[0] < certain[1] {
                shares.chords = shares.chords.max(share(begin, possible[0], certain[0]));
                shares.chords = shares.chords.max(share(end, certain[1], possible[1]));
            }
            for column in (certain[0].ceil().max(0.0) as u32..SIZE)
                .take_while(|column| f64::from(*column) < certain[1])
                .step_by(47)
            {
                let x = grid.coordinate(column);
                let at = Rectangle {
                    x: [x, x],
                    y: [y, y],
                };
                let (lower, upper) = depth.bounds(None, at);
                let hit = exact
                    .first_hit(&truth.transform.eye_ray(column, row))
                    .unwrap();
                if let Some(hit) = hit {
                    let part = share(hit.depth, lower, upper);
                    shares.sphere_depth = shares.sphere_depth.max(part);
                }
            }
        }
    }
}

fn check_tetrahedra(
    bounded: &Picture<'_, Bounded>,
    truth: &Picture<'_, DoubleDouble>,
    grid: Grid,
    shares: &mut Shares,
) {
    let arena = Bump::new();
    let (tetrahedra, exact) = (&bounded.view.tetrahedra, &truth.view.tetrahedra);
    for index in 0..tetrahedra.count() {
        let (t, exact) = (tetrahedra.get(index), exact.get(index));
        for wall in Passage::of(t.eye_signs).met.iter() {
            let half_space = t.solid.half_space(wall, eye_direction().vector);
            let exact = exact.solid.half_space(wall, eye_direction().vector);
            let half_plane = HalfPlane::of(&half_space, None, (grid, &arena));
            for row in (0..SIZE).step_by(7) {
                let y = grid.coordinate(row);
                let all = [0.0, f64::from(SIZE)];
                let mut enclosure = ColumnEnclosure {
                    possible: all,
                    certain: all,
                };
                let border = half_plane.border();
                dispatch!(Level::baseline(), simd => border.cut_row(simd, y, &mut enclosure));
                let ColumnEnclosure { possible, certain } = enclosure;
                // n·(X, Y, Z) = n·a.
                let (n, a) = (exact.normal, exact.at);
                let rest = n.y * (a.y - DoubleDouble::exact(y))
                    + n.z * (a.z - DoubleDouble::exact(grid.max));
                let root = column_of(a.x + rest / n.x, grid);
                for (low, high) in [(possible[0], certain[0]), (certain[1], possible[1])] {
                    if 0.0 < low && low < high && high < f64::from(SIZE) {
                        shares.half_plane = shares.half_plane.max(share(root, low, high));
                    }
                }
            }
        }
        for face in Passage::of(t.eye_signs).entered() {
            let depth = FaceDepth::new(&t.solid.inner_half_space(face), grid);
            let plane = exact.solid.inner_half_space(face);
            for (column, row) in (0..SIZE)
                .step_by(41)
                .flat_map(|x| (0..SIZE).step_by(37).map(move |y| (x, y)))
            {
                let ray = truth.transform.eye_ray(column, row);
                let n_dot_d = plane.normal.dot(ray.direction.vector);
                let exact = plane.normal.dot(plane.at - ray.origin) / n_dot_d;
                let [x, y] = [column, row].map(|number| [grid.coordinate(number); 2]);
                let (lower, upper) = depth.bounds(Rectangle { x, y });
                shares.face_depth = shares.face_depth.max(share(exact, lower, upper));
            }
        }
    }
}

fn check_surface(
    bounded: &Picture<'_, Bounded>,
    truth: &Picture<'_, DoubleDouble>,
    grid: Grid,
    shares: &mut Shares,
) {
    let square = bounded.surface.as_ref().unwrap().square;
    let exact = truth.surface.as_ref().unwrap().square;
    let (depth, plane) = (
        SurfaceDepth::new(&square, grid),
        surface_plane(&square, grid),
    );
    for row in (0..SIZE).step_by(7) {
        let (column, y) = (row / 3, grid.coordinate(row));
        let ray = truth.transform.eye_ray(column, row);
        let (t, point) = truth.transform.on_surface(&exact, &ray, row);
        let (lower, upper) = depth.at(y);
        shares.surface_depth = shares.surface_depth.max(share(t, lower, upper));
        let [x, y] = [grid.coordinate(column), y].map(Bounded::exact);
        let seen = plane.origin + plane.per_x * x + plane.per_y * y;
        for (truth, seen) in [(point.x, seen.x), (point.y, seen.y), (point.z, seen.z)] {
            let share = share(truth, seen.at_least(), seen.at_most());
            shares.surface_point = shares.surface_point.max(share);
        }
    }
}

#[test]
fn no_bound_on_an_edge_or_a_depth_is_out_of_proportion() {
    let grid = Grid::new(SIZE);
    let mut random = Random::new();
    let mut shares = Shares::default();
    for _ in 0..700 {
        let mut numbers = |count: usize, max: f64| -> Vec<f64> {
            let mut number = || max * (2.0 * random.fraction() - 1.0);
            (0..count).map(|_| number()).collect()
        };
        let center = numbers(3, 3.0);
        let radius = 0.4 + numbers(1, 4.0)[0].abs();
        let height = numbers(1, 1.0)[0];
        let vertices: Vec<Vec<f64>> = (0..4).map(|_| numbers(3, 3.6)).collect();
        let text = format!(
            "[[sphere]]\ncenter = {center:?}\nradius = {radius:?}\ncolor = [0.5, 0.5, 0.5]\n\
             [[tetrahedron]]\nvertices = {vertices:?}\ncolor = [0.5, 0.5, 0.5]\n\
             [surface]\nheight = {height:?}\nhalf_width = 1.0\n"
        );
        let scene = Scene::from_toml(&text).unwrap();
        let alpha = numbers(1, 3.0)[0];
        let (arena, allocator) = (Arena::default(), Bump::new());
        let ladder = Ladder::new(&scene, Stage::Shadow, alpha, SIZE, Rung::Hardware, &arena);
        let truth = ladder.picture::<DoubleDouble>(&&allocator);
        check_spheres(ladder.bounded(), &truth, grid, &mut shares);
        check_tetrahedra(ladder.bounded(), &truth, grid, &mut shares);
        check_surface(ladder.bounded(), &truth, grid, &mut shares);
    }
    // A bound that were ten times too small would be exceeded.
    let Shares {
        outline,
        chords,
        half_plane,
        sphere_depth,
        face_depth,
        surface_depth,
        surface_point,
    } = shares;
    let solids = outline
        .min(chords)
        .min(half_plane)
        .min(sphere_depth)
        .min(face_depth);
    let least = solids.min(surface_depth).min(surface_point);
    assert!(least > 0.1 && least < 1.0, "{shares:?}");
}
