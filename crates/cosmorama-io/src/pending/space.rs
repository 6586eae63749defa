use std::path::Path;

/// Returns the bytes that this user may still write to the disk of a folder, or of the nearest folder above it that exists; `None` where
/// the system does not tell.
#[cfg(unix)]
pub fn free_space(folder: &Path) -> Option<u64> {
    // The empty path is the current folder.
    let above = folder.ancestors().map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    let found = above.filter(|folder| folder.is_dir()).find_map(|folder| rustix::fs::statvfs(folder).ok())?;
    Some(found.f_bavail.saturating_mul(found.f_frsize))
}

/// Returns nothing: only Unix tells without further crates.
#[cfg(not(unix))]
pub fn free_space(_: &Path) -> Option<u64> {
    None
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_is_still_to_be_made_has_the_space_of_the_one_above() {
        let folder = tempfile::tempdir().unwrap();
        assert!(free_space(folder.path()).is_some_and(|bytes| bytes > 0));
        assert!(free_space(&folder.path().join("a/b")).is_some_and(|bytes| bytes > 0));
        assert!(free_space(Path::new("")).is_some_and(|bytes| bytes > 0));
        assert_eq!(free_space(Path::new("/proc")), Some(0), "it takes no files");
    }
}
