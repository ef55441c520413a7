//! Standard input and standard output, which the path `-` stands for.

use std::io::{self, BufWriter, IsTerminal as _, StdoutLock, Write};
use std::path::Path;

use super::Failure;

/// What standard input is called where the name of a file would stand.
pub(crate) const INPUT: &str = "standard input";

/// Whether `path` stands for a standard stream. A file of this name is `./-`.
pub(crate) fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Standard output, which remembers its first failure: an encoder may wrap an error until its kind
/// is lost.
pub(crate) struct StandardOutput {
    output: BufWriter<StdoutLock<'static>>,
    failure: Option<io::Error>,
}

impl StandardOutput {
    pub(crate) fn new() -> StandardOutput {
        StandardOutput {
            output: BufWriter::new(io::stdout().lock()),
            failure: None,
        }
    }

    /// Ends what was `written`. A closed pipe is no failure: its reader has read enough.
    pub(crate) fn finish(mut self, written: Result<(), Failure>) -> Result<(), Failure> {
        let flushed = written.and_then(|()| self.flush().map_err(Failure::StandardOutput));
        match (flushed, self.failure) {
            (_, Some(reason)) if reason.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            (Err(Failure::StandardOutput(_)), Some(reason)) => Err(Failure::StandardOutput(reason)),
            (flushed, _) => flushed,
        }
    }

    fn watch<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        result.inspect_err(|error| {
            let copy = match error.raw_os_error() {
                Some(code) => io::Error::from_raw_os_error(code),
                None => error.kind().into(),
            };
            if error.kind() != io::ErrorKind::Interrupted {
                self.failure.get_or_insert(copy);
            }
        })
    }
}

impl Write for StandardOutput {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.output.write(bytes);
        self.watch(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.output.flush();
        self.watch(flushed)
    }
}

/// Fails where a picture on standard output would be shown as text.
pub(crate) fn refuse_terminal() -> Result<(), Failure> {
    match io::stdout().is_terminal() {
        true => Err(Failure::Terminal),
        false => Ok(()),
    }
}

/// Writes text to standard output.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut output = StandardOutput::new();
    let written = output.write_all(text.as_bytes());
    output.finish(written.map_err(Failure::StandardOutput))
}
