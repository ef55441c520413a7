//! The command line, nothing else.

mod command;
mod ending;

use std::io::{self, Write};
use std::process::ExitCode;

use command::Failure;
use ending::Memory;

#[global_allocator]
static MEMORY: Memory = Memory;

fn main() -> ExitCode {
    ending::prepare();
    match command::run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Usage(answer)) => {
            // Where nobody listens any more there is nothing to be done about it.
            let _ = answer.print();
            // Help and version come this way too.
            ExitCode::from(if answer.use_stderr() { 2 } else { 0 })
        }
        Err(failure) => {
            say(&failure.to_string());
            ExitCode::FAILURE
        }
    }
}

/// One line on standard error, whatever is in `message`: a file's name may hold line breaks.
fn say(message: &str) {
    let mut line = String::from("firsthit: ");
    for character in message.chars() {
        if character.is_control() {
            line.extend(character.escape_default());
        } else {
            line.push(character);
        }
    }
    line.push('\n');
    let _ = io::stderr().write_all(line.as_bytes());
}
