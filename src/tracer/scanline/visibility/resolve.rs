//! Visibility: from the regions that cover a gap to what the gap shows.

use crate::scene::Side;
use crate::tracer::scanline::edges::table::SolidIndex;
use crate::tracer::scanline::prepare::frame::PreparedFrame;
use crate::tracer::scanline::prepare::front_faces::{FrontFace, FrontFaces};
use crate::tracer::scanline::prepare::solids::{Appearance, PreparedSolids};
use crate::tracer::scanline::prepare::surface::PreparedSurface;
use crate::tracer::scanline::visibility::coverage::Coverage;
use crate::tracer::scanline::visibility::depth_test::{Candidate, DepthTests};
use crate::tracer::scanline::visibility::visible::{Shown, Visible};
use crate::tracer::tetrahedron::last_entered;

/// What a gap with this coverage shows. If rows have to decide, a test is added to `depth_tests`.
pub(crate) fn visible(
    frame: &PreparedFrame<'_>,
    coverage: &Coverage,
    depth_tests: &mut DepthTests,
) -> Visible {
    let direct = frame.solids(false);
    let Some(met) = coverage.direct.certain() else {
        return Visible::IN_DOUBT;
    };
    // A solid above the surface hides the surface.
    let hides = |&solid: &SolidIndex| direct.side(solid) == Side::Above;
    let meets_surface = if met.iter().any(hides) {
        Some(false)
    } else {
        coverage.surface()
    };
    let surface = match meets_surface {
        Some(meets_surface) => frame.surface.as_ref().filter(|_| meets_surface),
        None => return Visible::IN_DOUBT,
    };
    match (met, surface) {
        ([], None) => Visible::Only(Shown::Paint(frame.background)),
        ([], Some(surface)) => visible_surface(surface, coverage, depth_tests),
        (_, surface) => {
            if surface.is_none()
                && let Some(solid) = direct.separation.first(met)
            {
                return Visible::Only(candidate(direct, solid, coverage).shown);
            }
            let rest = match surface {
                Some(surface) => visible_surface(surface, coverage, depth_tests),
                None => Visible::Only(Shown::Paint(frame.background)),
            };
            let candidates = met.iter().map(|&solid| candidate(direct, solid, coverage));
            depth_tests.defer(false, candidates, surface.is_some(), rest)
        }
    }
}

/// What a gap shows where the surface is in front of all solids seen directly.
fn visible_surface(
    surface: &PreparedSurface<'_>,
    coverage: &Coverage,
    depth_tests: &mut DepthTests,
) -> Visible {
    let itself = Visible::Only(Shown::Paint(surface.paint));
    let mirrored = match (coverage.in_shadow(surface.shadows), &surface.mirrored) {
        (Some(true), _) => return Visible::Only(Shown::Paint(surface.in_shadow)),
        (None, _) => return Visible::IN_DOUBT,
        (Some(false), None) => return itself,
        (Some(false), Some(mirrored)) => mirrored,
    };
    let Some(met) = coverage.mirrored.certain() else {
        return Visible::IN_DOUBT;
    };
    if met.is_empty() {
        return itself;
    }
    // The line of a mirrored ray may meet a solid that goes through the surface before the surface,
    // where the ray has not begun: the depth test decides.
    let goes_through = |&solid: &SolidIndex| mirrored.side(solid) == Side::Across;
    if !met.iter().any(goes_through)
        && let Some(solid) = mirrored.separation.first(met)
    {
        return Visible::Only(candidate(mirrored, solid, coverage).shown);
    }
    let candidates = met
        .iter()
        .map(|&solid| candidate(mirrored, solid, coverage));
    depth_tests.defer(true, candidates, false, itself)
}

/// What a gap shows where a solid is in front.
fn candidate(solids: &PreparedSolids<'_>, solid: SolidIndex, coverage: &Coverage) -> Candidate {
    let (front_face, shown) = match solids.appearance(solid) {
        Appearance::Flat(paint) => (None, Shown::Paint(*paint)),
        Appearance::Sphere(_) => {
            let shown = Shown::Sphere {
                mirrored: solids.mirrored,
                solid,
            };
            (None, shown)
        }
        Appearance::FrontFaces(front_faces) => front_face(front_faces, coverage),
        Appearance::LateFaces(_) => {
            let shown = Shown::Faces {
                mirrored: solids.mirrored,
                solid,
            };
            (None, shown)
        }
    };
    Candidate {
        solid,
        front_face,
        shown,
    }
}

/// The index of the front face that a gap sees of a tetrahedron, if no crease is in doubt, and what
/// the gap shows of it.
pub(crate) fn front_face(front_faces: &FrontFaces, coverage: &Coverage) -> (Option<usize>, Shown) {
    let pairs = front_faces.pairs.iter().copied();
    match last_entered(pairs.zip(front_faces.first_crease..), |region| {
        coverage.holds(region).ok_or(())
    }) {
        Ok(last) => (Some(last), front_face_in(&front_faces.all[last], coverage)),
        Err(()) => (None, Shown::InDoubt),
    }
}

/// What a gap shows where it sees a front face.
fn front_face_in(front_face: &FrontFace, coverage: &Coverage) -> Shown {
    match coverage.in_shadow(front_face.shadows) {
        Some(true) => Shown::Paint(front_face.in_shadow),
        Some(false) => Shown::Paint(front_face.outside),
        None => Shown::InDoubt,
    }
}
