use std::panic::PanicHookInfo;

use crate::allocator::{TAKE_LESS, lacking};
use crate::console::say;

/// Reports panics, which are faults of ours, on one line from now on, except those of decoders, which become errors about their files.
/// With RUST_BACKTRACE set, Rust's own report stays. Where memory has run out, that is told instead.
pub(crate) fn report_panics() {
    let usual = std::env::var_os("RUST_BACKTRACE").is_some_and(|value| value != "0").then(std::panic::take_hook);
    std::panic::set_hook(Box::new(move |info| match (lacking(), &usual) {
        _ if usual.is_none() && cosmorama_io::is_contained() => {}
        (Some(bytes), _) => say(short(bytes)),
        (None, Some(usual)) => usual(info),
        (None, None) => say(line(info)),
    }));
}

/// Tells of memory that ran out in spite of estimates: others may have taken it.
fn short(bytes: usize) -> String {
    format!("error: memory ran out, of which {bytes} bytes more were wanted; {TAKE_LESS}")
}

fn line(info: &PanicHookInfo<'_>) -> String {
    let payload = info.payload();
    let owned = || payload.downcast_ref::<String>().map(String::as_str);
    let what = payload.downcast_ref::<&str>().copied().or_else(owned).unwrap_or("a panic");
    let what = what.replace(char::is_control, " ");
    let place = info.location().map(|place| format!(" at {}:{}", place.file(), place.line())).unwrap_or_default();
    format!(
        "error: a fault of cosmorama {}{place}: {what}; please report it with the command and its inputs at {}/issues. \
         RUST_BACKTRACE=1 tells more",
        env!("CARGO_PKG_VERSION"),
        env!("CARGO_PKG_REPOSITORY")
    )
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[test]
    fn memory_that_ran_out_is_told() {
        assert_eq!(short(7), format!("error: memory ran out, of which 7 bytes more were wanted; {TAKE_LESS}"));
    }

    #[test]
    fn a_panic_is_one_line_that_asks_for_a_report() {
        static SAID: Mutex<String> = Mutex::new(String::new());
        let usual = std::panic::take_hook();
        std::panic::set_hook(Box::new(|info| *SAID.lock().unwrap() = line(info)));
        let caught = std::panic::catch_unwind(|| panic!("two\nlines"));
        std::panic::set_hook(usual);
        assert!(caught.is_err());
        let said = SAID.lock().unwrap();
        assert!(said.starts_with("error: a fault of cosmorama") && !said.contains('\n'), "{said}");
        assert!(["panic.rs:", "two lines", "/issues"].iter().all(|part| said.contains(part)), "{said}");
    }
}
