//! The sets of vector instructions that rows can be traced with.

use std::fmt;

use fearless_simd::Level;

/// A set of vector instructions that this machine has. It changes the speed of a tracer and no bit
/// of a picture.
#[derive(Clone, Copy)]
pub struct Simd(pub(super) Level);

impl Simd {
    /// The widest set of this machine.
    pub fn best() -> Simd {
        Simd(Level::new())
    }

    /// All sets of this machine, the widest first and none last.
    pub fn all() -> Vec<Simd> {
        let best = Level::new();
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let vectors = [
            best.as_avx512().map(Level::Avx512),
            best.as_avx2().map(Level::Avx2),
            best.as_sse4_2().map(Level::Sse4_2),
            best.as_sse2().map(Level::Sse2),
        ];
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        let vectors = [(!best.is_fallback()).then_some(best)];
        let vectors = vectors.into_iter().flatten();
        vectors.chain([Level::fallback()]).map(Simd).collect()
    }

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self.0 {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx512(_) => "avx512",
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx2(_) => "avx2",
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Sse4_2(_) => "sse4.2",
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Sse2(_) => "sse2",
            #[cfg(target_arch = "aarch64")]
            Level::Neon(_) => "neon",
            _ => "none",
        }
    }
}

impl fmt::Debug for Simd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
