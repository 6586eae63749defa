//! Worlds with closed-form answers, comparators and oracles for cosmorama's own tests.
