//! The sample programs that make pictures, tests/programs.

use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

use super::skipped;
use super::text;

/// The path of a sample program; a path with a root is one already.
fn source(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/programs")
        .join(name)
}

/// Whether a program of the system is there: in CI it is.
fn is_there(result: io::Result<std::process::Output>, name: &str) -> bool {
    match result {
        Ok(output) => {
            assert!(output.status.success(), "{name}: {}", text(&output.stderr));
            true
        }
        Err(error) => {
            skipped(&format!("{name}: {error}"));
            false
        }
    }
}

/// The command that starts the sample program `name`, a file in C, compiled into `folder` with
/// `options`; `None` where there is no compiler.
pub(crate) fn compiled(folder: &TempDir, name: &str, options: &[&str]) -> Option<String> {
    let program = folder.path().join("sample");
    let mut compiler = Command::new("cc");
    // No multiplication is fused with an addition: the samples are those of any processor.
    compiler
        .args(["-O2", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror"])
        .args(options)
        .arg(source(name))
        .args(["-lm", "-o"])
        .arg(&program);
    is_there(compiler.output(), "cc").then(|| format!("'{}'", program.display()))
}

/// The command that starts the sample program `name`, a file in Python; `None` where there is no
/// Python.
pub(crate) fn interpreted(name: &str) -> Option<String> {
    let python = Command::new("python3").arg("--version").output();
    is_there(python, "python3").then(|| format!("python3 '{}'", source(name).display()))
}
