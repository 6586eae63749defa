//! Regions of a plane that hold a cap of directions, and bounds on angles to edges.

pub(crate) mod cap_region;
pub(crate) mod lat_lon_box;
pub(crate) mod meridian;
