//! The arithmetic of a kernel that traces rows.

/// The arithmetic that spheres are shaded with.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::tracer) enum Precision {
    /// f32.
    Single,
    /// f64.
    Double,
    /// f64 with bounds on its errors; pixels in doubt are decided by themselves.
    Bounded,
}
