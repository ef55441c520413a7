//! Promise: a report names the commit that the program was built from, and nothing is run to find
//! it out, neither then nor later.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::Command;

use crate::helpers::{printed, program, skipped, succeeded, text};

#[path = "../src/build.rs"]
#[allow(dead_code, reason = "its main is called when the crate is built")]
mod build;

/// Git in a folder, as nobody in particular.
fn git(folder: &Path, line: &str) -> std::io::Result<String> {
    let output = Command::new("git")
        .args(["-c", "user.name=n", "-c", "user.email=e", "-C"])
        .arg(folder)
        .args(line.split(' '))
        .output()?;
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    Ok(text(&output.stdout).trim().to_owned())
}

#[test]
fn the_commit_is_found_wherever_git_keeps_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let git = |line: &str| git(path, line);
    if let Err(error) = git("init --quiet") {
        return skipped(&format!("git: {error}"));
    }
    git("commit --quiet --allow-empty --message one").unwrap();
    let commit = git("rev-parse HEAD").unwrap();
    let expected = Some(commit[..12].to_owned());
    assert_eq!(build::checked_out(path), expected);
    git("pack-refs --all").unwrap();
    assert_eq!(build::checked_out(path), expected, "packed");
    git("worktree add --quiet -b other other").unwrap();
    assert_eq!(
        build::checked_out(&path.join("other")),
        expected,
        "worktree"
    );
    git("checkout --quiet --detach").unwrap();
    assert_eq!(build::checked_out(path), expected, "detached");
    // A folder of a repository that is another's.
    fs::create_dir(path.join("unpacked")).unwrap();
    assert_eq!(build::checked_out(&path.join("unpacked")), None);
}

#[test]
fn a_packed_crate_brings_its_commit() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(build::packed(folder.path()), None);
    let commit = "0123456789abcdef0123456789abcdef01234567";
    for (text, expected) in [
        (
            format!("{{\n \"git\": {{\n  \"sha1\": \"{commit}\"\n }}\n}}"),
            Some("0123456789ab"),
        ),
        ("{\"git\":{\"sha1\":\"evil\\\"; rm\"}}".to_owned(), None),
        ("{}".to_owned(), None),
    ] {
        fs::write(folder.path().join(".cargo_vcs_info.json"), text).unwrap();
        assert_eq!(build::packed(folder.path()).as_deref(), expected);
    }
}

/// Programs whose names might be looked for, each of which leaves a trace where it is run.
#[test]
fn no_command_runs_another_program() {
    let folder = tempfile::tempdir().unwrap();
    let traps = tempfile::tempdir().unwrap();
    for name in ["git", "sh", "bash", "uname", "lscpu", "cc", "env"] {
        let path = traps.path().join(name);
        let trap = format!("#!/bin/sh\necho {name} >> {}/run\n", traps.path().display());
        fs::write(&path, trap).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }
    printed(
        &folder,
        "capture --stage 6 --size 8 --through none -o a.exr",
    );
    for line in [
        "scene",
        "capture --stage 6 --size 8 --through egl -o a.png",
        "compare a.exr a.exr",
        "explain 4 4 --stage 6 --size 8",
        "report --size 2 --frames 0..0 --kernel double --threads 1 --json a.json --plot a.svg",
    ] {
        let mut command = program(&folder, line);
        command.env("PATH", traps.path());
        succeeded(&command.output().unwrap(), line);
        assert!(!traps.path().join("run").exists(), "{line}");
    }
    // The traps work.
    let run = Command::new(traps.path().join("git")).status().unwrap();
    assert!(run.success() && traps.path().join("run").exists());
}
