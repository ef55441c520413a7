//! What needs neither a window nor a process to itself, in one program: a module for each promise.
//!
//! What traces whole pictures or saves them as EXR is tested here and not beside the code: the
//! library's own test program would have to contain every kernel for all vector instructions, and
//! every compression, once more, which takes as long to compile as the rest of it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a test stops at the first surprise, and shows its tables"
)]

#[cfg(feature = "program")]
mod command_line;
#[cfg(all(feature = "program", target_os = "linux"))]
mod commit;
#[cfg(feature = "program")]
mod compare;
mod crowds;
mod diagnosis;
mod doubt;
#[cfg(all(feature = "program", target_os = "linux"))]
mod drivers;
#[cfg(feature = "program")]
mod explain;
mod flip;
#[cfg(feature = "program")]
mod foreign_pictures;
mod fuzz;
mod helpers;
mod hints;
mod image_files;
mod imports;
#[cfg(all(feature = "program", target_os = "linux"))]
mod limits;
mod listing;
#[cfg(feature = "program")]
mod offscreen;
mod oracle;
mod pictures;
mod portable_maps;
#[cfg(all(feature = "program", target_os = "linux"))]
mod program;
mod progress;
mod properties;
#[cfg(feature = "program")]
mod readme;
#[cfg(feature = "program")]
mod report;
mod scene_files;
#[cfg(feature = "program")]
mod screen;
mod stability;
mod stages;
#[cfg(all(feature = "program", target_os = "linux"))]
mod terminal;
mod ties;
#[cfg(all(feature = "program", target_os = "linux"))]
mod whole_files;
