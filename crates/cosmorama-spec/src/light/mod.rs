//! Text forms of light: colours, transfer functions, sample types.

mod colour;
mod colour_table;
mod depth;
mod missing;
mod primaries;
mod transfer;

pub use colour::Colour;
pub use colour_table::{colour_table_csv, colour_table_of_csv, colour_table_of_stops};
pub use depth::DepthName;
pub use missing::Missing;
pub use primaries::PrimariesName;
pub use transfer::TransferName;
