//! Errors with exit codes: 1 for failures, 2 for wrong usage.

mod arguments;
mod no_projection;
mod other_words;
mod panic;
mod spec_key;
mod unknown_option;
mod unknown_verb;

use std::process::ExitCode;

use cosmorama_convert::ConvertError;
use thiserror::Error;

pub(crate) use arguments::report_arguments;
pub(crate) use panic::report_panics;

use crate::console::{Console, in_options};

/// An error in the command as it was typed: exit code 2.
#[derive(Debug, Error)]
#[error("{0}")]
pub(crate) struct Usage(String);

/// Makes an error of usage.
pub(crate) fn usage(message: impl Into<String>) -> anyhow::Error {
    Usage(message.into()).into()
}

fn is_usage(error: &anyhow::Error) -> bool {
    match error.downcast_ref::<ConvertError>() {
        Some(error) => error.is_of_settings(),
        None => error.chain().any(|cause| cause.is::<Usage>()),
    }
}

/// Returns an error and its causes on one line.
pub(crate) fn message(error: &anyhow::Error) -> String {
    if let Some(error) = error.downcast_ref::<ConvertError>() {
        return in_options(&error.message());
    }
    let mut message = String::new();
    for cause in error.chain().map(ToString::to_string) {
        // Many errors have their cause in their own message.
        if !message.contains(&cause) {
            message += if message.is_empty() { "" } else { ": " };
            message += &cause;
        }
    }
    message
}

/// Prints an error, its causes on the same line, and chooses the exit code.
pub(crate) fn report(error: &anyhow::Error, console: &Console) -> ExitCode {
    console.error(&message(error));
    if is_usage(error) { ExitCode::from(2) } else { ExitCode::FAILURE }
}
