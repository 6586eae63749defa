//! Things under a world.

mod behind;
mod camera;
mod memory;
mod model;
mod output;
mod things;
mod turntable;
mod world;
mod worlds;

use std::collections::HashSet;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use cosmorama::filter::FilterSettings;
use cosmorama::raster::{Image, Rgba};
use cosmorama_convert::{MemoryBudget, check_apart, threads};
use cosmorama_scene::{LightMaps, SceneError, Sky, Surroundings, picture_over};
use cpu_time::ProcessTime;
use serde_json::json;

use self::behind::Behind;
use self::camera::{Shot, shots};
use self::memory::{Lighting, needed};
use self::output::Output;
use self::things::Things;
use self::turntable::frames;
use self::worlds::{files, read, worlds};
use super::prepare_output;
use crate::args::{OcclusionName, ShadeArgs};
use crate::console::Console;
use crate::failure::usage;

/// Makes a picture of things under a world, or those of a whole turn.
pub(super) fn run(args: ShadeArgs, console: &mut Console) -> Result<ExitCode> {
    let (start, mut clock) = (Instant::now(), Clock::start());
    let output = Output::check(&args)?;
    let frames = frames(&args)?;
    let mut things = Things::read(&args, console)?;
    let shots = shots(&args, &things)?;
    let worlds = worlds(&args, &mut things, console)?;
    let files: HashSet<PathBuf> = files(&worlds).chain(things.files.iter().cloned()).collect();
    frames.iter().try_for_each(|frame| check_apart(&frame.path, &files))?;
    let prepared = frames.iter().map(|frame| prepare_output(&frame.path, args.file, console));
    let _folders = prepared.collect::<Result<Vec<_>>>()?;
    let pool = threads(args.limits.threads)?;
    let lights = pool.install(|| read(&worlds, console))?;
    let read = clock.lap();
    let skies: Vec<Sky> =
        lights.iter().map(|world| Sky { world: &world.world, light: &world.light, unseen: world.unseen }).collect();
    let maps = |(number, sky): (usize, &Sky)| LightMaps::of(&things.scene, number, *sky).map_err(wrong);
    let maps: Vec<LightMaps> = pool.install(|| skies.iter().enumerate().map(maps).collect::<Result<_>>())?;
    let lit = clock.lap();
    let filter =
        FilterSettings { kind: args.reflect.0, kernel: args.kernel.kernel, anti_ringing: args.kernel.anti_ringing };
    let lighting = Lighting { worlds: &lights, maps: &maps, filter };
    let needed = pool.install(|| needed(&things.scene, &lighting, &shots, (frames.len(), &output)));
    let needed = needed.saturating_add(things.bytes);
    let needed = MemoryBudget::new(args.limits.memory).check_things(needed, pool.current_num_threads())?;
    let surroundings = |number: usize| {
        let made = Surroundings::new(skies[number], &maps[number], filter).map_err(wrong)?;
        let is_hidden = args.occlusion == OcclusionName::Ambient;
        Ok(made.with_proxy(worlds[number].proxy).with_occlusion(is_hidden))
    };
    let mut surroundings: Vec<Surroundings> =
        pool.install(|| (0..worlds.len()).map(surroundings).collect::<Result<_>>())?;
    let behind = Behind::new(&args, &worlds);
    // Things turn, and what is behind them stays.
    let all = || shots.iter().map(|shot| behind.picture(shot, &surroundings)).collect::<Result<Vec<Image<Rgba>>>>();
    let kept = (frames.len() > 1).then(|| pool.install(all)).transpose()?;
    let (mut shaded, mut written) = (clock.lap(), 0.0);
    for frame in &frames {
        surroundings.iter_mut().for_each(|world| world.turn_things(frame.turn));
        let made = |k: usize, shot: &Shot| {
            let over = match &kept {
                Some(kept) => kept[k].clone(),
                None => behind.picture(shot, &surroundings)?,
            };
            picture_over(&things.scene, &shot.camera, &surroundings, over).map_err(wrong)
        };
        let image = pool.install(|| assembled(&shots, made))?;
        shaded += clock.lap();
        pool.install(|| output.write(&frame.path, image, lights[0].primaries, console))?;
        written += clock.lap();
    }
    if args.json {
        let cpu = json!({ "decode": read, "light": lit, "filter": shaded, "encode": written });
        let report = json!({
            "inputs": worlds.iter().map(|world| &*world.name).collect::<Vec<_>>(),
            "outputs": frames.iter().map(|frame| frame.path.display().to_string()).collect::<Vec<_>>(),
            "wall_seconds": start.elapsed().as_secs_f64(),
            "cpu_seconds": cpu,
            "peak_memory_bytes": cosmorama_convert::peak_bytes(),
            "estimated_memory_bytes": needed,
        });
        console.print(&(serde_json::to_string_pretty(&report)? + "\n"))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Processor time of all threads, stage by stage.
struct Clock(ProcessTime);

impl Clock {
    fn start() -> Self {
        Self(ProcessTime::now())
    }

    /// Returns the seconds since the last stage.
    fn lap(&mut self) -> f64 {
        let now = ProcessTime::now();
        let spent = now.duration_since(self.0).as_secs_f64();
        self.0 = now;
        spent
    }
}

/// Makes a picture of one shot, or of several side by side.
fn assembled(shots: &[Shot], make: impl Fn(usize, &Shot) -> Result<Image<Rgba>>) -> Result<Image<Rgba>> {
    if let [shot @ Shot { place: None, .. }] = shots {
        return make(0, shot);
    }
    let size = shots.iter().find_map(|shot| shot.place.as_ref()).map_or((0, 0), |place| place.of);
    let mut sheet = Image::filled(size.0, size.1, Rgba::TRANSPARENT);
    for (k, shot) in shots.iter().enumerate() {
        let (image, corner) = (make(k, shot)?, shot.place.as_ref().map_or((0, 0), |place| place.corner));
        for j in 0..image.height() {
            let start = (corner.1 + j) * size.0 + corner.0;
            sheet.pixels_mut()[start..start + image.width()].copy_from_slice(image.row(j));
        }
    }
    Ok(sheet)
}

fn wrong(error: SceneError) -> anyhow::Error {
    usage(error.to_string())
}
