//! Errors of arguments that cannot be understood, with what to type instead.

use std::error::Error as _;
use std::process::ExitCode;

use clap::Error;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use cosmorama_spec::{Size, SpecError, SpecKind, WordError, WordKind, nearest};

use super::{no_projection, spec_key, unknown_option, unknown_verb};
use crate::args::{self, examples};
use crate::console::{say, say_failure};

/// Words of the command line, without the program's own name.
pub(super) struct Typed(Vec<String>);

impl Typed {
    pub(super) fn new(words: impl IntoIterator<Item = String>) -> Self {
        Self(words.into_iter().collect())
    }

    /// Returns the verb, if the first word is one.
    pub(super) fn verb(&self) -> Option<&str> {
        self.0.first().map(String::as_str).filter(|word| args::verbs().any(|verb| verb == *word))
    }

    /// Returns the second word if it is a verb of the first, as `diffuse` is of `light`.
    pub(super) fn part(&self) -> Option<&str> {
        let parts = args::parts(self.verb()?);
        self.0.get(1).map(String::as_str).filter(|word| parts.iter().any(|part| part == word))
    }

    /// Finds a word that is a verb's option, but with one dash: `-to`.
    pub(super) fn option_with_one_dash(&self, verb: Option<&str>) -> Option<String> {
        let options = args::options(verb?);
        let names = self.0.iter().filter_map(|word| word.strip_prefix('-').filter(|rest| !rest.starts_with('-')));
        let mut names = names.map(|name| name.split('=').next().unwrap_or_default().replace('_', "-"));
        names.find(|name| options.contains(name))
    }

    /// Finds a word that is not text: its bytes are not UTF-8.
    fn no_text(&self) -> Option<&str> {
        self.0.iter().map(String::as_str).find(|word| word.contains(char::REPLACEMENT_CHARACTER))
    }

    /// Returns the argument of an encoder that stands right before a word, which belongs to it.
    pub(super) fn video_args_before(&self, word: &str) -> Option<&str> {
        self.0.windows(3).find(|words| words[0] == "--video-args" && words[2] == word).map(|words| &*words[1])
    }

    /// Returns the value of an option, given as `--name value` or `--name=value`.
    pub(super) fn value(&self, option: &str) -> Option<&str> {
        self.0.iter().enumerate().find_map(|(at, word)| match word.strip_prefix(option)? {
            "" => self.0.get(at + 1).map(String::as_str).filter(|next| is_value(next)),
            rest => rest.strip_prefix('='),
        })
    }
}

/// Returns whether a word can be an option's value: a negative number is no option.
fn is_value(word: &str) -> bool {
    !word.starts_with('-') || word[1..].starts_with(|first: char| first.is_ascii_digit() || first == '.')
}

/// Prints what is wrong with arguments, or the requested help, and chooses the exit code.
pub(crate) fn report_arguments(error: &Error) -> ExitCode {
    if error.use_stderr() && error.kind() != ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        let words = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
        let typed = Typed::new(words);
        // What was typed may hold what looks like a line for an engine.
        let message = message(error, &typed).replace("\nopenjd_", "\n  openjd_");
        say(format_args!("error: {}", message.trim_end()));
        if typed.value("--progress") == Some("openjd") {
            say_failure(message.trim_end());
        }
    } else {
        // If this fails, nobody reads messages either.
        let _ = error.print();
    }
    u8::try_from(error.exit_code()).map_or(ExitCode::FAILURE, ExitCode::from)
}

/// Returns what is wrong, and what to type instead.
fn message(error: &Error, typed: &Typed) -> String {
    let argument = text(error, ContextKind::InvalidArg);
    match error.kind() {
        ErrorKind::UnknownArgument => unknown_option::message(argument.unwrap_or_default(), typed),
        ErrorKind::InvalidSubcommand => {
            let word = text(error, ContextKind::InvalidSubcommand).unwrap_or_default();
            match typed.verb() {
                Some(verb) => unknown_verb::message_of_part(word, verb),
                None => unknown_verb::message(word),
            }
        }
        ErrorKind::ValueValidation => value(error, typed).unwrap_or_else(|| in_claps_words(error, typed)),
        ErrorKind::InvalidValue => choice(error).unwrap_or_else(|| in_claps_words(error, typed)),
        ErrorKind::InvalidUtf8 => format!(
            "'{}' is no text in UTF-8, as this value must be; where it names a file, rename it, or make a link to it with a plain \
             name\n\n{}",
            typed.no_text().unwrap_or_default(),
            see_options(typed.verb())
        ),
        _ => in_claps_words(error, typed),
    }
}

fn text(error: &Error, kind: ContextKind) -> Option<&str> {
    match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text),
        _ => None,
    }
}

/// Returns the message for a value that cannot be parsed.
fn value(error: &Error, words: &Typed) -> Option<String> {
    let (option, typed) = (text(error, ContextKind::InvalidArg)?, text(error, ContextKind::InvalidValue)?);
    let cause = error.source()?;
    let what = format!("invalid value '{typed}' for '{option}'");
    if typed.is_empty() {
        return Some(format!("{what}: it is empty, as where a shell's variable is not set"));
    }
    // Where it does not change, it is a key.
    let key = Some("fov").filter(|_| option.starts_with("--fov ") && !typed.contains(".."));
    if let Some(advice) = key.and_then(|key| spec_key::advice(key, "--fov", words)) {
        return Some(format!("{what}: expected two angles, as in 60..30; {advice}"));
    }
    if let Some(error) = cause.downcast_ref::<SpecError>() {
        if let SpecError::UnknownName { name, .. } = error
            && let Some(advice) = no_projection::advice(option.split(' ').next().unwrap_or_default(), name, typed)
        {
            return Some(format!("{what}: '{name}' is no projection; {advice}"));
        }
        let size = match error {
            SpecError::NoValue { part, instead } if instead.is_empty() => part.parse::<Size>().ok(),
            _ => None,
        };
        if size.is_some() {
            let (name, size) = typed.split_once(':').unwrap_or((typed, ""));
            let option = option.split(' ').next().unwrap_or_default();
            return Some(format!("{what}: '{size}' is a size: {option} {name} --size {size}"));
        }
        if let SpecError::NoValue { part, .. } = error
            && SpecKind::of(part).is_some()
        {
            let name = typed.split(':').next().unwrap_or_default();
            return Some(format!("{what}: '{part}' is a projection of its own: --from {name} --to {part}"));
        }
        return Some(format!("{what}: {}\n\n{}", error.summary(), keys(typed)));
    }
    if let Some(WordError::OfOther { of, name, .. }) = cause.downcast_ref() {
        let right = match of {
            WordKind::Filter => "--filter",
            WordKind::Kernel => "--kernel",
            WordKind::Transfer => "--transfer",
            WordKind::Primaries => "--primaries",
            WordKind::Depth => "--depth",
        };
        return Some(format!("{what}: that is a {of}: {right} {name}"));
    }
    Some(format!("{what}: {cause}"))
}

/// Words that people try as values of an option with a fixed set of values: the option, the words, and the value that
/// is meant.
const OTHER_VALUES: [(&str, &[&str], &str); 7] = [
    ("--region", &["circle", "disk", "dome", "fulldome", "fisheye", "round", "lens"], "disc"),
    ("--region", &["full", "whole", "everything", "none", "square"], "all"),
    ("--progress", &["off", "quiet", "no", "false", "silent"], "none"),
    ("--progress", &["text", "line", "lines", "log"], "plain"),
    ("--labels", &["majority", "mode", "most", "area"], "vote"),
    ("--labels", &["nn", "point", "centre", "center"], "nearest"),
    ("<SHELL>", &["sh", "dash", "ksh"], "bash"),
];

/// Returns the message for a value that is not in an option's fixed set.
fn choice(error: &Error) -> Option<String> {
    let (option, typed) = (text(error, ContextKind::InvalidArg)?, text(error, ContextKind::InvalidValue)?);
    let Some(ContextValue::Strings(known)) = error.get(ContextKind::ValidValue) else { return None };
    // Clap reports an option without a value by this error, too.
    if typed.is_empty() {
        return None;
    }
    let is_of = |of: &str| option.split(' ').next() == Some(of);
    let lower = typed.to_lowercase();
    let other = OTHER_VALUES.iter().find(|(of, words, _)| is_of(of) && words.contains(&lower.as_str()));
    let names: Vec<&str> = known.iter().map(String::as_str).collect();
    let meant = other.map(|(_, _, value)| *value).or_else(|| nearest(&lower, &names));
    let question = meant.map_or_else(|| "; there".to_owned(), |meant| format!("; did you mean '{meant}'? There"));
    Some(format!("invalid value '{typed}' for '{option}'{question} are {}", names.join(", ")))
}

/// Returns the keys of the projection that was typed.
fn keys(spec: &str) -> String {
    let all = "'cosmorama help spec' lists every projection with its keys";
    SpecKind::of(spec).map_or_else(|| all.to_owned(), |kind| format!("{}{all}", kind.help()))
}

/// Returns clap's message, with an example in place of its advice to read all help.
fn in_claps_words(error: &Error, typed: &Typed) -> String {
    let text = error.render().to_string();
    let text = text.trim_start_matches("error: ");
    let text = text.split("\n\nFor more information").next().unwrap_or(text).trim_end();
    let needs_example = matches!(error.kind(), ErrorKind::MissingRequiredArgument);
    let verb = typed.verb();
    let names: Vec<&str> = verb.into_iter().chain(typed.part()).collect();
    let (of_part, verb_and_part) = (format!(" {} ", names.join(" ")), names.join(" "));
    let mut of_verb = examples(verb).iter().filter(|example| verb.is_none() || example.contains(&of_part));
    let example = of_verb.next().filter(|_| needs_example);
    let verb = verb.map(|_| &*verb_and_part);
    let text = match error.kind() {
        ErrorKind::ArgumentConflict => text.replacen("\n\n", "; leave one of them out\n\n", 1),
        _ => text.to_owned(),
    };
    let example = example.map_or_else(String::new, |example| format!("Example: {example}\n"));
    if needs_example && typed.0.iter().any(String::is_empty) {
        let empty = "an argument is empty, as where a shell's variable is not set";
        return format!("{empty}\n\n{example}{}", see_options(verb));
    }
    format!("{text}\n\n{example}{}", see_options(verb))
}

/// Returns the command that lists the options.
pub(super) fn see_options(verb: Option<&str>) -> String {
    match verb {
        Some(verb) => format!("'cosmorama {verb} -h' lists the options"),
        None => "'cosmorama -h' lists the verbs".to_owned(),
    }
}
