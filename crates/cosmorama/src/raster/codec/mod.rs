//! Conversion of encoded samples to linear light, and back.

pub(crate) mod decode;
pub(crate) mod encode;
pub(crate) mod quantizer;
