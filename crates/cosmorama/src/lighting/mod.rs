//! Light of a world: its energy balance and its bright sources.

pub(crate) mod bright_sources;
pub(crate) mod energy_balance;

pub use energy_balance::LightBalance;
