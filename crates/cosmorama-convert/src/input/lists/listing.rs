//! Views of worlds that list them, one by one.

use crate::input::Input;

/// A view as a world file or a Hugin project lists it.
pub struct Listed {
    /// File or pattern, as written.
    pub image: String,
    /// Name of the list, and line.
    pub place: String,
    /// Projection, as written.
    pub spec: Option<String>,
    /// Findings: a view, or several that share an image or a pattern.
    pub input: Input,
}
