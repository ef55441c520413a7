//! The commit that the program is built from, for the report to name: looked up once, here, and
//! without running anything.

#![allow(clippy::print_stdout, reason = "Cargo listens there")]

use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-env-changed=FIRSTHIT_COMMIT");
    println!("cargo::rerun-if-changed=src/build.rs");
    let commit = env::var("FIRSTHIT_COMMIT").ok().or_else(|| {
        // Who works on it would have everything compiled anew after each commit.
        if env::var("PROFILE").is_ok_and(|profile| profile == "debug") {
            return None;
        }
        let source = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR")?);
        packed(&source).or_else(|| checked_out(&source))
    });
    if let Some(commit) = commit.filter(|commit| !commit.is_empty()) {
        println!("cargo::rustc-env=FIRSTHIT_COMMIT={commit}");
    }
}

/// Of a packed crate, from what cargo has packed with it.
pub(crate) fn packed(source: &Path) -> Option<String> {
    let text = read(&source.join(".cargo_vcs_info.json"))?;
    let hash = text.split_once("\"sha1\"")?.1.split('"').nth(1)?;
    short(hash)
}

/// Of a git repository, from its own files.
pub(crate) fn checked_out(source: &Path) -> Option<String> {
    // Where the source is not the whole of a repository, it may be another's.
    let git = source.join(".git");
    // In a second working tree it is a file that names the folder.
    let git = match read(&git) {
        Some(text) => source.join(text.strip_prefix("gitdir:")?.trim()),
        None => git,
    };
    let head = read(&git.join("HEAD"))?;
    let Some(reference) = head.strip_prefix("ref:") else {
        return short(head.trim());
    };
    let reference = reference.trim();
    let shared = read(&git.join("commondir")).map(|folder| git.join(folder.trim()));
    [Some(git), shared].into_iter().flatten().find_map(|git| {
        let loose = read(&git.join(reference)).and_then(|hash| short(hash.trim()));
        loose.or_else(|| {
            let packed = read(&git.join("packed-refs"))?;
            let mut lines = packed.lines();
            let hash = lines.find_map(|line| line.strip_suffix(reference)?.strip_suffix(' '))?;
            short(hash)
        })
    })
}

/// What a file holds; it is looked at again when it changes.
fn read(path: &Path) -> Option<String> {
    let text = fs::read_to_string(path).ok()?;
    println!("cargo::rerun-if-changed={}", path.display());
    Some(text)
}

/// The first twelve digits of a hash.
fn short(hash: &str) -> Option<String> {
    let digits = hash.get(..12)?;
    let is_hash = hash.len() >= 40 && hash.bytes().all(|byte| byte.is_ascii_hexdigit());
    is_hash.then(|| digits.to_owned())
}
