//! Options that a verb does not have: keys of SPECs, other programs' words, typing errors.

use cosmorama_spec::{SpecKind, nearest};

use super::arguments::{Typed, see_options};
use super::spec_key::{advice, with_key};
use crate::args;

/// Verbs that take projections.
const WITH_SPECS: [&str; 2] = ["convert", "explain"];

/// Words of other programs, and what to type for them.
const OTHER_WORDS: [(&[&str], &str); 25] = [
    (
        &[
            "width",
            "height",
            "w",
            "h",
            "s",
            "res",
            "resolution",
            "dimensions",
            "resize",
            "geometry",
            "output-size",
            "out-size",
            "image-size",
        ],
        "--size WxH, as in --size 4096x2048, or the width alone, as in --size 4096",
    ),
    (
        &["output", "out", "o", "dest", "destination"],
        "the output without an option, after the input: cosmorama convert INPUT OUTPUT --to SPEC",
    ),
    (
        &["input", "in", "i", "src"],
        "the input without an option, before the output: cosmorama convert INPUT OUTPUT --to SPEC",
    ),
    (&["source", "input-projection", "in-projection", "from-projection"], "--from SPEC, as in --from equirect"),
    (
        &["target", "projection", "proj", "output-projection", "out-projection", "to-projection", "type"],
        "--to SPEC, as in --to fulldome",
    ),
    (&["force", "replace", "yes", "clobber", "y"], "-y, which replaces existing outputs"),
    (
        &["interpolation", "interp", "resample", "resampling", "sampling", "method"],
        "--filter NAME, as in --filter bilinear, or --kernel NAME, as in --kernel catmull-rom",
    ),
    (&["jobs", "j", "cores", "workers", "cpus", "t"], "--threads N, as in --threads 4"),
    (&["bits", "bit-depth", "bitdepth", "bpp", "pix-fmt"], "--depth DEPTH, as in --depth 16"),
    (
        &["gamma", "colorspace", "colourspace", "color-space", "colour-space", "color", "colour"],
        "--transfer T, as in --transfer gamma:2.2",
    ),
    (
        &["bg", "fill", "background-color", "background-colour", "bgcolor"],
        "--background COLOR, as in --background black",
    ),
    (&["frame", "start", "end", "range", "first", "last", "start-number"], "--frames LIST, as in --frames 1-10"),
    (&["quiet", "q", "silent", "loglevel"], "--progress none"),
    (&["ram", "mem", "max-memory"], "--memory SIZE, as in --memory 8G"),
    (&["pan", "heading", "azimuth", "longitude", "lon"], "--yaw D, as in --yaw 30"),
    (&["elevation", "latitude"], "--pitch D, as in --pitch 10"),
    (&["rotation", "orientation", "ypr", "rpy", "angle"], "--yaw D, --pitch D and --roll D"),
    (
        &["antialias", "aa", "supersample", "supersampling", "ss", "oversample"],
        "nothing: the default filter averages all that a pixel sees",
    ),
    (&["dry-run", "n", "preview"], "cosmorama explain INPUT --to SPEC, which tells what a conversion will do"),
    (
        &["fps", "framerate", "frame-rate", "r"],
        "nothing: pictures have no frame rate; ffmpeg is told it when it makes the video (docs/video.md)",
    ),
    (&["f", "vf", "filter-complex"], "--from SPEC and --to SPEC: ffmpeg's v360=e:flat is --from e --to flat"),
    (
        &["threshold", "tolerance", "fuzz", "epsilon"],
        "--min-psnr DB, as in --min-psnr 36, or --max-shift PX, as in --max-shift 0.01",
    ),
    (&["amplify", "multiply", "exposure"], "--gain FACTOR, as in --gain 10"),
    (&["mkdir", "parents", "p"], "nothing: folders that do not exist are made"),
    (
        &["recursive", "batch", "glob"],
        "one pattern in quotes: '####' where frame numbers stand, '{face}' where faces' names do",
    ),
];

/// Returns what to type in place of an argument that a verb does not take.
pub(super) fn message(argument: &str, typed: &Typed) -> String {
    let verb = typed.verb();
    let Some(word) = argument.strip_prefix("--").or_else(|| argument.strip_prefix('-')) else {
        return format!("unexpected argument '{argument}'; {}\n\n{}", lone_word(argument, typed), see_options(verb));
    };
    let word = word.split('=').next().unwrap_or_default().to_lowercase().replace('_', "-");
    let who = verb.map_or_else(|| "cosmorama".to_owned(), |verb| format!("cosmorama {verb}"));
    let takes_specs = verb.is_none_or(|verb| WITH_SPECS.contains(&verb));
    let is_long = argument.starts_with("--");
    let advice = advice(&word, argument, typed)
        .filter(|_| takes_specs && is_long)
        .or_else(|| other_word(&word, verb))
        .or_else(|| own_option(&word, verb))
        .or_else(|| option_of_other(&word, verb))
        .unwrap_or_default();
    let advice = if advice.is_empty() { advice } else { format!("; {advice}") };
    format!("{who} has no option {argument}{advice}\n\n{}", see_options(verb))
}

/// Returns what to write for another program's word, where the verb has that.
fn other_word(word: &str, verb: Option<&str>) -> Option<String> {
    let (_, write) = OTHER_WORDS.iter().find(|(words, _)| words.contains(&word))?;
    let option = write.split([' ', ',']).next().unwrap_or_default();
    let option = if option == "-y" { "overwrite" } else { option.trim_start_matches('-') };
    let has = |verb| match write.starts_with('-') {
        true => args::options(verb).iter().any(|name| name == option),
        false => verb == "convert",
    };
    verb.is_none_or(has).then(|| format!("write {write}"))
}

/// Returns what a word without an option may have been meant for.
fn lone_word(word: &str, typed: &Typed) -> String {
    let key = word.split_once('=').map(|(key, value)| (key.trim_start_matches(':'), value));
    if let Some((key, value)) = key.filter(|(key, _)| SpecKind::all().any(|kind| kind.key(key).is_some())) {
        return match SpecKind::all().find_map(|kind| with_key(kind, kind.key(key)?, value, typed)) {
            Some(example) => format!("keys follow the projection's name and a colon, without spaces: {example}"),
            None => format!("keys follow the projection's name and a colon, without spaces: --to NAME:{key}={value}"),
        };
    }
    if SpecKind::of(word).is_some() {
        return format!("that is a projection: --to {word}");
    }
    if word == "x" || word.parse::<f64>().is_ok() {
        return "a size is one word, without spaces, as in --size 4096x2048".to_owned();
    }
    if typed.verb() == Some("compare") {
        return "two pictures are compared".to_owned();
    }
    // The shell makes a list of files of a wildcard.
    "many files are named by one pattern, in quotes: '####' where frame numbers stand, '{face}' where faces' names do"
        .to_owned()
}

/// Returns the verb's own option that is most similar to what was typed.
fn own_option(word: &str, verb: Option<&str>) -> Option<String> {
    let names = args::options(verb?);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let begun = names.iter().copied().find(|name| word.len() > 2 && name.starts_with(word));
    begun.or_else(|| nearest(word, &names)).map(|name| format!("did you mean --{name}?"))
}

/// Returns another verb that has the option.
fn option_of_other(word: &str, verb: Option<&str>) -> Option<String> {
    let other = args::verbs()
        .filter(|other| Some(*other) != verb)
        .find(|other| args::options(other).iter().any(|name| name == word))?;
    Some(format!("cosmorama {other} has it"))
}
