//! Texts that are typed wrongly, or by no one: each value is parsed or refused, and what was parsed is printed to the same value.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop where it stands")]

use std::fmt::{Debug, Display};
use std::str::FromStr;
use std::time::{Duration, Instant};

use cosmorama_spec::{Colour, FilterName, FrameRanges, KernelName, MemorySize, Size, Spec, SpecKind, TransferName};
use testkit::Mutants;

/// Longest time that a text of some hundred letters may take.
const LONGEST: Duration = Duration::from_secs(2);

/// Parses damaged copies of a text, prints what they are, and parses that again.
fn attack<T: FromStr<Err: Display> + Display + PartialEq + Debug>(good: &str, words: &[&str], usual: usize) {
    assert!(good.parse::<T>().is_ok(), "{good}");
    for damaged in Mutants::new(good.as_bytes(), words, 1986).take(Mutants::count(usual)) {
        let Ok(text) = str::from_utf8(&damaged) else { continue };
        let start = Instant::now();
        match text.parse::<T>() {
            Ok(value) => {
                let printed = value.to_string();
                assert_eq!(
                    printed.parse::<T>().map_err(|error| error.to_string()),
                    Ok(value),
                    "{text:?} → {printed:?}"
                );
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
        assert!(start.elapsed() < LONGEST, "{:?} for {text:?}", start.elapsed());
    }
}

#[test]
fn hostile_specs_with_any_of_their_keys() {
    for kind in SpecKind::all() {
        let name = kind.name();
        let keys: Vec<String> =
            kind.own_keys().iter().chain(kind.common_keys()).map(|key| format!("{}=", key.name)).collect();
        let words: Vec<&str> = keys.iter().map(String::as_str).chain([":", ",", "1:2", "90", "64x48+3+4"]).collect();
        let with_yaw = format!("{name}:yaw=10,pitch=5,roll=-3");
        let good = [with_yaw.as_str(), name].into_iter().find(|text| text.parse::<Spec>().is_ok());
        // Some need a file or a lens; the copies of a bare name bring them.
        for damaged in Mutants::new(good.unwrap_or(name).as_bytes(), &words, 7).take(Mutants::count(400)) {
            let Ok(text) = str::from_utf8(&damaged) else { continue };
            let start = Instant::now();
            match text.parse::<Spec>() {
                Ok(spec) => drop(spec.to_string()),
                Err(error) => assert!(!error.to_string().is_empty()),
            }
            assert!(start.elapsed() < LONGEST, "{:?} for {text:?}", start.elapsed());
        }
    }
}

#[test]
fn hostile_values_of_other_kinds() {
    attack::<Size>("1966x1436", &["x", "0"], 2000);
    attack::<FrameRanges>("1-3,5,7-20:2", &["-", ",", ":", "x2", "99999999999"], 2000);
    attack::<KernelName>("gaussian:alpha=2,cutoff=1", &["mitchell", "lanczos3", "scale=", "floor="], 2000);
    attack::<FilterName>("mipmap:levels=nearest", &["ewa", "paper", "trilinear"], 1000);
    attack::<Colour>("#20406080", &["#", "black", "transparent"], 1000);
    attack::<MemorySize>("2.5G", &["M", "K", "%"], 1000);
    attack::<TransferName>("gamma:2.2", &["srgb", "pq", "gamma:"], 1000);
}
