//! Topics of help other than verbs: lists of names, projections, and keys of SPECs.

use cosmorama_io::Format;
use cosmorama_spec::{DepthName, FilterName, KernelName, PrimariesName, SpecKind, TransferName, nearest};

use crate::args::{LISTS, SPEC_TOPIC, builtins, options, parts, verbs};

/// Words of a topic, and the page of the documentation that explains it.
const PAGES: [(&[&str], &str); 7] = [
    (&["blender"], "docs/blender-cube.md renders the faces of a cube with Blender, and makes a dome of them"),
    (
        &["video", "ffmpeg", "mp4"],
        "docs/video.md takes a video apart and puts it together, docs/v360.md has ffmpeg's v360",
    ),
    (&["v360"], "docs/v360.md has each projection of ffmpeg's v360 and its name here"),
    (&["nuke", "fusion", "oiiotool", "stmap"], "docs/st-maps.md has st maps; 'cosmorama help st-map' has their keys"),
    (&["opencv", "calibration-file", "lenses", "hugin-project"], "docs/cameras.md has measured lenses"),
    (&["colour", "color", "colours", "hdr", "icc"], "docs/colour.md tells what becomes of colours and profiles"),
    (&["tasks", "examples", "tutorial", "getting-started"], "README.md begins with tasks, and docs/tasks.md has more"),
];

/// Returns the list of names that a topic stands for, in the singular or the plural; `None` if it stands for none.
fn list(topic: &str) -> Option<String> {
    Some(match topic.trim_end_matches('s') {
        "kernel" => names("--kernel NAME[:scale=S,floor=F] weighs what a pixel averages", &KernelName::NAMES),
        "filter" => names("--filter NAME chooses what a pixel averages", FilterName::NAMES),
        "transfer" => names("--transfer T is how integer code values relate to light", &TransferName::NAMES),
        "primarie" | "primary" => names("--primaries P are the output's primaries", &PrimariesName::NAMES),
        "depth" => {
            let depths = DepthName::ALL.map(|depth| (depth.name(), depth.about()));
            names("--depth DEPTH is the output's sample type", &depths)
        }
        "format" => formats(),
        "naming" | "preset" => cosmorama_spec::presets(),
        "builtin" | "world" => builtins(),
        _ => return None,
    })
}

/// Returns the help on a topic other than a verb.
pub(super) fn text(topic: &str) -> Option<String> {
    list(topic).or_else(|| SpecKind::of(topic).map(of_projection)).or_else(|| cosmorama_spec::help_on_key(topic))
}

/// Returns the keys of one projection.
pub(super) fn of_projection(kind: SpecKind) -> String {
    format!("{} is {}.\n\n{}", kind.name(), kind.about(), kind.help())
}

/// Returns the message for a topic on which there is no help, with the topics that exist.
pub(super) fn unknown(topic: &str) -> String {
    if let Some((_, page)) = PAGES.iter().find(|(words, _)| words.contains(&topic)) {
        return format!("no help on '{topic}' here; {page}");
    }
    let option = topic.trim_start_matches('-');
    let has_option = verbs().find(|verb| options(verb).iter().any(|name| name == option));
    if let Some(verb) = has_option {
        return format!(
            "no help on '{topic}' by itself; it is an option: 'cosmorama {verb} --help' explains --{option}"
        );
    }
    let spec = format!("cube:naming={topic}");
    if spec.parse::<cosmorama_spec::Spec>().is_ok() {
        return format!(
            "no help on '{topic}' by itself; it is a way to name the files of cube faces: --from {spec} or --to {spec}; \
             'cosmorama help naming' lists all"
        );
    }
    if let Some(verb) = verbs().find(|verb| parts(verb).iter().any(|part| part == topic)) {
        return format!("no help on '{topic}' by itself; it is a verb of {verb}: 'cosmorama help {verb} {topic}'");
    }
    // As lanczos is for lanczos3.
    let begins = topic.len() > 2 && KernelName::NAMES.iter().any(|(name, _)| name.starts_with(topic));
    let is_kernel = begins || topic.parse::<KernelName>().is_ok();
    let settings = [("filter", topic.parse::<FilterName>().is_ok()), ("kernel", is_kernel)];
    if let Some((setting, _)) = settings.iter().find(|(_, is_one)| *is_one) {
        return format!("no help on '{topic}' by itself; it is a {setting}: 'cosmorama help {setting}' lists all");
    }
    let keys = SpecKind::all().flat_map(|kind| kind.own_keys().iter().map(|key| key.name));
    let topics: Vec<&str> =
        verbs().chain([SPEC_TOPIC]).chain(SpecKind::all().map(SpecKind::name)).chain(LISTS).collect();
    let known: Vec<&str> = keys.chain(topics.iter().copied()).collect();
    let meant = nearest(topic, &known);
    let question = meant.map_or_else(|| "; topics".to_owned(), |meant| format!("; did you mean '{meant}'? Topics"));
    format!("no help on '{topic}'{question} are {}, and every key of a SPEC", topics.join(", "))
}

/// Returns a list of names, a line each.
fn names(heading: &str, names: &[(&str, &str)]) -> String {
    let lines = names.iter().map(|(name, about)| format!("  {name:<15} {about}\n"));
    format!("{heading}:\n\n{}", lines.collect::<String>())
}

/// Returns the list of file formats.
fn formats() -> String {
    let mut text =
        "The extension of an output chooses its format, and inputs are known by their content:\n\n".to_owned();
    for format in Format::ALL.into_iter().filter(|format| format.is_built()) {
        let depths: Vec<&str> = format.depths().iter().map(|depth| DepthName(*depth).name()).collect();
        let extensions = format.own_extensions().join(", ");
        let name = format.to_string();
        text += &match &depths[..] {
            [] => format!("  {extensions:<12} {name}: read only\n"),
            depths => format!("  {extensions:<12} {name}: --depth {}\n", depths.join(", ")),
        };
    }
    text + "\nVideos: mp4, m4v, mov, mkv, webm, through the installed ffmpeg; streams of pictures: y4m, pam, pfm (docs/video.md).\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_list_is_a_topic_in_both_numbers() {
        for topic in LISTS {
            assert!(text(topic).is_some() && text(topic.trim_end_matches('s')).is_some(), "{topic}");
        }
    }
}
