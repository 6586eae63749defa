//! Report of `info` on worlds of many views.

use anyhow::Result;
use cosmorama::camera::{PixelPoint, View};
use cosmorama::sphere::{Direction, Extent};
use cosmorama_convert::{Files, InputView, Listed, MemoryBudget, Name, existing_frames, listed};
use serde_json::{Value, json};

use super::{add_damage, damages};
use crate::console::Console;

/// Number of directions, each for an equal part of the sphere: enough for a tenth of a percent.
const DIRECTIONS: usize = 100_000;

/// Returns the report on a world file or a Hugin project; `None` where an input is neither.
pub(super) fn report(files: &dyn Files, (name, check): (&Name, bool), console: &Console) -> Result<Option<Value>> {
    let mut warnings = Vec::new();
    let Some(list) = listed(name, files, MemoryBudget::new(None), &mut warnings)? else { return Ok(None) };
    warnings.iter().for_each(|warning| console.warn(warning));
    let sphere: Vec<Direction> = Direction::spread(DIRECTIONS).collect();
    let reading = check.then_some(files);
    let views = list.iter().map(|listed| views(listed, &sphere, reading)).collect::<Result<Vec<_>>>()?.concat();
    let all: Vec<&InputView> = list.iter().flat_map(|listed| &listed.input.worlds[0]).collect();
    let is_covered = |direction| all.iter().any(|view| holds(view, direction));
    let holes = sphere.iter().filter(|direction| !is_covered(**direction)).map(|direction| Extent::of(*direction));
    let mut report = json!({
        "input": &**name,
        "projection": match views.len() { 1 => "a world of one view".to_owned(), count => format!("a world of {count} views") },
        "covers": percent(share(&sphere, is_covered)),
    });
    report["read"] = json!(if check { "every picture" } else { "headers alone; --check decodes every picture" });
    if let Some(extent) = holes.reduce(Extent::union) {
        report["lacks"] = json!(format!("directions within {extent}"));
    }
    report["views"] = json!(views);
    Ok(Some(report))
}

fn views(listed: &Listed, sphere: &[Direction], reading: Option<&dyn Files>) -> Result<Vec<Value>> {
    let view = |view: &InputView| {
        let mut report = of_view(listed, view, sphere);
        if let (Some(files), Some(_)) = (reading, &view.header) {
            add_damage(&mut report, damages(files, &view.files, &existing_frames(&view.files, files)?));
        }
        Ok(report)
    };
    listed.input.worlds.iter().flatten().map(view).collect()
}

fn of_view(listed: &Listed, view: &InputView, sphere: &[Direction]) -> Value {
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
    report["covers"] = percent(share(sphere, |direction| holds(view, direction)));
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

/// Returns whether a view's file shows a direction and its mask lets it through.
fn holds(view: &InputView, direction: Direction) -> bool {
    let sees = |held: &View| {
        let is_shown = |pixel: PixelPoint| view.mask.as_ref().is_none_or(|mask| mask.shows(pixel));
        held.sees(direction) && held.pixel(direction).is_some_and(|pixel| is_shown(held.wrapped(pixel)))
    };
    view.window.as_ref().is_some_and(|(held, _)| sees(held))
}

fn share(sphere: &[Direction], chosen: impl Fn(Direction) -> bool) -> f64 {
    sphere.iter().filter(|direction| chosen(**direction)).count() as f64 / sphere.len() as f64
}

/// Returns a share of the whole sphere, in words.
fn percent(share: f64) -> Value {
    json!(format!("{:.1} % of the sphere", 100.0 * share))
}
