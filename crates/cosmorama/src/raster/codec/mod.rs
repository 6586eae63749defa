//! Conversion of encoded samples to linear light, and back.

pub(crate) mod byte_codes;
pub(crate) mod decode;
pub(crate) mod encode;
pub(crate) mod frame_pool;
pub(crate) mod quantizer;
pub(crate) mod samples;
