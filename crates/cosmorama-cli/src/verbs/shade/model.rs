use std::path::Path;

use anyhow::{Result, anyhow};
use cosmorama_scene::{Model, ModelFault, ModelSettings, PictureReader};

use crate::console::Console;

/// Reads a model, and tells what was left out of it.
pub(super) fn model(
    path: &Path,
    settings: &ModelSettings,
    pictures: &mut dyn PictureReader,
    console: &Console,
) -> Result<Model> {
    let model = Model::read(path, settings, pictures).map_err(|error| match error.why {
        ModelFault::TooLarge { .. } | ModelFault::TooLong { .. } => {
            anyhow!("{error}; allow more with --memory, or simplify the model")
        }
        _ => error.into(),
    })?;
    model.notes.iter().for_each(|note| console.warning(format_args!("{}: {note}", path.display())));
    Ok(model)
}
