//! The allowances: what each kernel may get wrong on each hard scene, at N = 128.

use std::fmt;

/// What a kernel gets wrong in a frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Errors {
    /// Pixels whose decision is not that of exact arithmetic.
    pub(crate) wrong: u32,
    /// Samples that are not the true value correctly rounded.
    pub(crate) misrounded: u32,
    /// The most floats that a sample is away from the true one, where the decision is right.
    pub(crate) ulp: u32,
}

/// A frame, and what is allowed there. The kernels exact and reference are allowed nothing, in
/// every row.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// The file's name in `tests/scenes`.
    pub(crate) scene: &'static str,
    pub(crate) stage: u8,
    pub(crate) alpha: f64,
    /// The bits of the oracle's rounded numbers: more than twice those between the largest and the
    /// smallest term of a decision.
    pub(crate) bits: usize,
    pub(crate) fast: Errors,
    pub(crate) double: Errors,
}

/// As it stands in the table.
impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let errors = |errors: &Errors| {
            let Errors {
                wrong,
                misrounded,
                ulp,
            } = errors;
            format!("[{wrong}, {misrounded}, {ulp}]")
        };
        let Row {
            scene,
            stage,
            alpha,
            bits,
            ..
        } = self;
        let (fast, double) = (errors(&self.fast), errors(&self.double));
        write!(
            f,
            "    row({scene:?}, {stage}, {alpha:?}, {bits}, {fast}, {double}),"
        )
    }
}

const fn row(
    scene: &'static str,
    stage: u8,
    alpha: f64,
    bits: usize,
    fast: [u32; 3],
    double: [u32; 3],
) -> Row {
    let [wrong, misrounded, ulp] = fast;
    let fast = Errors {
        wrong,
        misrounded,
        ulp,
    };
    let [wrong, misrounded, ulp] = double;
    let double = Errors {
        wrong,
        misrounded,
        ulp,
    };
    Row {
        scene,
        stage,
        alpha,
        bits,
        fast,
        double,
    }
}

/// Scene, stage, α, bits; then for fast and for double the wrong pixels, the misrounded samples,
/// the largest error in ulp. Where a row fails, the test prints it as it should be.
#[rustfmt::skip]
pub(crate) const TABLE: &[Row] = &[
    row("far_spheres", 2, 0.0, 256, [0, 0, 0], [0, 0, 0]),
    row("far_spheres", 6, 0.0, 256, [0, 3218, 2], [0, 0, 0]),
    row("far_spheres", 6, 0.3, 256, [0, 3062, 2], [0, 1, 1]),
    row("crossing_curves", 5, 0.0, 256, [0, 8697, 5], [0, 0, 0]),
    row("crossing_curves", 6, 0.0, 256, [0, 9150, 5], [0, 0, 0]),
    row("crossing_curves", 6, 0.3, 256, [0, 8145, 7], [0, 0, 0]),
    row("crossing_curves", 6, 4.2, 256, [0, 6004, 7], [0, 0, 0]),
    row("overlapping", 6, 0.0, 256, [0, 26046, 3], [0, 0, 0]),
    row("overlapping", 6, 0.3, 256, [0, 27118, 10], [0, 0, 0]),
    row("overlapping", 6, 4.2, 256, [0, 24219, 9], [0, 0, 0]),
    row("nested_spheres", 2, 0.0, 256, [825, 2475, 0], [134, 402, 0]),
    row("nested_spheres", 6, 0.0, 256, [0, 7419, 3], [0, 0, 0]),
    row("nested_spheres", 6, 0.3, 256, [0, 7035, 6], [0, 0, 0]),
    row("nested_spheres", 6, 4.2, 256, [0, 7851, 8], [0, 0, 0]),
    row("speck_on_a_sample", 6, 0.0, 256, [0, 5, 1058462342], [0, 0, 0]),
    row("speck_on_a_sample", 6, 0.3, 256, [0, 3, 1210213], [0, 0, 0]),
    row("speck_on_a_sample", 6, 4.2, 256, [0, 4, 1], [0, 0, 0]),
    row("giants", 2, 0.0, 256, [22, 66, 0], [1, 3, 0]),
    row("giants", 3, 0.3, 256, [0, 0, 0], [0, 0, 0]),
    row("giants", 6, 0.0, 256, [44, 25061, 169], [2, 6, 0]),
    row("giants", 6, 0.3, 256, [128, 19372, 2], [0, 0, 0]),
    row("giants", 6, 4.2, 256, [0, 19994, 2], [0, 0, 0]),
    row("resting_spheres", 6, 0.0, 256, [0, 3639, 3], [0, 0, 0]),
    row("resting_spheres", 6, 0.3, 256, [0, 3949, 10], [0, 0, 0]),
    row("resting_spheres", 6, 4.2, 256, [0, 3376, 4], [0, 0, 0]),
    row("resting_spheres", 6, 1e22, 256, [0, 3232, 3], [0, 0, 0]),
    row("axis_spheres", 6, 0.0, 256, [0, 5378, 2], [2, 0, 0]),
    row("axis_spheres", 6, 0.3, 256, [0, 5407, 2], [2, 0, 0]),
    row("axis_spheres", 6, 4.2, 256, [0, 5506, 2], [2, 0, 0]),
    row("axis_spheres", 2, 0.3, 256, [0, 0, 0], [0, 0, 0]),
    row("axis_spheres", 4, 0.3, 256, [0, 2861, 4], [0, 0, 0]),
    row("crossing_spheres", 2, 0.0, 256, [0, 0, 0], [0, 0, 0]),
    row("crossing_spheres", 6, 0.0, 256, [0, 6934, 4], [0, 0, 0]),
    row("crossing_spheres", 6, 0.3, 256, [0, 6886, 11], [0, 0, 0]),
    row("crossing_spheres", 6, 4.2, 256, [0, 6605, 17], [0, 0, 0]),
    row("spheres_in_the_floor", 5, 0.0, 256, [0, 6776, 5], [0, 0, 0]),
    row("spheres_in_the_floor", 6, 0.0, 256, [0, 8029, 5], [0, 0, 0]),
    row("spheres_in_the_floor", 6, 0.3, 256, [0, 6601, 5], [0, 0, 0]),
    row("spheres_in_the_floor", 6, 4.2, 256, [0, 5973, 5], [0, 0, 0]),
    row("edges_on_samples", 3, 0.0, 256, [0, 0, 0], [0, 0, 0]),
    row("edges_on_samples", 6, 0.0, 256, [0, 3215, 1], [0, 0, 0]),
    row("edges_on_samples", 6, 0.3, 256, [0, 3366, 1], [0, 0, 0]),
    row("edges_on_samples", 6, 4.2, 256, [0, 2623, 2], [0, 0, 0]),
    row("along_faces", 3, 0.0, 256, [0, 0, 0], [0, 0, 0]),
    row("along_faces", 6, 0.0, 256, [1, 648, 1], [0, 0, 0]),
    row("along_faces", 6, 1e-9, 256, [1, 585, 1], [0, 0, 0]),
    row("along_faces", 6, 4.2, 256, [1, 2258, 1], [1, 3, 0]),
    row("along_faces", 6, 5e-324, 8192, [46, 715, 1], [45, 135, 0]),
    row("edge_on_the_axis", 6, 0.0, 256, [0, 2616, 1], [2, 6, 0]),
    row("edge_on_the_axis", 6, 0.3, 256, [0, 2735, 1], [0, 0, 0]),
    row("edge_on_the_axis", 6, 4.2, 256, [68, 5221, 1], [68, 136, 0]),
    row("shared_faces", 4, 0.3, 256, [0, 2676, 1], [0, 0, 0]),
    row("shared_faces", 6, 0.0, 256, [0, 3465, 1], [0, 0, 0]),
    row("shared_faces", 6, 0.3, 256, [0, 2952, 1], [0, 0, 0]),
    row("shared_faces", 6, 4.2, 256, [0, 3740, 1], [0, 0, 0]),
    row("skew_shared_plane", 6, 0.0, 256, [0, 1726, 10], [0, 0, 0]),
    row("skew_shared_plane", 6, 0.3, 256, [0, 2653, 4], [0, 0, 0]),
    row("skew_shared_plane", 6, 4.2, 256, [0, 3575, 4], [0, 0, 0]),
    row("duplicated_solids", 4, 0.0, 256, [0, 3376, 4], [0, 0, 0]),
    row("duplicated_solids", 6, 0.0, 256, [0, 5027, 4], [0, 0, 0]),
    row("duplicated_solids", 6, 0.3, 256, [0, 5248, 4], [0, 0, 0]),
    row("duplicated_solids", 6, 4.2, 256, [0, 3338, 3], [0, 0, 0]),
    row("needle", 6, 0.0, 256, [0, 2037, 1], [1, 3, 0]),
    row("needle", 6, 0.3, 256, [0, 1875, 1], [0, 0, 0]),
    row("needle", 6, 4.2, 256, [0, 0, 0], [0, 0, 0]),
    row("crossing_tetrahedra", 6, 0.0, 256, [0, 3319, 1], [2, 6, 0]),
    row("crossing_tetrahedra", 6, 0.3, 256, [0, 3575, 1], [0, 0, 0]),
    row("crossing_tetrahedra", 6, 4.2, 256, [0, 4729, 2], [0, 0, 0]),
    row("below_the_floor", 5, 0.0, 256, [1, 2989, 5], [0, 0, 0]),
    row("below_the_floor", 6, 0.0, 256, [1, 3687, 5], [0, 0, 0]),
    row("below_the_floor", 6, 0.3, 256, [0, 4147, 3], [0, 0, 0]),
    row("below_the_floor", 6, 4.2, 256, [1, 3542, 6], [0, 0, 0]),
    row("floor_border_on_samples", 6, 0.0, 256, [0, 1459, 5], [0, 0, 0]),
    row("floor_border_on_samples", 6, 0.3, 256, [0, 1562, 4], [0, 0, 0]),
    row("floor_border_on_samples", 6, 4.2, 256, [0, 1801, 3], [0, 0, 0]),
    row("tiny_and_huge_floor", 6, 0.0, 256, [2, 2069, 3], [1, 3, 0]),
    row("tiny_and_huge_floor", 6, 0.3, 256, [1, 2859, 3], [1, 3, 0]),
    row("tiny_and_huge_floor", 6, 4.2, 256, [1, 3347, 10], [1, 3, 0]),
    row("light_in_the_floor", 6, 0.0, 256, [1, 4634, 6], [0, 0, 0]),
    row("light_in_the_floor", 6, 0.3, 256, [0, 4203, 7], [0, 0, 0]),
    row("light_in_the_floor", 6, 4.2, 256, [0, 3946, 8], [0, 0, 0]),
    row("light_along_the_axes", 6, 0.0, 256, [0, 1203, 3], [1, 0, 0]),
    row("light_along_the_axes", 6, 0.3, 256, [0, 482, 3], [0, 0, 0]),
    row("light_along_the_axes", 6, 4.2, 256, [0, 1206, 1], [0, 0, 0]),
    row("light_from_the_eye", 6, 0.0, 256, [0, 4449, 6], [0, 0, 0]),
    row("light_from_the_eye", 6, 1e-9, 256, [0, 4383, 2495], [0, 0, 0]),
    row("light_from_the_eye", 6, 2.1, 256, [0, 3866, 3], [0, 0, 0]),
    row("light_from_the_eye", 6, 1e-300, 8192, [73, 4598, 6], [72, 216, 0]),
    row("light_into_the_eye", 4, 0.0, 256, [0, 629, 1], [0, 0, 0]),
    row("light_into_the_eye", 6, 0.0, 256, [0, 3984, 2], [0, 0, 0]),
    row("light_into_the_eye", 6, 1e-9, 256, [0, 3928, 2], [0, 0, 0]),
    row("light_into_the_eye", 6, 2.1, 256, [0, 4772, 4], [0, 0, 0]),
    row("light_into_the_eye", 4, 1e-17, 256, [1, 3502, 3], [1, 3, 0]),
    row("light_into_the_mirrored_eye", 6, 0.0, 256, [0, 3321, 3], [0, 0, 0]),
    row("light_into_the_mirrored_eye", 6, 1e-9, 256, [0, 3312, 3], [0, 0, 0]),
    row("light_into_the_mirrored_eye", 6, 2.1, 256, [0, 4927, 4], [0, 0, 0]),
    row("light_nearly_into_the_eye", 4, 0.0, 256, [0, 2250, 9], [0, 0, 0]),
    row("light_nearly_into_the_eye", 6, 0.0, 256, [0, 3984, 2], [0, 0, 0]),
    row("light_nearly_into_the_eye", 6, 2.1, 256, [0, 4772, 4], [0, 0, 0]),
    row("light_from_below", 6, 0.0, 256, [0, 4744, 4], [0, 0, 0]),
    row("light_from_below", 6, 0.3, 256, [0, 4096, 22], [0, 0, 0]),
    row("light_from_below", 6, 4.2, 256, [0, 5091, 4], [0, 0, 0]),
    row("grazing_light", 6, 0.0, 256, [2, 2216, 1], [1, 3, 0]),
    row("grazing_light", 6, 0.3, 256, [38, 1992, 1], [107, 321, 0]),
    row("grazing_light", 6, 4.2, 256, [93, 2146, 1], [0, 0, 0]),
    row("wide_light", 6, 0.0, 512, [1, 2666, 4], [1, 3, 0]),
    row("wide_light", 6, 0.3, 512, [0, 2758, 6], [0, 0, 0]),
    row("wide_light", 6, 4.2, 512, [0, 2246, 5], [0, 0, 0]),
    row("highlights", 4, 0.6, 256, [0, 4864, 27], [0, 0, 0]),
    row("highlights", 6, 0.0, 256, [0, 7119, 3], [0, 0, 0]),
    row("highlights", 6, 0.3, 256, [0, 7164, 15], [0, 0, 0]),
    row("highlights", 6, 4.2, 256, [0, 3960, 7], [0, 0, 0]),
    row("exponent_million", 6, 0.0, 256, [0, 22483, 2], [0, 0, 0]),
    row("exponent_million", 6, 0.3, 256, [0, 26433, 3], [0, 0, 0]),
    row("exponent_million", 6, 4.2, 256, [0, 3093, 1], [0, 0, 0]),
    row("subnormal_samples", 6, 0.0, 256, [0, 1185, 2], [0, 0, 0]),
    row("subnormal_samples", 6, 0.3, 256, [0, 1954, 1], [0, 0, 0]),
    row("subnormal_samples", 6, 4.2, 256, [0, 951, 2], [0, 0, 0]),
    row("largest_samples", 6, 0.0, 256, [0, 3968, 850309630], [0, 33, 546864991]),
    row("largest_samples", 6, 0.3, 256, [0, 3559, 846990824], [0, 27, 539912853]),
    row("largest_samples", 6, 4.2, 256, [0, 2122, 869735988], [0, 20, 506438686]),
    row("midpoint_samples", 6, 0.0, 256, [0, 1050, 50], [0, 0, 0]),
    row("midpoint_samples", 6, 0.3, 256, [0, 1095, 73], [0, 0, 0]),
    row("midpoint_samples", 6, 4.2, 256, [0, 1136, 156], [0, 0, 0]),
    row("extremes", 2, 0.0, 2048, [6, 18, 0], [1, 3, 0]),
    row("extremes", 3, 0.0, 2048, [4, 6, 0], [4, 6, 0]),
    row("extremes", 4, 0.0, 2048, [10, 28501, 550], [5, 15, 0]),
    row("extremes", 5, 0.0, 2048, [4, 7915, 1], [4, 6, 0]),
    row("extremes", 6, 0.0, 2048, [4, 7915, 1], [4, 6, 0]),
    row("extremes", 6, 0.3, 2048, [0, 9108, 1], [0, 0, 0]),
    row("extremes", 6, 1.7e308, 2048, [0, 7198, 1], [0, 0, 0]),
    row("extremes", 6, 5e-324, 8192, [4, 7915, 1], [4, 6, 0]),
    row("extremes_without_floor", 2, 0.3, 2048, [0, 0, 0], [0, 0, 0]),
    row("extremes_without_floor", 3, 0.3, 2048, [1, 2, 0], [0, 0, 0]),
    row("extremes_without_floor", 6, 0.0, 2048, [0, 17002, 1], [1, 3, 0]),
    row("extremes_without_floor", 6, 0.3, 2048, [0, 16993, 1], [0, 0, 0]),
    row("extremes_without_floor", 6, -1.7e308, 2048, [0, 17226, 1], [1, 3, 0]),
    row("extremes_without_floor", 6, 5e-324, 8192, [0, 17002, 1], [1, 3, 0]),
    row("far_ring", 6, 0.0, 256, [1, 3579, 127968], [1, 3, 0]),
    row("far_ring", 6, 2.1, 256, [22, 4047, 1075232], [1, 4, 1]),
    row("far_ring", 6, 4.2, 256, [43, 4438, 508879], [0, 4, 53]),
    row("crowd", 6, 0.0, 256, [3, 11591, 7], [1, 3, 0]),
    row("crowd", 6, 0.3, 256, [0, 11092, 7], [0, 0, 0]),
    row("crowd", 6, 4.2, 256, [0, 12663, 7], [0, 0, 0]),
    row("touching_solids", 6, 0.0, 256, [0, 4988, 2], [0, 0, 0]),
    row("touching_solids", 6, 0.3, 256, [0, 6057, 5], [0, 0, 0]),
    row("touching_solids", 6, 4.2, 256, [0, 6840, 4], [0, 0, 0]),
];
