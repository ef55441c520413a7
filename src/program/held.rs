//! What must not outlive this process: programs that it has started, and their scenes.

use std::fs;
use std::io;
use std::mem;
use std::path::{self, Path, PathBuf};
use std::process::{Child, Command};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::parting;
#[cfg(unix)]
use rustix::process::{Pid, Signal, kill_process_group};

struct Held {
    /// The process groups of programs. Each has the number of its first process, which is not
    /// waited for as long as it stands here: no other process can have that number.
    #[cfg(unix)]
    groups: Vec<Pid>,
    folders: Vec<PathBuf>,
}

/// All of it. Programs are started and ended, files are written and removed under this lock.
static HELD: Mutex<Held> = Mutex::new(Held {
    #[cfg(unix)]
    groups: Vec::new(),
    folders: Vec::new(),
});

fn held() -> MutexGuard<'static, Held> {
    HELD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts a process, on Unix in a process group of its own.
pub(super) fn start(command: &mut Command) -> io::Result<Child> {
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt as _;
        let mut held = held();
        let child = command.process_group(0).spawn()?;
        held.groups.push(Pid::from_child(&child));
        Ok(child)
    }
    #[cfg(not(unix))]
    {
        let _held = held();
        command.spawn()
    }
}

/// Ends a process that [`start`] has started, on Unix with its group; one that was ended so before
/// is left alone.
pub(super) fn end(child: &mut Child) {
    #[cfg(unix)]
    {
        let mut held = held();
        let group = Pid::from_child(child);
        if held.groups.contains(&group) {
            held.groups.retain(|other| *other != group);
            // An error says that all have ended.
            let _ = kill_process_group(group, Signal::KILL);
        }
    }
    #[cfg(not(unix))]
    {
        let _held = held();
        // An error says that it has ended.
        let _ = child.kill();
    }
}

/// Makes a folder for temporary files that only this user may read, and gives its absolute path.
pub(super) fn create_folder() -> io::Result<PathBuf> {
    let mut held = held();
    let folder = tempfile::Builder::new()
        .prefix("firsthit-")
        .disable_cleanup(true)
        .tempdir()?;
    let folder = path::absolute(folder.path())?;
    held.folders.push(folder.clone());
    Ok(folder)
}

/// Writes a file in such a folder.
pub(super) fn write(path: &Path, text: &str) -> io::Result<()> {
    let _held = held();
    fs::write(path, text)
}

/// Removes a file in such a folder.
pub(super) fn remove_file(path: &Path) {
    let _held = held();
    // The folder is removed later, with every file.
    let _ = fs::remove_file(path);
}

/// Removes such a folder.
pub(super) fn remove_folder(folder: &Path) {
    let mut held = held();
    // Where it cannot be removed there is nothing more to be done about it.
    let _ = fs::remove_dir_all(folder);
    held.folders.retain(|other| other != folder);
}

/// Ends every program that this process has started for pictures, on Unix with its process group,
/// and removes their scenes: for a program that is about to end without coming back to whoever asks
/// for pictures, as on a signal. Whoever starts or ends a program from now on waits for ever.
///
/// Elsewhere than on Unix a program leaves when its standard input ends: together with this
/// process.
pub fn end_all() {
    let Some(held) = parting::lock(&HELD) else {
        return;
    };
    #[cfg(unix)]
    for group in &held.groups {
        let _ = kill_process_group(*group, Signal::KILL);
    }
    for folder in &held.folders {
        let _ = fs::remove_dir_all(folder);
    }
    mem::forget(held);
}
