//! Errors with exit codes: 1 for what failed, 2 for wrong usage.

use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use cosmorama_convert::ConvertError;
use thiserror::Error;

use crate::console::{Console, in_options, say};

/// An error of the person who typed the command: exit code 2.
#[derive(Debug, Error)]
#[error("{0}")]
pub(crate) struct Usage(String);

/// An error of usage.
pub(crate) fn usage(message: impl Into<String>) -> anyhow::Error {
    Usage(message.into()).into()
}

fn is_usage(error: &anyhow::Error) -> bool {
    match error.downcast_ref::<ConvertError>() {
        Some(error) => error.is_of_settings(),
        None => error.chain().any(|cause| cause.is::<Usage>()),
    }
}

/// An error and its causes on one line.
fn message(error: &anyhow::Error) -> String {
    if let Some(error) = error.downcast_ref::<ConvertError>() {
        return in_options(&error.message());
    }
    let mut message = String::new();
    for cause in error.chain().map(ToString::to_string) {
        // Many errors tell their cause themselves.
        if !message.contains(&cause) {
            message += if message.is_empty() { "" } else { ": " };
            message += &cause;
        }
    }
    message
}

/// Prints an error, its causes on the same line, and chooses the exit code.
pub(crate) fn report(error: &anyhow::Error, console: &Console) -> ExitCode {
    say(format_args!("error: {}", console.told(&message(error))));
    if is_usage(error) { ExitCode::from(2) } else { ExitCode::FAILURE }
}

/// Prints what is wrong with arguments, or what was asked for, and chooses the exit code.
pub(crate) fn report_arguments(mut error: clap::Error) -> ExitCode {
    let unknown = match error.get(ContextKind::InvalidArg) {
        Some(ContextValue::String(argument)) if error.kind() == ErrorKind::UnknownArgument => argument.as_str(),
        _ => "-",
    };
    if !unknown.starts_with('-') && error.get(ContextKind::Suggested).is_none() {
        // The shell makes a list of files of a wildcard.
        let tip = "many files are named by one pattern, in quotes: '####' where frame numbers stand, '{face}' where faces' names do";
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    // Where nobody listens any more, there is nobody to tell so.
    let _ = error.print();
    u8::try_from(error.exit_code()).map_or(ExitCode::FAILURE, ExitCode::from)
}
