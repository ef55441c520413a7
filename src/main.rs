//! The command line, nothing else.

mod command;
mod exit;

use std::env;
use std::process::ExitCode;

use command::Failure;
use exit::Allocator;
use firsthit::program;

#[global_allocator]
static ALLOCATOR: Allocator = Allocator;

fn main() -> ExitCode {
    exit::take_stack();
    exit::install_handlers();
    let done = command::run(env::args_os());
    // A thread that nobody waits for may have one.
    program::end_all();
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Usage(error)) => {
            // Where nobody listens any more there is nothing to be done about it.
            let _ = error.print();
            ExitCode::from(2)
        }
        Err(failure) => {
            command::say(&failure.to_string());
            ExitCode::FAILURE
        }
    }
}
