use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use cosmorama::filter::{Texture, Wrap};
use cosmorama::raster::{Image, Rgba};
use toml::Spanned;

use super::error::{SceneFileError, Source};
use super::written::{Kind, MaterialEntry, WrapName};
use crate::material::{Finish, Glass, Material, NormalMap, Paint, PictureKind, PictureReader, PictureSource};
use crate::shape::Sphere;

/// Roughness of metallic-roughness, unless given.
const ROUGHNESS: f64 = 0.5;

impl MaterialEntry {
    /// Returns the material, with its pictures as a ball has them, or a model.
    pub(super) fn material(
        &self,
        at: Range<usize>,
        source: &Source,
        is_ball: bool,
        reader: &mut dyn PictureReader,
    ) -> Result<Material, SceneFileError> {
        let wrong = |message: &str| source.error(Some(at.clone()), message);
        if self.normal_scale.is_some() && self.normal_texture.is_none() {
            return Err(wrong("normal_scale is for a normal_texture; name one"));
        }
        if self.wrap.is_some() && self.pictures().all(Option::is_none) {
            return Err(wrong("wrap is for pictures; name one, as in texture = \"map.png\""));
        }
        let usual = match self.kind {
            Some(Kind::Mirror) => Material::MIRROR,
            Some(Kind::Matte) => Material::MATTE,
            Some(Kind::Mixed) => Material::MIXED,
            Some(Kind::Glass) => Material::GLASS,
            Some(Kind::Chrome) => Material::CHROME,
            Some(Kind::Metallic) | None => Material::of(Finish { roughness: ROUGHNESS, ..Finish::default() }),
        };
        let finish = match usual.paintable() {
            Some(found) if self.is_painted() || usual.finish.is_some() => {
                Some(Arc::new(self.finish(found, source, is_ball, reader)?))
            }
            None if self.is_painted() => {
                let message = "color, textures, metallic, roughness and specular are for the kinds matte and metallic";
                return Err(wrong(message));
            }
            _ => None,
        };
        let is_glass = usual.glass.is_some();
        if !is_glass && (self.absorption.is_some() || self.surfaces.is_some() || self.ior.is_some() && finish.is_none())
        {
            return Err(wrong("ior, absorption and surfaces are for the kind glass"));
        }
        if let (Some([red, green, blue]), true) = (self.ior.map(|ior| ior.by_colour()), finish.is_some())
            && (red != green || green != blue)
        {
            return Err(wrong("ior is one number here; three are for the kind glass"));
        }
        if self.alpha.is_some() && finish.is_some() {
            return Err(wrong("alpha is the square of roughness here; give that"));
        }
        let glass = usual.glass.map(|glass| Glass {
            index: self.ior.map_or(glass.index, |ior| ior.by_colour()),
            absorption: self.absorption.map_or(glass.absorption, |absorption| absorption.by_colour()),
            surfaces: self.surfaces.unwrap_or(glass.surfaces),
            ..glass
        });
        let material = Material {
            diffuse: self.dc.unwrap_or(usual.diffuse),
            specular: self.sc.unwrap_or(usual.specular),
            alpha: self.alpha.unwrap_or(usual.alpha),
            glass,
            finish,
            ..usual
        };
        material.check().map_err(|error| wrong(&error.to_string()))?;
        Ok(material)
    }

    /// Returns whether there is a number or a picture of metallic-roughness.
    fn is_painted(&self) -> bool {
        let numbers = [self.metallic, self.roughness, self.specular].iter().any(Option::is_some);
        let colours = self.color.is_some() || self.emissive.is_some();
        numbers || colours || self.pictures().any(|picture| picture.is_some())
    }

    fn pictures(&self) -> impl Iterator<Item = &Option<Spanned<PathBuf>>> {
        [&self.texture, &self.metal_texture, &self.emissive_texture, &self.normal_texture].into_iter()
    }

    fn finish(
        &self,
        usual: Finish,
        source: &Source,
        is_ball: bool,
        reader: &mut dyn PictureReader,
    ) -> Result<Finish, SceneFileError> {
        let across = self.wrap.unwrap_or_default().wrap();
        let wrap = if is_ball { Sphere::wrap(across) } else { [across; 2] };
        let mut picture = |path: &Option<Spanned<PathBuf>>, kind: PictureKind| {
            let Some(path) = path else { return Ok(None) };
            let found = reader.picture(PictureSource::File(&source.folder().join(path.get_ref())), kind);
            found.map(Some).map_err(|message| source.error(Some(path.span()), message))
        };
        let map = |picture: Image<Rgba>| Arc::new(Texture::new(picture, wrap));
        let normals = picture(&self.normal_texture, PictureKind::Numbers)?;
        let emissive_map = picture(&self.emissive_texture, PictureKind::Colour)?.map(map);
        let dark = if emissive_map.is_some() { [1.0; 3] } else { usual.emissive.colour };
        let index = self.ior.map_or(usual.index, |ior| ior.by_colour()[0]);
        Ok(Finish {
            base: Paint {
                colour: self.color.map_or(usual.base.colour, |color| color.0),
                map: picture(&self.texture, PictureKind::Colour)?.map(map),
            },
            metallic: self.metallic.unwrap_or(usual.metallic),
            roughness: self.roughness.unwrap_or(usual.roughness),
            specular: self.specular.unwrap_or(usual.specular),
            index,
            emissive: Paint { colour: self.emissive.map_or(dark, |emissive| emissive.0), map: emissive_map },
            metal_map: picture(&self.metal_texture, PictureKind::Numbers)?.map(map),
            normal_map: normals.map(|normals| NormalMap::new(&normals, wrap, self.normal_scale.unwrap_or(1.0))),
        })
    }
}

impl WrapName {
    fn wrap(self) -> Wrap {
        match self {
            Self::Repeat => Wrap::Repeat,
            Self::Mirror => Wrap::Mirror,
            Self::Clamp => Wrap::Clamp,
        }
    }
}
