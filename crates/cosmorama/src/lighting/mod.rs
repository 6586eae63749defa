//! The light that a world sheds: its balance of energy and its bright sources.

pub(crate) mod bright_sources;
pub(crate) mod energy_balance;

pub use energy_balance::LightBalance;
