use std::path::PathBuf;

/// Returns a path in the folder `shared`, which developers and CI have beside the checkout.
///
/// If it is absent, the caller's test says so and passes; in CI (`CI` is set) that is a failure.
///
/// # Panics
/// In CI, when the folder is absent.
#[allow(clippy::print_stderr)]
pub fn shared(path: &str) -> Option<PathBuf> {
    let found = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared").join(path);
    if found.exists() {
        return Some(found);
    }
    assert!(std::env::var_os("CI").is_none(), "{} is absent: CI must have it", found.display());
    eprintln!("NOT CHECKED: {} is absent", found.display());
    None
}
