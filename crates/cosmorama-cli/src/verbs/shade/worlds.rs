use std::path::PathBuf;

use anyhow::{Error, Result, anyhow};
use cosmorama::raster::Rgba;
use cosmorama_convert::{Code, ConvertError, Name, Radiance};
use cosmorama_scene::{FileBackdrop, Located, NamedWorld, Proxy, SceneFile};
use cosmorama_spec::{Missing, Spec, did_you_mean};

use super::things::Things;
use super::world::{Asked, Whence, WorldInput};
use crate::args::ShadeArgs;
use crate::console::Console;
use crate::failure::usage;

/// A world that things stand under, checked but not read.
pub(super) struct Under {
    pub(super) name: Name,
    pub(super) input: WorldInput,
    pub(super) proxy: Option<Proxy>,
    /// Facts of the backdrop, if it is that.
    pub(super) behind: Option<Behind>,
}

/// A world that is seen behind the things.
pub(super) struct Behind {
    pub(super) whence: Whence,
    /// Whether it does not show all directions, and is empty there.
    pub(super) is_partial: bool,
}

/// Finds the files of all worlds: that of the picture, those of the scene file, and those of single parts, which the parts
/// are told of. The last is the backdrop, if there is one.
pub(super) fn worlds(args: &ShadeArgs, things: &mut Things, console: &mut Console) -> Result<Vec<Under>> {
    let asked = Asked { frames: args.frames.clone(), ..Asked::of(&args.world, args.from.clone(), args, Whence::World) };
    let proxy =
        args.proxy.map(|walls| Proxy { centre: args.centre.map_or([0.0; 3], |point| point.0).into(), walls: walls.0 });
    let main = Under { name: args.world.clone(), input: WorldInput::check(asked, args, console)?, proxy, behind: None };
    let mut worlds = vec![main];
    for world in &things.worlds {
        worlds.push(of_file(world, args, console)?);
    }
    for part in &args.part {
        let world = Name::from(&part.world);
        let known = worlds.iter().position(|under| under.name == world);
        let number = known.unwrap_or(worlds.len());
        if known.is_none() {
            let input = WorldInput::check(Asked::of(&world, None, args, Whence::World), args, console)?;
            worlds.push(Under { name: world, input, proxy: None, behind: None });
        }
        give(things, &part.name, number)?;
    }
    if let Some(wanted) = asked_backdrop(args, things)? {
        worlds.push(backdrop(wanted, args, console)?);
    }
    Ok(worlds)
}

/// The world that is to be seen behind the things.
struct AskedBackdrop {
    name: Name,
    from: Option<Spec>,
    whence: Whence,
}

/// Returns the backdrop that was asked for: by options, or by the scene file where no option says what is behind.
fn asked_backdrop(args: &ShadeArgs, things: &Things) -> Result<Option<AskedBackdrop>> {
    if let Some(name) = &args.backdrop {
        let from = args.backdrop_from.clone();
        return Ok(Some(AskedBackdrop { name: name.clone(), from, whence: Whence::Backdrop }));
    }
    let file = things.file.as_ref().and_then(SceneFile::backdrop).filter(|_| args.background.is_none());
    let asked = |FileBackdrop { image, spec }: FileBackdrop| {
        let from = spec.as_ref().map(parsed).transpose()?;
        Ok(AskedBackdrop { name: Name::from(&image.value), from, whence: Whence::File(image.place) })
    };
    file.map(asked).transpose()
}

/// Finds the files of the world that is seen behind the things.
fn backdrop(wanted: AskedBackdrop, args: &ShadeArgs, console: &mut Console) -> Result<Under> {
    let AskedBackdrop { name, from, whence } = wanted;
    let asked = Asked::of(&name, from, args, whence.clone());
    if asked.is_none() {
        return Err(whence.error(anyhow!("none is no world; name one, or give --background black")));
    }
    let empty = Asked { missing: Missing::Fill(Rgba::TRANSPARENT), ..asked.clone() };
    // Of directions that it does not show, the picture may show none: that is checked when it is made.
    let (input, is_partial) = match WorldInput::check(asked, args, console) {
        Err(error) if is_uncovered(&error) => (WorldInput::check(empty, args, console), true),
        checked => (checked, false),
    };
    let input = input.map_err(|error| whence.error(error))?;
    Ok(Under { name, input, proxy: None, behind: Some(Behind { whence, is_partial }) })
}

/// Returns whether a world does not show all directions.
fn is_uncovered(error: &Error) -> bool {
    error.downcast_ref::<ConvertError>().is_some_and(|error| error.code() == Code::Uncovered)
}

/// Reads a projection of the scene file.
fn parsed(spec: &Located) -> Result<Spec> {
    spec.value.parse().map_err(|error| anyhow!("{}: spec = \"{}\": {error}", spec.place, spec.value))
}

fn of_file(world: &NamedWorld, args: &ShadeArgs, console: &mut Console) -> Result<Under> {
    let from = world.spec.as_ref().map(parsed).transpose()?;
    let (name, whence) = (Name::from(&world.image.value), Whence::File(world.image.place.clone()));
    let asked = Asked::of(&name, from, args, whence.clone());
    let input = WorldInput::check(asked, args, console).map_err(|error| whence.error(error))?;
    Ok(Under { name, input, proxy: world.proxy, behind: None })
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
