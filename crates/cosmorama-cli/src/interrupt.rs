use anyhow::Result;
use cosmorama_io::pending::Unfinished;

/// Watches for interrupts: files in the making are removed, then the program ends with 130, 143 or, on Linux, when its terminal
/// goes away, 129. What was ignored when it began, as `nohup` has it, stays so. A file that grows beyond the limit (`ulimit -f`)
/// does not end it: writing fails, which is told and leaves nothing behind.
#[cfg(unix)]
pub(crate) fn install(unfinished: Unfinished) -> Result<()> {
    use anyhow::Context;
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};

    let limit_reached = std::sync::Arc::default();
    signal_hook::flag::register(SIGXFSZ, limit_reached).context("cannot watch for the limit of file sizes")?;
    let ignored = ignored();
    let watched = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    let mut signals = signal_hook::iterator::Signals::new(watched).context("cannot watch for interrupts")?;
    let watch = move || {
        if let Some(signal) = signals.forever().next() {
            unfinished.remove_all();
            std::process::exit(128 + signal);
        }
    };
    let thread = std::thread::Builder::new().name("interrupts".to_owned());
    thread.spawn(watch).context("cannot watch for interrupts")?;
    Ok(())
}

/// The signals that this program was told to ignore, a bit for each from 1 on. Only Linux says it without `unsafe`; elsewhere
/// the terminal's going away counts as ignored, as `nohup` has it.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let bits = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    bits.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok()).unwrap_or(1 << (signal_hook::consts::SIGHUP - 1))
}

/// Elsewhere the system ends the program; what it was writing stays as a `.cosmorama-*.part` file.
#[cfg(not(unix))]
pub(crate) fn install(_: Unfinished) -> Result<()> {
    Ok(())
}
