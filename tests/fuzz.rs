//! Promise: no bytes break a promise. What fuzzing has tried is tried again: the files of the
//! corpora, each by what `.ci/fuzz` runs.

#[cfg(feature = "program")]
mod command_line;
mod exr;
mod pfm;
mod picture;
mod png;
mod ppm;
mod scene;

use std::fs;

use crate::helpers::on_all_cores;

/// Tries every file of the corpus of that name.
fn replay(name: &str, run: impl Fn(&[u8]) + Sync) {
    let folder = format!("{}/tests/fuzz/corpus/{name}", env!("CARGO_MANIFEST_DIR"));
    let files = fs::read_dir(folder).unwrap();
    let mut paths: Vec<_> = files.map(|file| file.unwrap().path()).collect();
    paths.sort_unstable();
    assert!(paths.len() > 10, "{name}");
    on_all_cores(paths.into_iter(), |path| {
        let bytes = fs::read(&path).unwrap();
        let tried = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| run(&bytes)));
        assert!(tried.is_ok(), "{}", path.display());
    });
}

#[test]
fn of_scenes() {
    replay("scene", scene::run);
}

#[test]
fn of_exr_files() {
    replay("exr", exr::run);
}

#[test]
fn of_png_files() {
    replay("png", png::run);
}

#[test]
fn of_pfm_files() {
    replay("pfm", pfm::run);
}

#[test]
fn of_ppm_files() {
    replay("ppm", ppm::run);
}

#[cfg(feature = "program")]
#[test]
fn of_command_lines() {
    use std::process::Command;

    use crate::helpers::{PROGRAM, failed};

    replay("command_line", |bytes| {
        command_line::run(bytes, &|words, folder| {
            let mut command = Command::new(PROGRAM);
            command.args(words).current_dir(folder);
            let output = command.output().unwrap();
            match output.status.code() {
                Some(0) => {}
                Some(status @ (1 | 2)) => {
                    let said = failed(&output, status, &words.join(" "));
                    assert!(!said.is_empty(), "{words:?}");
                }
                other => panic!("{other:?} {words:?} {output:?}"),
            }
        });
    });
}
