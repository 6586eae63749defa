//! Worlds with closed-form answers, comparators and oracles for cosmorama's own tests.
#![forbid(unsafe_code)]

mod common_field;
mod dome;
mod forms;
mod frames;
mod kernels;
mod light;
mod mutants;
mod round_trip;
mod shared;
mod sky;
mod suns;

pub use dome::Dome;
pub use forms::Form;
pub use frames::{cube, cube_face, equirect, fisheye, omnimax, partial_worlds, perspective, turned, whole_worlds};
pub use kernels::Kernel;
pub use light::{light_by_direction, light_by_texel, position_error};
pub use mutants::{Mutants, say_premultiplied};
pub use round_trip::RoundTrip;
pub use shared::shared;
pub use sky::{Sky, power};
pub use suns::{HARD_PLACES, LIGHT, equirect_density, sun};
