//! The choice of how numbers are computed.

/// How numbers are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Kernel {
    /// Every decision as in exact arithmetic, every sample the true value correctly rounded.
    #[default]
    Exact,
    /// Colours in f32, by careful formulas without bounds. Which solid a pixel shows is told by
    /// edges and depths in f64 with bounds, and in f32 where those leave it in doubt.
    Fast,
    /// The same in f64, rounded to f32 once at the end.
    Double,
    /// The document's listings as printed, slips included: the baseline. Two spheres, one
    /// tetrahedron and a surface only.
    Listing,
    /// The reference that errors are measured against: double-doubles with a bound on their error,
    /// then arbitrary precision. f64 is not tried.
    Reference,
}

impl Kernel {
    /// Every kernel.
    pub const ALL: [Kernel; 5] = [
        Kernel::Exact,
        Kernel::Fast,
        Kernel::Double,
        Kernel::Listing,
        Kernel::Reference,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Kernel::Exact => "exact",
            Kernel::Fast => "fast",
            Kernel::Double => "double",
            Kernel::Listing => "listing",
            Kernel::Reference => "reference",
        }
    }
}
