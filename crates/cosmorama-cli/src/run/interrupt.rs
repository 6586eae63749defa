use anyhow::{Context, Result};
use cosmorama_io::pending;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

/// Watches for interrupts: files in the making are removed, then the program ends with 130 or 143.
pub(super) fn install() -> Result<()> {
    let mut signals = Signals::new([SIGINT, SIGTERM]).context("cannot watch for interrupts")?;
    std::thread::Builder::new()
        .name("interrupts".to_owned())
        .spawn(move || {
            if let Some(signal) = signals.forever().next() {
                pending::remove_all();
                std::process::exit(128 + signal);
            }
        })
        .context("cannot watch for interrupts")?;
    Ok(())
}
