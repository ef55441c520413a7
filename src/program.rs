//! Another program that makes the pictures: anybody's, in any language.
//!
//! # The protocol
//!
//! The program is started once. For each picture it reads one line from its standard input, a JSON
//! object:
//!
//! ```json
//! {"scene": "/tmp/firsthit-Xy3z/scene-1.toml", "stage": 6, "alpha": 0.3, "size": 500}
//! ```
//!
//! `scene` is the absolute path of a scene file, as [`Scene::to_toml`](crate::Scene::to_toml)
//! writes it; another scene has another path. `stage` is the number of a [`Stage`], `alpha` the
//! angle in radians, the shortest decimal that reads back as the same f64, and `size` is N.
//!
//! It answers on its standard output with exactly N × N × 3 little-endian 32-bit floats: red, green
//! and blue of each pixel, rows from the bottom, as `glDrawPixels` takes them. When its standard
//! input ends, it leaves.

mod command_words;
mod diagnostics;
mod error;
mod group;
mod held;
mod output;
mod process;
mod request;
mod scene_files;

use std::io;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use crate::{Canceller, Image, Render, RenderError, Scene, Stage};
use command_words::CommandWords;
use diagnostics::Diagnostics;
use process::Process;
use request::Request;
use scene_files::SceneFiles;

pub use error::{Fault, Partial, ProgramError};
pub use held::end_all;

/// How long a program that cannot be started since a linker still has it open is waited for.
const BUSY_FILE_TIMEOUT: Duration = Duration::from_secs(1);

/// How long to sleep between two tries to start it.
const RETRY_INTERVAL: Duration = Duration::from_millis(10);

/// A program that is asked for pictures.
///
/// ```no_run
/// use std::time::Duration;
/// use firsthit::program::Program;
/// use firsthit::{Image, Scene, Stage};
///
/// let say = |line: &str| eprintln!("{line}");
/// let mut program = Program::start("./homework", Duration::from_secs(10), say)?;
/// let mut image = Image::new(500)?;
/// program.ask(&Scene::builtin(), Stage::Reflection, 0.3, &mut image)?;
/// program.finish()?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// On Unix it runs in a process group of its own, which is ended whenever the program fails, and
/// when this is dropped: no process that it has started in that group goes on running.
pub struct Program {
    words: CommandWords,
    timeout: Duration,
    diagnostics: Diagnostics,
    scenes: SceneFiles,
    /// `None` until the next picture is asked for.
    process: Option<Process>,
    /// The picture that was asked for last.
    last: Option<Request>,
    /// That picture is not wanted any more.
    is_cancelled: Arc<AtomicBool>,
}

impl Program {
    /// Starts the program that `command` names: its path or its name in `PATH`, and its arguments,
    /// split into words as a shell splits them. No shell is involved.
    ///
    /// A picture may take as long as `timeout`. `diagnostics` is called, on another thread, with
    /// each line of the program's standard error, after the program's name and a colon; a line that
    /// is longer than 4 KiB comes in pieces. Control characters in it are the caller's business.
    ///
    /// # Errors
    /// [`ProgramError::CommandWords`] where `command` has an open quote, [`ProgramError::Empty`]
    /// where it has no words, [`ProgramError::Folder`] where no scene can be written for the
    /// program, [`ProgramError::Start`] where the program cannot be started.
    pub fn start(
        command: &str,
        timeout: Duration,
        diagnostics: impl FnMut(&str) + Send + 'static,
    ) -> Result<Program, ProgramError> {
        let words = CommandWords::split(command)?;
        let scenes = SceneFiles::create().map_err(|reason| words.folder_error(reason))?;
        let mut program = Program {
            words,
            timeout,
            diagnostics: Arc::new(Mutex::new(diagnostics)),
            scenes,
            process: None,
            last: None,
            is_cancelled: Arc::default(),
        };
        program.process = Some(program.start_process()?);
        Ok(program)
    }

    fn start_process(&self) -> Result<Process, ProgramError> {
        let deadline = Instant::now() + BUSY_FILE_TIMEOUT;
        loop {
            match Process::start(&self.words, &self.diagnostics) {
                Err(reason)
                    if reason.kind() == io::ErrorKind::ExecutableFileBusy
                        && Instant::now() < deadline =>
                {
                    thread::sleep(RETRY_INTERVAL);
                }
                started => {
                    return started.map_err(|reason| ProgramError::Start {
                        program: self.words.name().to_owned(),
                        reason,
                    });
                }
            }
        }
    }

    /// The words of the command without the folders of files, as in `python3 tracer.py`: at most 40
    /// characters, none of which is a control character.
    pub fn name(&self) -> &str {
        self.words.name()
    }

    /// The files that the command names: the executable, and each argument that is the path of a
    /// file.
    pub fn files(&self) -> Vec<PathBuf> {
        self.words.files()
    }

    /// Asks for the picture of `scene` in `stage`, seen at angle `alpha` in radians, and writes all
    /// of `image` with it. A program that does not run is started.
    ///
    /// # Errors
    /// [`ProgramError::Picture`] where the program answers with no picture: its process is ended
    /// then. [`ProgramError::Angle`] where `alpha` is not finite, [`ProgramError::Folder`] where
    /// the scene cannot be written, [`ProgramError::Start`] where the program cannot be started.
    pub fn ask(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
    ) -> Result<(), ProgramError> {
        let request = Request {
            stage,
            alpha,
            size: image.size(),
        };
        if !alpha.is_finite() {
            let program = self.words.name().to_owned();
            return Err(ProgramError::Angle { program, alpha });
        }
        let path = self.scenes.path(scene);
        let path = path.map_err(|reason| self.words.folder_error(reason))?;
        let line = request.line(path);
        let mut process = match self.process.take() {
            Some(process) => process,
            None => {
                self.last = None;
                self.start_process()?
            }
        };
        if let Some(fault) = process.unasked(size_of_val(image.samples())) {
            drop(process);
            // What comes after a picture is the fault of that picture, not of the next.
            return Err(self.fault(self.last.unwrap_or(request), fault));
        }
        self.last = Some(request);
        self.is_cancelled.store(false, Relaxed);
        match process.answer(line, self.timeout, &self.is_cancelled, image) {
            Ok(()) => {
                self.process = Some(process);
                Ok(())
            }
            Err(fault) => {
                // Whoever reads of the fault finds no process of the program any more.
                drop(process);
                Err(self.fault(request, fault))
            }
        }
    }

    /// Checks that the program has not written more than the picture that was asked for last. One
    /// that has is ended.
    ///
    /// # Errors
    /// [`ProgramError::Picture`] where it has.
    pub fn recheck(&mut self) -> Result<(), ProgramError> {
        let surplus = |process: &Process| process.unasked(0);
        match (self.process.as_ref().and_then(surplus), self.last) {
            (Some(fault), Some(last)) => {
                self.process = None;
                Err(self.fault(last, fault))
            }
            _ => Ok(()),
        }
    }

    fn fault(&self, request: Request, fault: Fault) -> ProgramError {
        ProgramError::Picture {
            program: self.words.name().to_owned(),
            stage: request.stage,
            alpha: request.alpha,
            size: request.size,
            fault,
        }
    }

    /// Ends the process: tells it to leave, gives it a second to do so, and then ends what is left
    /// of its process group. The next picture is asked of a new process.
    ///
    /// # Errors
    /// [`ProgramError::Picture`] where the program has written more than the picture that was asked
    /// for last.
    pub fn finish(&mut self) -> Result<(), ProgramError> {
        let left = self.process.take().and_then(Process::leave);
        match (left, self.last) {
            (Some(fault), Some(request)) => Err(self.fault(request, fault)),
            _ => Ok(()),
        }
    }
}

impl Render for Program {
    fn name(&self) -> &str {
        self.name()
    }

    fn render(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
    ) -> Result<(), RenderError> {
        Ok(self.ask(scene, stage, alpha, image)?)
    }

    fn files(&self) -> Vec<PathBuf> {
        self.files()
    }

    fn recheck(&mut self) -> Result<(), RenderError> {
        Ok(self.recheck()?)
    }

    /// It ends the process that works at the picture.
    fn canceller(&self) -> Option<Canceller> {
        let is_cancelled = self.is_cancelled.clone();
        Some(Box::new(move || is_cancelled.store(true, Relaxed)))
    }

    /// Ends the process: the next picture is asked of a new one.
    fn reload(&mut self) {
        self.process = None;
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // Nobody asks for what an error could be about.
        let _ = self.finish();
    }
}
