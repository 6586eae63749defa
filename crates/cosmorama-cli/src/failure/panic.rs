use std::panic::PanicHookInfo;

use crate::allocator::{OUT_OF_MEMORY, is_refused};
use crate::console::say;

/// Reports panics, which are faults of ours, on one line from now on, except those of decoders, which become errors about their files.
/// With RUST_BACKTRACE set, Rust's own report stays. Where memory was refused, that is told instead.
pub(crate) fn report_panics() {
    let usual = std::env::var_os("RUST_BACKTRACE").is_some_and(|value| value != "0").then(std::panic::take_hook);
    std::panic::set_hook(Box::new(move |info| match (&usual, is_refused()) {
        (None, _) if cosmorama_io::is_contained() => {}
        (_, true) => say(OUT_OF_MEMORY.to_owned()),
        (Some(usual), false) => usual(info),
        (None, false) => say(line(info)),
    }));
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
