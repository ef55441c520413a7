//! Standard output.

use std::io::{self, Write as _};

use super::Failure;

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
