//! Colours and sizes that all figures share.

/// Background of the sheet.
pub(crate) const PAPER: &str = "#faf9f6";
/// Text and outlines.
pub(crate) const INK: &str = "#1d2430";
/// Inconspicuous outlines.
pub(crate) const FAINT: &str = "#b9bec7";
/// Parts that are not needed, and parts outside the lens.
pub(crate) const DARK: &str = "#232a36";
/// Edge of the field of view, drawn over [`INK`] to be visible on bright and dark.
pub(crate) const CURVE: &str = "#ffcb2d";

/// Heights of capitals in titles and in labels.
pub(crate) const TITLE: f64 = 13.0;
pub(crate) const LABEL: f64 = 10.5;
pub(crate) const SMALL: f64 = 7.5;

/// Space around a figure, and above it for the title.
pub(crate) const MARGIN: f64 = 28.0;
pub(crate) const HEADER: f64 = 76.0;

/// Returns the colour of a view, by its index.
pub(crate) fn colour(view: usize) -> &'static str {
    const COLOURS: [&str; 8] = ["#8ec1e8", "#f6b27c", "#c9b3dd", "#a3d39c", "#f2dc7d", "#d8b59b", "#f3a8b8", "#9fd8d3"];
    COLOURS[view % COLOURS.len()]
}
