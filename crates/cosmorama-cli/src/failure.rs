//! Errors with exit codes: 1 for what failed, 2 for wrong usage.

use std::process::ExitCode;

use thiserror::Error;

use crate::stream;

/// An error of the person who typed the command: exit code 2.
#[derive(Debug, Error)]
#[error("{0}")]
pub(crate) struct Usage(String);

/// An error of usage.
pub(crate) fn usage(message: impl Into<String>) -> anyhow::Error {
    Usage(message.into()).into()
}

/// The same error in other words.
pub(crate) fn retold(error: &anyhow::Error, words: impl Fn(&str) -> String) -> anyhow::Error {
    let text = words(&message(error));
    if is_usage(error) { usage(text) } else { anyhow::anyhow!(text) }
}

fn is_usage(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| cause.is::<Usage>())
}

/// An error and its causes on one line.
fn message(error: &anyhow::Error) -> String {
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

/// Something that should be known but does not stop the work.
#[allow(clippy::print_stderr)]
pub(crate) fn warn(message: &str) {
    eprintln!("warning: {}", stream::told(message));
}

/// Prints an error, its causes on the same line, and chooses the exit code.
#[allow(clippy::print_stderr)]
pub(crate) fn report(error: &anyhow::Error) -> ExitCode {
    eprintln!("error: {}", stream::told(&message(error)));
    if is_usage(error) { ExitCode::from(2) } else { ExitCode::FAILURE }
}
