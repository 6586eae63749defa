use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use cosmorama::filter::{Texture, Wrap};
use cosmorama::lighting::TableAngle;
use cosmorama::raster::{Image, Rgba};
use cosmorama::sphere::Orientation;
use cosmorama_spec::colour_table_of_stops;

use super::error::{SceneFileError, Source};
use super::written::{Key, Kind, MaterialEntry, WrapName, place, value};
use crate::material::{
    Chrome, Finish, Glass, Material, MaterialError, NormalMap, Paint, PictureKind, PictureReader, PictureSource,
};
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
        let usual = match self.kind {
            Some(Kind::Mirror) => Material::MIRROR,
            Some(Kind::Matte) => Material::MATTE,
            Some(Kind::Mixed) => Material::MIXED,
            Some(Kind::Glass) => Material::GLASS,
            Some(Kind::Chrome) => Material::chrome(self.table(source)?),
            Some(Kind::Metallic) | None => Material::of(Finish { roughness: ROUGHNESS, ..Finish::default() }),
        };
        if let Some((at, message)) = self.misplaced(&usual) {
            return Err(source.error(Some(at), message));
        }
        let finish = match usual.paintable() {
            Some(found) if self.is_painted() || usual.finish.is_some() => {
                Some(Arc::new(self.finish(found, source, is_ball, reader)?))
            }
            _ => None,
        };
        let glass = usual.glass.map(|glass| Glass {
            index: value(&self.ior).map_or(glass.index, |ior| ior.by_colour()),
            absorption: value(&self.absorption).map_or(glass.absorption, |absorption| absorption.by_colour()),
            surfaces: value(&self.surfaces).unwrap_or(glass.surfaces),
            ..glass
        });
        let material = Material {
            diffuse: value(&self.dc).unwrap_or(usual.diffuse),
            specular: value(&self.sc).unwrap_or(usual.specular),
            alpha: value(&self.alpha).unwrap_or(usual.alpha),
            glass,
            finish,
            ..usual
        };
        let wrong = |error: MaterialError| source.error(self.key_of(&error).or(Some(at)), error.to_string());
        material.check().map_err(wrong)?;
        Ok(material)
    }

    /// Returns the table of chrome; that of earth and sky if none is given.
    fn table(&self, source: &Source) -> Result<Chrome, SceneFileError> {
        let Some(text) = &self.chrome else { return Ok(Chrome::earth_and_sky()) };
        let wrong = |why: String| source.error(Some(text.span()), format!("chrome = \"{}\": {why}", text.get_ref()));
        let table = colour_table_of_stops(text.get_ref(), (TableAngle::Elevation, Orientation::IDENTITY));
        Chrome::new(&table.map_err(wrong)?, Vec::new()).map_err(|error| wrong(error.to_string()))
    }

    /// Finds a key that is for other materials: its place, and what it is for.
    fn misplaced(&self, usual: &Material) -> Option<(Range<usize>, &'static str)> {
        let is_painted = usual.finish.is_some() || usual.paintable().is_some() && self.is_painted();
        let (is_glass, has_pictures) = (usual.glass.is_some(), self.pictures().any(Option::is_some));
        let is_grey = |[red, green, blue]: [f64; 3]| red == green && green == blue;
        let glassy = [place(&self.absorption), place(&self.surfaces)].into_iter().flatten().next();
        let rules = [
            (
                place(&self.normal_scale).filter(|_| self.normal_texture.is_none()),
                "normal_scale is for a normal_texture; name one",
            ),
            (
                place(&self.wrap).filter(|_| !has_pictures),
                "wrap is for pictures; name one, as in texture = \"map.png\"",
            ),
            (
                place(&self.chrome).filter(|_| usual.chrome.is_none()),
                "chrome is the table of chrome; add kind = \"chrome\"",
            ),
            (
                self.painted().filter(|_| usual.paintable().is_none()),
                "color, textures, metallic, roughness and specular are for the kinds matte and metallic",
            ),
            (glassy.filter(|_| !is_glass), "absorption and surfaces are for the kind glass"),
            (place(&self.ior).filter(|_| !is_glass && !is_painted), "ior is for the kinds glass and metallic"),
            (
                place(&self.ior).filter(|_| !is_glass && !value(&self.ior).is_some_and(|ior| is_grey(ior.by_colour()))),
                "ior is one number here; three are for the kind glass",
            ),
            (place(&self.alpha).filter(|_| is_painted), "alpha is the square of roughness here; give that"),
        ];
        rules.into_iter().find_map(|(at, message)| Some((at?, message)))
    }

    /// Returns the place of the number that is out of range.
    fn key_of(&self, error: &MaterialError) -> Option<Range<usize>> {
        let number = |keys: &[&Key<f64>], wrong: f64| {
            let is_it = |key: &&&Key<f64>| value(key).is_some_and(|found| found.to_bits() == wrong.to_bits());
            keys.iter().find(is_it).and_then(|key| place(key))
        };
        match error {
            MaterialError::Coefficient(wrong) => number(&[&self.dc, &self.sc], *wrong),
            MaterialError::Alpha(_) => place(&self.alpha),
            MaterialError::Index(_) => place(&self.ior),
            MaterialError::Absorption(_) => place(&self.absorption),
            MaterialError::Surfaces(_) => place(&self.surfaces),
            MaterialError::Part(wrong) => number(&[&self.metallic, &self.roughness, &self.specular], *wrong),
            MaterialError::NormalScale(_) => place(&self.normal_scale),
            MaterialError::Colour(_) => place(&self.color).or(place(&self.emissive)),
            MaterialError::NotByElevation => place(&self.chrome),
        }
    }

    /// Returns whether there is a number or a picture of metallic-roughness.
    fn is_painted(&self) -> bool {
        self.painted().is_some()
    }

    /// Returns the place of a number or a picture of metallic-roughness.
    fn painted(&self) -> Option<Range<usize>> {
        let numbers = [&self.metallic, &self.roughness, &self.specular].map(place);
        let colours = [&self.color, &self.emissive].map(place);
        numbers.into_iter().chain(colours).chain(self.pictures().map(place)).flatten().next()
    }

    fn pictures(&self) -> impl Iterator<Item = &Key<PathBuf>> {
        [&self.texture, &self.metal_texture, &self.emissive_texture, &self.normal_texture].into_iter()
    }

    fn finish(
        &self,
        usual: Finish,
        source: &Source,
        is_ball: bool,
        reader: &mut dyn PictureReader,
    ) -> Result<Finish, SceneFileError> {
        let across = value(&self.wrap).unwrap_or_default().wrap();
        let wrap = if is_ball { Sphere::wrap(across) } else { [across; 2] };
        let mut picture = |path: &Key<PathBuf>, kind: PictureKind| {
            let Some(path) = path else { return Ok(None) };
            let found = reader.picture(PictureSource::File(&source.folder().join(path.get_ref())), kind);
            found.map(Some).map_err(|message| source.error(Some(path.span()), message))
        };
        let map = |picture: Image<Rgba>| Arc::new(Texture::new(picture, wrap));
        let normals = picture(&self.normal_texture, PictureKind::Numbers)?;
        let emissive_map = picture(&self.emissive_texture, PictureKind::Colour)?.map(map);
        let dark = if emissive_map.is_some() { [1.0; 3] } else { usual.emissive.colour };
        let index = value(&self.ior).map_or(usual.index, |ior| ior.by_colour()[0]);
        Ok(Finish {
            base: Paint {
                colour: value(&self.color).map_or(usual.base.colour, |color| color.0),
                map: picture(&self.texture, PictureKind::Colour)?.map(map),
            },
            metallic: value(&self.metallic).unwrap_or(usual.metallic),
            roughness: value(&self.roughness).unwrap_or(usual.roughness),
            specular: value(&self.specular).unwrap_or(usual.specular),
            index,
            emissive: Paint { colour: value(&self.emissive).map_or(dark, |emissive| emissive.0), map: emissive_map },
            metal_map: picture(&self.metal_texture, PictureKind::Numbers)?.map(map),
            normal_map: normals.map(|normals| NormalMap::new(&normals, wrap, value(&self.normal_scale).unwrap_or(1.0))),
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
