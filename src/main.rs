//! The command line, nothing else.

mod command;
mod exit;

use std::env;
use std::process::ExitCode;

use command::Failure;
use exit::Allocator;

#[global_allocator]
static ALLOCATOR: Allocator = Allocator;

fn main() -> ExitCode {
    exit::install_handlers();
    match command::run(env::args_os()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Usage(answer)) => {
            // Where nobody listens any more there is nothing to be done about it.
            let _ = answer.print();
            // Help and version come this way too.
            ExitCode::from(if answer.use_stderr() { 2 } else { 0 })
        }
        Err(failure) => {
            command::say(&failure.to_string());
            ExitCode::FAILURE
        }
    }
}
