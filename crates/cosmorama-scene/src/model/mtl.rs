//! Materials of Wavefront OBJ.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use std::sync::Arc;

use cosmorama::filter::{Texture, Wrap};
use cosmorama::raster::{Image, Rgba};

use super::file::beside;
use super::obj::{keyed, numbers};
use crate::material::{Finish, Material, NormalMap, Paint, PictureKind, PictureReader, PictureSource};

/// Materials of a library, by their names.
pub(super) struct Library {
    pub(super) materials: HashMap<String, Entry>,
    /// Keys that change what a material looks like, and are not read.
    pub(super) ignored: BTreeSet<String>,
}

/// A material of a file, without the content of its pictures.
#[derive(Clone, Default)]
pub(super) struct Entry {
    diffuse: Option<[f64; 3]>,
    specular: [f64; 3],
    emissive: Option<[f64; 3]>,
    shininess: f64,
    colours: Option<Map>,
    glow: Option<Map>,
    bumps: Option<Map>,
}

/// A picture as a line names it.
#[derive(Clone)]
struct Map {
    file: String,
    wrap: [Wrap; 2],
    /// Factor on bumps.
    factor: f64,
}

/// Options of pictures, with the greatest number of words behind each; those with numbers may have fewer.
const OPTIONS: [(&str, usize); 12] = [
    ("-blendu", 1),
    ("-blendv", 1),
    ("-bm", 1),
    ("-boost", 1),
    ("-cc", 1),
    ("-clamp", 1),
    ("-imfchan", 1),
    ("-mm", 2),
    ("-o", 3),
    ("-s", 3),
    ("-t", 3),
    ("-texres", 1),
];

/// Keys that say nothing of what is shown: comments, ambient light, models of illumination, and the index of glass.
const IDLE: [&str; 4] = ["#", "Ka", "illum", "Ni"];

impl Library {
    /// Reads the materials of a text. A fault comes with its line.
    pub(super) fn parse(text: &str) -> Result<Self, (usize, String)> {
        let (mut entries, mut name, mut ignored) = (HashMap::<String, Entry>::new(), None, BTreeSet::new());
        for (number, line) in text.lines().enumerate() {
            let Some((key, rest)) = keyed(line) else { continue };
            if key == "newmtl" {
                entries.insert(rest.to_owned(), Entry::default());
                name = Some(rest.to_owned());
            } else if let Some(entry) = name.as_ref().and_then(|name| entries.get_mut(name)) {
                let is_read = entry.read(key, rest).map_err(|why| (number + 1, why))?;
                let is_idle = IDLE.iter().any(|idle| key == *idle || key.starts_with('#'));
                if !is_read && !is_idle {
                    ignored.insert(key.to_owned());
                }
            }
        }
        Ok(Self { materials: entries, ignored })
    }
}

/// Reads a colour: one number for all, or three. `None` if it is a spectrum, or of CIE's X, Y and Z.
fn colour(text: &str) -> Result<Option<[f64; 3]>, String> {
    match text.split_ascii_whitespace().next() {
        Some("xyz" | "spectral") => Ok(None),
        _ if text.split_ascii_whitespace().count() == 1 => numbers(text).map(|[grey]| Some([grey; 3])),
        _ => numbers(text).map(Some),
    }
}

impl Entry {
    /// Reads a line of a material; false if what it says is not read.
    fn read(&mut self, key: &str, text: &str) -> Result<bool, String> {
        let found = match key {
            "Kd" | "Ks" | "Ke" => colour(text)?,
            "map_Kd" | "map_Ke" | "map_Bump" | "map_bump" | "bump" | "norm" => {
                let (map, is_whole) = Map::parse(text)?;
                let into = match key {
                    "map_Kd" => &mut self.colours,
                    "map_Ke" => &mut self.glow,
                    _ => &mut self.bumps,
                };
                *into = Some(map);
                return Ok(is_whole);
            }
            "Ns" => {
                [self.shininess] = numbers(text)?;
                return Ok(true);
            }
            // Opaque is what all are.
            "d" => return Ok(numbers(text).is_ok_and(|[part]: [f64; 1]| part == 1.0)),
            "Tr" => return Ok(numbers(text).is_ok_and(|[part]: [f64; 1]| part == 0.0)),
            _ => return Ok(false),
        };
        match key {
            "Kd" => self.diffuse = found.or(self.diffuse),
            "Ks" => self.specular = found.unwrap_or(self.specular),
            _ => self.emissive = found.or(self.emissive),
        }
        Ok(found.is_some())
    }

    /// Returns the metallic-roughness that is nearest, with the pictures of a folder: metal if it reflects more than an
    /// insulator can, with an α by which GGX's lobe has the width of Blinn and Phong's, √(2/(n + 2)).
    pub(super) fn material(&self, folder: &Path, pictures: &mut dyn PictureReader) -> Result<Material, String> {
        /// Greatest part of light that insulators reflect straight on.
        const INSULATOR: f64 = 0.16;
        const USUAL: f64 = 0.04;
        /// Colour of which nothing is said: light grey, as in Blender; a picture is shown as it is.
        const GREY: [f64; 3] = [0.8; 3];
        let bare = if self.colours.is_some() { [1.0; 3] } else { GREY };
        let diffuse = self.diffuse.unwrap_or(bare);
        // Some programs write a picture of glow beside a colour that is black.
        let lit = self.emissive.filter(|colour| *colour != [0.0; 3]);
        let emissive = lit.unwrap_or(if self.glow.is_some() { [1.0; 3] } else { [0.0; 3] });
        let strongest = self.specular.into_iter().fold(0.0, f64::max);
        let roughness = (2.0 / (self.shininess.max(0.0) + 2.0)).sqrt().sqrt();
        let is_metal = strongest > INSULATOR && strongest > diffuse.into_iter().fold(0.0, f64::max);
        let mut paint = |colour: [f64; 3], map: &Option<Map>| {
            let texture = |map: &Map| {
                let picture = map.read(folder, PictureKind::Colour, pictures)?;
                Ok::<Arc<Texture>, String>(Arc::new(Texture::new(picture, map.wrap)))
            };
            Ok::<Paint, String>(Paint { colour, map: map.as_ref().map(texture).transpose()? })
        };
        let base = paint(if is_metal { self.specular } else { diffuse }, &self.colours)?;
        let emissive = paint(emissive, &self.glow)?;
        let bumps = self.bumps.as_ref().map(|map| {
            let picture = map.read(folder, PictureKind::Numbers, pictures)?;
            Ok::<NormalMap, String>(NormalMap::of_bumps(&picture, map.wrap, map.factor))
        });
        Ok(Material::of(Finish {
            base,
            metallic: if is_metal { 1.0 } else { 0.0 },
            roughness,
            emissive,
            normal_map: bumps.transpose()?,
            specular: (strongest / USUAL).min(1.0),
            ..Finish::default()
        }))
    }
}

impl Map {
    /// Reads options and the name of a file, which may have blanks in it; false if an option is not followed.
    fn parse(text: &str) -> Result<(Self, bool), String> {
        let mut map = Self { file: String::new(), wrap: [Wrap::Repeat; 2], factor: 1.0 };
        let (mut rest, mut is_whole) = (text.trim(), true);
        while let Some((option, most)) =
            OPTIONS.iter().find(|(option, _)| keyed(rest).is_some_and(|(key, _)| key == *option))
        {
            rest = keyed(rest).map_or("", |(_, rest)| rest);
            let mut values = Vec::new();
            while values.len() < *most {
                let Some((value, beyond)) = keyed(rest) else { break };
                if !values.is_empty() && value.parse::<f64>().is_err() {
                    break;
                }
                values.push(value);
                rest = beyond;
            }
            match (*option, values.as_slice()) {
                ("-clamp", ["on"]) => map.wrap = [Wrap::Clamp; 2],
                ("-clamp", ["off"]) => {}
                ("-bm", [factor]) => [map.factor] = numbers(factor)?,
                _ => is_whole = false,
            }
        }
        if rest.is_empty() {
            return Err(format!("expected the name of a picture, but found '{text}'"));
        }
        // Programs of Windows write its strokes.
        map.file = rest.replace('\\', "/");
        Ok((map, is_whole))
    }

    fn read(&self, folder: &Path, kind: PictureKind, pictures: &mut dyn PictureReader) -> Result<Image<Rgba>, String> {
        let path = beside(folder, &self.file).map_err(|why| format!("{} {why}", self.file))?;
        pictures.picture(PictureSource::File(&path), kind)
    }
}
