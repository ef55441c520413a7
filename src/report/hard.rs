//! The scenes of the stability suite: each provokes something that others have stumbled over, which
//! its first line names.

macro_rules! scenes {
    ($($name:literal)*) => {
        &[$(($name, include_str!(concat!("../../tests/scenes/", $name, ".toml")))),*]
    };
}

/// Their names and their texts, sorted by name.
#[rustfmt::skip]
pub(super) const HARD_SCENES: &[(&str, &str)] = scenes! {
    "along_faces"
    "axis_spheres"
    "below_the_floor"
    "crossing_curves"
    "crossing_spheres"
    "crossing_tetrahedra"
    "crowd"
    "duplicated_solids"
    "edge_on_the_axis"
    "edges_on_samples"
    "exponent_million"
    "extremes"
    "extremes_without_floor"
    "far_ring"
    "far_spheres"
    "floor_border_on_samples"
    "giants"
    "grazing_light"
    "highlights"
    "largest_samples"
    "light_along_the_axes"
    "light_from_below"
    "light_from_the_eye"
    "light_in_the_floor"
    "light_into_the_eye"
    "light_into_the_mirrored_eye"
    "light_nearly_into_the_eye"
    "midpoint_samples"
    "needle"
    "nested_spheres"
    "overlapping"
    "resting_spheres"
    "shared_faces"
    "skew_shared_plane"
    "speck_on_a_sample"
    "spheres_in_the_floor"
    "subnormal_samples"
    "tiny_and_huge_floor"
    "touching_solids"
    "wide_light"
};

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::report::NamedScene;

    #[test]
    fn the_hard_scenes_are_those_of_the_stability_suite() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes");
        let mut files: Vec<(String, String)> = folder
            .read_dir()
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .map(|path| {
                let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
                (name, std::fs::read_to_string(path).unwrap())
            })
            .collect();
        files.sort();
        let listed = HARD_SCENES
            .iter()
            .map(|&(name, text)| (name.to_owned(), text.to_owned()));
        assert!(listed.eq(files));
        // Each of them is a scene.
        assert_eq!(NamedScene::hard().count(), HARD_SCENES.len());
    }
}
