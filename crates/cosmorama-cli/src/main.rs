//! The `cosmorama` program.
fn main() {}
