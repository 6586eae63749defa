use anyhow::Result;

/// Watches for interrupts: files in the making are removed, then the program ends with 130 or 143. A file that grows
/// beyond the limit (`ulimit -f`) does not end it: writing fails, which is told and leaves nothing behind.
#[cfg(unix)]
pub(super) fn install() -> Result<()> {
    use anyhow::Context;
    use signal_hook::consts::{SIGINT, SIGTERM, SIGXFSZ};

    let limit_reached = std::sync::Arc::default();
    signal_hook::flag::register(SIGXFSZ, limit_reached).context("cannot watch for the limit of file sizes")?;
    let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM]).context("cannot watch for interrupts")?;
    let watch = move || {
        if let Some(signal) = signals.forever().next() {
            cosmorama_io::pending::remove_all();
            std::process::exit(128 + signal);
        }
    };
    let thread = std::thread::Builder::new().name("interrupts".to_owned());
    thread.spawn(watch).context("cannot watch for interrupts")?;
    Ok(())
}

/// Elsewhere the system ends the program; what it was writing stays as a `.cosmorama-*.part` file.
#[cfg(not(unix))]
pub(super) fn install() -> Result<()> {
    Ok(())
}
