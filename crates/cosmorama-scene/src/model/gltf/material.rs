use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use cosmorama::filter::{Texture, Wrap};
use cosmorama::raster::{Image, Rgba};
use gltf::image::Source;
use gltf::texture::WrappingMode;

use super::buffers::{Buffers, Found};
use crate::material::{Finish, Material, NormalMap, Paint, PictureKind, PictureReader, PictureSource};
use crate::model::ModelFault;

/// Materials of a file, read once each with their pictures.
pub(super) struct Materials<'a> {
    buffers: &'a Buffers,
    folder: &'a Path,
    pictures: &'a mut dyn PictureReader,
    /// By number; the one without is that of parts that name none.
    read: HashMap<Option<usize>, Material>,
    textures: HashMap<(usize, PictureKind, [Wrap; 2]), Arc<Texture>>,
    normals: HashMap<(usize, [Wrap; 2]), NormalMap>,
}

impl<'a> Materials<'a> {
    pub(super) fn new(buffers: &'a Buffers, folder: &'a Path, pictures: &'a mut dyn PictureReader) -> Self {
        Self { buffers, folder, pictures, read: HashMap::new(), textures: HashMap::new(), normals: HashMap::new() }
    }

    /// Returns a material.
    pub(super) fn get(&mut self, material: &gltf::Material) -> Result<Material, ModelFault> {
        if let Some(read) = self.read.get(&material.index()) {
            return Ok(read.clone());
        }
        let made = self.make(material)?;
        self.read.insert(material.index(), made.clone());
        Ok(made)
    }

    fn make(&mut self, material: &gltf::Material) -> Result<Material, ModelFault> {
        let pbr = material.pbr_metallic_roughness();
        let [red, green, blue, _] = pbr.base_color_factor().map(f64::from);
        let mut map = |info: Option<gltf::texture::Info>, kind: PictureKind| {
            info.map(|info| self.texture(&info.texture(), kind)).transpose()
        };
        let base = Paint { colour: [red, green, blue], map: map(pbr.base_color_texture(), PictureKind::Colour)? };
        let metal_map = map(pbr.metallic_roughness_texture(), PictureKind::Numbers)?;
        let emissive = Paint {
            colour: material.emissive_factor().map(f64::from),
            map: map(material.emissive_texture(), PictureKind::Colour)?,
        };
        let normal = |normal: gltf::material::NormalTexture| {
            Ok::<NormalMap, ModelFault>(self.normals(&normal.texture())?.with_scale(normal.scale().into()))
        };
        let normal_map = material.normal_texture().map(normal).transpose()?;
        Ok(Material::of(Finish {
            base,
            metallic: pbr.metallic_factor().into(),
            roughness: pbr.roughness_factor().into(),
            metal_map,
            emissive,
            normal_map,
            ..Finish::default()
        }))
    }

    fn texture(&mut self, texture: &gltf::Texture, kind: PictureKind) -> Result<Arc<Texture>, ModelFault> {
        let (image, wrap) = (texture.source().index(), wrap(texture));
        if let Some(read) = self.textures.get(&(image, kind, wrap)) {
            return Ok(Arc::clone(read));
        }
        let made = Arc::new(Texture::new(self.picture(texture, kind)?, wrap));
        self.textures.insert((image, kind, wrap), Arc::clone(&made));
        Ok(made)
    }

    /// Reads a picture of normals, with a scale of 1.
    fn normals(&mut self, texture: &gltf::Texture) -> Result<NormalMap, ModelFault> {
        let key = (texture.source().index(), wrap(texture));
        if let Some(read) = self.normals.get(&key) {
            return Ok(read.clone());
        }
        let made = NormalMap::new(&self.picture(texture, PictureKind::Numbers)?, key.1, 1.0);
        self.normals.insert(key, made.clone());
        Ok(made)
    }

    /// Reads a picture: a part of a buffer, a text in the file, or a file beside it.
    fn picture(&mut self, texture: &gltf::Texture, kind: PictureKind) -> Result<Image<Rgba>, ModelFault> {
        let image = texture.source();
        let fault = |why: String| ModelFault::Piece { piece: format!("image {}", image.index()), why };
        let read = match image.source() {
            Source::View { view, .. } => {
                let bytes = self.buffers.view(&view).map_err(fault)?;
                self.pictures.picture(PictureSource::Bytes(bytes), kind)
            }
            Source::Uri { uri, .. } => match Found::of(uri, self.folder).map_err(fault)? {
                Found::Bytes(bytes) => self.pictures.picture(PictureSource::Bytes(&bytes), kind),
                Found::File(path) => self.pictures.picture(PictureSource::File(&path), kind),
            },
        };
        read.map_err(|error| fault(format!("cannot be read: {error}")))
    }
}

fn wrap(texture: &gltf::Texture) -> [Wrap; 2] {
    let sampler = texture.sampler();
    [sampler.wrap_s(), sampler.wrap_t()].map(|mode| match mode {
        WrappingMode::ClampToEdge => Wrap::Clamp,
        WrappingMode::MirroredRepeat => Wrap::Mirror,
        WrappingMode::Repeat => Wrap::Repeat,
    })
}

/// Lists the sets of texture coordinates that a material's pictures go by.
pub(super) fn sets(material: &gltf::Material) -> Vec<u32> {
    let pbr = material.pbr_metallic_roughness();
    let maps = [pbr.base_color_texture(), pbr.metallic_roughness_texture(), material.emissive_texture()];
    let set = |info: gltf::texture::Info| info.tex_coord();
    let normal = material.normal_texture().map(|normal| normal.tex_coord());
    maps.into_iter().flatten().map(set).chain(normal).collect()
}
