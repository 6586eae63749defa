//! The table of projections as help text.

use cosmorama::layout::{FaceOrder, Naming};

use super::alias::{ALIASES, without_alias};
use super::projections::{COMMON, KINDS, Key, Kind};
use crate::error::key_for;

/// A projection that a SPEC can name, for help and messages.
#[derive(Clone, Copy)]
pub struct SpecKind(&'static Kind);

impl SpecKind {
    /// Returns every projection, in the order of the help.
    pub fn all() -> impl Iterator<Item = Self> {
        KINDS.iter().map(Self)
    }

    /// Finds the projection of a SPEC by its name alone; names of other programs are accepted.
    pub fn of(spec: &str) -> Option<Self> {
        Kind::named(without_alias(spec).split(':').next()?).map(Self)
    }

    /// Returns other programs' names that are understood, each with the SPEC that it stands for.
    pub fn other_names() -> impl Iterator<Item = (&'static str, &'static str)> {
        ALIASES.into_iter()
    }

    /// Returns the name that users type.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Returns a line of help.
    pub fn about(self) -> &'static str {
        self.0.about
    }

    /// Returns the keys of this projection alone.
    pub fn own_keys(self) -> &'static [Key] {
        self.0.keys
    }

    /// Returns the keys that the projection shares with others.
    pub fn common_keys(self) -> impl Iterator<Item = &'static Key> {
        COMMON.iter().filter(move |key| self.0.refusal(key.name).is_none())
    }

    /// Finds a key of the projection by our name, by another spelling or by ffmpeg's name.
    pub fn key(self, typed: &str) -> Option<&'static Key> {
        let names: Vec<&str> = self.0.all_keys().map(|key| key.name).collect();
        let name = key_for(typed, &names)?;
        self.0.all_keys().find(|key| key.name == name)
    }

    /// Returns the help on the projection's keys, a paragraph for each.
    pub fn help(self) -> String {
        let mut text = format!("{} takes\n", self.name());
        for key in self.own_keys() {
            text += &key_help(2, key);
        }
        let common: Vec<&str> = self.common_keys().map(|key| key.name).collect();
        text += &paragraph(2, &format!("and, as every SPEC, {}", common.join(", ")));
        text
    }
}

/// Returns the help on SPECs: every projection with its keys, other names, and presets of cubes.
pub fn help() -> String {
    let mut text = String::from("SPEC is NAME[:key=value[,key=value]...], as in fisheye:fov=220,fit=width\n");
    for kind in KINDS {
        text += "\n";
        text += &entry(2, 15, kind.name, kind.about);
        for key in kind.keys {
            text += &key_help(4, key);
        }
    }
    text += "\n  Every SPEC also takes\n";
    for key in &COMMON {
        text += &key_help(4, key);
        let without: Vec<&str> =
            KINDS.iter().filter(|kind| kind.refusal(key.name).is_some()).map(|kind| kind.name).collect();
        if !without.is_empty() {
            text += &entry(4, KEY_WIDTH, "", &format!("not {}", without.join(", ")));
        }
    }
    text += "\nOther names that are understood\n\n";
    for (name, meaning) in ALIASES {
        text += &entry(2, 17, name, meaning);
    }
    text + "\n" + &presets()
}

/// Returns the help on a key: the projections that take it, and what it means there. `None` if there is no such key.
pub fn help_on_key(key: &str) -> Option<String> {
    let mut text = String::new();
    for kind in KINDS {
        for own in kind.keys.iter().filter(|own| own.name == key) {
            text += &entry(2, KEY_WIDTH, &format!("{}:{}={}", kind.name, own.name, own.value), own.about);
        }
    }
    for common in COMMON.iter().filter(|common| common.name == key) {
        text += &entry(2, KEY_WIDTH, &format!("SPEC:{}={}", common.name, common.value), common.about);
    }
    let heading = format!("{key} is a key: --from and --to take it behind a projection and a colon\n\n");
    (!text.is_empty()).then(|| heading + &text)
}

/// Returns the help on namings and orders of cube faces.
pub fn presets() -> String {
    let named = |name: &str, aliases: &[&str]| [&[name], aliases].concat().join(", ");
    let mut text = String::from("cube:naming=PRESET is what files are called: front, right, back, left, up, down\n\n");
    for naming in Naming::presets() {
        text += &entry(2, 27, &named(naming.name, naming.aliases), &naming.names.join(", "));
    }
    text += "\ncube:order=PRESET is the order of faces in one image\n\n";
    for order in FaceOrder::presets() {
        let faces: Vec<&str> = order.faces.iter().map(|face| face.name()).collect();
        text += &entry(2, 38, &named(order.name, order.aliases), &faces.join(", "));
    }
    text
}

/// Greatest width of help in columns, for manual pages and narrow terminals.
const WIDTH: usize = 80;

/// Width of a key with its values, including the space behind them.
const KEY_WIDTH: usize = 24;

fn key_help(indent: usize, key: &Key) -> String {
    entry(indent, KEY_WIDTH, &format!("{}={}", key.name, key.value), key.about)
}

/// Formats a term with its description beside it, or below if the term is long.
fn entry(indent: usize, width: usize, term: &str, about: &str) -> String {
    let column = indent + width;
    let about = paragraph(column, about);
    if term.chars().count() < width {
        format!("{:indent$}{term:<width$}{}", "", about.trim_start())
    } else {
        format!("{:indent$}{term}\n{about}", "")
    }
}

/// Formats a paragraph of indented lines.
fn paragraph(indent: usize, text: &str) -> String {
    let (mut paragraph, mut line) = (String::new(), String::new());
    for word in text.split(' ') {
        if !line.is_empty() && indent + line.chars().count() + 1 + word.chars().count() > WIDTH {
            paragraph += &format!("{:indent$}{line}\n", "");
            line.clear();
        }
        if !line.is_empty() {
            line += " ";
        }
        line += word;
    }
    paragraph + &format!("{:indent$}{line}\n", "")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::Spec;

    #[test]
    fn every_spec_takes_the_keys_that_help_says_it_takes() {
        for (kind, key) in SpecKind::all().flat_map(|kind| COMMON.iter().map(move |key| (kind, key))) {
            // Keys with a value of a special kind, with other keys that they need.
            let beside = if matches!(key.name, "swap" | "eye") { "stereo=sbs," } else { "" };
            let file = if kind.name() == "st-map" { "file=a.exr," } else { "" };
            let value = match key.name {
                "flip" => "x",
                "canvas" => "9x9+0+0",
                "stereo" => "sbs",
                "swap" => "yes",
                "eye" => "left",
                _ => "2",
            };
            let parsed = format!("{}:{file}{beside}{}={value}", kind.name(), key.name).parse::<Spec>();
            let is_left_out = kind.key(key.name).is_none();
            let needs_stereo = !beside.is_empty() && kind.0.refusal("stereo").is_some();
            assert_eq!(parsed.is_err(), is_left_out || needs_stereo, "{} {}: {parsed:?}", kind.name(), key.name);
        }
    }

    #[test]
    fn help_says_who_does_not_take_a_common_key() {
        let help = help().split_whitespace().collect::<Vec<_>>().join(" ");
        for key in &COMMON {
            let without: Vec<&str> =
                SpecKind::all().filter(|kind| kind.key(key.name).is_none()).map(SpecKind::name).collect();
            let not = format!("{} not {}", key.about, without.join(", "));
            assert!(without.is_empty() || help.contains(&not), "{not}");
        }
    }

    #[test]
    fn help_has_every_name_and_fits_narrow_terminals() {
        let help = help();
        assert!(help.lines().all(|line| line.chars().count() <= WIDTH && !line.ends_with(' ')), "{help}");
        let has = |name: &str| help.split(|c: char| c.is_whitespace() || c == ',').any(|word| word == name);
        let keys = KINDS.iter().flat_map(|kind| kind.keys).chain(&COMMON);
        assert!(keys.into_iter().all(|key| has(&format!("{}={}", key.name, key.value)) || key.value.contains(',')));
        assert!(KINDS.iter().all(|kind| has(kind.name)));
        assert!(ALIASES.iter().all(|(name, _)| has(name)));
        assert!(Naming::presets().iter().all(|naming| has(naming.name)));
        assert!(FaceOrder::presets().iter().all(|order| has(order.name)));
    }

    #[test]
    fn other_names_are_no_projections_of_ours_and_are_understood() {
        for (name, meaning) in ALIASES {
            assert!(Kind::named(name).is_none() && name.parse::<Spec>().is_ok(), "{name}");
            assert_eq!(SpecKind::of(name).unwrap().name(), meaning.split(':').next().unwrap());
        }
    }

    #[test]
    fn a_projection_has_help_of_its_own() {
        let kind = SpecKind::of("flat:fov=60").unwrap();
        let help = kind.help();
        assert!(
            help.starts_with("perspective takes\n  fov=DEGREES             horizontal field of view (90)\n"),
            "{help}"
        );
        assert!(help.ends_with("and, as every SPEC, yaw, pitch, roll, flip, canvas, aspect, stereo, swap, eye\n"));
        assert_eq!(kind.key("h_fov").unwrap().name, "fov");
        assert_eq!(SpecKind::of("fisheye").unwrap().key("centre").unwrap().name, "center");
        assert!(kind.key("tilt").is_none() && SpecKind::of("fisheyes").is_none());
    }
}
