//! What a program writes to its standard error.

use std::io::{self, BufRead as _, BufReader, Read as _};
use std::process::ChildStderr;
use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

/// What is called with each line.
pub(super) type Diagnostics = Arc<Mutex<dyn FnMut(&str) + Send>>;

/// The most bytes of a line: what comes without line breaks takes no more memory than that.
const LINE: u64 = 1 << 12;

/// Hands on each line of `pipe`, after `name` and a colon, on a thread of its own. The sender is
/// dropped when the pipe ends.
pub(super) fn pass(
    pipe: ChildStderr,
    name: &str,
    diagnostics: &Diagnostics,
) -> io::Result<Receiver<()>> {
    let (ends, end) = mpsc::channel();
    let (name, diagnostics) = (name.to_owned(), diagnostics.clone());
    let pass = move || {
        let _ends = ends;
        let mut pipe = BufReader::new(pipe);
        let mut line = Vec::new();
        while let Ok(1..) = pipe.by_ref().take(LINE).read_until(b'\n', &mut line) {
            let text = String::from_utf8_lossy(line.trim_ascii_end());
            let mut diagnostics = diagnostics.lock().unwrap_or_else(PoisonError::into_inner);
            diagnostics(&format!("{name}: {text}"));
            line.clear();
        }
    };
    let thread = thread::Builder::new().name("program diagnostics".to_owned());
    thread.spawn(pass)?;
    Ok(end)
}
