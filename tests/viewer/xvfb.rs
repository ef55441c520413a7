//! X servers without a screen, each for one test at a time.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, mpsc};
use std::thread;

use rustix::process::{Pid, Signal, kill_process};
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::ConnectionExt as _;

use super::DEADLINE;
use super::program::wait_for;

/// A running Xvfb. It ends when dropped, also by a panic, unless another test may have it next.
pub struct Xvfb {
    server: Option<Server>,
    /// As DISPLAY names it.
    pub display: String,
    /// What it was started with, if it is lent.
    lent: Option<&'static [&'static str]>,
}

/// Xvfbs that tests lend one another: a start takes as much processor time as some tests.
static LENDING: Mutex<Lending> = Mutex::new(Lending {
    used: 0,
    idle: Vec::new(),
});

struct Lending {
    /// How many Xvfbs tests have, also such as are not lent.
    used: usize,
    /// With what they were started with. They end when no test has an Xvfb, since the end of the
    /// test program drops nothing.
    idle: Vec<(&'static [&'static str], Server)>,
}

impl Xvfb {
    /// Starts one with a screen of 1280 × 1024 pixels and further `arguments`. `None`, and a line
    /// on standard error, where there is no Xvfb; where CI is set there must be one.
    pub fn start(arguments: &[&str]) -> Option<Xvfb> {
        Some(Xvfb::new(Server::start(arguments)?, None))
    }

    /// One without further arguments, for a test that leaves nothing on it: another test may have
    /// had it before.
    pub fn lent() -> Option<Xvfb> {
        Xvfb::lent_with(&[])
    }

    /// The same with further `arguments`.
    pub fn lent_with(arguments: &'static [&'static str]) -> Option<Xvfb> {
        let idle = {
            let idle = &mut LENDING.lock().unwrap().idle;
            let place = idle.iter().position(|(given, _)| *given == arguments);
            place.map(|place| idle.swap_remove(place).1)
        };
        let server = match idle {
            Some(server) => server,
            None => Server::start(arguments)?,
        };
        server.clear();
        Some(Xvfb::new(server, Some(arguments)))
    }

    fn new(server: Server, lent: Option<&'static [&'static str]>) -> Xvfb {
        LENDING.lock().unwrap().used += 1;
        Xvfb {
            display: server.display.clone(),
            server: Some(server),
            lent,
        }
    }

    /// Ends it at once, as a crash would.
    pub fn crash(mut self) {
        self.server.take().unwrap().process.kill().unwrap();
    }
}

impl Drop for Xvfb {
    fn drop(&mut self) {
        let mut lending = LENDING.lock().unwrap();
        lending.used -= 1;
        // A test that fails may leave keys pressed.
        if let Some(arguments) = self.lent
            && !thread::panicking()
        {
            lending
                .idle
                .extend(self.server.take().map(|server| (arguments, server)));
        }
        if lending.used == 0 {
            lending.idle.clear();
        }
    }
}

/// The process. It ends with SIGTERM when dropped, and then removes its socket and its lock.
struct Server {
    process: Child,
    display: String,
}

impl Server {
    fn start(arguments: &[&str]) -> Option<Server> {
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
        let mut server = Server {
            process,
            display: String::new(),
        };
        let number = receiver
            .recv_timeout(DEADLINE)
            .expect("Xvfb says on which display it is");
        let number: u32 = number.trim().parse().expect("the number of Xvfb's display");
        server.display = format!(":{number}");
        Some(server)
    }

    /// Waits until the last test's windows are gone, and moves the pointer to the middle of the
    /// screen, where it is at first.
    fn clear(&self) {
        let (connection, screen) = x11rb::connect(Some(&self.display)).unwrap();
        let screen = &connection.setup().roots[screen];
        wait_for("the last test's windows to be gone", || {
            let tree = connection.query_tree(screen.root).unwrap();
            tree.reply().unwrap().children.is_empty().then_some(())
        });
        let middle = [screen.width_in_pixels, screen.height_in_pixels].map(|size| size as i16 / 2);
        let (none, [x, y]) = (x11rb::NONE, middle);
        let moved = connection.warp_pointer(none, screen.root, 0, 0, 0, 0, x, y);
        moved.unwrap().check().unwrap();
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = kill_process(Pid::from_child(&self.process), Signal::TERM);
        let _ = self.process.wait();
    }
}
