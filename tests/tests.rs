//! What needs neither a window nor a process to itself, in one program: a module for each promise.

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
