//! Text forms of light: colours, transfer functions, sample types.

mod colour;
mod depth;
mod missing;
mod primaries;
mod transfer;

pub use colour::Colour;
pub use depth::DepthName;
pub use missing::Missing;
pub use primaries::PrimariesName;
pub use transfer::TransferName;
