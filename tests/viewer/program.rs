//! The built program as a process, and what it says.

use std::cell::RefCell;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::DEADLINE;

/// Calls `probe` until it gives something, for as long as [`DEADLINE`].
pub fn wait_for<T>(what: &str, mut probe: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(found) = probe() {
            return found;
        }
        assert!(start.elapsed() < DEADLINE, "waited in vain for {what}");
        thread::sleep(Duration::from_millis(10));
    }
}

/// The program, running. It is killed when dropped.
pub struct Program {
    process: Child,
    lines: Receiver<String>,
    /// What was read of `lines`.
    seen: RefCell<Vec<String>>,
    errors: Option<JoinHandle<String>>,
}

impl Program {
    /// Starts it with `arguments` in `folder`, on no display unless `environment` names one.
    pub fn start(folder: &Path, arguments: &[&str], environment: &[(&str, &str)]) -> Program {
        let mut process = Command::new(env!("CARGO_BIN_EXE_firsthit"))
            .args(arguments)
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .envs(environment.iter().copied())
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let output = BufReader::new(process.stdout.take().unwrap());
        let (sender, lines) = mpsc::channel();
        thread::spawn(move || {
            for line in output.lines().map_while(Result::ok) {
                let _ = sender.send(line);
            }
        });
        let mut errors = process.stderr.take().unwrap();
        let errors = thread::spawn(move || {
            let mut text = String::new();
            let _ = errors.read_to_string(&mut text);
            text
        });
        Program {
            process,
            lines,
            seen: RefCell::default(),
            errors: Some(errors),
        }
    }

    /// Waits for a line on standard output that starts so, among all that came yet.
    pub fn line(&self, start: &str) -> String {
        wait_for(&format!("a line “{start}…”"), || {
            let mut seen = self.seen.borrow_mut();
            seen.extend(self.lines.try_iter());
            seen.iter().find(|line| line.starts_with(start)).cloned()
        })
    }

    /// The first lines on standard output.
    pub fn first_lines(&self, count: usize) -> Vec<String> {
        wait_for(&format!("{count} lines"), || {
            let mut seen = self.seen.borrow_mut();
            seen.extend(self.lines.try_iter());
            seen.get(..count).map(<[String]>::to_vec)
        })
    }

    /// How often its main thread has gone to sleep so far: it must, to wake up.
    pub fn sleeps(&self) -> u64 {
        let file = format!("/proc/{}/status", self.process.id());
        let status = std::fs::read_to_string(file).unwrap();
        let line = status
            .lines()
            .find_map(|line| line.strip_prefix("voluntary_ctxt_switches:"));
        line.unwrap().trim().parse().unwrap()
    }

    /// Waits until it has ended: its status, and all of its standard error.
    pub fn ended(&mut self) -> (ExitStatus, String) {
        let status = wait_for("the program's end", || self.process.try_wait().unwrap());
        (status, self.errors.take().unwrap().join().unwrap())
    }

    /// Waits until it has ended well: traces, uploads and draws in all.
    pub fn left(&mut self) -> [u64; 3] {
        let (status, errors) = self.ended();
        assert_eq!((status.code(), errors.as_str()), (Some(0), ""));
        let line = self.line("traced ");
        let numbers = line.split(|c: char| !c.is_ascii_digit());
        let numbers: Vec<u64> = numbers.filter_map(|number| number.parse().ok()).collect();
        numbers.try_into().unwrap()
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
