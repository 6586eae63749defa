//! Things under a world.

mod camera;
mod model;
mod output;
mod world;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use cosmorama::filter::FilterSettings;
use cosmorama::raster::{Image, Rgba};
use cosmorama_convert::{check_apart, threads};
use cosmorama_scene::{
    Background, Chrome, Glass, LightMaps, Material, MaterialError, Refraction, Scene, SceneError, Sky, Surroundings,
    picture,
};
use cpu_time::ProcessTime;
use serde_json::json;

use self::camera::{Shot, shots};
use self::model::model;
use self::output::Output;
use self::world::WorldInput;
use super::prepare_output;
use crate::args::{BackgroundName, ObjectName, RefractName, ShadeArgs};
use crate::console::Console;
use crate::failure::usage;

/// Makes a picture of things under a world.
pub(super) fn run(args: ShadeArgs, console: &mut Console) -> Result<ExitCode> {
    let (start, mut clock) = (Instant::now(), Clock::start());
    let path = Path::new(&args.output);
    let output = Output::check(&args)?;
    let scene = scene(&args)?;
    let chrome = chrome(&args)?;
    let shots = shots(&args, &scene)?;
    let world = WorldInput::check(&args, console)?;
    if let Some(files) = world.files() {
        check_apart(path, files)?;
    }
    let _folders = prepare_output(path, args.file, console)?;
    let pool = threads(args.limits.threads)?;
    let world = pool.install(|| world.read(console))?;
    let read = clock.lap();
    let sky = Sky { world: &world.world, light: &world.light, unseen: world.unseen };
    let maps = pool.install(|| LightMaps::of(&scene, sky)).map_err(wrong)?;
    let lit = clock.lap();
    let filter =
        FilterSettings { kind: args.reflect.0, kernel: args.kernel.kernel, anti_ringing: args.kernel.anti_ringing };
    let surroundings = pool.install(|| Surroundings::new(sky, &maps, filter)).map_err(wrong)?.with_chrome(chrome);
    let background = match args.background {
        BackgroundName::World => Background::World,
        BackgroundName::Colour(colour) => Background::Colour(colour),
    };
    let image = pool.install(|| {
        assembled(&shots, |shot| picture(&scene, &shot.camera, &surroundings, background).map_err(wrong))
    })?;
    let shaded = clock.lap();
    pool.install(|| output.write(path, image, world.primaries, console))?;
    if args.json {
        let cpu = json!({ "decode": read, "light": lit, "filter": shaded, "encode": clock.lap() });
        let report = json!({
            "inputs": [args.world],
            "outputs": [args.output],
            "wall_seconds": start.elapsed().as_secs_f64(),
            "cpu_seconds": cpu,
            "peak_memory_bytes": cosmorama_convert::peak_bytes(),
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

/// Returns the things that were asked for.
fn scene(args: &ShadeArgs) -> Result<Scene> {
    let asked = &args.material.0;
    let material = Material {
        diffuse: args.dc.unwrap_or(asked.diffuse),
        specular: args.sc.unwrap_or(asked.specular),
        alpha: args.alpha.unwrap_or(asked.alpha),
        glass: glass(args, asked.glass)?,
        ..asked.clone()
    };
    material.check().map_err(|error| usage(format!("{}: {error}", option_of(&error))))?;
    if args.crease.is_some() && !matches!(args.object, ObjectName::Model(_)) {
        return Err(usage("--crease is for models; name one, as in --object teapot.obj"));
    }
    match &args.object {
        ObjectName::Sphere => Ok(Scene::sphere(material)),
        ObjectName::Spheres(_) if args.alpha.is_some() => {
            Err(usage("--alpha is for one sphere; those of spheres:N go from 1 to 0 by themselves"))
        }
        ObjectName::Spheres(count) => {
            Scene::spheres(*count, &material).map_err(|error| usage(format!("--object: {error}")))
        }
        ObjectName::Plate4 if material != Material::MIRROR => Err(usage(
            "plate4 has materials of its own: leave out --material, --dc, --sc, --alpha and options of glass",
        )),
        ObjectName::Plate4 => Ok(Scene::plate4()),
        ObjectName::Model(path) => model(path, material, args),
    }
}

/// Returns the option that a number of a material comes from.
fn option_of(error: &MaterialError) -> &'static str {
    match error {
        MaterialError::Coefficient(_) => "--dc, --sc",
        MaterialError::Alpha(_) => "--alpha",
        MaterialError::Index(_) => "--ior",
        MaterialError::Absorption(_) => "--absorption",
        MaterialError::Surfaces(_) => "--surfaces",
    }
}

/// Returns the table of chrome that was asked for; its options are for nothing else.
fn chrome(args: &ShadeArgs) -> Result<Chrome> {
    if !args.material.0.chrome {
        let message = "--chrome and --highlight are for chrome; add --material chrome";
        let is_given = args.chrome.is_some() || !args.highlight.is_empty();
        return if is_given { Err(usage(message)) } else { Ok(Chrome::earth_and_sky()) };
    }
    if args.alpha.is_some() || matches!(args.object, ObjectName::Spheres(_)) {
        return Err(usage("chrome is one smooth sphere: leave out --alpha and spheres:N"));
    }
    let highlights = args.highlight.iter().map(|name| name.0).collect();
    match &args.chrome {
        Some(table) => Chrome::new(&table.0, highlights).map_err(|error| usage(format!("--chrome: {error}"))),
        None => Ok(Chrome::earth_and_sky().with_highlights(highlights)),
    }
}

/// Returns the glass that was asked for; options of glass are for nothing else.
fn glass(args: &ShadeArgs, asked: Option<Glass>) -> Result<Option<Glass>> {
    let given = args.ior.is_some() || args.absorption.is_some() || args.refract.is_some() || args.surfaces.is_some();
    let Some(usual) = asked else {
        let message = "--ior, --absorption, --refract and --surfaces are for glass; add --material glass";
        return if given { Err(usage(message)) } else { Ok(None) };
    };
    Ok(Some(Glass {
        index: args.ior.map_or(usual.index, |index| index.0),
        absorption: args.absorption.map_or(usual.absorption, |absorption| absorption.0),
        refraction: match args.refract {
            Some(RefractName::Bent) => Refraction::Bent,
            Some(RefractName::Traced) | None => Refraction::Traced,
        },
        surfaces: args.surfaces.unwrap_or(usual.surfaces),
        ..usual
    }))
}

/// Makes a picture of one shot, or of several side by side.
fn assembled(shots: &[Shot], make: impl Fn(&Shot) -> Result<Image<Rgba>>) -> Result<Image<Rgba>> {
    if let [Shot { place: None, .. }] = shots {
        return make(&shots[0]);
    }
    let size = shots.iter().find_map(|shot| shot.place.as_ref()).map_or((0, 0), |place| place.of);
    let mut sheet = Image::filled(size.0, size.1, Rgba::TRANSPARENT);
    for shot in shots {
        let (image, corner) = (make(shot)?, shot.place.as_ref().map_or((0, 0), |place| place.corner));
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
