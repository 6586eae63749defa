//! Views that may show a direction: cones around views, and views by parts of the sphere.

pub(crate) mod bounding_cone;
pub(crate) mod coverage;
pub(crate) mod view_index;
