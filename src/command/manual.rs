//! `firsthit completions` and `firsthit man`: the command line, made known to shells and to man.

use std::io;

use clap::{Args, CommandFactory as _};
use clap_complete::Shell;
use clap_mangen::Man;

use super::streams::print;
use super::{CommandLine, Failure, wrong};

#[derive(Args)]
pub(crate) struct CompletionsArguments {
    /// The shell that completes
    #[arg(value_name = "SHELL", value_enum)]
    shell: Shell,
}

#[derive(Args)]
pub(crate) struct ManArguments {
    /// The command that the page is about; the program if not given
    #[arg(value_name = "COMMAND")]
    command: Option<String>,
}

pub(crate) fn completions(arguments: &CompletionsArguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    let mut program = CommandLine::command();
    clap_complete::generate(arguments.shell, &mut program, "firsthit", &mut script);
    print(&String::from_utf8_lossy(&script))
}

pub(crate) fn man(arguments: &ManArguments) -> Result<(), Failure> {
    let mut program = CommandLine::command();
    // Its commands get the names that their pages have.
    program.build();
    let command = match &arguments.command {
        None => program,
        Some(name) => program.find_subcommand(name).cloned().ok_or_else(|| {
            let message = format!("{name}: there is no such command: see firsthit --help");
            wrong::<ManArguments>("firsthit man", message)
        })?,
    };
    let page = page(command).map_err(Failure::StandardOutput)?;
    print(&String::from_utf8_lossy(&page))
}

fn page(command: clap::Command) -> io::Result<Vec<u8>> {
    let mut page = Vec::new();
    Man::new(command).render(&mut page)?;
    Ok(page)
}
