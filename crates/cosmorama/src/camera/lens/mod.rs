//! Camera models with a circular picture: fisheyes, domes, Omnimax, mirror balls.

pub(crate) mod calibrated;
pub(crate) mod camera_matrix;
pub(crate) mod fisheye;
pub(crate) mod framing;
pub(crate) mod fulldome;
pub(crate) mod hugin;
pub(crate) mod lens_circle;
pub(crate) mod mirror_ball;
pub(crate) mod omnimax;
pub(crate) mod stereographic;
