//! What the measuring was done on, and with.

use std::num::NonZeroUsize;
use std::{env, fs, thread};

use serde::Serialize;

/// A machine, and the program on it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Machine {
    /// The processor, as it names itself; "unknown" where the system does not tell.
    pub(super) cpu: String,
    /// What the processor has of SIMD instruction sets.
    pub(super) features: Vec<&'static str>,
    /// The architecture that the program was built for.
    pub(super) architecture: &'static str,
    /// The operating system.
    pub(super) os: &'static str,
    /// Threads that run at the same time.
    pub(super) cores: usize,
    /// The version of the program.
    pub(super) version: &'static str,
    /// The commit that it was built from: the environment variable `FIRSTHIT_COMMIT` of the build,
    /// else the one that the sources of the build were at; `None` where neither was known, and
    /// in a debug build. Changes to the sources that were not committed are not seen.
    pub(super) commit: Option<String>,
    /// Whether it was built without optimisation: then its times mean little.
    pub(super) debug_build: bool,
}

impl Machine {
    /// This one.
    pub(super) fn this() -> Machine {
        Machine {
            cpu: cpu(),
            features: features(),
            architecture: env::consts::ARCH,
            os: env::consts::OS,
            cores: cores(),
            version: env!("CARGO_PKG_VERSION"),
            commit: option_env!("FIRSTHIT_COMMIT").map(str::to_owned),
            debug_build: cfg!(debug_assertions),
        }
    }
}

/// Threads that run at the same time.
pub(super) fn cores() -> usize {
    thread::available_parallelism().map_or(1, NonZeroUsize::get)
}

fn cpu() -> String {
    // Linux, then Windows.
    let information = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = information
        .lines()
        .filter_map(|line| line.split_once(':'))
        .find(|(key, _)| key.trim() == "model name")
        .map(|(_, model)| model.trim().to_owned());
    model
        .or_else(|| env::var("PROCESSOR_IDENTIFIER").ok())
        .unwrap_or_else(|| "unknown".to_owned())
}

macro_rules! detected {
    ($detected:ident: $($feature:tt)*) => {
        [$(($feature, std::arch::$detected!($feature))),*]
            .into_iter()
            .filter_map(|(feature, is_there)| is_there.then_some(feature))
            .collect()
    };
}

#[cfg(target_arch = "x86_64")]
fn features() -> Vec<&'static str> {
    detected!(is_x86_feature_detected: "sse2" "sse4.1" "sse4.2" "avx" "avx2" "fma" "avx512f" "avx512bw" "avx512dq" "avx512vl")
}

#[cfg(target_arch = "aarch64")]
fn features() -> Vec<&'static str> {
    detected!(is_aarch64_feature_detected: "neon" "sve" "sve2")
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn features() -> Vec<&'static str> {
    Vec::new()
}
