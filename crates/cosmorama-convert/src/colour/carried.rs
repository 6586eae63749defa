//! Metadata of inputs that go along to outputs.

use std::sync::Arc;

use cosmorama_io::{Carried, Format, Kept, Metadata};

use super::Light;
use crate::diagnostic::{Code, Diagnostic, STRIP};

/// Returns what goes along from the first file to outputs of this format, and tells what does not.
pub(super) fn carried(first: &Metadata, format: Format, warnings: &mut Vec<Diagnostic>) -> Arc<Carried> {
    let Kept { carried, untrue, lost, loses_owner } = first.carried.kept(format.room());
    if !lost.is_empty() {
        let message = format!("{format} cannot hold what the input says in {}: not carried over", lost.join(", "));
        // Nobody misses a camera's settings; whose picture it is must not get lost without a word.
        warnings.push(if loses_owner {
            Diagnostic::warning(Code::MetadataLost, format!("{message}; {STRIP} says that none is wanted"))
        } else {
            Diagnostic::note(Code::MetadataLost, message)
        });
    }
    if !untrue.is_empty() {
        let message = format!("metadata that would be untrue of the output are left out: {}", untrue.join(", "));
        warnings.push(Diagnostic::note(Code::MetadataLost, message));
    }
    Arc::new(carried)
}

impl Light {
    /// Returns what goes along from a frame's file to its outputs; `None` where nothing does.
    pub(crate) fn carried(&self, metadata: &Metadata) -> Option<Arc<Carried>> {
        self.carries.map(|format| Arc::new(metadata.carried.kept(format.room()).carried))
    }
}
