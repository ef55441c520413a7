//! The sample programs that make pictures, tests/programs.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

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

/// The command that starts the sample program `name`, a file in C, which is compiled once; `None`
/// where there is no compiler.
pub(crate) fn compiled(name: &str) -> Option<String> {
    static COMPILED: Mutex<BTreeMap<String, Option<String>>> = Mutex::new(BTreeMap::new());
    // Where the compiler finds a mistake, other tests stop at it, too.
    let mut compiled = COMPILED.lock().unwrap_or_else(PoisonError::into_inner);
    let once = || compile(&source(name));
    compiled.entry(name.to_owned()).or_insert_with(once).clone()
}

fn compile(source: &Path) -> Option<String> {
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join(source.file_stem()?);
    // What still runs of tests that ran before goes on.
    let _ = std::fs::remove_file(&program);
    let mut compiler = Command::new("cc");
    // No multiplication is fused with an addition: the samples are those of any processor.
    compiler
        .args(["-O2", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror"])
        .arg(source)
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
