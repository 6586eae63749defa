//! A scene file as written.

use std::collections::BTreeMap;
use std::path::PathBuf;

use cosmorama::raster::Rgba;
use cosmorama_spec::Colour;
use serde::Deserialize;
use toml::Spanned;

/// All of a file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Written {
    #[serde(default)]
    pub(super) camera: CameraEntry,
    #[serde(default)]
    pub(super) world: BTreeMap<String, WorldEntry>,
    #[serde(default)]
    pub(super) material: BTreeMap<String, Spanned<MaterialEntry>>,
    #[serde(default)]
    pub(super) object: Vec<Spanned<ObjectEntry>>,
}

/// The camera.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraEntry {
    pub(super) projection: Option<Spanned<String>>,
    pub(super) eye: Option<[f64; 3]>,
    pub(super) target: Option<[f64; 3]>,
    pub(super) size: Option<Spanned<String>>,
}

/// Another world.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WorldEntry {
    pub(super) image: Spanned<String>,
    pub(super) spec: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) centre: [f64; 3],
    pub(super) proxy: Option<Spanned<String>>,
}

/// A material: one with a name and coefficients, or metallic-roughness.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialEntry {
    pub(super) kind: Option<Kind>,
    pub(super) dc: Option<f64>,
    pub(super) sc: Option<f64>,
    pub(super) alpha: Option<f64>,
    pub(super) ior: Option<Numbers>,
    pub(super) absorption: Option<Numbers>,
    pub(super) surfaces: Option<usize>,
    pub(super) metallic: Option<f64>,
    pub(super) roughness: Option<f64>,
    pub(super) specular: Option<f64>,
    pub(super) color: Option<ColourText>,
    pub(super) emissive: Option<ColourText>,
    pub(super) texture: Option<Spanned<PathBuf>>,
    pub(super) metal_texture: Option<Spanned<PathBuf>>,
    pub(super) emissive_texture: Option<Spanned<PathBuf>>,
    pub(super) normal_texture: Option<Spanned<PathBuf>>,
    pub(super) normal_scale: Option<f64>,
    pub(super) wrap: Option<WrapName>,
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
    pub(super) name: Option<String>,
    pub(super) shape: Option<ShapeName>,
    /// A model's file.
    pub(super) file: Option<Spanned<PathBuf>>,
    /// Angle in degrees, as of `--crease`.
    pub(super) crease: Option<f64>,
    pub(super) material: Option<Spanned<String>>,
    pub(super) world: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) translate: [f64; 3],
    /// Yaw, pitch and roll, in degrees.
    #[serde(default)]
    pub(super) rotate: [f64; 3],
    pub(super) scale: Option<f64>,
}

/// Name of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum ShapeName {
    Sphere,
}
