//! The arithmetic of a kernel that traces rows.

/// The arithmetic that spheres are shaded with.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::tracer) enum Precision {
    /// f32.
    Single,
    /// f64.
    Double,
    /// f64, and pixels that its errors may make wrong are asked for by themselves.
    Bounded,
}
