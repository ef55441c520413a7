//! A Wayland compositor without a screen, for one test, with a keyboard and a pointer.

use std::fs;
use std::os::unix::fs::{MetadataExt as _, chown};
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

use firsthit::Stage;
use tempfile::TempDir;

use super::pixels::{Pixels, letterboxed, traced, wait_to_show};
use super::program::{Program, wait_for};

pub const WIDTH: usize = 800;
pub const HEIGHT: usize = 700;

const CONFIG: &str =
    "xwayland disable\noutput * resolution 800x700\ndefault_border none\nseat * hide_cursor 100\n";

/// sway must not be root.
const NOBODY: u32 = 65534;

/// A running sway. It ends when dropped.
pub struct Sway {
    process: Child,
    /// Holds a keyboard, or each key that is typed would come with one that nobody knows yet.
    keyboard: Option<Child>,
    /// Its sockets lie here.
    folder: TempDir,
}

impl Sway {
    pub fn start() -> Sway {
        let folder = tempfile::tempdir().unwrap();
        let config = folder.path().join("config");
        fs::write(&config, CONFIG).unwrap();
        let mut command = Command::new("sway");
        command
            .arg("--config")
            .arg(&config)
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .env("XDG_RUNTIME_DIR", folder.path())
            .env("HOME", folder.path())
            .env("WLR_BACKENDS", "headless")
            .env("WLR_RENDERER", "pixman")
            .env("WLR_LIBINPUT_NO_DEVICES", "1")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        if fs::metadata("/proc/self").unwrap().uid() == 0 {
            chown(folder.path(), Some(NOBODY), Some(NOBODY)).unwrap();
            command.uid(NOBODY).gid(NOBODY);
        }
        let process = command
            .spawn()
            .expect("sway: install the Debian package sway");
        let mut sway = Sway {
            process,
            keyboard: None,
            folder,
        };
        wait_for("sway", || {
            (sway.socket("wayland-").is_some() && sway.socket("sway-ipc.").is_some()).then_some(())
        });
        let keyboard = sway.command("wtype").args(["-s", "600000", "x"]).spawn();
        sway.keyboard = Some(keyboard.expect("wtype: install the Debian package wtype"));
        wait_for("the keyboard", || {
            let inputs = sway.output("swaymsg", &["-t", "get_inputs"]);
            let inputs = String::from_utf8(inputs.stdout).unwrap();
            inputs.contains("virtual_keyboard").then_some(())
        });
        sway
    }

    /// The path of the socket whose name starts so.
    fn socket(&self, start: &str) -> Option<PathBuf> {
        let entries = fs::read_dir(self.folder.path()).unwrap();
        let mut paths = entries.map(|entry| entry.unwrap().path());
        paths.find(|path| {
            let name = path.file_name().unwrap().to_str().unwrap();
            name.starts_with(start) && !name.ends_with(".lock")
        })
    }

    /// The Wayland socket.
    pub fn display(&self) -> String {
        let path = self.socket("wayland-").unwrap();
        path.to_str().unwrap().to_owned()
    }

    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command
            .env("XDG_RUNTIME_DIR", self.folder.path())
            .env("WAYLAND_DISPLAY", self.display())
            .env("SWAYSOCK", self.socket("sway-ipc.").unwrap());
        command
    }

    fn output(&self, program: &str, arguments: &[&str]) -> Output {
        let output = self.command(program).args(arguments).output();
        output.unwrap_or_else(|error| panic!("{program}: {error}: install its Debian package"))
    }

    /// What a program on this display prints.
    #[track_caller]
    pub fn printed(&self, program: &str, arguments: &[&str]) -> Vec<u8> {
        let output = self.output(program, arguments);
        assert!(output.status.success(), "{program} {arguments:?}");
        output.stdout
    }

    /// Has sway do what a line of its configuration says.
    #[track_caller]
    pub fn order(&self, line: &str) {
        self.printed("swaymsg", &[line]);
    }

    /// Opens the viewer, alone on the whole display, and waits for its first frame.
    pub fn open(&self, arguments: &[&str]) -> Program {
        let program = self.begin(arguments);
        program.line("first frame");
        program
    }

    /// Starts the program in the folder of [`Sway::folder`], which need not say that it has a
    /// window.
    pub fn begin(&self, arguments: &[&str]) -> Program {
        let display = self.display();
        let folder = self.folder.path().to_str().unwrap();
        let environment = [
            ("WAYLAND_DISPLAY", display.as_str()),
            ("XDG_RUNTIME_DIR", folder),
        ];
        Program::start(self.folder.path(), arguments, &environment)
    }

    /// Where its programs start.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// What the display shows.
    pub fn pixels(&self) -> Pixels {
        portable_pixmap(&self.printed("grim", &["-t", "ppm", "-"]))
    }

    /// Types `keys`.
    #[track_caller]
    pub fn type_keys(&self, keys: &str) {
        self.printed("wtype", &[keys]);
    }

    /// What is on the clipboard; `None` where nothing is.
    pub fn pasted(&self) -> Option<String> {
        let output = self.output("wl-paste", &["--no-newline"]);
        let text = output.status.success().then_some(output.stdout)?;
        Some(String::from_utf8(text).unwrap())
    }

    /// Waits until the display shows nothing but the picture of N = 500, `stage` and α = 0 as it
    /// was traced, byte for byte.
    #[track_caller]
    pub fn shows(&self, stage: Stage) {
        let picture = traced(500, stage, 0.0);
        wait_to_show(
            || Some(self.pixels()),
            |_, _| letterboxed(&picture, WIDTH, HEIGHT),
        );
    }

    /// Ends it at once, as a crash would.
    pub fn crash(&mut self) {
        self.process.kill().unwrap();
    }
}

impl Drop for Sway {
    fn drop(&mut self) {
        for process in self.keyboard.iter_mut().chain([&mut self.process]) {
            let _ = process.kill();
            let _ = process.wait();
        }
    }
}

/// The pixels of a file in the binary PPM format with 8 bits a sample.
fn portable_pixmap(file: &[u8]) -> Pixels {
    let mut parts = file.splitn(4, |byte| byte.is_ascii_whitespace());
    let mut text = || str::from_utf8(parts.next().unwrap()).unwrap();
    assert_eq!(text(), "P6");
    let [width, height] = [(); 2].map(|()| text().parse().unwrap());
    let (depth, samples) = parts.next().unwrap().split_at(4);
    assert_eq!(depth, b"255\n");
    let bytes = samples.chunks_exact(3).map(|p| [p[0], p[1], p[2]]);
    Pixels {
        width,
        height,
        bytes: bytes.collect(),
    }
}
