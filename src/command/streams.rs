//! Standard input and standard output, which the path `-` stands for.

use std::io::{self, Write as _};
use std::path::Path;

use super::Failure;

/// What standard input is called where the name of a file would stand.
pub(crate) const INPUT: &str = "standard input";

/// Whether `path` stands for a standard stream. A file of this name is `./-`.
pub(crate) fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Writes text to standard output.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut output = io::stdout().lock();
    match output
        .write_all(text.as_bytes())
        .and_then(|()| output.flush())
    {
        // Who closes a pipe has read enough.
        Err(reason) if reason.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::StandardOutput(reason))
        }
        _ => Ok(()),
    }
}
