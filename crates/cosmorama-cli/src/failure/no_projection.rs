//! Values of `--from` and `--to` that are not projections.

use std::path::Path;

use cosmorama_io::Format;
use cosmorama_spec::{FilterName, KernelName, Size};

/// Extensions of files that hold calibrations.
const CALIBRATIONS: [&str; 5] = [".yml", ".yaml", ".json", ".xml", ".txt"];

/// Returns what to type for a value that is not a projection, but something else that the program knows.
pub(super) fn advice(option: &str, name: &str, typed: &str) -> Option<String> {
    let is_input = option.starts_with("--from");
    let is_path = Format::of_name(Path::new(name)).is_some() || name.contains(['/', '{', '#']);
    Some(if is_input && ["auto", "unknown", "any", "detect", "none", "default"].contains(&name) {
        format!("leave {option} out: then the projection is found")
    } else if ["same", "input", "keep", "source"].contains(&name) {
        "name the input's projection, which 'cosmorama info INPUT' tells".to_owned()
    } else if name == "v360" {
        "that is ffmpeg's filter, whose names of projections are understood: v360=e:flat is --from e --to flat"
            .to_owned()
    } else if name == "builtin" {
        format!("that is an input: cosmorama convert {typed} OUTPUT --to SPEC --size N")
    } else if typed.parse::<FilterName>().is_ok() {
        format!("that is a filter: --filter {typed}")
    } else if typed.parse::<KernelName>().is_ok() {
        format!("that is a kernel: --kernel {typed}")
    } else if name.contains('x') && name.parse::<Size>().is_ok() {
        format!("that is a size: --size {name}")
    } else if Format::of_extension(name).is_some() {
        format!("that is a format, which the output's extension chooses: name the output .{name}")
    } else if CALIBRATIONS.iter().any(|extension| typed.ends_with(extension)) {
        let file = typed.rsplit(':').next().unwrap_or(typed);
        format!(
            "a calibration is a key: {option} fisheye:calibration={file} or {option} perspective:calibration={file}"
        )
    } else if is_path && is_input {
        format!("that is a file, which goes without an option: cosmorama convert {typed} OUTPUT --to SPEC")
    } else if is_path {
        format!("that is a file, which goes without an option: cosmorama convert INPUT {typed} --to SPEC")
    } else {
        return None;
    })
}
