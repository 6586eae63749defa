//! Procedural worlds for cosmorama: radiance by direction, given by formula.
