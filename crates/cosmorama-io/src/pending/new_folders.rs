use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::Unfinished;

/// Folders that were created for outputs.
///
/// Folders that are still empty are removed when this value is dropped, and by [`Unfinished::remove_all`]. So a failed
/// run leaves no empty folder behind.
#[derive(Debug, Default)]
pub struct NewFolders {
    /// Paths, each after that of its parent.
    made: Vec<PathBuf>,
    list: Unfinished,
}

impl NewFolders {
    /// Creates an empty list.
    pub fn new(unfinished: &Unfinished) -> Self {
        Self { made: Vec::new(), list: unfinished.clone() }
    }

    /// Creates a missing folder, with those above it; whatever exists is left unchanged.
    ///
    /// # Errors
    /// When one of them cannot be made.
    pub fn make(&mut self, folder: &Path) -> io::Result<()> {
        let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
        let missing: Vec<&Path> = folder.ancestors().take_while(is_missing).collect();
        for folder in missing.into_iter().rev() {
            let mut listing = self.list.listing();
            match fs::create_dir(folder) {
                Ok(()) => {
                    listing.folders.insert(folder.to_owned());
                    self.made.push(folder.to_owned());
                }
                // Another program has made the folder meanwhile.
                Err(_) if folder.is_dir() => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

impl Drop for NewFolders {
    fn drop(&mut self) {
        let mut listing = self.list.listing();
        for folder in self.made.iter().rev() {
            // A folder with content cannot be removed, and stays.
            let _ = fs::remove_dir(folder);
            listing.folders.remove(folder);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_that_stay_empty_go_away_again() {
        let place = tempfile::tempdir().unwrap();
        let path = |name: &str| place.path().join(name);
        fs::create_dir(path("old")).unwrap();
        let mut folders = NewFolders::new(&Unfinished::default());
        for name in ["old/a/b", "old/a/c", "new/d", "old"] {
            folders.make(&path(name)).unwrap();
            assert!(path(name).is_dir(), "{name}");
        }
        fs::write(path("old/a/c/picture"), "").unwrap();
        drop(folders);
        assert!(path("old/a/c/picture").exists() && !path("old/a/b").exists() && !path("new").exists());
    }

    #[test]
    fn folders_that_stay_empty_go_away_when_all_is_removed() {
        let place = tempfile::tempdir().unwrap();
        let unfinished = Unfinished::default();
        let mut folders = NewFolders::new(&unfinished);
        folders.make(&place.path().join("a/b")).unwrap();
        folders.make(&place.path().join("c")).unwrap();
        fs::write(place.path().join("c/picture"), "").unwrap();
        unfinished.remove_all();
        assert!(!place.path().join("a").exists() && place.path().join("c/picture").exists());
        // After `remove_all` the list stays locked until the program ends, so that dropping this would block.
        std::mem::forget(folders);
    }

    #[test]
    fn a_file_is_no_folder() {
        let place = tempfile::tempdir().unwrap();
        fs::write(place.path().join("file"), "").unwrap();
        let mut folders = NewFolders::new(&Unfinished::default());
        assert!(folders.make(&place.path().join("file/folder")).is_err());
    }
}
