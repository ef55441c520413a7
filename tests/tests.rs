//! What needs neither a window nor a process to itself, in one program: a module for each promise.
//!
//! What traces whole pictures or saves them as EXR is tested here and not beside the code: the library's own test program would have to
//! contain every kernel for all vector instructions, and every compression, once more, which takes as long to compile as the rest of it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a test stops at the first surprise, and shows its tables"
)]

mod command_line;
mod compare;
mod explain;
mod helpers;
mod image_files;
mod listing;
mod offscreen;
mod pictures;
mod plain;
mod properties;
mod readme;
mod report;
mod scene_files;
mod screen;
mod stability;
mod stages;
