use std::collections::HashSet;
use std::path::PathBuf;

use anyhow::{Error, Result, anyhow};
use cosmorama::camera::{CameraModel, LayoutFaceCamera, Placement};
use cosmorama::raster::{Image, Primaries, Rgba};
use cosmorama::sphere::CubeFace;
use cosmorama::world::World;
use cosmorama_builtin::BuiltinWorld;
use cosmorama_convert::{Builtin, Conversion, ConvertError, GeometrySettings, Name, Radiance, Setting, WorldLight};
use cosmorama_io::FrameList;
use cosmorama_spec::{Missing, Spec};

use crate::args::{BackgroundName, ShadeArgs};
use crate::console::{Console, option};
use crate::failure::usage;
use crate::pipe::KeptStreams;

/// The world that things stand under, checked but not read.
pub(super) enum WorldInput {
    Files(Box<WorldLight>),
    Formula(BuiltinWorld),
    None,
}

/// Name of no world.
const NONE: &str = "none";

/// Edge of the faces by which a built-in world is held.
const EDGE: usize = 1024;

/// Place where a world was asked for.
#[derive(Clone)]
pub(super) enum Whence {
    /// By WORLD, or for a part.
    World,
    /// By `--backdrop`.
    Backdrop,
    /// By a scene file: its name, and the line.
    File(String),
}

impl Whence {
    /// Returns the name of a setting there.
    pub(super) fn setting(&self, setting: Setting) -> String {
        match (self, setting) {
            (Self::Backdrop, Setting::From) => "--backdrop-from".to_owned(),
            (Self::File(_), Setting::From) => "spec".to_owned(),
            _ => option(setting),
        }
    }

    /// Returns an error about the world, as one of what was written there.
    pub(super) fn error(&self, error: Error) -> Error {
        let found = error.downcast_ref::<ConvertError>();
        let text = || found.map_or_else(|| error.to_string(), |found| found.message().render(|of| self.setting(of)));
        match self {
            Self::World => error,
            Self::Backdrop if found.is_none_or(ConvertError::is_of_settings) => {
                usage(format!("--backdrop: {}", text()))
            }
            Self::Backdrop | Self::File(_) => self.failure(&text()),
        }
    }

    /// Returns an error that is none of usage.
    pub(super) fn failure(&self, message: &str) -> Error {
        match self {
            Self::World => anyhow!("{message}"),
            Self::Backdrop => anyhow!("--backdrop: {message}"),
            Self::File(place) => anyhow!("{place}: {message}"),
        }
    }
}

/// A world as it was asked for.
#[derive(Clone)]
pub(super) struct Asked<'a> {
    pub(super) name: &'a Name,
    pub(super) from: Option<Spec>,
    pub(super) frames: Option<FrameList>,
    pub(super) missing: Missing,
    pub(super) whence: Whence,
}

impl<'a> Asked<'a> {
    /// Asks for a world beside the one that things stand under.
    pub(super) fn of(name: &'a Name, from: Option<Spec>, args: &ShadeArgs, whence: Whence) -> Self {
        Self { name, from, frames: None, missing: args.missing, whence }
    }

    /// Returns whether no world is asked for.
    pub(super) fn is_none(&self) -> bool {
        **self.name == *NONE
    }
}

impl WorldInput {
    /// Finds the world's files and reads their headers.
    pub(super) fn check(asked: Asked, args: &ShadeArgs, console: &mut Console) -> Result<Self> {
        if asked.is_none() {
            return without(args);
        }
        match Builtin::named(asked.name)? {
            Some(Builtin::World(world)) if asked.from.is_none() && asked.frames.is_none() => Ok(Self::Formula(world)),
            Some(Builtin::World(_)) => {
                let from = match asked.whence {
                    Whence::World => "--from and --frames".to_owned(),
                    other => other.setting(Setting::From),
                };
                Err(usage(format!("{from} cannot be given for {}: a formula; leave that out", asked.name)))
            }
            Some(Builtin::DirectionMap(_)) => {
                Err(usage(format!("{} holds directions, but things need light; name a world", asked.name)))
            }
            None => Self::files_of(asked, args, console),
        }
    }

    fn files_of(asked: Asked, args: &ShadeArgs, console: &mut Console) -> Result<Self> {
        let mut kept = KeptStreams::default();
        let conversion = Conversion {
            input: kept.input(asked.name)?,
            geometry: GeometrySettings { from: asked.from, ..GeometrySettings::default() },
            transfer: args.transfer.clone(),
            missing: asked.missing,
            frames: asked.frames,
            limits: args.limits.clone().into(),
            ..Conversion::default()
        };
        let checked = conversion.files(kept.files()).check_light();
        console.tell_all_as(&checked, |setting| asked.whence.setting(setting));
        Ok(Self::Files(Box::new(checked.result?)))
    }

    /// Returns the files that are read, by their real paths, if any are.
    pub(super) fn files(&self) -> Option<&HashSet<PathBuf>> {
        match self {
            Self::Files(light) => Some(light.files()),
            Self::Formula(_) | Self::None => None,
        }
    }

    /// Reads the world, or renders it.
    pub(super) fn read(&self, console: &Console) -> Result<Radiance> {
        match self {
            Self::Files(light) => {
                let radiance = light.radiance()?;
                radiance.diagnostics.iter().for_each(|diagnostic| console.warn(diagnostic));
                Ok(radiance)
            }
            Self::Formula(world) => rendered(*world),
            Self::None => darkness(),
        }
    }
}

/// Checks that nothing needs a world.
fn without(args: &ShadeArgs) -> Result<WorldInput> {
    if args.scene.is_some() {
        return Err(usage("things of a scene file need a world; name one"));
    }
    if !args.material.is_chrome() || args.dc.unwrap_or(0.0) > 0.0 {
        return Err(usage("without a world there is only chrome: name a world, or give --material chrome and no --dc"));
    }
    if args.background.is_none_or(|background| background == BackgroundName::World) && args.backdrop.is_none() {
        return Err(usage(
            "without a world there is no background; add --background black, transparent or a --backdrop",
        ));
    }
    if args.from.is_some() || args.frames.is_some() {
        return Err(usage("--from and --frames are for a world, and there is none; leave them out"));
    }
    Ok(WorldInput::None)
}

/// Returns a world without light.
fn darkness() -> Result<Radiance> {
    let (world, light) = World::from_panorama(Image::filled(4, 2, Rgba::BLACK))?;
    Ok(Radiance { world, light, unseen: None, primaries: Primaries::REC709, diagnostics: Vec::new() })
}

/// Renders a built-in world onto the faces of a cube.
fn rendered(world: BuiltinWorld) -> Result<Radiance> {
    let camera = CameraModel::from(LayoutFaceCamera::default());
    let face = |face: CubeFace| {
        let placement = Placement { orientation: face.orientation(), ..Placement::new(camera.clone()) };
        let view = placement.view(EDGE, EDGE)?;
        let picture = world.picture(&view);
        Ok((face.name().to_owned(), view, picture))
    };
    let faces: Vec<_> = CubeFace::ALL.into_iter().map(face).collect::<Result<_>>()?;
    let (world, light) = World::from_pictures(faces)?;
    Ok(Radiance { world, light, unseen: None, primaries: Primaries::REC709, diagnostics: Vec::new() })
}
