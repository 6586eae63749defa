//! A scene file as written.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use cosmorama::raster::Rgba;
use cosmorama_spec::Colour;
use serde::Deserialize;
use toml::Spanned;

/// A key that may be left out, with its place in the text.
pub(super) type Key<T> = Option<Spanned<T>>;

/// Returns what a key says.
pub(super) fn value<T: Copy>(key: &Key<T>) -> Option<T> {
    key.as_ref().map(|key| *key.get_ref())
}

/// Returns where a key is.
pub(super) fn place<T>(key: &Key<T>) -> Option<Range<usize>> {
    key.as_ref().map(Spanned::span)
}

/// All of a file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Written {
    #[serde(default)]
    pub(super) camera: CameraEntry,
    pub(super) backdrop: Option<BackdropEntry>,
    #[serde(default)]
    pub(super) world: BTreeMap<String, WorldEntry>,
    #[serde(default)]
    pub(super) material: BTreeMap<String, Spanned<MaterialEntry>>,
    #[serde(default)]
    pub(super) light: Vec<LightEntry>,
    #[serde(default)]
    pub(super) object: Vec<Spanned<ObjectEntry>>,
}

/// The camera.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraEntry {
    pub(super) projection: Key<String>,
    pub(super) eye: Key<[f64; 3]>,
    pub(super) target: Key<[f64; 3]>,
    pub(super) size: Key<String>,
}

/// World that is seen behind the things.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BackdropEntry {
    pub(super) image: Spanned<String>,
    pub(super) spec: Key<String>,
}

/// Another world.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WorldEntry {
    pub(super) image: Spanned<String>,
    pub(super) spec: Key<String>,
    pub(super) centre: Key<[f64; 3]>,
    pub(super) proxy: Key<String>,
}

/// A material: one with a name and coefficients, or metallic-roughness.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialEntry {
    pub(super) kind: Option<Kind>,
    pub(super) dc: Key<f64>,
    pub(super) sc: Key<f64>,
    pub(super) alpha: Key<f64>,
    pub(super) ior: Key<Numbers>,
    pub(super) absorption: Key<Numbers>,
    pub(super) surfaces: Key<usize>,
    /// Table of chrome, as of `--chrome`.
    pub(super) chrome: Key<String>,
    pub(super) metallic: Key<f64>,
    pub(super) roughness: Key<f64>,
    pub(super) specular: Key<f64>,
    pub(super) color: Key<ColourText>,
    pub(super) emissive: Key<ColourText>,
    pub(super) texture: Key<PathBuf>,
    pub(super) metal_texture: Key<PathBuf>,
    pub(super) emissive_texture: Key<PathBuf>,
    pub(super) normal_texture: Key<PathBuf>,
    pub(super) normal_scale: Key<f64>,
    pub(super) wrap: Key<WrapName>,
}

/// A light that is a point, for chrome.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightEntry {
    pub(super) yaw: Spanned<f64>,
    pub(super) pitch: Spanned<f64>,
    pub(super) power: Key<f64>,
    pub(super) color: Option<ColourText>,
}

/// Name of a material's kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    Mirror,
    Matte,
    Mixed,
    Glass,
    Chrome,
    Metallic,
}

/// Name of a way in which pictures go on beyond their edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum WrapName {
    #[default]
    Repeat,
    Mirror,
    Clamp,
}

/// One number for all colours, or one for each.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "expected a number, or three, as in [1.51, 1.52, 1.53]")]
pub(super) enum Numbers {
    One(f64),
    Three([f64; 3]),
}

impl Numbers {
    pub(super) fn by_colour(self) -> [f64; 3] {
        match self {
            Self::One(number) => [number; 3],
            Self::Three(numbers) => numbers,
        }
    }
}

/// A colour as text.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "String")]
pub(super) struct ColourText(pub(super) [f64; 3]);

impl TryFrom<String> for ColourText {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let colour: Colour = text.parse().map_err(|error| format!("'{text}': {error}"))?;
        let Rgba([red, green, blue, alpha]) = colour.0;
        if alpha == 1.0 { Ok(Self([red, green, blue].map(f64::from))) } else { Err(format!("'{text}' is not opaque")) }
    }
}

/// A thing.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectEntry {
    pub(super) name: Key<String>,
    pub(super) shape: Option<ShapeName>,
    /// A model's file.
    pub(super) file: Key<PathBuf>,
    /// Angle in degrees, as of `--crease`.
    pub(super) crease: Key<f64>,
    pub(super) material: Key<String>,
    pub(super) world: Key<String>,
    pub(super) translate: Key<[f64; 3]>,
    /// Yaw, pitch and roll, in degrees.
    pub(super) rotate: Key<[f64; 3]>,
    pub(super) scale: Key<f64>,
}

/// Name of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum ShapeName {
    Sphere,
}
