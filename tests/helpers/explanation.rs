//! The words of an explanation.

use firsthit::image::display_byte;
use firsthit::tracer::Decision;
use firsthit::{Scene, Stage};

/// What follows `about` on its line.
pub(crate) fn line<'a>(text: &'a str, about: &str) -> Option<&'a str> {
    let mut lines = text.lines().filter(|line| line.starts_with(about));
    lines.next().map(|line| line[about.len()..].trim())
}

/// Checks that the explanation of a pixel, in a stage, says what was decided for it, and its
/// samples.
pub(crate) fn says_what_is_shown(
    text: &str,
    (scene, stage): (&Scene, Stage),
    (decision, samples): (Decision, [f32; 3]),
) {
    let [r, g, b] = samples;
    assert_eq!(
        line(text, "samples"),
        Some(&*format!("{r:?} {g:?} {b:?}")),
        "{text}"
    );
    let [r, g, b] = samples.map(display_byte);
    assert_eq!(
        line(text, "bytes"),
        Some(&*format!("{r} {g} {b}")),
        "{text}"
    );
    let mut shown = text.lines().filter(|line| line.starts_with("shows"));
    let shown = shown.next_back().map(|line| line["shows".len()..].trim());
    let (expected, in_shadow) = match decision {
        Decision::Quadrant(_) => return assert!(line(text, "quadrant").is_some(), "{text}"),
        Decision::Background => ("the background: nothing is hit".to_owned(), false),
        Decision::Surface => ("the surface, which no solid hides".to_owned(), false),
        Decision::SurfaceInShadow => ("the surface, which no solid hides".to_owned(), true),
        Decision::Solid(seen) | Decision::Mirrored(seen) => {
            let mirrored = matches!(decision, Decision::Mirrored(_));
            let end = if mirrored { ", mirrored" } else { "" };
            let solid = usize::from(seen.solid);
            let name = match (solid.checked_sub(scene.spheres().len()), seen.face) {
                (None, _) => format!("sphere {}", solid + 1),
                (Some(index), face) => format!("tetrahedron {}, face {}", index + 1, face.unwrap()),
            };
            // In the light, equation 4-1 has all its terms.
            let has_terms = line(text, "diffuse").is_some();
            assert_eq!(
                has_terms,
                stage >= Stage::Shading && !seen.in_shadow,
                "{text}"
            );
            (name + end, seen.in_shadow)
        }
    };
    assert_eq!(shown, Some(&*expected), "{text}");
    assert_eq!(line(text, "in shadow").is_some(), in_shadow, "{text}");
}
