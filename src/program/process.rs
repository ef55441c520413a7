//! A program's process and its three pipes.

use std::io::{self, Write as _};
use std::process::{ChildStdin, ExitStatus, Stdio};
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread;
use std::time::{Duration, Instant};

use super::command_words::CommandWords;
use super::diagnostics::{self, Diagnostics};
use super::error::{Fault, Partial};
use super::group::Group;
use super::output;
use crate::Image;

/// How long a process has to leave once its input has ended.
const EXIT_GRACE: Duration = Duration::from_secs(1);

/// How long to wait for bytes before it is looked whether the process has ended, and how long its
/// last bytes and lines may take from there.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// The most bytes that are shown of an answer.
const SHOWN: usize = 40;

pub(super) struct Process {
    group: Group,
    /// Lines for its standard input; `None` once that has ended.
    requests: Option<Sender<String>>,
    output: Receiver<Vec<u8>>,
    /// Ends with its standard error.
    diagnostics: Receiver<()>,
    answer: Answer,
}

/// The answer to the last request, as far as it has come.
#[derive(Default)]
struct Answer {
    expected: usize,
    received: usize,
    /// How it begins.
    head: Vec<u8>,
}

/// Why no more bytes come.
enum Stop {
    /// The pipe has ended, or the process has.
    End,
    Late,
    Cancelled,
}

impl Process {
    pub(super) fn start(words: &CommandWords, to: &Diagnostics) -> io::Result<Process> {
        let mut command = words.command();
        command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut group = Group::start(&mut command)?;
        let first = group.first();
        let pipes = (first.stdin.take(), first.stdout.take(), first.stderr.take());
        let (Some(input), Some(output), Some(errors)) = pipes else {
            return Err(io::ErrorKind::BrokenPipe.into());
        };
        Ok(Process {
            requests: Some(write(input)?),
            output: output::read(output)?,
            diagnostics: diagnostics::pass(errors, words.name(), to)?,
            group,
            answer: Answer::default(),
        })
    }

    /// That it has written what nobody asked for: before the first request, which is for a picture
    /// of `expected` bytes, or after the last one.
    pub(super) fn unasked(&self, expected: usize) -> Option<Fault> {
        let chunk = self.output.try_recv().ok()?;
        let expected = match self.answer.expected {
            0 => expected,
            last => last,
        };
        Some(self.surplus(chunk, expected))
    }

    /// Sends a request, and writes the answer into all of `image`, unless it `is_cancelled`
    /// meanwhile.
    pub(super) fn answer(
        &mut self,
        request: String,
        timeout: Duration,
        is_cancelled: &AtomicBool,
        image: &mut Image,
    ) -> Result<(), Fault> {
        let samples = image.samples_mut();
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(samples);
        self.answer = Answer {
            expected: bytes.len(),
            ..Answer::default()
        };
        if let Some(requests) = &self.requests {
            // A process that does not read is found to have ended, or to be late.
            let _ = requests.send(request);
        }
        let deadline = Instant::now().checked_add(timeout);
        let mut rest = bytes;
        while !rest.is_empty() {
            let chunk = match self.next(deadline, is_cancelled) {
                Ok(chunk) => chunk,
                Err(Stop::Cancelled) => return Err(Fault::Cancelled),
                Err(Stop::Late) => {
                    let answer = self.answer.partial();
                    return Err(Fault::Late { timeout, answer });
                }
                Err(Stop::End) => return Err(self.ended()),
            };
            let (used, surplus) = chunk.split_at(chunk.len().min(rest.len()));
            let (filled, unfilled) = rest.split_at_mut(used.len());
            filled.copy_from_slice(used);
            rest = unfilled;
            self.answer.add(used);
            if !surplus.is_empty() {
                return Err(self.surplus(surplus.to_vec(), self.answer.expected));
            }
        }
        if cfg!(target_endian = "big") {
            for sample in samples {
                *sample = f32::from_bits(sample.to_bits().swap_bytes());
            }
        }
        Ok(())
    }

    /// The next bytes of its standard output.
    fn next(
        &mut self,
        deadline: Option<Instant>,
        is_cancelled: &AtomicBool,
    ) -> Result<Vec<u8>, Stop> {
        let mut has_ended = false;
        loop {
            let left = deadline.map_or(Duration::MAX, |deadline| {
                deadline.saturating_duration_since(Instant::now())
            });
            match self.output.recv_timeout(left.min(POLL_INTERVAL)) {
                Ok(chunk) => return Ok(chunk),
                Err(RecvTimeoutError::Disconnected) => return Err(Stop::End),
                // Another process holds the pipe, and no more need come through it.
                Err(RecvTimeoutError::Timeout) if has_ended => return Err(Stop::End),
                Err(RecvTimeoutError::Timeout) if is_cancelled.load(Relaxed) => {
                    return Err(Stop::Cancelled);
                }
                Err(RecvTimeoutError::Timeout) if left <= POLL_INTERVAL => return Err(Stop::Late),
                Err(RecvTimeoutError::Timeout) => has_ended = self.group.has_ended(),
            }
        }
    }

    /// That it ended, or closed its standard output.
    fn ended(&mut self) -> Fault {
        let has_ended = self.group.has_ended_by(Instant::now() + EXIT_GRACE);
        let status = self.end();
        let answer = self.answer.partial();
        if has_ended {
            Fault::Ended { status, answer }
        } else {
            Fault::Closed { answer }
        }
    }

    /// That it wrote `surplus` and more beside a picture of `expected` bytes.
    fn surplus(&self, surplus: Vec<u8>, expected: usize) -> Fault {
        // Of what was printed before the picture, the answer begins with all, and the surplus is as
        // many bytes of the picture.
        let head = &self.answer.head;
        let printed = &head[..head.len().min(surplus.len())];
        let text = first_line(head)
            .or_else(|| first_line(&surplus))
            .or_else(|| text(&surplus))
            .or_else(|| text(printed));
        Fault::Surplus {
            expected: expected as u64,
            bytes: match text {
                Some(text) => text.into(),
                None => surplus.into_iter().take(SHOWN).collect(),
            },
        }
    }

    /// Ends it with its group, and waits for the last lines of its standard error; how it ended.
    fn end(&mut self) -> ExitStatus {
        let status = self.group.end();
        // A process that has left the group may still hold the pipe.
        let _ = self.diagnostics.recv_timeout(POLL_INTERVAL);
        status
    }

    /// Lets it leave, and ends what has not left; that it wrote more than was asked for.
    pub(super) fn leave(mut self) -> Option<Fault> {
        self.requests = None;
        let deadline = Instant::now() + EXIT_GRACE;
        let surplus = self.next(Some(deadline), &AtomicBool::new(false)).ok();
        let fault = surplus.map(|bytes| self.surplus(bytes, self.answer.expected));
        if fault.is_none() {
            self.group.has_ended_by(deadline);
        }
        self.end();
        fault
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.end();
    }
}

impl Answer {
    fn add(&mut self, bytes: &[u8]) {
        self.received += bytes.len();
        let room = SHOWN.saturating_sub(self.head.len());
        self.head.extend(bytes.iter().take(room));
    }

    fn partial(&self) -> Partial {
        Partial {
            received: self.received as u64,
            expected: self.expected as u64,
            text: first_line(&self.head).or_else(|| {
                // All of it is shown then.
                text(&self.head).filter(|_| self.received == self.head.len())
            }),
        }
    }
}

/// The text up to the first line break, if that is what the bytes begin with.
fn first_line(bytes: &[u8]) -> Option<String> {
    let end = bytes.iter().take(SHOWN).position(|byte| *byte == b'\n')?;
    text(&bytes[..=end])
}

/// The first bytes as a text, if they are one.
fn text(bytes: &[u8]) -> Option<String> {
    let bytes = &bytes[..bytes.len().min(SHOWN)];
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        // A character is cut in two at the end.
        Err(error) if error.error_len().is_none() => {
            std::str::from_utf8(&bytes[..error.valid_up_to()]).ok()?
        }
        Err(_) => return None,
    };
    let is_text = |character: char| !character.is_control() || "\n\r\t".contains(character);
    (!text.is_empty() && text.chars().all(is_text)).then(|| text.to_owned())
}

/// Writes each line that is sent to `pipe`, on a thread of its own: a process that reads nothing
/// lets it wait. The pipe ends when the sender is dropped.
fn write(mut pipe: ChildStdin) -> io::Result<Sender<String>> {
    let (send, lines) = mpsc::channel::<String>();
    let write = move || {
        for line in lines {
            if pipe.write_all(line.as_bytes()).is_err() {
                return;
            }
        }
    };
    thread::Builder::new()
        .name("program input".to_owned())
        .stack_size(1 << 16)
        .spawn(write)?;
    Ok(send)
}
