//! Dimensions of the arcade in metres, shared by its parts. Its axis runs from back to front past the viewer.

/// Distance from the axis to the middle of each row of columns.
pub(in crate::demo) const HALF_WIDTH: f64 = 4.0;
/// Height at which the columns end and the beams begin.
pub(in crate::demo) const BEAM_BOTTOM: f64 = 4.6;
/// Height at which the beams end and the vault begins.
pub(in crate::demo) const SPRINGING: f64 = 5.35;
/// z of the front end.
pub(in crate::demo) const FRONT: f64 = -30.0;
/// z of the back end.
pub(in crate::demo) const BACK: f64 = 14.0;
/// Distance from column to column.
pub(in crate::demo) const BAY: f64 = 4.0;
/// z of the frontmost columns.
pub(in crate::demo) const FIRST_COLUMN: f64 = -30.0;
/// Columns in each row.
pub(in crate::demo) const COLUMNS: usize = 12;

/// Returns the height of the vault's shell above the floor at a distance from the axis.
pub(in crate::demo) fn vault_height(x: f64) -> f64 {
    SPRINGING + (HALF_WIDTH * HALF_WIDTH - x * x).max(0.0).sqrt()
}
