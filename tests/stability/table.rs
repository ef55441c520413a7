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

/// A frame, and what is allowed there. The kernels exact and reference are allowed nothing, in every row.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// The file's name in `tests/scenes`.
    pub(crate) scene: &'static str,
    pub(crate) stage: u8,
    pub(crate) alpha: f64,
    /// The bits of the plain evaluation: more than twice those between the largest and the smallest term of a decision.
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

/// Scene, stage, α, bits; then for fast and for double the wrong pixels, the misrounded samples, the largest error in ulp. Where
/// a row fails, the test prints it as it should be.
#[rustfmt::skip]
pub(crate) const TABLE: &[Row] = &[
    row("far_spheres", 2, 0.0, 256, [20, 60, 0], [0, 0, 0]),
    row("far_spheres", 6, 0.0, 256, [28, 5174, 2514515], [0, 0, 0]),
    row("far_spheres", 6, 0.3, 256, [34, 4328, 2609641], [0, 1, 1]),
    row("nested_spheres", 2, 0.0, 256, [825, 2475, 0], [134, 402, 0]),
    row("nested_spheres", 6, 0.0, 256, [825, 9154, 9], [134, 402, 0]),
    row("nested_spheres", 6, 0.3, 256, [838, 9539, 26], [14, 42, 0]),
    row("nested_spheres", 6, 4.2, 256, [790, 9919, 52], [162, 486, 0]),
    row("speck_on_a_sample", 6, 0.0, 256, [9, 30, 1058462342], [0, 0, 0]),
    row("speck_on_a_sample", 6, 0.3, 256, [5, 15, 0], [0, 0, 0]),
    row("speck_on_a_sample", 6, 4.2, 256, [0, 4, 1], [0, 0, 0]),
    row("giants", 2, 0.0, 256, [256, 768, 0], [1, 3, 0]),
    row("giants", 3, 0.3, 256, [0, 0, 0], [0, 0, 0]),
    row("giants", 6, 0.0, 256, [337, 25175, 169], [2, 6, 0]),
    row("giants", 6, 0.3, 256, [312, 35180, 4], [0, 0, 0]),
    row("giants", 6, 4.2, 256, [0, 26293, 3], [0, 0, 0]),
    row("resting_spheres", 6, 0.0, 256, [0, 4316, 9], [0, 0, 0]),
    row("resting_spheres", 6, 0.3, 256, [0, 4722, 23], [0, 0, 0]),
    row("resting_spheres", 6, 4.2, 256, [0, 3874, 25], [0, 0, 0]),
    row("resting_spheres", 6, 1e22, 256, [0, 3852, 14], [0, 0, 0]),
    row("axis_spheres", 6, 0.0, 256, [0, 5772, 3], [0, 0, 0]),
    row("axis_spheres", 6, 0.3, 256, [0, 5801, 3], [0, 0, 0]),
    row("axis_spheres", 6, 4.2, 256, [0, 5900, 3], [0, 0, 0]),
    row("axis_spheres", 2, 0.3, 256, [0, 0, 0], [0, 0, 0]),
    row("axis_spheres", 4, 0.3, 256, [0, 6113, 11], [0, 0, 0]),
    row("crossing_spheres", 2, 0.0, 256, [0, 0, 0], [0, 0, 0]),
    row("crossing_spheres", 6, 0.0, 256, [0, 7284, 6], [0, 0, 0]),
    row("crossing_spheres", 6, 0.3, 256, [0, 7508, 34], [0, 0, 0]),
    row("crossing_spheres", 6, 4.2, 256, [0, 7513, 11], [0, 0, 0]),
    row("spheres_in_the_floor", 5, 0.0, 256, [0, 7485, 6], [0, 0, 0]),
    row("spheres_in_the_floor", 6, 0.0, 256, [0, 8768, 6], [0, 0, 0]),
    row("spheres_in_the_floor", 6, 0.3, 256, [0, 7459, 14], [0, 0, 0]),
    row("spheres_in_the_floor", 6, 4.2, 256, [0, 6434, 14], [0, 0, 0]),
    row("edges_on_samples", 3, 0.0, 256, [0, 0, 0], [0, 0, 0]),
    row("edges_on_samples", 6, 0.0, 256, [0, 3215, 1], [0, 0, 0]),
    row("edges_on_samples", 6, 0.3, 256, [0, 3366, 1], [0, 0, 0]),
    row("edges_on_samples", 6, 4.2, 256, [0, 2623, 2], [0, 0, 0]),
    row("along_faces", 3, 0.0, 256, [0, 0, 0], [0, 0, 0]),
    row("along_faces", 6, 0.0, 256, [1, 648, 1], [0, 0, 0]),
    row("along_faces", 6, 1e-9, 256, [45, 712, 1], [0, 0, 0]),
    row("along_faces", 6, 4.2, 256, [1, 2258, 1], [1, 3, 0]),
    row("along_faces", 6, 5e-324, 8192, [46, 715, 1], [45, 135, 0]),
    row("edge_on_the_axis", 6, 0.0, 256, [0, 2616, 1], [2, 6, 0]),
    row("edge_on_the_axis", 6, 0.3, 256, [0, 2735, 1], [0, 0, 0]),
    row("edge_on_the_axis", 6, 4.2, 256, [68, 5221, 1], [68, 136, 0]),
    row("shared_faces", 4, 0.3, 256, [0, 2676, 1], [0, 0, 0]),
    row("shared_faces", 6, 0.0, 256, [0, 3465, 1], [0, 0, 0]),
    row("shared_faces", 6, 0.3, 256, [0, 2952, 1], [0, 0, 0]),
    row("shared_faces", 6, 4.2, 256, [0, 3740, 1], [0, 0, 0]),
    row("skew_shared_plane", 6, 0.0, 256, [0, 1782, 19], [0, 0, 0]),
    row("skew_shared_plane", 6, 0.3, 256, [0, 2882, 27], [0, 0, 0]),
    row("skew_shared_plane", 6, 4.2, 256, [0, 3575, 5], [0, 0, 0]),
    row("duplicated_solids", 4, 0.0, 256, [0, 4430, 8], [0, 0, 0]),
    row("duplicated_solids", 6, 0.0, 256, [0, 5109, 8], [0, 0, 0]),
    row("duplicated_solids", 6, 0.3, 256, [0, 5375, 10], [0, 0, 0]),
    row("duplicated_solids", 6, 4.2, 256, [0, 3615, 9], [0, 0, 0]),
    row("needle", 6, 0.0, 256, [1978, 7957, 1], [1, 3, 0]),
    row("needle", 6, 0.3, 256, [1913, 7553, 1], [0, 0, 0]),
    row("needle", 6, 4.2, 256, [789, 2367, 0], [0, 0, 0]),
    row("crossing_tetrahedra", 6, 0.0, 256, [0, 3328, 1], [2, 6, 0]),
    row("crossing_tetrahedra", 6, 0.3, 256, [0, 3599, 4], [0, 0, 0]),
    row("crossing_tetrahedra", 6, 4.2, 256, [0, 4729, 2], [0, 0, 0]),
    row("below_the_floor", 5, 0.0, 256, [1, 3138, 7], [0, 0, 0]),
    row("below_the_floor", 6, 0.0, 256, [1, 3834, 7], [0, 0, 0]),
    row("below_the_floor", 6, 0.3, 256, [0, 4303, 14], [0, 0, 0]),
    row("below_the_floor", 6, 4.2, 256, [1, 3784, 14], [0, 0, 0]),
    row("floor_border_on_samples", 6, 0.0, 256, [0, 1426, 3], [0, 0, 0]),
    row("floor_border_on_samples", 6, 0.3, 256, [0, 1932, 5], [0, 0, 0]),
    row("floor_border_on_samples", 6, 4.2, 256, [0, 2120, 36], [0, 0, 0]),
    row("tiny_and_huge_floor", 6, 0.0, 256, [2, 2083, 3], [1, 3, 0]),
    row("tiny_and_huge_floor", 6, 0.3, 256, [1, 3002, 6], [1, 3, 0]),
    row("tiny_and_huge_floor", 6, 4.2, 256, [1, 3676, 16], [1, 3, 0]),
    row("light_in_the_floor", 6, 0.0, 256, [1, 5043, 10], [0, 0, 0]),
    row("light_in_the_floor", 6, 0.3, 256, [0, 4941, 12], [0, 0, 0]),
    row("light_in_the_floor", 6, 4.2, 256, [0, 4065, 16], [0, 0, 0]),
    row("light_along_the_axes", 6, 0.0, 256, [0, 1261, 3], [0, 0, 0]),
    row("light_along_the_axes", 6, 0.3, 256, [0, 612, 12], [0, 0, 0]),
    row("light_along_the_axes", 6, 4.2, 256, [0, 1212, 2], [0, 0, 0]),
    row("light_from_the_eye", 6, 0.0, 256, [0, 4384, 3], [0, 0, 0]),
    row("light_from_the_eye", 6, 1e-9, 256, [72, 4529, 2495], [0, 0, 0]),
    row("light_from_the_eye", 6, 2.1, 256, [0, 4311, 19], [0, 0, 0]),
    row("light_from_the_eye", 6, 1e-300, 8192, [73, 4537, 3], [72, 216, 0]),
    row("light_into_the_eye", 4, 0.0, 256, [0, 3341, 1], [0, 0, 0]),
    row("light_into_the_eye", 6, 0.0, 256, [0, 3988, 1], [0, 0, 0]),
    row("light_into_the_eye", 6, 1e-9, 256, [72, 4148, 1], [0, 0, 0]),
    row("light_into_the_eye", 6, 2.1, 256, [0, 5263, 13], [0, 0, 0]),
    row("light_into_the_eye", 4, 1e-17, 256, [1, 4858, 2], [1, 3, 0]),
    row("light_into_the_mirrored_eye", 6, 0.0, 256, [0, 3373, 2], [0, 0, 0]),
    row("light_into_the_mirrored_eye", 6, 1e-9, 256, [73, 3591, 2], [0, 0, 0]),
    row("light_into_the_mirrored_eye", 6, 2.1, 256, [0, 5408, 30], [0, 0, 0]),
    row("light_nearly_into_the_eye", 4, 0.0, 256, [0, 4579, 70], [0, 0, 0]),
    row("light_nearly_into_the_eye", 6, 0.0, 256, [0, 3988, 1], [0, 0, 0]),
    row("light_nearly_into_the_eye", 6, 2.1, 256, [0, 5263, 13], [0, 0, 0]),
    row("light_from_below", 6, 0.0, 256, [0, 5355, 33], [0, 0, 0]),
    row("light_from_below", 6, 0.3, 256, [0, 4660, 30], [0, 0, 0]),
    row("light_from_below", 6, 4.2, 256, [0, 5865, 13], [0, 0, 0]),
    row("grazing_light", 6, 0.0, 256, [2, 2216, 1], [1, 3, 0]),
    row("grazing_light", 6, 0.3, 256, [38, 1992, 1], [107, 321, 0]),
    row("grazing_light", 6, 4.2, 256, [93, 2146, 1], [0, 0, 0]),
    row("wide_light", 6, 0.0, 512, [1, 2764, 4], [1, 3, 0]),
    row("wide_light", 6, 0.3, 512, [0, 2861, 7], [0, 0, 0]),
    row("wide_light", 6, 4.2, 512, [0, 2693, 5], [0, 0, 0]),
    row("highlights", 4, 0.6, 256, [0, 6488, 64], [0, 0, 0]),
    row("highlights", 6, 0.0, 256, [0, 7313, 7], [0, 0, 0]),
    row("highlights", 6, 0.3, 256, [0, 8347, 41], [0, 0, 0]),
    row("highlights", 6, 4.2, 256, [0, 4197, 61], [0, 0, 0]),
    row("exponent_million", 6, 0.0, 256, [0, 22795, 3], [0, 0, 0]),
    row("exponent_million", 6, 0.3, 256, [0, 21766, 3], [0, 0, 0]),
    row("exponent_million", 6, 4.2, 256, [0, 3093, 1], [0, 0, 0]),
    row("subnormal_samples", 6, 0.0, 256, [0, 1001, 2], [0, 0, 0]),
    row("subnormal_samples", 6, 0.3, 256, [0, 1788, 2], [0, 0, 0]),
    row("subnormal_samples", 6, 4.2, 256, [0, 811, 2], [0, 0, 0]),
    row("largest_samples", 6, 0.0, 256, [0, 3860, 157], [0, 0, 0]),
    row("largest_samples", 6, 0.3, 256, [0, 3649, 538], [0, 0, 0]),
    row("largest_samples", 6, 4.2, 256, [0, 2221, 676], [0, 0, 0]),
    row("midpoint_samples", 6, 0.0, 256, [0, 1112, 13], [0, 0, 0]),
    row("midpoint_samples", 6, 0.3, 256, [0, 1188, 318], [0, 0, 0]),
    row("midpoint_samples", 6, 4.2, 256, [0, 1175, 125], [0, 0, 0]),
    row("extremes", 2, 0.0, 2048, [222, 666, 0], [1, 3, 0]),
    row("extremes", 3, 0.0, 2048, [222, 654, 0], [4, 6, 0]),
    row("extremes", 4, 0.0, 2048, [409, 29537, 550], [5, 15, 0]),
    row("extremes", 5, 0.0, 2048, [106, 8153, 1], [4, 6, 0]),
    row("extremes", 6, 0.0, 2048, [106, 8153, 1], [4, 6, 0]),
    row("extremes", 6, 0.3, 2048, [171, 9589, 1], [0, 0, 0]),
    row("extremes", 6, 1.7e308, 2048, [247, 7787, 1], [0, 0, 0]),
    row("extremes", 6, 5e-324, 8192, [106, 8153, 1], [4, 6, 0]),
    row("extremes_without_floor", 2, 0.3, 2048, [0, 0, 0], [0, 0, 0]),
    row("extremes_without_floor", 3, 0.3, 2048, [54, 120, 0], [0, 0, 0]),
    row("extremes_without_floor", 6, 0.0, 2048, [72, 17144, 1], [1, 3, 0]),
    row("extremes_without_floor", 6, 0.3, 2048, [45, 17039, 1], [0, 0, 0]),
    row("extremes_without_floor", 6, -1.7e308, 2048, [78, 17381, 1], [1, 3, 0]),
    row("extremes_without_floor", 6, 5e-324, 8192, [72, 17144, 1], [1, 3, 0]),
    row("far_ring", 6, 0.0, 256, [200, 5361, 5223934], [1, 3, 0]),
    row("far_ring", 6, 2.1, 256, [288, 7133, 2167287], [1, 4, 1]),
    row("far_ring", 6, 4.2, 256, [284, 5749, 4059593], [0, 4, 53]),
    row("crowd", 6, 0.0, 256, [3, 12328, 8], [1, 3, 0]),
    row("crowd", 6, 0.3, 256, [0, 14168, 52], [0, 0, 0]),
    row("crowd", 6, 4.2, 256, [0, 14504, 33], [0, 0, 0]),
    row("touching_solids", 6, 0.0, 256, [0, 4997, 3], [0, 0, 0]),
    row("touching_solids", 6, 0.3, 256, [0, 6361, 14], [0, 0, 0]),
    row("touching_solids", 6, 4.2, 256, [0, 7238, 12], [0, 0, 0]),
];
