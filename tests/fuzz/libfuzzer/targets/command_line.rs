#![no_main]

#[path = "../../../../src"]
mod program {
    pub mod command;
    pub mod exit;
}
#[path = "../../command_line.rs"]
mod target;

use std::env;
use std::iter::once;
use std::path::Path;

use program::command::Failure;
use program::{command, exit};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| target::run(bytes, &act));

/// What the program does, in this process, so that its branches are seen.
fn act(words: &[&str], folder: &Path) {
    let before = env::current_dir().unwrap();
    env::set_current_dir(folder).unwrap();
    let words = once("firsthit").chain(words.iter().copied());
    match command::run(words.map(Into::into)) {
        Ok(()) => {}
        Err(Failure::Usage(answer)) => {
            assert!([0, 2].contains(&answer.exit_code()));
            assert!(!answer.render().to_string().is_empty());
        }
        Err(failure) => command::say(&failure.to_string()),
    }
    env::set_current_dir(before).unwrap();
}
