use anyhow::Result;
use cosmorama_convert::{Files, ViewFiles};
use serde_json::{Value, json};

/// Adds what a video says of itself beside its pictures.
pub(super) fn add(report: &mut Value, inputs: &dyn Files, files: &ViewFiles) -> Result<()> {
    let Some((video, videos)) = files.video().zip(inputs.videos()) else { return Ok(()) };
    for (name, value) in videos.facts(video)? {
        report[name] = json!(value);
    }
    if let Some((spec, by)) = videos.spec(video)? {
        report["projection"] = json!(format!("{spec} ({by})"));
    }
    Ok(())
}
