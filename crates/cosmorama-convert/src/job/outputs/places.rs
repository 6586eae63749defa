use std::collections::{HashMap, HashSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use cosmorama_io::pending::place;

use super::real_path;

/// Places of outputs on their disks.
///
/// A folder is listed once. A name that nothing in it has costs no look of its own, so that a sequence of many frames is planned soon.
#[derive(Default)]
pub(super) struct Places {
    /// Folders by the names that outputs give them.
    folders: HashMap<OsString, Option<Folder>>,
}

/// Place of an output.
pub(super) struct Place {
    /// File that the output becomes, behind all links.
    pub(super) file: PathBuf,
    /// Whether something may be there.
    pub(super) is_taken: bool,
}

/// Content of a folder.
struct Folder {
    /// Path of the folder, behind all links.
    path: PathBuf,
    /// Names in it, in lower case: on some disks upper case leads to the same file.
    names: HashSet<String>,
}

impl Places {
    /// Returns whether an output has been in the folder of a path.
    pub(super) fn know_folder_of(&self, path: &Path) -> bool {
        self.folders.contains_key(folder_of(path).as_os_str())
    }

    /// Returns the place of an output.
    pub(super) fn of(&mut self, path: &Path) -> Place {
        let folder = folder_of(path);
        if !self.know_folder_of(path) {
            self.folders.insert(folder.as_os_str().to_owned(), Folder::list(folder));
        }
        let listed = self.folders.get(folder.as_os_str()).and_then(Option::as_ref);
        if let Some(file) = listed.and_then(|listed| listed.free(path)) {
            return Place { file, is_taken: false };
        }
        // If the path cannot be resolved, the error comes with its frame.
        Place { file: real_path(&place(path).unwrap_or_else(|_| path.to_owned())), is_taken: true }
    }
}

impl Folder {
    /// Lists a folder; `None` if it cannot be read.
    fn list(folder: &Path) -> Option<Self> {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let path = folder.canonicalize().ok()?;
        let lower = |entry: std::io::Result<std::fs::DirEntry>| Ok(entry?.file_name().to_string_lossy().to_lowercase());
        let names =
            path.read_dir().ok()?.collect::<Vec<_>>().into_iter().map(lower).collect::<std::io::Result<_>>().ok()?;
        Some(Self { path, names })
    }

    /// Returns the file of a name that nothing in the folder has; `None` if something may have it.
    fn free(&self, path: &Path) -> Option<PathBuf> {
        // Beyond ASCII, disks may spell a name in another way, and a tilde stands in short names that Windows makes up.
        let name = path.file_name()?.to_str().filter(|name| name.is_ascii() && !name.contains('~'))?;
        let is_free = self.names.is_empty() || !self.names.contains(&name.to_ascii_lowercase());
        is_free.then(|| self.path.join(name))
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    /// Looks for the place of an output by its name alone.
    fn looked_at(path: &Path) -> PathBuf {
        real_path(&place(path).unwrap_or_else(|_| path.to_owned()))
    }

    #[test]
    fn free_places_are_found_without_a_look() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("dome_2.png"), "a picture").unwrap();
        fs::create_dir(folder.path().join("dome_3.png")).unwrap();
        fs::write(folder.path().join("DOME_4.png"), "a picture").unwrap();
        let mut places = Places::default();
        let mut taken = Vec::new();
        for name in ["dome_1.png", "dome_2.png", "dome_3.png", "dome_4.png", "kuppel_ä.png", "dome~1.png"] {
            let path = folder.path().join(name);
            let place = places.of(&path);
            assert_eq!(place.file, looked_at(&path), "{name}");
            taken.extend(place.is_taken.then_some(name));
        }
        // Which some disks may have under another spelling are among them.
        assert_eq!(taken, ["dome_2.png", "dome_3.png", "dome_4.png", "kuppel_ä.png", "dome~1.png"]);
        // A folder is listed once.
        fs::write(folder.path().join("dome_5.png"), "made meanwhile").unwrap();
        assert!(!places.of(&folder.path().join("dome_5.png")).is_taken);
    }

    #[test]
    #[cfg(unix)]
    fn links_lead_to_their_places() {
        use std::os::unix::fs::symlink;

        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("disk")).unwrap();
        fs::write(path("disk/old.png"), "a picture").unwrap();
        symlink("disk", path("show")).unwrap();
        symlink("disk/old.png", path("file.png")).unwrap();
        symlink("disk/none.png", path("new.png")).unwrap();
        symlink("none/none.png", path("lost.png")).unwrap();
        symlink("round.png", path("round.png")).unwrap();
        let mut places = Places::default();
        for name in ["file.png", "new.png", "lost.png", "round.png", "show/old.png", "show/new.png", "none/new.png"] {
            assert_eq!(places.of(&path(name)).file, looked_at(&path(name)), "{name}");
        }
        let disk = path("disk").canonicalize().unwrap();
        assert_eq!(places.of(&path("new.png")).file, disk.join("none.png"));
        assert_eq!(places.of(&path("show/new.png")).file, disk.join("new.png"));
        assert_eq!(places.of(&path("disk/new.png")).file, disk.join("new.png"));
    }

    #[test]
    fn names_alone_are_in_the_working_folder() {
        let place = Places::default().of(Path::new("no-such-picture.png"));
        assert_eq!((place.file, place.is_taken), (looked_at(Path::new("no-such-picture.png")), false));
    }
}
