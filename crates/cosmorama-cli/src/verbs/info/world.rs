//! Report of `info` on worlds of many views.

use anyhow::Result;
use cosmorama::world::SphereCoverage;
use cosmorama_convert::{Files, InputView, Listed, MemoryBudget, Name, existing_frames, listed};
use serde_json::{Value, json};

use super::{add_damage, damages};
use crate::console::Console;

/// Returns the report on a world file or a Hugin project; `None` where an input is neither.
pub(super) fn report(files: &dyn Files, (name, check): (&Name, bool), console: &Console) -> Result<Option<Value>> {
    let mut warnings = Vec::new();
    let Some(list) = listed(name, files, MemoryBudget::new(None), &mut warnings)? else { return Ok(None) };
    warnings.iter().for_each(|warning| console.warn(warning));
    let mut coverage = SphereCoverage::new();
    let reading = check.then_some(files);
    let views = list.iter().map(|listed| views(listed, &mut coverage, reading)).collect::<Result<Vec<_>>>()?.concat();
    let mut report = json!({
        "input": &**name,
        "projection": match views.len() { 1 => "a world of one view".to_owned(), count => format!("a world of {count} views") },
        "covers": percent(coverage.share()),
    });
    report["read"] = json!(if check { "every picture" } else { "headers alone; --check decodes every picture" });
    if let Some(extent) = coverage.lacks() {
        report["lacks"] = json!(format!("directions within {extent}"));
    }
    report["views"] = json!(views);
    Ok(Some(report))
}

/// Returns the report on each view. What the first eye's show is added to what is covered.
fn views(listed: &Listed, coverage: &mut SphereCoverage, reading: Option<&dyn Files>) -> Result<Vec<Value>> {
    let mut reports = Vec::new();
    for (eye, world) in listed.input.worlds.iter().enumerate() {
        for view in world {
            let mask = view.mask.as_deref();
            let share = view.window.as_ref().map_or(0.0, |(held, _)| {
                if eye == 0 { coverage.add(held, mask) } else { coverage.share_of(held, mask) }
            });
            let mut report = of_view(listed, view, share);
            if let (Some(files), Some(_)) = (reading, &view.header) {
                add_damage(&mut report, damages(files, &view.files, &existing_frames(&view.files, files)?));
            }
            reports.push(report);
        }
    }
    Ok(reports)
}

fn of_view(listed: &Listed, view: &InputView, covers: f64) -> Value {
    let spec = listed.spec.clone().unwrap_or_else(|| "not said: found from the file".to_owned());
    let angles = view.nominal.orientation.yaw_pitch_roll();
    let [yaw, pitch, roll] = angles.map(|angle| format!("{:.2}", angle.degrees()));
    let mut report = json!({ "image": listed.image, "line": listed.place, "spec": spec });
    if view.name != listed.image {
        report["name"] = json!(view.name);
    }
    match &view.header {
        Some(header) => report["size"] = json!(format!("{}x{}", header.width, header.height)),
        None => report["missing"] = json!(format!("no {}", view.files.path(None).display())),
    }
    report["looks"] = json!(format!("yaw {yaw}, pitch {pitch}, roll {roll}"));
    report["covers"] = percent(covers);
    if view.blend.priority != 0 {
        report["priority"] = json!(view.blend.priority);
    }
    if view.blend.feather.degrees() > 0.0 {
        report["feather"] = json!(format!("{:.1}", view.blend.feather.degrees()));
    }
    if view.mask.is_some() {
        report["mask"] = json!("yes");
    }
    report
}

/// Returns a share of the whole sphere, in words.
fn percent(share: f64) -> Value {
    json!(format!("{:.1} % of the sphere", 100.0 * share))
}
