//! Words of the command line: projections, sizes, frames, filters and colours. What is parsed is printed to the same value.
#![no_main]

use std::fmt::{Debug, Display};
use std::str::FromStr;

use cosmorama_fuzz::prepare;
use cosmorama_spec::{
    Colour, FilterName, FrameMap, FrameRanges, FrameRate, KernelName, MemorySize, Missing, Size, Spec, SpecKind,
    TimeRanges, TransferName, parse_degrees, parse_ramp,
};
use libfuzzer_sys::fuzz_target;

fuzz_target!(init: prepare(seeds), |bytes: &[u8]| {
    let Ok(text) = str::from_utf8(bytes) else { return };
    let _ = text.parse::<Spec>().map(|spec| spec.to_string());
    let _ = (text.parse::<TimeRanges>().is_ok(), text.parse::<FrameMap>().is_ok(), text.parse::<FrameRate>().is_ok());
    let _ = (text.parse::<Missing>().is_ok(), parse_degrees(text).is_some(), parse_ramp(text).is_some());
    is_printed::<Size>(text);
    is_printed::<FrameRanges>(text);
    is_printed::<KernelName>(text);
    is_printed::<FilterName>(text);
    is_printed::<Colour>(text);
    is_printed::<MemorySize>(text);
    is_printed::<TransferName>(text);
});

/// Checks that a value is printed as it is parsed, and that an error says something.
fn is_printed<T: FromStr<Err: Display> + Display + PartialEq + Debug>(text: &str) {
    match text.parse::<T>() {
        Ok(value) => {
            let printed = value.to_string();
            assert_eq!(printed.parse::<T>().ok(), Some(value), "{text:?} → {printed:?}");
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// Each projection alone, and with each of its keys.
fn seeds() -> Vec<(String, Vec<u8>)> {
    let of_kind = |kind: SpecKind| {
        let keys = kind.own_keys().iter().chain(kind.common_keys());
        let with_keys = keys.map(|key| format!("{}:{}=1", kind.name(), key.name));
        std::iter::once(kind.name().to_owned()).chain(with_keys).collect::<Vec<_>>()
    };
    let texts = SpecKind::all().flat_map(of_kind);
    texts.enumerate().map(|(number, text)| (number.to_string(), text.into_bytes())).collect()
}
