//! Files that SPECs name: calibrations and st maps.

pub(crate) mod calibration;
pub(crate) mod st_map;
