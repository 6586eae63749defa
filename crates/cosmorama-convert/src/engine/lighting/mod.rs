//! Energy balance of pictures, and maps of light.

pub(crate) mod balance;
pub(crate) mod between;
pub(crate) mod light_maps;
