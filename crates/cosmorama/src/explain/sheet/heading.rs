use super::drawing::{Anchor, Drawing};
use super::theme::{INK, LABEL, MARGIN, PAPER, TITLE};

/// Returns a sheet with a title and a line under it.
pub(crate) fn sheet((width, height): (f64, f64), title: &str, subtitle: &str) -> Drawing {
    let mut drawing = Drawing::new(width, height, PAPER);
    drawing.label(title, (MARGIN, MARGIN + TITLE * 0.5), TITLE, Anchor::Start, INK);
    drawing.label(subtitle, (MARGIN, MARGIN + TITLE * 0.5 + 21.0), LABEL * 0.8, Anchor::Start, INK);
    drawing
}

/// Returns a size as text: `1024×960`.
pub(crate) fn size_text((width, height): (usize, usize)) -> String {
    format!("{width}×{height}")
}
