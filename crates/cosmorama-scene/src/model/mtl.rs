//! Materials of Wavefront OBJ.

use std::collections::{BTreeSet, HashMap};

use super::obj::{keyed, numbers};
use crate::material::{Finish, Material, Paint};

/// Materials of a library, by their names.
pub(super) struct Library {
    pub(super) materials: HashMap<String, Material>,
    /// Keys that change what a material looks like, and are not read.
    pub(super) ignored: BTreeSet<String>,
}

/// A material of a file.
#[derive(Clone, Copy)]
struct Entry {
    diffuse: [f64; 3],
    specular: [f64; 3],
    emissive: [f64; 3],
    shininess: f64,
}

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
        let materials = entries.into_iter().map(|(name, entry)| (name, entry.material())).collect();
        Ok(Self { materials, ignored })
    }
}

impl Default for Entry {
    /// Returns a material of which nothing is said: light grey, as in Blender.
    fn default() -> Self {
        Self { diffuse: [0.8; 3], specular: [0.0; 3], emissive: [0.0; 3], shininess: 0.0 }
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
        let into = match key {
            "Kd" => &mut self.diffuse,
            "Ks" => &mut self.specular,
            "Ke" => &mut self.emissive,
            "Ns" => {
                [self.shininess] = numbers(text)?;
                return Ok(true);
            }
            // Opaque is what all are.
            "d" => return Ok(numbers(text).is_ok_and(|[part]: [f64; 1]| part == 1.0)),
            "Tr" => return Ok(numbers(text).is_ok_and(|[part]: [f64; 1]| part == 0.0)),
            _ => return Ok(false),
        };
        let found = colour(text)?;
        *into = found.unwrap_or(*into);
        Ok(found.is_some())
    }

    /// Returns the metallic-roughness that is nearest: metal if it reflects more than an insulator can, with an α by
    /// which GGX's lobe has the width of Blinn and Phong's, √(2/(n + 2)).
    fn material(&self) -> Material {
        /// Greatest part of light that insulators reflect straight on.
        const INSULATOR: f64 = 0.16;
        const USUAL: f64 = 0.04;
        let strongest = self.specular.into_iter().fold(0.0, f64::max);
        let roughness = (2.0 / (self.shininess.max(0.0) + 2.0)).sqrt().sqrt();
        let is_metal = strongest > INSULATOR && strongest > self.diffuse.into_iter().fold(0.0, f64::max);
        Material::of(Finish {
            base: Paint::plain(if is_metal { self.specular } else { self.diffuse }),
            metallic: if is_metal { 1.0 } else { 0.0 },
            roughness,
            emissive: Paint::plain(self.emissive),
            specular: (strongest / USUAL).min(1.0),
            ..Finish::default()
        })
    }
}
