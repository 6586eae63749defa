//! Files that are written under a temporary name first.
//!
//! [`write`](crate::write()) writes to a temporary file beside the output, and renames it when it is complete.
//! Meanwhile the file is listed in [`Unfinished`]. An interrupt handler calls [`Unfinished::remove_all`] before the
//! program ends, so that no partial file stays behind. Files and folders left by a killed program are named
//! `.cosmorama-MACHINE-PROCESS-*.part`; the next run that writes into their folder removes them.
//! Folders that are created for outputs ([`NewFolders`]) are listed, too, and removed if they stay empty. A [`PendingFolder`] appears
//! with all of its files.

mod folder;
mod new_folders;
mod space;
mod sweep;

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError, Weak};

use tempfile::{Builder, TempDir, TempPath};

pub use folder::PendingFolder;
pub use new_folders::NewFolders;
pub use space::free_space;

use self::sweep::Owner;
use crate::IoError;

const PREFIX: &str = ".cosmorama-";
const SUFFIX: &str = ".part";

/// List of temporary files in progress, and of work elsewhere that is done for them. Clones share the list.
#[derive(Clone, Debug, Default)]
pub struct Unfinished(Arc<Shared>);

/// List and owner, which clones share.
#[derive(Debug, Default)]
struct Shared {
    listing: Mutex<Listing>,
    /// Owner of the files, who is found when the first is made.
    owner: OnceLock<Owner>,
}

/// Things to remove when a program is interrupted.
#[derive(Debug, Default)]
struct Listing {
    /// Temporary files, and temporary folders with their content.
    paths: BTreeSet<PathBuf>,
    /// Folders for outputs, which are removed if they are empty.
    folders: BTreeSet<PathBuf>,
    /// Folders in which files of killed programs have been sought.
    swept: BTreeSet<PathBuf>,
    /// Work elsewhere that was begun and is still needed.
    elsewhere: Vec<Weak<dyn Elsewhere>>,
}

/// Work outside this process, such as that of a program, which an interrupt ends.
pub trait Elsewhere: std::fmt::Debug + Send + Sync {
    /// Ends the work, and waits until it has ended. It may have ended before.
    fn end(&self);
}

impl Unfinished {
    /// Deletes all temporary files on the list and empty new folders, and ends work elsewhere, for interrupt handlers. The
    /// program must end next: from now on, whoever begins, finishes or abandons a file or a work of this list blocks until it
    /// does. So nothing appears after the removal, and no writer's failure is reported in place of the interrupt.
    pub fn remove_all(&self) {
        let listing = self.listing();
        listing.elsewhere.iter().filter_map(Weak::upgrade).for_each(|work| work.end());
        for path in &listing.paths {
            // Whether a file is already gone does not matter.
            let _ = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
        }
        // In reverse order, inner folders come before the folders that hold them.
        for folder in listing.folders.iter().rev() {
            let _ = std::fs::remove_dir(folder);
        }
        std::mem::forget(listing);
    }

    /// Begins work elsewhere, which [`Unfinished::remove_all`] ends.
    ///
    /// # Errors
    /// When it cannot be begun.
    pub fn begin<T: Elsewhere + 'static>(&self, begin: impl FnOnce() -> io::Result<T>) -> io::Result<Arc<T>> {
        let mut listing = self.listing();
        let work = Arc::new(begin()?);
        listing.elsewhere.retain(|other| other.strong_count() > 0);
        let listed: Arc<dyn Elsewhere> = work.clone();
        listing.elsewhere.push(Arc::downgrade(&listed));
        Ok(work)
    }

    /// Goes on if work elsewhere is still wanted. Whoever sees some end calls this before it is told as a failure: once
    /// [`Unfinished::remove_all`] has ended all, it blocks.
    pub fn go_on(&self) {
        drop(self.listing());
    }

    fn listing(&self) -> MutexGuard<'_, Listing> {
        // A set of paths is whole after every step, even if a thread panicked.
        self.0.listing.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Removes what killed programs have left in a folder, once for each folder.
    fn sweep(&self, folder: &Path) {
        if self.listing().swept.insert(folder.to_owned()) {
            self.owner().sweep(folder);
        }
    }

    /// Returns the owner of the files.
    fn owner(&self) -> &Owner {
        self.0.owner.get_or_init(Owner::this)
    }

    /// Creates a file and puts it on the list, while `remove_all` cannot run.
    fn list<T>(&self, make: impl FnOnce() -> io::Result<(PathBuf, T)>) -> io::Result<(T, Listed)> {
        let mut listing = self.listing();
        let (path, made) = make()?;
        listing.paths.insert(path.clone());
        Ok((made, Listed { path, list: self.clone() }))
    }
}

/// A temporary folder for private files. It is deleted when dropped, and by [`Unfinished::remove_all`].
pub struct Scratch {
    // Fields are dropped in order: the folder is deleted before it is removed from the list.
    folder: TempDir,
    _listed: Listed,
}

impl Scratch {
    /// Creates an empty folder among the system's temporary files, and removes those of programs that were killed.
    ///
    /// # Errors
    /// When the folder cannot be created.
    pub fn create(unfinished: &Unfinished) -> io::Result<Self> {
        unfinished.sweep(&std::env::temp_dir());
        let (folder, _listed) = unfinished.list(|| {
            let folder = Builder::new().prefix(&unfinished.owner().prefix()).suffix(SUFFIX).tempdir()?;
            Ok((folder.path().to_owned(), folder))
        })?;
        Ok(Self { folder, _listed })
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// Creates a private file among the system's temporary files that has no name: it goes with the process, however that ends.
///
/// # Errors
/// When the file cannot be created.
pub fn nameless() -> io::Result<File> {
    tempfile::tempfile()
}

/// A file in progress. Dropped without [`Pending::finish`], it leaves nothing behind.
pub struct Pending {
    target: PathBuf,
    // Fields are dropped in order: the file is closed, then deleted, then removed from the list.
    file: BufWriter<File>,
    path: TempPath,
    listed: Listed,
}

/// An entry of the list, which lasts as long as this value.
struct Listed {
    path: PathBuf,
    list: Unfinished,
}

impl Drop for Listed {
    fn drop(&mut self) {
        self.list.listing().paths.remove(&self.path);
    }
}

impl Pending {
    /// Creates a temporary file that is to become `target`, or the file that `target` links to. It is in the same
    /// folder, so that renaming it is immediate.
    ///
    /// # Errors
    /// When the folder is missing or not writable, or something other than a file has the target's name.
    pub fn create(target: &Path, unfinished: &Unfinished) -> Result<Self, IoError> {
        let target = &place(target)?;
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        unfinished.sweep(folder);
        let prefix = unfinished.owner().prefix();
        let mut builder = Builder::new();
        builder.prefix(&prefix).suffix(SUFFIX);
        let make = || {
            // Not with the permissions of `tempfile`, whose files only their owner can read: the umask decides who can
            // read an output.
            let file = builder.make_in(folder, |path| File::create_new(path))?;
            Ok((file.path().to_owned(), file))
        };
        let (file, listed) = unfinished.list(make).map_err(|error| refused(target, folder, &error))?;
        let (file, path) = file.into_parts();
        Ok(Self { target: target.to_owned(), file: BufWriter::with_capacity(1 << 18, file), path, listed })
    }

    /// Returns the writer of the file.
    pub fn writer(&mut self) -> &mut BufWriter<File> {
        &mut self.file
    }

    /// Returns the temporary path, for a program that opens the file by its name. Nothing may be given to
    /// [`writer`](Self::writer) then.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the complete file its name; an older file is replaced.
    ///
    /// # Errors
    /// When the rest cannot be written, as on a full disk, or the file cannot be renamed.
    pub fn finish(self) -> Result<(), IoError> {
        self.close()?.appear()
    }

    /// Ends writing. The file gets its name later, so that several can appear together, and waiting for the disk can be left to another
    /// thread.
    ///
    /// # Errors
    /// When the rest cannot be written, as on a full disk.
    pub fn close(self) -> Result<Hidden, IoError> {
        // Dropped in reverse order.
        let Self { target, listed, path, file } = self;
        let file = file.into_inner().map_err(|failed| IoError::write(&target, failed.error()))?;
        keep_permissions(&target, &path).map_err(|error| IoError::write(&target, error))?;
        Ok(Hidden { target, file, path, _listed: listed })
    }
}

/// A complete file without its name. Dropped without [`Hidden::appear`], it leaves nothing behind.
#[must_use = "a file that does not appear is deleted"]
pub struct Hidden {
    target: PathBuf,
    // Fields are dropped in order: the file is closed, then deleted or renamed, then removed from the list.
    file: File,
    path: TempPath,
    _listed: Listed,
}

impl Hidden {
    /// Waits until the file is on its disk, and gives it its name; an older file is replaced.
    ///
    /// # Errors
    /// When the disk fails, or the file cannot be renamed.
    pub fn appear(self) -> Result<(), IoError> {
        Self::appear_all([self])
    }

    /// Waits until all of some files are on their disks, and then gives each its name. If one of them cannot be kept, none appears.
    ///
    /// # Errors
    /// When a disk fails, or a file cannot be renamed.
    pub fn appear_all(files: impl IntoIterator<Item = Self>) -> Result<(), IoError> {
        let files: Vec<Self> = files.into_iter().collect();
        // On the disk before it is renamed: after a power cut there is no file of that name that is not whole.
        let settle = |hidden: &Self| sync(&hidden.file).map_err(|error| IoError::write(&hidden.target, error));
        files.iter().try_for_each(settle)?;
        files.into_iter().try_for_each(|Self { target, file, path, _listed: _last }| {
            drop(file);
            path.persist(&target).map_err(|failed| IoError::write(&target, failed.error))
        })
    }
}

/// Greatest number of links that are followed to an output's place, as on Linux.
const LINKS: usize = 40;

/// Returns the place of a file: the end of its chain of links, so that the links stay. Anything other than a file there
/// is an error now, before writing, and not when the file gets its name.
///
/// # Errors
/// When a folder, a pipe or a device is there, or a link leads nowhere.
pub fn place(target: &Path) -> Result<PathBuf, IoError> {
    let mut path = target.to_owned();
    for _ in 0..=LINKS {
        let found = match path.symlink_metadata() {
            Ok(found) => found.file_type(),
            Err(error) if error.kind() == io::ErrorKind::InvalidFilename => {
                return Err(IoError::write(&path, format_args!("{error}; choose another name")));
            }
            // There is nothing at this path, or opening its folder will report the error.
            Err(_) => return Ok(path),
        };
        if found.is_file() {
            return Ok(path);
        }
        if found.is_dir() {
            return Err(IoError::write(target, "there is a folder of this name"));
        }
        if !found.is_symlink() {
            return Err(IoError::write(
                target,
                "there is a pipe or a device of this name, no file; choose another name",
            ));
        }
        let link = std::fs::read_link(&path).map_err(|error| IoError::write(target, error))?;
        path = path.parent().unwrap_or(Path::new("")).join(link);
    }
    Err(IoError::write(target, "its links lead nowhere but to each other; choose another name"))
}

/// Waits until a file is on its disk. Some file systems cannot tell.
fn sync(file: &File) -> io::Result<()> {
    match file.sync_all() {
        Err(error) if matches!(error.kind(), io::ErrorKind::Unsupported | io::ErrorKind::InvalidInput) => Ok(()),
        result => result,
    }
}

/// Copies the permissions of the file that is replaced, so that a private file stays private.
fn keep_permissions(old: &Path, new: &Path) -> io::Result<()> {
    let Ok(old) = std::fs::metadata(old) else { return Ok(()) };
    if !old.is_file() || std::fs::metadata(new)?.permissions() == old.permissions() {
        return Ok(());
    }
    std::fs::set_permissions(new, old.permissions())
}

/// Returns the error for a folder in which no file can be created, with a remedy. Some folders report that they do not
/// exist when they accept no files (`/proc`).
fn refused(target: &Path, folder: &Path, error: &io::Error) -> IoError {
    let name = folder.display();
    match std::fs::metadata(folder) {
        Ok(found) if !found.is_dir() => IoError::write(target, format_args!("{name} is no folder; choose another")),
        Ok(_) if error.kind() == io::ErrorKind::NotFound => {
            IoError::write(target, format_args!("its folder {name} takes no new files; choose another"))
        }
        Ok(_) if matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem) => {
            let what = format_args!(
                "no files can be made in its folder {name} ({error}); have that allowed, or choose another"
            );
            IoError::write(target, what)
        }
        Err(missing) if missing.kind() == io::ErrorKind::NotFound => {
            IoError::write(target, format_args!("its folder {name} does not exist; make it first"))
        }
        _ => IoError::write(target, error),
    }
}
