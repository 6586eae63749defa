//! Parsers of single values, for clap.

pub(crate) mod compression;
pub(crate) mod file;
pub(crate) mod listed;
pub(crate) mod log_format;
pub(crate) mod number;
pub(crate) mod progress;
