use cosmorama_builtin::{BuiltinWorld, DirectionMap};
use cosmorama_spec::did_you_mean;

use crate::diagnostic::{ConvertError, Result, usage};

/// What a built-in input's name begins with.
const PREFIX: &str = "builtin:";

/// The name of the map of directions, which is no world: its pixels are numbers.
const DIRECTION_MAP: &str = "direction-map";

/// What comes with the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Builtin {
    /// A world.
    World(BuiltinWorld),
    /// Where pixels look.
    DirectionMap(DirectionMap),
}

impl Builtin {
    /// What an input names; `None` where it names a file.
    pub fn named(input: &str) -> Result<Option<Self>> {
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
    pub fn about(self) -> &'static str {
        match self {
            Self::World(world) => world.about(),
            Self::DirectionMap(_) => "OpenEXR channels: where pixels look, and (:footprint=yes) its derivatives",
        }
    }

    /// All that can be named, with what they show.
    pub fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
        let worlds = BuiltinWorld::ALL.into_iter().map(|world| (world.name(), world.about()));
        worlds.chain([(DIRECTION_MAP, Self::DirectionMap(DirectionMap::default()).about())])
    }
}

fn unknown(name: &str) -> ConvertError {
    let known: Vec<&str> = Builtin::all().map(|(name, _)| name).collect();
    let listed: Vec<String> = known.iter().map(|name| format!("{PREFIX}{name}")).collect();
    let likely = did_you_mean(name, &known);
    usage(format!("unknown built-in world '{name}'{likely}; there are {}", listed.join(", ")))
}
