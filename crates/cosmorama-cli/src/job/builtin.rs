use anyhow::Result;
use cosmorama::filter::Filter;
use cosmorama::raster::Depth;
use cosmorama_builtin::{BuiltinWorld, DirectionMap, Grid};
use cosmorama_io::Format;
use cosmorama_spec::{Missing, did_you_mean};

use super::input::SAME_FOR_BOTH;
use super::target::TargetView;
use super::{Input, Light, MemoryBudget, Outputs, Target, check_file_options, filter, settled};
use crate::args::ConvertArgs;
use crate::failure::{usage, warn};

/// What a built-in input's name begins with.
const PREFIX: &str = "builtin:";

/// The name of the map of directions, which is no world: its pixels are numbers.
const DIRECTION_MAP: &str = "direction-map";

/// What comes with the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Builtin {
    /// A world.
    World(BuiltinWorld),
    /// Where pixels look.
    DirectionMap(DirectionMap),
}

impl Builtin {
    /// What an input names; `None` where it names a file.
    pub(crate) fn named(input: &str) -> Result<Option<Self>> {
        let Some(typed) = input.strip_prefix(PREFIX) else { return Ok(None) };
        let (name, keys) = typed.split_once(':').map_or((typed, None), |(name, keys)| (name, Some(keys)));
        if name == DIRECTION_MAP {
            let footprint = match keys {
                None | Some("footprint=no") => false,
                Some("footprint=yes") => true,
                Some(keys) => {
                    return Err(usage(format!("{input}: expected footprint=yes or footprint=no, not {keys}")));
                }
            };
            return Ok(Some(Self::DirectionMap(DirectionMap { footprint })));
        }
        let Some(world) = BuiltinWorld::ALL.into_iter().find(|world| world.name() == name) else {
            return Err(unknown(name));
        };
        match keys {
            None => Ok(Some(Self::World(world))),
            Some(keys) => Err(usage(format!("{input}: {PREFIX}{name} takes no keys; leave :{keys} out"))),
        }
    }

    /// What it shows.
    pub(crate) fn about(self) -> &'static str {
        match self {
            Self::World(world) => world.about(),
            Self::DirectionMap(_) => "OpenEXR channels: where pixels look, and (:footprint=yes) its derivatives",
        }
    }

    /// All that can be named, with what they show.
    pub(crate) fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
        let worlds = BuiltinWorld::ALL.into_iter().map(|world| (world.name(), world.about()));
        worlds.chain([(DIRECTION_MAP, Self::DirectionMap(DirectionMap::default()).about())])
    }
}

fn unknown(name: &str) -> anyhow::Error {
    let known: Vec<&str> = Builtin::all().map(|(name, _)| name).collect();
    let listed: Vec<String> = known.iter().map(|name| format!("{PREFIX}{name}")).collect();
    let likely = did_you_mean(name, &known);
    usage(format!("unknown built-in world '{name}'{likely}; there are {}", listed.join(", ")))
}

/// Pictures of a built-in world, ready to be made.
pub(crate) struct BuiltinJob {
    /// What they show.
    pub(crate) builtin: Builtin,
    /// Where they go.
    pub(crate) target: Target,
    /// What they hold.
    pub(crate) light: Light,
    /// Those to be made.
    pub(crate) outputs: Outputs,
    /// What should be known.
    pub(crate) warnings: Vec<String>,
}

impl BuiltinJob {
    /// Resolves arguments and checks everything that can be checked before a pixel is made.
    pub(crate) fn resolve(builtin: Builtin, args: &ConvertArgs) -> Result<Self> {
        let memory = MemoryBudget::new(args.limits.memory);
        let mut warnings = Vec::new();
        let geometry = &settled(&args.geometry, None, memory, &mut warnings)?;
        let format = Target::check_names(&args.output, geometry)?;
        check_file_options(args, format)?;
        check_input_options(args)?;
        if filter(geometry, &mut warnings) != Filter::DEFAULT {
            warnings.push(format!("--filter, --kernel and --anti-ringing have no effect on {}: a formula", args.input));
        }
        let mut target = Target::resolve(&args.output, geometry, None)?;
        if args.mips {
            target = target.with_mips(&args.output, geometry)?;
        }
        if target.is_stereo() {
            warnings.push(SAME_FOR_BOTH.to_owned());
        }
        warnings.extend(super::told_of_shape(geometry, &target));
        let files = Input { worlds: Vec::new(), frames: vec![None], faces: None, beside: Vec::new() };
        let mut light = Light::resolve(args, &files, &target, &mut warnings)?;
        if let Builtin::DirectionMap(_) = builtin {
            check_map(args, format)?;
            // Halves turn a direction by as much as a pixel of a large picture.
            light.depth = args.depth.map_or(Depth::Float, Depth::from);
        }
        if builtin == Builtin::World(BuiltinWorld::Grid) {
            warnings.extend(without_letters(&target));
        }
        memory.check_outputs(&target)?;
        let outputs = Outputs::plan(args, &files, &target, &light, memory)?;
        warnings.extend(outputs.warning());
        warnings.iter().for_each(|warning| warn(warning));
        Ok(Self { builtin, target, light, outputs, warnings })
    }
}

/// What is to be said of a picture of the grid that is too coarse for its letters, those in its middle.
fn without_letters(target: &Target) -> Option<String> {
    let TargetView { name, view, .. } = target.views.first()?;
    Grid::width_for_letters(view).map(|enough| {
        let when = if enough <= WIDEST {
            format!("they show from a width of {enough} on")
        } else {
            "in this projection its middle is too small for any".to_owned()
        };
        let (width, height) = (view.width(), view.height());
        format!(
            "{name}: in {width}x{height} pixels the grid's letters would be too small to read, and are left out; {when}"
        )
    })
}

/// Nobody makes wider pictures for the sake of letters.
const WIDEST: usize = 1 << 15;

/// What speaks of files means nothing here.
fn check_input_options(args: &ConvertArgs) -> Result<()> {
    let given = [
        (args.geometry.from.is_some(), "--from", "it is a formula, with no projection of its own"),
        (args.frames.is_some(), "--frames", "it has none"),
        (args.in_transfer.is_some(), "--in-transfer", "it has no code values"),
        (args.missing != Missing::Error, "--missing", "it shows something in every direction"),
    ];
    match given.into_iter().find(|(is_given, ..)| *is_given) {
        Some((_, option, why)) => {
            Err(usage(format!("{option} cannot be given for {}: {why}; leave {option} out", args.input)))
        }
        None => Ok(()),
    }
}

/// A map of directions holds no colours.
fn check_map(args: &ConvertArgs, format: Format) -> Result<()> {
    if format != Format::Exr {
        return Err(usage(format!(
            "{} is {format}, but the numbers of {} go into named channels; name the output .exr",
            args.output, args.input
        )));
    }
    if args.resume {
        return Err(usage(format!(
            "--resume cannot tell whether a file of {} is complete; replace it with -y (--overwrite)",
            args.input
        )));
    }
    let is_transferred = args.transfer.fixed().is_some() || args.out_transfer.is_some();
    if args.background.is_some() || is_transferred {
        return Err(usage(format!(
            "--background, --transfer and --out-transfer are for light, but {} has none; leave them out",
            args.input
        )));
    }
    Ok(())
}
