//! The files that a program reads its scenes from.

use std::io;
use std::path::PathBuf;

use super::held;
use crate::Scene;

/// A folder of temporary files, with that of one scene. Dropped, it is gone.
pub(super) struct SceneFiles {
    folder: PathBuf,
    /// The scene, and the path of its file.
    current: Option<(Scene, PathBuf)>,
    /// How many scenes there were.
    count: u64,
}

impl SceneFiles {
    pub(super) fn create() -> io::Result<SceneFiles> {
        Ok(SceneFiles {
            folder: held::create_folder()?,
            current: None,
            count: 0,
        })
    }

    /// The absolute path of a file that holds `scene`: another one than that of any scene before,
    /// so that a program may keep what it has read.
    pub(super) fn path(&mut self, scene: &Scene) -> io::Result<&str> {
        let is_current = |(current, _): &(Scene, PathBuf)| current == scene;
        if !self.current.as_ref().is_some_and(is_current) {
            self.count += 1;
            let path = self.folder.join(format!("scene-{}.toml", self.count));
            held::write(&path, &scene.to_toml())?;
            let old = self.current.replace((scene.clone(), path));
            if let Some((_, old)) = old {
                held::remove_file(&old);
            }
        }
        let path = self.current.as_ref().and_then(|(_, path)| path.to_str());
        path.ok_or_else(|| io::Error::other("its path is not UTF-8"))
    }
}

impl Drop for SceneFiles {
    fn drop(&mut self) {
        held::remove_folder(&self.folder);
    }
}
