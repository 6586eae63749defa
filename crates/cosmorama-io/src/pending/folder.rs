use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use tempfile::{Builder, TempDir};

use super::{Listed, SUFFIX, Unfinished, place};
use crate::IoError;

/// A folder of files in progress. Dropped without [`PendingFolder::finish`], it leaves nothing behind.
pub struct PendingFolder {
    target: PathBuf,
    /// Folder that gets the files, inside the temporary one, so that it has the usual permissions.
    path: PathBuf,
    // Fields are dropped in order: the folder is deleted before it is removed from the list.
    _folder: TempDir,
    listed: Listed,
}

impl PendingFolder {
    /// Creates an empty folder whose files are to become those of `target`. It is beside that, so that renaming is immediate.
    ///
    /// # Errors
    /// When the folder that holds `target` is missing or not writable.
    pub fn create(target: &Path, unfinished: &Unfinished) -> io::Result<Self> {
        let target = if target.is_dir() { target.canonicalize()? } else { target.to_owned() };
        let beside = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        unfinished.sweep(beside);
        let (folder, listed) = unfinished.list(|| {
            let folder = Builder::new().prefix(&unfinished.owner().prefix()).suffix(SUFFIX).tempdir_in(beside)?;
            Ok((folder.path().to_owned(), folder))
        })?;
        let path = folder.path().join("files");
        fs::create_dir(&path)?;
        Ok(Self { target, path, _folder: folder, listed })
    }

    /// Returns the path of the folder that gets the files.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the folder its name. If there is one of that name, the files move into it: those of their names are replaced, others stay.
    ///
    /// # Errors
    /// When a file cannot be renamed.
    pub fn finish(self) -> Result<(), IoError> {
        // Nothing is removed meanwhile.
        let _whole = self.listed.list.listing();
        let failed = |error| IoError::write(&self.target, error);
        if !self.target.exists() {
            return fs::rename(&self.path, &self.target).map_err(failed);
        }
        let files: Vec<PathBuf> = fs::read_dir(&self.path)
            .and_then(|entries| entries.map(|entry| Ok(entry?.path())).collect())
            .map_err(failed)?;
        // All that can be known to fail does so before the first is moved.
        let places: Vec<PathBuf> = files
            .iter()
            .map(|file| place(&self.target.join(file.file_name().unwrap_or_default())))
            .collect::<Result<_, _>>()?;
        files
            .iter()
            .zip(places)
            .try_for_each(|(file, place)| fs::rename(file, &place).map_err(|error| IoError::write(&place, error)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_appears_whole_or_not_at_all() {
        let place = tempfile::tempdir().unwrap();
        let target = place.path().join("light");
        let begin = || {
            let pending = PendingFolder::create(&target, &Unfinished::default()).unwrap();
            fs::write(pending.path().join("a"), "new").unwrap();
            fs::write(pending.path().join("b"), "new").unwrap();
            pending
        };
        drop(begin());
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 0);
        begin().finish().unwrap();
        assert_eq!(fs::read_to_string(target.join("a")).unwrap(), "new");
        // What else is there stays; nothing is moved if not all can be.
        fs::write(target.join("a"), "old").unwrap();
        fs::write(target.join("c"), "old").unwrap();
        fs::remove_file(target.join("b")).unwrap();
        fs::create_dir(target.join("b")).unwrap();
        assert!(begin().finish().is_err());
        assert_eq!(fs::read_to_string(target.join("a")).unwrap(), "old");
        fs::remove_dir(target.join("b")).unwrap();
        begin().finish().unwrap();
        let text = |name: &str| fs::read_to_string(target.join(name)).unwrap();
        assert_eq!(["a", "b", "c"].map(text), ["new", "new", "old"]);
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    }
}
