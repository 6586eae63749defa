use anyhow::Result;
use cosmorama_io::pending::Unfinished;

/// Installs the handler of interrupts, which removes unfinished files and ends the program with 130 or 143. On Linux
/// the program also ends with 129 when its terminal goes away. Signals that were ignored at the start, as under
/// `nohup`, stay so. A file that exceeds the limit (`ulimit -f`) does not end the program: writing fails, which is
/// reported and leaves nothing behind.
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

/// Returns the signals that this program was told to ignore, a bit for each from 1 on. Only Linux reports them without
/// `unsafe`. Elsewhere the terminal's going away counts as ignored, as under `nohup`.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let bits = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    bits.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok()).unwrap_or(1 << (signal_hook::consts::SIGHUP - 1))
}

/// Does nothing: the system ends the program, and what it was writing stays as a `.cosmorama-*.part` file.
#[cfg(not(unix))]
pub(crate) fn install(_: Unfinished) -> Result<()> {
    Ok(())
}
