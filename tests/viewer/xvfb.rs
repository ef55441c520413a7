//! An X server without a screen, for one test.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::thread;

use super::DEADLINE;

/// A running Xvfb. It ends with SIGTERM when dropped, also by a panic, and then removes its socket
/// and its lock.
pub struct Xvfb {
    process: Child,
    /// As DISPLAY names it.
    pub display: String,
}

impl Xvfb {
    /// Starts one with a screen of 1280 × 1024 pixels and further `arguments`. `None`, and a line
    /// on standard error, where there is no Xvfb; where CI is set there must be one.
    pub fn start(arguments: &[&str]) -> Option<Xvfb> {
        let spawned = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x1024x24"])
            .args(["-nolisten", "tcp", "-noreset"])
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut process = match spawned {
            Ok(process) => process,
            Err(error) => {
                assert!(
                    std::env::var_os("CI").is_none(),
                    "Xvfb cannot be started ({error}): install the Debian package xvfb"
                );
                eprintln!("skipped: no Xvfb ({error}); the Debian package is xvfb");
                return None;
            }
        };
        let output = process.stdout.take().unwrap();
        let (sender, receiver) = mpsc::channel();
        thread::spawn(move || {
            let mut line = String::new();
            let _ = BufReader::new(output).read_line(&mut line);
            let _ = sender.send(line);
        });
        let mut xvfb = Xvfb {
            process,
            display: String::new(),
        };
        let number = receiver
            .recv_timeout(DEADLINE)
            .expect("Xvfb says on which display it is");
        let number: u32 = number.trim().parse().expect("the number of Xvfb's display");
        xvfb.display = format!(":{number}");
        Some(xvfb)
    }

    /// Ends it at once, as a crash would.
    pub fn crash(mut self) {
        self.process.kill().unwrap();
    }
}

impl Drop for Xvfb {
    fn drop(&mut self) {
        let kill = format!("kill -TERM {}", self.process.id());
        let _ = Command::new("sh").args(["-c", &kill]).status();
        let _ = self.process.wait();
    }
}
