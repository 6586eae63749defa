//! Image files for cosmorama: formats, metadata, face sets and frame sequences.
