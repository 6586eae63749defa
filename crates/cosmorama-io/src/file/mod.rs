//! Files on disk and in memory: headers, pixels, and writing a file whole or not at all.

mod read;
mod st_pairs;
mod upright;
mod write;

pub(crate) use upright::upright;

pub use read::{
    check_chosen, open, probe, probe_chosen, probe_from, read, read_chosen, read_from, read_in, read_layers,
};
pub use st_pairs::{StPairs, probe_pairs, probe_pairs_from, read_pairs, read_pairs_from};
pub use write::{
    write, write_flat, write_hidden, write_layer_rows_hidden, write_layers, write_layers_hidden, write_levels,
    write_planes, write_rows_hidden, write_to,
};
