use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use cosmorama_io::ImageFile;

/// Picture that was decoded to find its projection, held until its file is read: no file is decoded twice.
#[derive(Debug, Default)]
pub(crate) struct DecodedPicture {
    /// Greatest number of bytes that are held.
    most: u64,
    /// Bytes that the largest picture took while it was looked at.
    looked_at: AtomicU64,
    picture: Mutex<Option<(PathBuf, ImageFile)>>,
}

impl DecodedPicture {
    /// Creates a place for a picture of at most so many bytes.
    pub(crate) fn up_to(most: u64) -> Self {
        Self { most, ..Self::default() }
    }

    /// Holds a picture, unless it is too large. It took so many bytes while it was looked at.
    pub(crate) fn put(&self, path: &Path, file: ImageFile, looked_at: u64) {
        self.looked_at.fetch_max(looked_at, Ordering::Relaxed);
        if file.image.samples().bytes() <= self.most {
            *self.lock() = Some((path.to_owned(), file));
        }
    }

    /// Returns the bytes that the largest picture took while it was looked at; zero if none was.
    pub(crate) fn looked_at(&self) -> u64 {
        self.looked_at.load(Ordering::Relaxed)
    }

    /// Hands out the picture of a file, once.
    pub(crate) fn take(&self, path: &Path) -> Option<ImageFile> {
        let (_, file) = self.lock().take_if(|(held, _)| held == path)?;
        Some(file)
    }

    fn lock(&self) -> MutexGuard<'_, Option<(PathBuf, ImageFile)>> {
        self.picture.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
