use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use cosmorama_io::ImageFile;

/// Picture that was decoded to find its projection, held until its file is read: no file is decoded twice.
#[derive(Debug, Default)]
pub(crate) struct DecodedPicture {
    /// Greatest number of bytes that are held.
    most: u64,
    picture: Mutex<Option<(PathBuf, ImageFile)>>,
}

impl DecodedPicture {
    /// Creates a place for a picture of at most so many bytes.
    pub(crate) fn up_to(most: u64) -> Self {
        Self { most, picture: Mutex::default() }
    }

    /// Holds a picture, unless it is too large.
    pub(crate) fn put(&self, path: &Path, file: ImageFile) {
        if file.image.samples().bytes() <= self.most {
            *self.lock() = Some((path.to_owned(), file));
        }
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
