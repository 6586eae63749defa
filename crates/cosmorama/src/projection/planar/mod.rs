//! Projections onto a flat image plane: pinhole cameras, their distortions, faces of cubes, Pannini.

pub(crate) mod brown_conrady;
pub(crate) mod calibrated;
pub(crate) mod equi_angular;
pub(crate) mod pannini;
pub(crate) mod perspective;
