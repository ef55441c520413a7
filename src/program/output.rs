//! What a program writes to its standard output.

use std::io::{self, Read as _};
use std::process::ChildStdout;
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;

/// The most bytes of a chunk: what a pipe of Linux holds.
const CHUNK: usize = 1 << 16;

/// How many chunks may wait: a program that writes more waits itself.
const WAITING: usize = 16;

/// Reads `pipe` on a thread of its own, until it ends or nobody wants to know.
pub(super) fn read(mut pipe: ChildStdout) -> io::Result<Receiver<Vec<u8>>> {
    let (send, chunks) = sync_channel(WAITING);
    let read = move || {
        let mut buffer = vec![0; CHUNK];
        loop {
            match pipe.read(&mut buffer) {
                Ok(count @ 1..) => {
                    if send.send(buffer[..count].to_vec()).is_err() {
                        return;
                    }
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Ok(0) | Err(_) => return,
            }
        }
    };
    thread::Builder::new()
        .name("program output".to_owned())
        .stack_size(1 << 16)
        .spawn(read)?;
    Ok(chunks)
}
