//! A file that nobody finds before it is whole.
//!
//! On Linux it has no name at all until then, where the file system can do that: it vanishes with
//! the process, however that ends. Elsewhere it has one that begins with `.firsthit-`, in the same
//! folder, and is removed when it is given up, and by [`abandon_unfinished`].

use std::fs::{self, File, OpenOptions};
use std::io;
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::Builder;

use crate::parting;

/// A file on its way to its name. Dropped, it is gone.
pub(super) enum Unfinished {
    /// One without a name, in this folder.
    #[cfg(target_os = "linux")]
    Nameless(PathBuf),
    Named(Named),
}

impl Unfinished {
    /// Starts a file that can be given any name in `folder`, with the permissions that any new file
    /// gets.
    pub(super) fn create(folder: &Path) -> io::Result<(Unfinished, File)> {
        #[cfg(target_os = "linux")]
        if let Some(file) = nameless::create(folder) {
            return Ok((Unfinished::Nameless(folder.to_owned()), file));
        }
        Named::create(folder).map(|(named, file)| (Unfinished::Named(named), file))
    }

    /// Gives `file`, which was created with this, the name `target` in the same folder. What has
    /// that name already is replaced.
    pub(super) fn persist(self, file: File, target: &Path) -> io::Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Unfinished::Nameless(folder) => nameless::persist(&file, &folder, target),
            Unfinished::Named(named) => {
                // Some systems rename no file that is open.
                drop(file);
                named.persist(target)
            }
        }
    }
}

#[cfg(target_os = "linux")]
mod nameless {
    use std::fs::{self, File, OpenOptions};
    use std::io;
    use std::os::fd::AsRawFd as _;
    use std::os::unix::fs::OpenOptionsExt as _;
    use std::path::{Path, PathBuf};

    use rustix::fs::{AtFlags, CWD, OFlags, linkat};

    use super::Named;

    /// A file without a name; `None` where this file system has none, or where it could not be
    /// given one.
    pub(super) fn create(folder: &Path) -> Option<File> {
        let file = OpenOptions::new()
            .write(true)
            .custom_flags(OFlags::TMPFILE.bits().cast_signed())
            .open(folder)
            .ok()?;
        fs::symlink_metadata(handle(&file)).ok()?;
        Some(file)
    }

    /// The path by which the system lists an open file.
    fn handle(file: &File) -> PathBuf {
        PathBuf::from(format!("/proc/self/fd/{}", file.as_raw_fd()))
    }

    pub(super) fn persist(file: &File, folder: &Path, target: &Path) -> io::Result<()> {
        match link(file, target) {
            // A link replaces no file: the file gets a temporary name first, and is renamed from
            // that.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                let (named, ()) = Named::with(folder, |name| link(file, name))?;
                named.persist(target)
            }
            linked => linked,
        }
    }

    fn link(file: &File, name: &Path) -> io::Result<()> {
        Ok(linkat(
            CWD,
            handle(file),
            CWD,
            name,
            AtFlags::SYMLINK_FOLLOW,
        )?)
    }
}

/// A name in a folder. Dropped, it is gone, and the file with it.
pub(super) struct Named(PathBuf);

/// Every such name. Names are given and removed under this lock.
static NAMES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn names() -> MutexGuard<'static, Vec<PathBuf>> {
    NAMES.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Named {
    fn create(folder: &Path) -> io::Result<(Named, File)> {
        Named::with(folder, |name| {
            OpenOptions::new().write(true).create_new(true).open(name)
        })
    }

    /// A new name, and what `make` makes of it: a file, or an error of the kind `AlreadyExists`
    /// where another name is to be tried.
    fn with<T>(folder: &Path, make: impl FnMut(&Path) -> io::Result<T>) -> io::Result<(Named, T)> {
        let mut names = names();
        let (made, path) = Builder::new()
            .prefix(".firsthit-")
            .disable_cleanup(true)
            .make_in(folder, make)?
            .into_parts();
        names.push(path.to_path_buf());
        Ok((Named(path.to_path_buf()), made))
    }

    fn persist(self, target: &Path) -> io::Result<()> {
        // Unlocked before `self` is dropped.
        let mut names = names();
        fs::rename(&self.0, target).inspect(|()| names.retain(|name| *name != self.0))
    }
}

impl Drop for Named {
    fn drop(&mut self) {
        let mut names = names();
        // A file that was renamed stays.
        if names.contains(&self.0) {
            // Where it cannot be removed there is nothing more to be done about it.
            let _ = fs::remove_file(&self.0);
            names.retain(|name| *name != self.0);
        }
    }
}

/// Removes every file that this process has begun to save and not finished, and lets it begin and
/// finish no other: for a program that is about to end without coming back to who saves, as on a
/// signal. Who saves from now on waits for ever.
///
/// On Linux there is mostly nothing to remove: unfinished files have no name there, where the file
/// system can do that.
pub fn abandon_unfinished() {
    let Some(names) = parting::lock(&NAMES) else {
        return;
    };
    for name in &*names {
        let _ = fs::remove_file(name);
    }
    mem::forget(names);
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use std::io::Write as _;

    use super::*;

    fn names_in(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.collect();
        names.sort();
        names
    }

    /// An unfinished file as on this system, or one with a name as on every system.
    fn start(folder: &Path, is_named: bool) -> (Unfinished, File) {
        if is_named {
            let (named, file) = Named::create(folder).unwrap();
            let is_temporary = |name: &String| name.starts_with(".firsthit-");
            assert!(names_in(folder).iter().any(is_temporary));
            return (Unfinished::Named(named), file);
        }
        Unfinished::create(folder).unwrap()
    }

    #[test]
    fn what_is_given_up_is_gone() {
        let folder = tempfile::tempdir().unwrap();
        for is_named in [false, true] {
            drop(start(folder.path(), is_named));
            assert_eq!(names_in(folder.path()), [""; 0]);
        }
        assert!(!names().iter().any(|name| name.starts_with(folder.path())));
    }

    #[test]
    fn a_file_is_found_once_it_has_its_name_and_takes_the_place_of_another() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a");
        for old in [None, Some("old")] {
            for is_named in [false, true] {
                let _ = fs::remove_file(&target);
                if let Some(old) = old {
                    fs::write(&target, old).unwrap();
                }
                let (unfinished, mut file) = start(folder.path(), is_named);
                file.write_all(b"new").unwrap();
                assert_eq!(fs::read_to_string(&target).ok().as_deref(), old);
                unfinished.persist(file, &target).unwrap();
                assert_eq!(fs::read_to_string(&target).unwrap(), "new");
                assert_eq!(names_in(folder.path()), ["a"], "{is_named}");
            }
        }
    }

    #[test]
    fn a_file_that_cannot_get_its_name_is_gone() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a");
        for is_named in [false, true] {
            let (unfinished, file) = start(folder.path(), is_named);
            fs::create_dir(&target).unwrap();
            assert!(unfinished.persist(file, &target).is_err());
            fs::remove_dir(&target).unwrap();
            assert_eq!(names_in(folder.path()), [""; 0], "{is_named}");
        }
    }
}
