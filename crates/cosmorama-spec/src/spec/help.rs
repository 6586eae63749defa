//! The table of projections as help text.

use super::projections::{COMMON, KINDS, Key};

/// Returns the help on SPECs: every projection with its keys.
pub fn help() -> String {
    let mut text = String::from("SPEC is NAME[:key=value[,key=value]...]:\n");
    for kind in KINDS {
        text += &format!("\n  {:<12} {}\n", kind.name, kind.about);
        for key in kind.keys {
            text += &key_help(key);
        }
    }
    text += "\n  Every SPEC also takes\n";
    for key in &COMMON {
        text += &key_help(key);
        let without: Vec<&str> =
            KINDS.iter().filter(|kind| kind.refusal(key.name).is_some()).map(|kind| kind.name).collect();
        if !without.is_empty() {
            text += &format!("{:39} not {}\n", "", without.join(", "));
        }
    }
    text
}

fn key_help(key: &Key) -> String {
    format!("    {:<34} {}\n", format!("{}={}", key.name, key.value), key.about)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::Spec;

    #[test]
    fn every_spec_takes_the_keys_that_help_says_it_takes() {
        let help = help();
        for (kind, key) in KINDS.iter().flat_map(|kind| COMMON.iter().map(move |key| (kind, key))) {
            // Values of their own kind; what they need beside them comes along.
            let beside = if matches!(key.name, "swap" | "eye") { "stereo=sbs," } else { "" };
            let file = if kind.name == "st-map" { "file=a.exr," } else { "" };
            let value = match key.name {
                "flip" => "x",
                "canvas" => "9x9+0+0",
                "stereo" => "sbs",
                "swap" => "yes",
                "eye" => "left",
                _ => "2",
            };
            let parsed = format!("{}:{file}{beside}{}={value}", kind.name, key.name).parse::<Spec>();
            let line = help.lines().skip_while(|line| !line.starts_with(&format!("    {}=", key.name))).nth(1);
            let is_left_out = line.is_some_and(|line| {
                line.trim_start()
                    .strip_prefix("not ")
                    .is_some_and(|names| names.split(", ").any(|name| name == kind.name))
            });
            let needs_stereo = !beside.is_empty() && kind.refusal("stereo").is_some();
            assert_eq!(parsed.is_err(), is_left_out || needs_stereo, "{} {}: {parsed:?}", kind.name, key.name);
        }
    }
}
