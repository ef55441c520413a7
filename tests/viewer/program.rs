//! The built program as a process, and what it says.

use std::cell::RefCell;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::{DEADLINE, WATCH};

/// Calls `probe` until it gives something, for as long as [`DEADLINE`].
pub fn wait_for<T>(what: &str, mut probe: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(found) = probe() {
            return found;
        }
        assert!(start.elapsed() < DEADLINE, "waited in vain for {what}");
        pause(start);
    }
}

/// Sleeps between two looks at what has been awaited since `start`: the longer the more has been
/// waited, for many a look is one at all pixels of a window, which is work.
pub fn pause(start: Instant) {
    let [shortest, longest] = [5, 100].map(Duration::from_millis);
    thread::sleep((start.elapsed() / 4).clamp(shortest, longest));
}

/// A table of the sequences of keys that make other characters, without any: Xlib and xkbcommon
/// read the locale's, which takes a sixth of a start.
pub const COMPOSE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/viewer/Compose");

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
            .env("XCOMPOSEFILE", COMPOSE)
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

    /// All lines on standard output, once it has ended.
    pub fn all_lines(&self) -> Vec<String> {
        let mut seen = self.seen.borrow_mut();
        seen.extend(self.lines.iter());
        seen.clone()
    }

    /// What its main thread has done so far: the times that it was put to sleep or to wait, and its
    /// ticks of processor time.
    fn activity(&self) -> Vec<String> {
        let read = |file: &str| {
            let path = format!("/proc/{0}/task/{0}/{file}", self.process.id());
            std::fs::read_to_string(path).unwrap()
        };
        let (status, stat) = (read("status"), read("stat"));
        let switches = status
            .lines()
            .filter(|line| line.contains("_ctxt_switches:"));
        // After the name in brackets, utime and stime are the 12th and 13th.
        let (_, fields) = stat.rsplit_once(')').unwrap();
        let ticks = fields.split_whitespace().skip(11).take(2);
        switches.chain(ticks).map(str::to_owned).collect()
    }

    /// Waits until it does nothing at all.
    pub fn sleeps(&self) {
        wait_for("the program to sleep on", || {
            let before = self.activity();
            thread::sleep(WATCH);
            (self.activity() == before).then_some(())
        });
    }

    /// The memory that it has in use, in KiB.
    pub fn memory(&self) -> u64 {
        let status = format!("/proc/{}/status", self.process.id());
        let status = std::fs::read_to_string(status).unwrap();
        let line = status.lines().find(|line| line.starts_with("VmRSS:"));
        let kibibytes = line.unwrap().split_whitespace().nth(1);
        kibibytes.unwrap().parse().unwrap()
    }

    /// Makes sure that it has not ended.
    pub fn goes_on(&mut self) {
        if self.process.try_wait().unwrap().is_some() {
            panic!("it has ended: {:?}", self.ended());
        }
    }

    /// Waits until it has ended: its status, and all of its standard error.
    pub fn ended(&mut self) -> (ExitStatus, String) {
        let status = wait_for("the program's end", || self.process.try_wait().unwrap());
        let errors = self.errors.take().unwrap().join().unwrap();
        // On a machine with much else to do that may be said of any driver.
        let slow = "firsthit: waits for the OpenGL driver: Ctrl+C ends it\n";
        (status, errors.replace(slow, ""))
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
