//! A file that appears whole or not at all.
//!
//! The bytes go to an [`Unfinished`] file in the same folder, which gets its name at the end, when
//! the disk has it: whoever looks at the name finds the old file or the new one, never a part.

use std::fs::{self, File};
#[cfg(unix)]
use std::fs::{Metadata, Permissions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use super::SaveError;
use super::unfinished::Unfinished;

/// The name of a file that is still being written through its [`Output`].
pub(crate) struct WholeFile {
    path: PathBuf,
    target: PathBuf,
    unfinished: Unfinished,
    /// The file of the output.
    file: File,
    failure: Failure,
}

/// What a [`WholeFile`] holds so far, to be written on.
pub(crate) struct Output {
    file: BufWriter<File>,
    failure: Failure,
}

/// The first write that failed. An encoder may drop such an error, or wrap it until its kind is
/// lost; a file is only whole if there was none.
type Failure = Arc<OnceLock<io::Error>>;

impl WholeFile {
    /// Starts the file that is to be named `path`, with the permissions of the file that it
    /// replaces, else with those that any new file gets.
    ///
    /// A symbolic link is followed: what it points to is replaced, or made.
    pub(crate) fn create(path: &Path) -> Result<(WholeFile, Output), SaveError> {
        let target = target(path);
        let old = match fs::metadata(path) {
            Err(reason) if reason.kind() != io::ErrorKind::NotFound => {
                return Err(SaveError::write(path, reason));
            }
            old => old.ok(),
        };
        if let Some(metadata) = &old {
            // Renaming would put a file in the place of a device, and would not ask whether the old
            // file may be written.
            if !metadata.is_file() {
                return Err(SaveError::NotAFile(path.to_owned()));
            }
            if metadata.permissions().readonly() {
                return Err(SaveError::ReadOnly(path.to_owned()));
            }
        }
        let folder = folder(&target);
        let create = || {
            let (unfinished, file) = Unfinished::create(folder)?;
            #[cfg(unix)]
            if let Some(metadata) = &old {
                keep_mode(&file, metadata)?;
            }
            Ok((unfinished, file.try_clone()?, file))
        };
        let (unfinished, output, file) =
            create().map_err(|reason| SaveError::write(path, reason))?;
        let failure = Failure::default();
        let output = Output {
            file: BufWriter::new(output),
            failure: Arc::clone(&failure),
        };
        let whole = WholeFile {
            path: path.to_owned(),
            target,
            unfinished,
            file,
            failure,
        };
        Ok((whole, output))
    }

    /// The whole of a file: what `write` writes.
    pub(crate) fn write(
        path: &Path,
        write: impl FnOnce(&mut Output) -> io::Result<()>,
    ) -> Result<(), SaveError> {
        let (file, mut output) = WholeFile::create(path)?;
        let written = write(&mut output).and_then(|()| output.flush());
        // Closed before it is renamed: some systems insist.
        drop(output);
        file.finish(written)
    }

    /// Gives the file its name, if it was `written` and no write failed.
    pub(crate) fn finish(self, written: io::Result<()>) -> Result<(), SaveError> {
        written.map_err(|error| self.error(error))?;
        if let Some(failure) = self.failure.get() {
            return Err(SaveError::write(&self.path, copy(failure)));
        }
        let persist = || {
            synced(self.file.sync_all())?;
            self.unfinished.persist(self.file, &self.target)?;
            // Otherwise a power failure might undo the renaming.
            #[cfg(unix)]
            if let Ok(folder) = File::open(folder(&self.target)) {
                synced(folder.sync_all())?;
            }
            Ok(())
        };
        persist().map_err(|reason| SaveError::write(&self.path, reason))
    }

    /// Why the file cannot be written: the first write that failed, else the encoder's own `error`.
    pub(crate) fn error(&self, error: io::Error) -> SaveError {
        SaveError::write(&self.path, self.failure.get().map_or(error, copy))
    }
}

impl Output {
    fn watch<T>(&self, result: io::Result<T>) -> io::Result<T> {
        if let Err(error) = &result
            && error.kind() != io::ErrorKind::Interrupted
        {
            // Later failures follow from the first.
            let _ = self.failure.set(copy(error));
        }
        result
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes);
        self.watch(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.file.flush();
        self.watch(flushed)
    }
}

impl Seek for Output {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        let sought = self.file.seek(position);
        self.watch(sought)
    }
}

/// Gives `file` the mode of an old one, but for what makes a program run as another user.
#[cfg(unix)]
fn keep_mode(file: &File, old: &Metadata) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    let mode = |metadata: &Metadata| metadata.permissions().mode() & 0o777;
    // A file system without modes cannot set one, and all its files have the same.
    if mode(&file.metadata()?) == mode(old) {
        return Ok(());
    }
    file.set_permissions(Permissions::from_mode(mode(old)))
}

/// The most links to links that are followed, as Linux has it.
const LINKS: usize = 40;

/// What `path` points to, be it there or not; `path` itself where that is no symbolic link.
fn target(path: &Path) -> PathBuf {
    let mut target = path.to_owned();
    for _ in 0..LINKS {
        let Ok(link) = fs::read_link(&target) else {
            break;
        };
        target = folder(&target).join(link);
    }
    target
}

/// The folder of a file.
fn folder(file: &Path) -> &Path {
    // A path without a folder lies in the current one.
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// The result of a sync: a file system that cannot sync needs none.
fn synced(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error)
            if matches!(
                error.kind(),
                io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported
            ) =>
        {
            Ok(())
        }
        result => result,
    }
}

fn copy(error: &io::Error) -> io::Error {
    match error.raw_os_error() {
        Some(code) => io::Error::from_raw_os_error(code),
        None => error.kind().into(),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;

    #[test]
    fn a_write_that_failed_is_never_forgotten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let (file, mut output) = WholeFile::create(&path).unwrap();
        // Open for reading only: every write fails.
        let read_only = File::open(std::env::current_exe().unwrap()).unwrap();
        output.file = BufWriter::with_capacity(0, read_only);
        let reason = output.write(b"lost").unwrap_err();
        drop(output);
        let error = file.finish(Ok(())).unwrap_err();
        assert!(error.to_string().contains(&reason.to_string()), "{error}");
        assert!(folder.path().read_dir().unwrap().next().is_none());
    }
}
