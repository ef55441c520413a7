//! The command that starts a program.

use std::env;
use std::io;
use std::path::{self, Path, PathBuf};
use std::process::Command;

use super::error::ProgramError;

/// How many characters of a command make a name.
const NAME: usize = 40;

/// A command in words, at least one.
pub(super) struct CommandWords {
    program: String,
    arguments: Vec<String>,
    name: String,
}

impl CommandWords {
    /// Splits `command` as a shell does.
    pub(super) fn split(command: &str) -> Result<CommandWords, ProgramError> {
        let words = shlex::split(command);
        let mut words = words
            .ok_or_else(|| ProgramError::CommandWords(command.to_owned()))?
            .into_iter();
        let program = words.next().ok_or(ProgramError::Empty)?;
        let arguments: Vec<String> = words.collect();
        let name = name(&program, &arguments);
        Ok(CommandWords {
            program,
            arguments,
            name,
        })
    }

    /// The words without the folders of files, cut short.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// What starts the program.
    pub(super) fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.args(&self.arguments);
        command
    }

    /// The files among the words.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        let program = Path::new(&self.program);
        let is_looked_up = program.components().count() == 1 && !self.program.contains('/');
        let folders = env::var_os("PATH").filter(|_| is_looked_up);
        let program = match folders {
            Some(folders) => env::split_paths(&folders)
                .map(|folder| folder.join(program))
                .find(|path| path.is_file()),
            None => Some(program.to_owned()),
        };
        program
            .into_iter()
            .chain(self.arguments.iter().map(PathBuf::from))
            .filter(|path| path.is_file())
            .filter_map(|path| path::absolute(path).ok())
            .collect()
    }

    /// That no scene can be written for the program.
    pub(super) fn folder_error(&self, reason: io::Error) -> ProgramError {
        ProgramError::Folder {
            program: self.name.clone(),
            folder: env::temp_dir(),
            reason,
        }
    }
}

fn name(program: &str, arguments: &[String]) -> String {
    let words = arguments.iter().map(|argument| {
        let is_file = Path::new(argument).is_file();
        if is_file {
            file_name(argument)
        } else {
            argument
        }
    });
    let words: Vec<&str> = [file_name(program)].into_iter().chain(words).collect();
    let name = words.join(" ");
    let mut shown = String::new();
    for character in name.chars() {
        if character.is_control() {
            shown.extend(character.escape_default());
        } else {
            shown.push(character);
        }
    }
    if shown.chars().count() > NAME {
        shown = shown.chars().take(NAME - 1).chain(['…']).collect();
    }
    shown
}

/// The last part of a path.
fn file_name(path: &str) -> &str {
    let name = Path::new(path).file_name();
    name.and_then(|name| name.to_str()).unwrap_or(path)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_short_and_on_one_line() {
        for (command, name) in [
            ("./homework", "homework"),
            ("/usr/bin/python3 tracer.py", "python3 tracer.py"),
            ("cat /etc/passwd /no/such", "cat passwd /no/such"),
            ("'/my programs/a b' -x", "a b -x"),
            ("a '\n'", "a \\n"),
            ("/", "/"),
            (
                "./homework --with 'a very long list' --of arguments",
                "homework --with a very long list --of a…",
            ),
        ] {
            assert_eq!(CommandWords::split(command).unwrap().name(), name);
        }
    }

    #[test]
    fn files_are_those_that_the_command_names() {
        let folder = tempfile::tempdir().unwrap();
        let script = folder.path().join("a script.py");
        std::fs::write(&script, "").unwrap();
        let shown = script.display();
        let words = CommandWords::split(&format!("'{shown}' --size '{shown}' nothing")).unwrap();
        assert_eq!(words.files(), [&script, &script].map(PathBuf::clone));
        #[cfg(unix)]
        {
            let files = CommandWords::split(&format!("sh '{shown}'"))
                .unwrap()
                .files();
            assert!(files[0].is_absolute() && files[0].ends_with("sh"));
            assert_eq!(files[1..], [script]);
        }
    }
}
