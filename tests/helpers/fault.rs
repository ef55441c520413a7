//! Faults that no healthy system has, put between the program and what it calls.

use std::path::PathBuf;
use std::process::Command;
use std::sync::LazyLock;

use tempfile::TempDir;

/// What is preloaded; it lies here until the process ends.
struct Library {
    path: PathBuf,
    _folder: TempDir,
}

static LIBRARY: LazyLock<Option<Library>> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fault.so");
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/helpers/fault.c");
    let mut compiler = Command::new("cc");
    compiler.args(["-shared", "-fPIC", "-O1", "-Wall", "-Werror", "-o"]);
    match compiler.arg(&path).args([source, "-ldl"]).output() {
        Ok(output) => {
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{said}");
            let _folder = folder;
            Some(Library { path, _folder })
        }
        Err(error) => {
            assert!(std::env::var_os("CI").is_none(), "no C compiler: {error}");
            eprintln!("skipped: faults need a C compiler: {error}");
            None
        }
    }
});

/// The variables of the environment that bring a fault; `None` where there is no compiler for it:
/// never so in CI.
pub(crate) fn environment(fault: &str) -> Option<[(&'static str, &str); 2]> {
    let library = LIBRARY.as_ref()?.path.to_str()?;
    Some([("LD_PRELOAD", library), ("FAULT", fault)])
}

/// The program of `command` with a fault; `None` as above.
#[allow(
    dead_code,
    reason = "some bring the fault to what they start themselves"
)]
pub(crate) fn with_fault<'c>(command: &'c mut Command, fault: &str) -> Option<&'c mut Command> {
    Some(command.envs(environment(fault)?))
}
