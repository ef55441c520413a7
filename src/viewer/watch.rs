//! Files that are looked at while the viewer is seen: where one is replaced, what depends on it is
//! made anew.

use std::fs::{self, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, SystemTime};

use crate::Scene;
use crate::scene::SceneFileError;

/// How often the files are looked at. One that has changed is looked at once more before it is
/// used: it may still be being written.
const PERIOD: Duration = Duration::from_millis(100);

/// What is watched, and what for.
pub(super) enum Watched {
    /// The scene is read again.
    Scene(PathBuf),
    /// The renderer of this number is to be made anew.
    Renderer(usize, PathBuf),
}

/// What has changed.
pub(super) enum Change {
    /// The scene, or why there is none.
    Scene(Box<Result<Scene, SceneFileError>>),
    /// A file of the renderer of this number.
    Renderer(usize),
}

/// The thread that looks, seen from the window's side.
pub(super) struct Watch {
    changes: Receiver<Change>,
    held: Arc<(Mutex<bool>, Condvar)>,
}

impl Watch {
    /// Starts it, where there is anything to watch; `wake` is called there after a change.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub(super) fn start(
        watched: Vec<Watched>,
        wake: impl Fn() + Send + 'static,
    ) -> io::Result<Watch> {
        let (sender, changes) = mpsc::channel();
        let held = Arc::new((Mutex::new(false), Condvar::new()));
        let mut files: Vec<_> = watched.into_iter().filter_map(File::new).collect();
        if !files.is_empty() {
            let held = held.clone();
            thread::Builder::new()
                .name("watching".to_owned())
                .spawn(move || {
                    loop {
                        thread::sleep(PERIOD);
                        wait_while_held(&held);
                        for change in files.iter_mut().filter_map(File::look) {
                            if sender.send(change).is_err() {
                                return;
                            }
                            wake();
                        }
                    }
                })?;
        }
        Ok(Watch { changes, held })
    }

    /// The next change, if there is one.
    pub(super) fn change(&self) -> Option<Change> {
        self.changes.try_recv().ok()
    }

    /// Looks at nothing while `hold` is true; what changes meanwhile is seen afterwards.
    pub(super) fn hold(&self, hold: bool) {
        let (held, changed) = &*self.held;
        *held.lock().unwrap_or_else(PoisonError::into_inner) = hold;
        changed.notify_one();
    }
}

fn wait_while_held((held, changed): &(Mutex<bool>, Condvar)) {
    let held = held.lock().unwrap_or_else(PoisonError::into_inner);
    drop(changed.wait_while(held, |held| *held));
}

/// What a replaced file differs in.
#[derive(Clone, Debug, PartialEq)]
struct Stamp {
    modified: Option<SystemTime>,
    length: u64,
    /// A file that was written under another name and then renamed is another one; a program that
    /// has just become executable has another mode.
    #[cfg(unix)]
    identity: (u64, u64, u32),
}

impl Stamp {
    fn new(metadata: &Metadata) -> Stamp {
        #[cfg(unix)]
        use std::os::unix::fs::MetadataExt as _;
        Stamp {
            modified: metadata.modified().ok(),
            length: metadata.len(),
            #[cfg(unix)]
            identity: (metadata.dev(), metadata.ino(), metadata.mode()),
        }
    }

    /// That of a file, or `None` where there is none.
    fn of(path: &Path) -> Option<Stamp> {
        Some(Stamp::new(&fs::metadata(path).ok()?))
    }
}

/// A file that is watched.
struct File {
    watched: Watched,
    /// The file that was used last.
    used: Option<Stamp>,
    /// The file that was there last.
    seen: Option<Stamp>,
}

impl File {
    /// `None` for a pipe or a device, which to look into would use up.
    fn new(watched: Watched) -> Option<File> {
        let (Watched::Scene(path) | Watched::Renderer(_, path)) = &watched;
        let metadata = fs::metadata(path).ok();
        if metadata.as_ref().is_some_and(|there| !there.is_file()) {
            return None;
        }
        let stamp = metadata.as_ref().map(Stamp::new);
        Some(File {
            watched,
            used: stamp.clone(),
            seen: stamp,
        })
    }

    /// Looks at the file: the change, once it stays.
    fn look(&mut self) -> Option<Change> {
        let (Watched::Scene(path) | Watched::Renderer(_, path)) = &self.watched;
        let now = Stamp::of(path);
        let stays = now == self.seen;
        self.seen.clone_from(&now);
        if !stays || now == self.used {
            return None;
        }
        self.used = now;
        match &self.watched {
            Watched::Scene(path) => Some(Change::Scene(Box::new(read(path)))),
            // A renderer without its file still makes pictures: it is running.
            Watched::Renderer(number, _) => {
                self.used.is_some().then_some(Change::Renderer(*number))
            }
        }
    }
}

/// The scene in the file that is at `path` now. A pipe or a device is refused: to wait for what it
/// holds would keep every other file from being looked at.
fn read(path: &Path) -> Result<Scene, SceneFileError> {
    match fs::metadata(path) {
        Ok(there) if !there.is_file() && !there.is_dir() => Err(SceneFileError::Read {
            path: path.to_owned(),
            reason: io::Error::other("it is a pipe or a device now"),
        }),
        _ => Scene::from_file(path),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;

    const BALL: &str =
        "[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = 0.5\ncolor = [1.0, 0.5, 0.0]\n";

    /// The scene of a change that is one of the scene.
    fn scene_of(change: Option<Change>) -> Result<Scene, SceneFileError> {
        let scene = change.and_then(|change| match change {
            Change::Scene(scene) => Some(*scene),
            Change::Renderer(_) => None,
        });
        scene.unwrap()
    }

    #[test]
    fn a_file_is_used_once_it_stays_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        fs::write(&path, BALL).unwrap();
        let mut file = File::new(Watched::Scene(path.clone())).unwrap();
        assert!(file.look().is_none() && file.look().is_none());
        // It grows while it is looked at.
        for text in [&BALL[..20], &BALL.repeat(2)] {
            fs::write(&path, text).unwrap();
            assert!(file.look().is_none());
        }
        let scene = scene_of(file.look()).unwrap();
        assert_eq!(scene.spheres().len(), 2);
        assert!(file.look().is_none());
        // As editors do that write another file first; it is refused.
        let other = folder.path().join("other");
        fs::write(&other, BALL.replace("0.5\n", "0.0\n").repeat(2)).unwrap();
        fs::rename(&other, &path).unwrap();
        assert!(file.look().is_none());
        let error = scene_of(file.look()).unwrap_err();
        assert!(
            error.to_string().contains("line 3: sphere[0].radius"),
            "{error}"
        );
        // It goes, and comes again.
        fs::remove_file(&path).unwrap();
        assert!(file.look().is_none());
        let error = scene_of(file.look()).unwrap_err();
        assert!(matches!(error, SceneFileError::Read { .. }));
        fs::write(&path, BALL).unwrap();
        assert!(file.look().is_none());
        assert!(scene_of(file.look()).is_ok());
    }

    #[test]
    fn a_program_is_made_anew_when_it_is_there_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("program");
        fs::write(&path, "1").unwrap();
        let mut file = File::new(Watched::Renderer(3, path.clone())).unwrap();
        fs::remove_file(&path).unwrap();
        assert!((0..3).all(|_| file.look().is_none()));
        fs::write(&path, "22").unwrap();
        assert!(file.look().is_none());
        assert!(matches!(file.look(), Some(Change::Renderer(3))));
        assert!(file.look().is_none());
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_not_looked_into() {
        assert!(File::new(Watched::Scene("/dev/null".into())).is_none());
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_in_the_place_of_a_scene_is_refused_and_keeps_nothing_waiting() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        fs::write(&path, BALL).unwrap();
        let mut file = File::new(Watched::Scene(path.clone())).unwrap();
        fs::remove_file(&path).unwrap();
        let made = std::process::Command::new("mkfifo").arg(&path).status();
        assert!(made.unwrap().success());
        let (send, looked) = mpsc::channel();
        thread::spawn(move || {
            let changes = [file.look(), file.look()];
            let _ = send.send((changes, file));
        });
        let looked = looked.recv_timeout(Duration::from_secs(10));
        let ([first, second], mut file) = looked.unwrap();
        assert!(first.is_none());
        let error = scene_of(second).unwrap_err();
        assert!(error.to_string().contains("it is a pipe"), "{error}");
        fs::remove_file(&path).unwrap();
        fs::write(&path, BALL).unwrap();
        assert!(file.look().is_none());
        assert!(scene_of(file.look()).is_ok());
    }

    #[test]
    fn while_it_is_held_nothing_is_looked_at() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        fs::write(&path, BALL).unwrap();
        let (woken, wakes) = mpsc::channel();
        let watch = Watch::start(vec![Watched::Scene(path.clone())], move || {
            let _ = woken.send(());
        })
        .unwrap();
        watch.hold(true);
        // What it is just looking at it may still see.
        thread::sleep(2 * PERIOD);
        fs::write(&path, BALL.repeat(2)).unwrap();
        assert!(wakes.recv_timeout(5 * PERIOD).is_err());
        watch.hold(false);
        wakes.recv_timeout(Duration::from_secs(10)).unwrap();
        assert!(scene_of(watch.change()).is_ok());
    }
}
