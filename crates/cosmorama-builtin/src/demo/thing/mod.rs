//! Things that stand, hang and float in the demo world.

pub(super) mod balloon;
pub(super) mod colonnade;
pub(super) mod gazing_ball;
pub(super) mod ground;
pub(super) mod lamps;
pub(super) mod panel;
pub(super) mod pyramid;
pub(super) mod vault;
