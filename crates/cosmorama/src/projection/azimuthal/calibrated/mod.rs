//! Lens formulas with calibrated coefficients.

pub(crate) mod by_angle;
pub(crate) mod by_radius;
pub(crate) mod double_sphere;
pub(crate) mod field_of_view;
pub(crate) mod hugin;
pub(crate) mod kannala_brandt;
pub(crate) mod ocam;
pub(crate) mod polynomial;
pub(crate) mod unified;
