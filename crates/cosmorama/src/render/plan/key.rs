use std::fmt::{self, Display, Write};

use twox_hash::XxHash3_128;

use super::saved::FORMAT;
use crate::render::Resampler;

/// What a plan was made of, in 128 bits: conversions that differ in anything that a plan depends on have different ones.
///
/// Within one version of this library, on one kind of machine: elsewhere the same conversion may have another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PlanKey(pub(crate) u128);

impl PlanKey {
    /// That of a conversion, for a kind of light.
    pub(crate) fn new(Resampler { world, target, filter }: &Resampler, light: &str) -> Self {
        let mut hash = Hash(XxHash3_128::new());
        let version = env!("CARGO_PKG_VERSION");
        // What is derived prints all there is, each number so that it comes back.
        let mut written = write!(hash, "{version} {FORMAT} {light} {target:?} {filter:?}");
        for source in world.sources() {
            // A name is no geometry.
            let mut nameless = source.clone();
            nameless.name.clear();
            written = written.and_then(|()| write!(hash, "{nameless:?}"));
            // What masks hide and what views share is seen in the texels' weights.
            hash.0.write(bytemuck::cast_slice(&source.solid_angles));
        }
        match written {
            Ok(()) => Self(hash.0.finish_128()),
            // Only a failing sink makes writing fail, and this one does not.
            Err(fmt::Error) => unreachable!("a hash takes whatever is written"),
        }
    }
}

/// As 32 hexadecimal digits, as for a file's name.
impl Display for PlanKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

struct Hash(XxHash3_128);

impl Write for Hash {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.write(text.as_bytes());
        Ok(())
    }
}
