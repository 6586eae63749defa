use std::path::Path;

use anyhow::Result;
use cosmorama_convert::MemoryBudget;
use cosmorama_scene::{Material, Model, ModelFault, ModelSettings, Scene};

use crate::args::ShadeArgs;
use crate::console::say;

/// Reads a model, and tells what was left out of it.
pub(super) fn model(path: &Path, material: Material, args: &ShadeArgs) -> Result<Scene> {
    let most = MemoryBudget::new(args.limits.memory).count_of(Model::TRIANGLE_BYTES);
    let settings = ModelSettings { crease: args.crease, material: Some(material), most };
    let model = Model::read(path, &settings).map_err(|error| match error.why {
        ModelFault::TooLarge { .. } => anyhow::anyhow!("{error}; allow more with --memory, or simplify the model"),
        _ => error.into(),
    })?;
    model.notes.iter().for_each(|note| say(format_args!("warning: {}: {note}", path.display())));
    Ok(Scene { objects: vec![model.object] })
}
