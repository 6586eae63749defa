use std::path::PathBuf;
use std::str::FromStr;

use clap::ValueEnum;
use cosmorama::lighting::{ColourTable, TableAngle};
use cosmorama::raster::Rgba;
use cosmorama::sphere::Orientation;
use cosmorama_scene::{Highlight, MODEL_EXTENSIONS, Walls};
use cosmorama_spec::{Colour, Spec, SpecKind, colour_table_of_stops};

use crate::parse::listed::Listed;

/// Name of what stands under the world.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum ObjectName {
    Sphere,
    Spheres(usize),
    Plate4,
    /// A model's file.
    Model(PathBuf),
}

impl ObjectName {
    /// Names for help and completions.
    pub(crate) const NAMES: [(&'static str, &'static str); 4] = [
        ("sphere", "a sphere of radius 1"),
        ("spheres:5", "a row of spheres from rough to smooth"),
        ("plate4", "the paper's three spheres: matt, mixed, mirror"),
        ("model.obj", "a model's file"),
    ];
}

impl FromStr for ObjectName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(':') {
            None if text == "sphere" => Ok(Self::Sphere),
            None if text == "plate4" => Ok(Self::Plate4),
            _ if is_model(text) => Ok(Self::Model(text.into())),
            Some(("spheres", count)) => {
                let count = count.parse().ok().filter(|count| *count > 0);
                count.map(Self::Spheres).ok_or_else(|| "spheres needs a number, as in spheres:5".to_owned())
            }
            _ => Err(format!("expected sphere, spheres:N, plate4 or a file ({})", MODEL_EXTENSIONS.join(", "))),
        }
    }
}

fn is_model(text: &str) -> bool {
    let text = text.to_lowercase();
    MODEL_EXTENSIONS.iter().any(|extension| text.ends_with(extension))
}

/// Reads a camera.
pub(super) fn camera() -> Listed<CameraName> {
    let parallel = ("orthographic", "parallel rays; orthographic:height=H");
    let own = ("gltf", "a model's own camera, the first; gltf:NAME");
    Listed::new(SpecKind::all().map(|kind| (kind.name(), kind.about())).chain([parallel, own]))
}

/// Name of a camera: parallel rays, a projection of the library, or one of a model's.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum CameraName {
    /// Parallel rays; the picture's height in units of the scene, if given.
    Orthographic(Option<f64>),
    Lens(Box<Spec>),
    /// A camera of a model's file, by its name; the first without one.
    Model(Option<String>),
}

impl FromStr for CameraName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let height = |number: &str| number.parse().ok().filter(|height: &f64| height.is_finite() && *height > 0.0);
        match text.split_once(':') {
            None if text == "gltf" => Ok(Self::Model(None)),
            Some(("gltf", name)) if !name.is_empty() => Ok(Self::Model(Some(name.to_owned()))),
            None if text == "orthographic" => Ok(Self::Orthographic(None)),
            Some(("orthographic", keys)) => {
                let height = keys.strip_prefix("height=").and_then(height);
                height
                    .map(|height| Self::Orthographic(Some(height)))
                    .ok_or_else(|| "orthographic takes height=H, more than 0, as in orthographic:height=2.5".to_owned())
            }
            _ => text.parse().map(|spec| Self::Lens(Box::new(spec))).map_err(|error| format!("{error}")),
        }
    }
}

/// Three numbers, for red, green and blue, or one for all: `1.5`, `1.51:1.52:1.53`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ByColour(pub(crate) [f64; 3]);

impl FromStr for ByColour {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f64>> = text.split(':').map(|number| number.parse().ok()).collect();
        match numbers.as_deref() {
            Some([all]) => Ok(Self([*all; 3])),
            Some([red, green, blue]) => Ok(Self([*red, *green, *blue])),
            _ => Err("expected a number, or one for red, green and blue each, as in 1.51:1.52:1.53".to_owned()),
        }
    }
}

/// A table of chrome: colours at elevations in degrees, `-90=#201008;0=white;90=#102040`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ChromeTable(pub(crate) ColourTable);

impl FromStr for ChromeTable {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        colour_table_of_stops(text, (TableAngle::Elevation, Orientation::IDENTITY)).map(Self)
    }
}

/// A light that is a point, for chrome: `YAW:PITCH`, or `YAW:PITCH:POWER`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HighlightName(pub(crate) Highlight);

impl FromStr for HighlightName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f64>> = text.split(':').map(|number| number.trim().parse().ok()).collect();
        let (angles, power) = match numbers.as_deref() {
            Some([yaw, pitch]) => ([*yaw, *pitch], Highlight::USUAL_POWER),
            Some([yaw, pitch, power]) => ([*yaw, *pitch], *power),
            _ => return Err("expected YAW:PITCH in degrees, or YAW:PITCH:POWER, as in 30:50:300".to_owned()),
        };
        Highlight::new(angles, power).map(Self).map_err(|error| error.to_string())
    }
}

/// What is seen beside the things.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BackgroundName {
    World,
    Colour(Rgba),
}

impl FromStr for BackgroundName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "world" => Ok(Self::World),
            _ => {
                text.parse().map(|colour: Colour| Self::Colour(colour.0)).map_err(|error| format!("{error}, or world"))
            }
        }
    }
}

/// A point of the scene: `X,Y,Z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point(pub(crate) [f64; 3]);

impl FromStr for Point {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
        let point = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
        let is_point = |point: &[f64; 3]| point.iter().all(|number| number.is_finite());
        point.filter(is_point).map(Self).ok_or_else(|| "expected three numbers, as in 0,1.5,4".to_owned())
    }
}

/// A world for a part: `NAME=WORLD`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PartName {
    pub(crate) name: String,
    pub(crate) world: String,
}

impl FromStr for PartName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=').filter(|(name, world)| !name.is_empty() && !world.is_empty());
        let part = parts.map(|(name, world)| Self { name: name.to_owned(), world: world.to_owned() });
        part.ok_or_else(|| "expected NAME=WORLD, as in sphere2=room.hdr".to_owned())
    }
}

/// Walls of a near world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WallsName(pub(crate) Walls);

impl FromStr for WallsName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.parse().map(Self)
    }
}

/// Way of light in glass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum RefractName {
    /// From surface to surface
    Traced,
    /// Bent once, where it enters
    Bent,
}

/// What hides light from things.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum OcclusionName {
    /// Nothing
    None,
    /// Things, from what is matt
    Ambient,
}
