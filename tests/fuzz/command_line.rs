//! Bytes as the words of a command line, one a line → what it asks for, or why not.

use std::fs;
use std::path::Path;

use firsthit::{Image, scene};

/// What `act` is called with: the words of a command line without the program's name, to be carried
/// out in a folder.
pub(crate) type Act<'a> = &'a dyn Fn(&[&str], &Path);

/// Calls `act`, which panics on a finding, with words that do no harm: they write only into the
/// folder, open no window, start no program and take no time. Others are followed by `--help`, with
/// which nothing is done but they are read all the same.
pub(crate) fn run(bytes: &[u8], act: Act<'_>) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let mut words: Vec<_> = text.trim_end_matches('\n').split(['\n', '\0']).collect();
    if !is_harmless(&words) {
        words.push("--help");
    }
    let folder = tempfile::tempdir().unwrap();
    let path = |name| folder.path().join(name);
    fs::write(path("scene.toml"), scene::BUILTIN_TOML).unwrap();
    let picture = Image::new(4).unwrap();
    picture.save(path("picture.png")).unwrap();
    picture.save(path("picture.exr")).unwrap();
    act(&words, folder.path());
}

/// Whether these words may be carried out.
fn is_harmless(words: &[&str]) -> bool {
    let has = |start: &str| words.iter().any(|word| word.starts_with(start));
    let is_quick = match words.first() {
        Some(&"capture") => has("--size") && has("--through"),
        Some(&"explain" | &"compare" | &"scene") => true,
        _ => false,
    };
    is_quick
        && !has("--program")
        && !has("--show")
        && words.iter().all(|word| {
            let is_short = |number: &str| number.len() < 3;
            !word.contains(['/', '\\', ':'])
                && !word.contains("egl")
                && !word.contains("osmesa")
                && word
                    .split(|c: char| !c.is_ascii_digit() && c != '_')
                    .all(is_short)
        })
}
