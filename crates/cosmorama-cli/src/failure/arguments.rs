//! Errors of arguments that cannot be understood, with what to type instead.

use std::error::Error as _;
use std::process::ExitCode;

use clap::Error;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use cosmorama_spec::{SpecError, SpecKind, WordError, WordKind};

use super::{unknown_option, unknown_verb};
use crate::args::{self, examples};
use crate::console::say;

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
        say(format_args!("error: {}", message(error, &Typed::new(words)).trim_end()));
    } else {
        // Where nobody listens any more, there is nobody to tell so.
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
            unknown_verb::message(text(error, ContextKind::InvalidSubcommand).unwrap_or_default())
        }
        ErrorKind::ValueValidation => value(error).unwrap_or_else(|| in_claps_words(error, typed)),
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
fn value(error: &Error) -> Option<String> {
    let (option, typed) = (text(error, ContextKind::InvalidArg)?, text(error, ContextKind::InvalidValue)?);
    let cause = error.source()?;
    let what = format!("invalid value '{typed}' for '{option}'");
    if let Some(error) = cause.downcast_ref::<SpecError>() {
        return Some(format!("{what}: {}\n\n{}", error.summary(), keys(typed)));
    }
    if let Some(WordError::OfOther { of, name, .. }) = cause.downcast_ref() {
        let right = match of {
            WordKind::Filter => "--filter",
            WordKind::Kernel => "--kernel",
            WordKind::Transfer => "--transfer",
            WordKind::Primaries => "--primaries",
        };
        return Some(format!("{what}: that is a {of}: {right} {name}"));
    }
    Some(format!("{what}: {cause}"))
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
    let example = examples(verb).first().filter(|_| needs_example);
    let example = example.map_or_else(String::new, |example| format!("Example: {example}\n"));
    format!("{text}\n\n{example}{}", see_options(verb))
}

/// Returns the command that lists the options.
pub(super) fn see_options(verb: Option<&str>) -> String {
    match verb {
        Some(verb) => format!("'cosmorama {verb} -h' lists the options"),
        None => "'cosmorama -h' lists the verbs".to_owned(),
    }
}
