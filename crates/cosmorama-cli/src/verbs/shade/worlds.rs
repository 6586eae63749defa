use std::path::PathBuf;

use anyhow::{Error, Result, anyhow};
use cosmorama::raster::Rgba;
use cosmorama_convert::{Code, ConvertError, Name, Radiance, Setting};
use cosmorama_scene::{Located, NamedWorld, Proxy};
use cosmorama_spec::{Missing, Spec, did_you_mean};

use super::things::Things;
use super::world::{Asked, WorldInput};
use crate::args::ShadeArgs;
use crate::console::Console;
use crate::failure::{message, usage};

/// A world that things stand under, checked but not read.
pub(super) struct Under {
    pub(super) name: Name,
    pub(super) input: WorldInput,
    pub(super) proxy: Option<Proxy>,
    /// Whether it does not show all directions, and is empty there.
    pub(super) is_partial: bool,
}

/// Finds the files of all worlds: that of the picture, those of the scene file, and those of single parts, which the parts
/// are told of. The last is the backdrop, if there is one.
pub(super) fn worlds(args: &ShadeArgs, things: &mut Things, console: &mut Console) -> Result<Vec<Under>> {
    let asked =
        Asked { name: &args.world, from: args.from.clone(), frames: args.frames.clone(), missing: args.missing };
    let proxy =
        args.proxy.map(|walls| Proxy { centre: args.centre.map_or([0.0; 3], |point| point.0).into(), walls: walls.0 });
    let main =
        Under { name: args.world.clone(), input: WorldInput::check(asked, args, console)?, proxy, is_partial: false };
    let mut worlds = vec![main];
    for world in &things.worlds {
        worlds.push(of_file(world, args, console)?);
    }
    for part in &args.part {
        let world = Name::from(&part.world);
        let known = worlds.iter().position(|under| under.name == world);
        let number = known.unwrap_or(worlds.len());
        if known.is_none() {
            let input = WorldInput::check(Asked::of(&world, None, args), args, console)?;
            worlds.push(Under { name: world, input, proxy: None, is_partial: false });
        }
        give(things, &part.name, number)?;
    }
    if let Some(name) = &args.backdrop {
        worlds.push(backdrop(name, args, console)?);
    }
    Ok(worlds)
}

/// Finds the files of the world that is seen behind the things.
fn backdrop(name: &Name, args: &ShadeArgs, console: &mut Console) -> Result<Under> {
    let asked = Asked::of(name, args.backdrop_from.clone(), args);
    if asked.is_none() {
        return Err(usage("--backdrop: none is no world; name one, or give --background black"));
    }
    let empty = Asked { missing: Missing::Fill(Rgba::TRANSPARENT), ..asked.clone() };
    // Of directions that it does not show, the picture may show none: that is checked when it is made.
    let (input, is_partial) = match WorldInput::check(asked, args, console) {
        Err(error) if is_uncovered(&error) => (WorldInput::check(empty, args, console), true),
        checked => (checked, false),
    };
    let input = input.map_err(|error| of_backdrop(&error))?;
    Ok(Under { name: name.clone(), input, proxy: None, is_partial })
}

/// Returns whether a world does not show all directions.
fn is_uncovered(error: &Error) -> bool {
    error.downcast_ref::<ConvertError>().is_some_and(|error| error.code() == Code::Uncovered)
}

/// Returns an error about an input as one about the backdrop.
fn of_backdrop(error: &Error) -> Error {
    let option = |setting: Setting| match setting {
        Setting::From => "--backdrop-from".to_owned(),
        other => format!("--{}", other.name()),
    };
    match error.downcast_ref::<ConvertError>() {
        Some(found) => of_kind(found.is_of_settings(), found.message().render(option)),
        None => usage(format!("--backdrop: {error}")),
    }
}

/// Makes an error of usage, or one of a file.
fn of_kind(is_usage: bool, message: String) -> Error {
    let message = format!("--backdrop: {message}");
    if is_usage { usage(message) } else { Error::msg(message) }
}

fn of_file(world: &NamedWorld, args: &ShadeArgs, console: &mut Console) -> Result<Under> {
    let spec = |spec: &Located| -> Result<Spec> {
        spec.value.parse().map_err(|error| anyhow!("{}: spec = \"{}\": {error}", spec.place, spec.value))
    };
    let from = world.spec.as_ref().map(spec).transpose()?;
    let name = Name::from(&world.image.value);
    let asked = Asked::of(&name, from, args);
    let placed = |error| anyhow!("{}: {}", world.image.place, message(&error));
    let input = WorldInput::check(asked, args, console).map_err(placed)?;
    Ok(Under { name, input, proxy: world.proxy, is_partial: false })
}

/// Puts the things of a name under a world.
fn give(things: &mut Things, name: &str, number: usize) -> Result<()> {
    let mut count = 0;
    for part in things.scene.parts_mut().filter(|part| part.name == name) {
        part.world = number;
        count += 1;
    }
    if count > 0 {
        return Ok(());
    }
    let names: Vec<&str> = things.scene.parts().map(|part| part.name.as_str()).collect();
    let meant = did_you_mean(name, &names);
    Err(usage(format!("--part: there is no '{name}'; there is {}{meant}", names.join(", "))))
}

/// Reads worlds, or renders them.
pub(super) fn read(worlds: &[Under], console: &Console) -> Result<Vec<Radiance>> {
    let read: Vec<Radiance> = worlds.iter().map(|world| world.input.read(console)).collect::<Result<_>>()?;
    match read.iter().position(|world| !world.primaries.is_same(&read[0].primaries)) {
        None => Ok(read),
        Some(other) => Err(anyhow!(
            "{} and {} have other primaries; convert one to those of the other first, with convert --primaries",
            worlds[0].name,
            worlds[other].name
        )),
    }
}

/// Lists the files of all worlds, by their real paths.
pub(super) fn files(worlds: &[Under]) -> impl Iterator<Item = PathBuf> {
    worlds.iter().filter_map(|world| world.input.files()).flatten().cloned()
}
