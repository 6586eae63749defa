use cosmorama_builtin::{BuiltinWorld, DirectionMap};
use cosmorama_spec::did_you_mean;

use crate::diagnostic::{ConvertError, Result, usage};

/// Prefix of a built-in input's name.
const PREFIX: &str = "builtin:";

/// Name of the map of directions, whose pixels are values, not light.
const DIRECTION_MAP: &str = "direction-map";

/// A built-in input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Builtin {
    /// A world.
    World(BuiltinWorld),
    /// A map of the directions of pixels.
    DirectionMap(DirectionMap),
}

impl Builtin {
    /// Returns the built-in input of a name; `None` if it names a file.
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

    /// Returns a line of help.
    pub fn about(self) -> &'static str {
        match self {
            Self::World(world) => world.about(),
            Self::DirectionMap(_) => "OpenEXR channels: where pixels look, and (:footprint=yes) its derivatives",
        }
    }

    /// Returns all names, with a line of help each.
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
