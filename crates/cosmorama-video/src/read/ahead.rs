//! Frames and messages that came before their turn.

use super::decoder::Decoded;

/// Frame with its number.
#[derive(Debug)]
pub(super) struct Ahead {
    pub(super) index: u64,
    pub(super) frame: Decoded,
}

/// Message of an error, and the frame before which it was heard.
#[derive(Debug)]
pub(super) struct Complaint {
    pub(super) frame: u64,
    /// Frames of which one is meant, from that one on.
    pub(super) meant: u64,
    pub(super) text: String,
}
