use crate::material::{Finish, Material, Paint};

/// Returns a material by its numbers, without its pictures.
pub(super) fn material(material: &gltf::Material) -> Material {
    let pbr = material.pbr_metallic_roughness();
    let [red, green, blue, _] = pbr.base_color_factor().map(f64::from);
    Material::of(Finish {
        base: Paint::plain([red, green, blue]),
        metallic: pbr.metallic_factor().into(),
        roughness: pbr.roughness_factor().into(),
        emissive: Paint::plain(material.emissive_factor().map(f64::from)),
        ..Finish::default()
    })
}

/// Returns whether a material has pictures.
pub(super) fn has_pictures(material: &gltf::Material) -> bool {
    let pbr = material.pbr_metallic_roughness();
    pbr.base_color_texture().is_some()
        || pbr.metallic_roughness_texture().is_some()
        || material.normal_texture().is_some()
        || material.emissive_texture().is_some()
        || material.occlusion_texture().is_some()
}
