use anyhow::Result;
use cosmorama::resample::Filter;
use cosmorama_builtin::BuiltinWorld;

use super::{Input, Light, MemoryBudget, Outputs, Target, check_quality, filter};
use crate::args::ConvertArgs;
use crate::failure::{usage, warn};
use crate::spec::did_you_mean;

/// What a built-in input's name begins with.
const PREFIX: &str = "builtin:";

/// The built-in world that an input names; `None` where it names something else.
pub(crate) fn builtin(input: &str) -> Result<Option<BuiltinWorld>> {
    let Some(typed) = input.strip_prefix(PREFIX) else { return Ok(None) };
    let known = BuiltinWorld::ALL.map(BuiltinWorld::name);
    let unknown = || {
        let known_names = known.map(|name| format!("{PREFIX}{name}")).join(", ");
        usage(format!("unknown built-in world '{typed}'{}; there are {known_names}", did_you_mean(typed, &known)))
    };
    BuiltinWorld::ALL.into_iter().find(|world| world.name() == typed).map(Some).ok_or_else(unknown)
}

/// Pictures of a built-in world, ready to be made.
pub(crate) struct BuiltinJob {
    /// What they show.
    pub(crate) world: BuiltinWorld,
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
    pub(crate) fn resolve(world: BuiltinWorld, args: &ConvertArgs) -> Result<Self> {
        let memory = MemoryBudget::new(args.limits.memory);
        let mut warnings = Vec::new();
        let format = Target::check_names(&args.output, &args.geometry)?;
        check_quality(args, format)?;
        check_input_options(args)?;
        if filter(&args.geometry, &mut warnings) != Filter::DEFAULT {
            warnings.push(format!("--filter, --kernel and --anti-ringing have no effect on {}: a formula", args.input));
        }
        let target = Target::resolve(&args.output, &args.geometry, None)?;
        let files = Input { views: Vec::new(), frames: vec![None] };
        let light = Light::resolve(args, &files, &target, &mut warnings)?;
        memory.check_outputs(&target)?;
        let outputs = Outputs::plan(args, &files, &target, &light, memory)?;
        warnings.iter().for_each(|warning| warn(warning));
        Ok(Self { world, target, light, outputs, warnings })
    }
}

/// What speaks of files means nothing here.
fn check_input_options(args: &ConvertArgs) -> Result<()> {
    let given = [
        (args.geometry.from.is_some(), "--from", "it is a formula, with no projection of its own"),
        (args.frames.is_some(), "--frames", "it has none"),
        (args.in_transfer.is_some(), "--in-transfer", "it has no code values"),
    ];
    match given.into_iter().find(|(is_given, ..)| *is_given) {
        Some((_, option, why)) => {
            Err(usage(format!("{option} cannot be given for {}: {why}; leave {option} out", args.input)))
        }
        None => Ok(()),
    }
}
