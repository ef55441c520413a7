//! The choice of how numbers are computed.

/// How numbers are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Kernel {
    /// Every decision as in exact arithmetic, every sample the true value correctly rounded.
    #[default]
    Exact,
    /// Every pixel in f32: careful formulas, no bounds, no safety net. Where borders cross a row is
    /// computed once a row, in f64.
    Fast,
    /// The same in f64, rounded to f32 once at the end.
    Double,
    /// The document's listings as printed, slips included: the baseline. Two spheres, one
    /// tetrahedron and a surface only.
    Listing,
    /// What errors are measured against: as exact, but with no f64 on the way.
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
