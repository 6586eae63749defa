//! Texels that a conversion needs, and directions that no view covers.

pub(crate) mod block;
pub(crate) mod bounds;
pub(crate) mod continuation;
pub(crate) mod need;
pub(crate) mod require;
pub(crate) mod screen_mask;
pub(crate) mod uncovered;
