use std::collections::BTreeSet;
use std::str::FromStr;

use cosmorama::raster::Rgba;
use cosmorama_scene::{Chrome, Finish, Material, Paint};
use cosmorama_spec::{Colour, nearest};

/// Name of a material, or the numbers of one; `None` for those of a model's file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MaterialName(pub(crate) Option<Material>);

/// Numbers of metallic-roughness, as glTF names them.
const KEYS: [&str; 6] = ["metallic", "roughness", "color", "emissive", "ior", "specular"];

impl MaterialName {
    /// Names for help and completions.
    pub(crate) const NAMES: [(&'static str, &'static str); 7] = [
        ("mirror", "reflects all light: dc 0, sc 1"),
        ("matte", "scatters all light: dc 1, sc 0"),
        ("mixed", "half of both: dc 0.5, sc 0.5"),
        ("glass", "reflects and refracts; --ior is its index"),
        ("chrome", "reflects a table of colours by elevation; --chrome is the table"),
        ("own", "a model's own materials, with their pictures"),
        ("metallic=1,roughness=0.3,color=#ffcc66", "glTF's metal and insulators; also emissive, ior, specular"),
    ];

    /// Returns whether it is chrome.
    pub(crate) fn is_chrome(&self) -> bool {
        self.0.as_ref().is_some_and(|material| material.chrome.is_some())
    }
}

impl FromStr for MaterialName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let material = match text {
            "mirror" => Material::MIRROR,
            "matte" | "matt" | "diffuse" => Material::MATTE,
            "mixed" => Material::MIXED,
            "glass" => Material::GLASS,
            "chrome" => Material::chrome(Chrome::earth_and_sky()),
            "own" => return Ok(Self(None)),
            _ if text.contains('=') => Material::of(finish(text)?),
            _ => {
                return Err("expected own, or mirror, matte, mixed, glass or chrome, which --dc, --sc and --alpha change, or numbers, as in metallic=1,roughness=0.3,color=#ffcc66".to_owned());
            }
        };
        material.check().map_err(|error| error.to_string())?;
        Ok(Self(Some(material)))
    }
}

/// Reads the numbers of metallic-roughness; those that are not given are those of a white insulator of middle roughness.
fn finish(text: &str) -> Result<Finish, String> {
    let mut finish = Finish { roughness: 0.5, ..Finish::default() };
    let mut known = BTreeSet::new();
    for part in text.split(',') {
        let (key, value) =
            part.split_once('=').ok_or_else(|| format!("'{part}' is not KEY=VALUE, as in metallic=1"))?;
        if !known.insert(key.trim()) {
            return Err(format!("'{}' is given twice", key.trim()));
        }
        let number = || value.parse::<f64>().map_err(|_| format!("{key}: '{value}' is not a number"));
        match key.trim() {
            "metallic" => finish.metallic = number()?,
            "roughness" => finish.roughness = number()?,
            "color" | "colour" => finish.base = Paint::plain(colour(value)?),
            "emissive" => finish.emissive = Paint::plain(colour(value)?),
            "ior" => finish.index = number()?,
            "specular" => finish.specular = number()?,
            other => {
                let meant = nearest(other, &KEYS).map_or_else(String::new, |meant| format!("; did you mean {meant}?"));
                return Err(format!("'{other}' is none of {}{meant}", KEYS.join(", ")));
            }
        }
    }
    Ok(finish)
}

/// Reads a colour; numbers are parted by colons, since commas part keys.
fn colour(text: &str) -> Result<[f64; 3], String> {
    let Rgba([red, green, blue, alpha]) = text.replace(':', ",").parse::<Colour>()?.0;
    if alpha == 1.0 { Ok([red, green, blue].map(f64::from)) } else { Err(format!("'{text}' is not opaque")) }
}
