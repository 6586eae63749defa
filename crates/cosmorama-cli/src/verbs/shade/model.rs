use std::path::Path;

use anyhow::{Result, anyhow};
use cosmorama_scene::{Model, ModelFault, ModelSettings, PictureReader};

use crate::console::say;

/// Reads a model, and tells what was left out of it.
pub(super) fn model(path: &Path, settings: &ModelSettings, pictures: &mut dyn PictureReader) -> Result<Model> {
    let model = Model::read(path, settings, pictures).map_err(|error| match error.why {
        ModelFault::TooLarge { .. } | ModelFault::TooLong { .. } => {
            anyhow!("{error}; allow more with --memory, or simplify the model")
        }
        _ => error.into(),
    })?;
    model.notes.iter().for_each(|note| say(format_args!("warning: {}: {note}", path.display())));
    Ok(model)
}
