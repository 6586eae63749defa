//! Ellipses and weights of eight pixels at once.

pub(crate) mod centring;
pub(crate) mod ellipses;
pub(crate) mod weights;
pub(crate) mod window;
