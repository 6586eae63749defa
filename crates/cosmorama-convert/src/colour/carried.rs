//! Metadata of inputs that outputs take over.

use std::sync::Arc;

use cosmorama_io::{Carried, Format, Kept, Metadata};

use super::Light;
use crate::diagnostic::{Code, Diagnostic, STRIP};

/// Returns the metadata that outputs of this format take over from the first file, and warns about those that are lost.
pub(super) fn carried(first: &Metadata, format: Format, warnings: &mut Vec<Diagnostic>) -> Arc<Carried> {
    let Kept { carried, untrue, lost, unread, loses_owner } = first.carried.kept(format.room());
    if !lost.is_empty() {
        let message = format!("{format} cannot hold what the input says in {}: not carried over", lost.join(", "));
        // Camera settings may be lost in silence, but not the name of a picture's owner.
        warnings.push(if loses_owner {
            Diagnostic::warning(Code::MetadataLost, format!("{message}; {STRIP} says that none is wanted"))
        } else {
            Diagnostic::note(Code::MetadataLost, message)
        });
    }
    if !unread.is_empty() {
        let message =
            format!("{} of the input: read and written by no format here, not carried over", unread.join(", "));
        warnings.push(Diagnostic::note(Code::MetadataLost, message));
    }
    if !untrue.is_empty() {
        let message = format!("metadata that would be untrue of the output are left out: {}", untrue.join(", "));
        warnings.push(Diagnostic::note(Code::MetadataLost, message));
    }
    Arc::new(carried)
}

impl Light {
    /// Returns the metadata that a frame's outputs take over from its file; `None` if there are none.
    pub(crate) fn carried(&self, metadata: &Metadata) -> Option<Arc<Carried>> {
        self.carries.map(|format| Arc::new(metadata.carried.kept(format.room()).carried))
    }
}
