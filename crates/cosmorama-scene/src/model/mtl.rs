//! Materials of Wavefront OBJ.

use std::collections::HashMap;

use super::obj::numbers;
use crate::material::{Finish, Material, Paint};

/// A material of a file.
#[derive(Clone, Copy, Default)]
struct Entry {
    diffuse: [f64; 3],
    specular: [f64; 3],
    emissive: [f64; 3],
    shininess: f64,
}

/// Reads the materials of a text, by their names. Pictures are not read: their number is returned, too.
pub(super) fn materials(text: &str) -> Result<(HashMap<String, Material>, usize), (usize, String)> {
    let (mut entries, mut name, mut pictures) = (HashMap::<String, Entry>::new(), None, 0);
    for (number, line) in text.lines().enumerate() {
        let Some(key) = line.split_ascii_whitespace().next() else { continue };
        let rest = line.trim_start()[key.len()..].trim();
        if key == "newmtl" {
            name = Some(rest.to_owned());
        }
        let Some(name) = &name else { continue };
        let entry = entries.entry(name.clone()).or_default();
        let at = |why: String| (number + 1, why);
        match key {
            "Kd" => entry.diffuse = numbers(rest).map_err(at)?,
            "Ks" => entry.specular = numbers(rest).map_err(at)?,
            "Ke" => entry.emissive = numbers(rest).map_err(at)?,
            "Ns" => entry.shininess = numbers(rest).map(|[number]| number).map_err(at)?,
            _ if key.starts_with("map_") => pictures += 1,
            _ => {}
        }
    }
    Ok((entries.into_iter().map(|(name, entry)| (name, entry.material())).collect(), pictures))
}

impl Entry {
    /// Returns the metallic-roughness that is nearest: metal if it reflects more than an insulator can, with an α by
    /// which GGX's lobe has the width of Phong's, √(2/(n + 2)).
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
