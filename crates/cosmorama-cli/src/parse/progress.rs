use clap::ValueEnum;

/// Style of the progress on standard error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ProgressStyle {
    /// A bar on a terminal, else plain
    Auto,
    /// A bar with rate and time left
    Bar,
    /// A line for each frame, and every two seconds while one is made
    Plain,
    /// A JSON object where plain has a line; warnings and errors stay lines of text
    Json,
    /// Lines for Open Job Description: openjd_progress: 12.5
    Openjd,
    /// Nothing
    None,
}

impl ProgressStyle {
    /// Returns whether people read along, who want a report at the end, too.
    pub(crate) fn is_for_people(self) -> bool {
        matches!(self, Self::Auto | Self::Bar | Self::Plain)
    }
}
