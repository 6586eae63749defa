use cosmorama::lighting::{HarmonicPreset, RoughnessMap};

use crate::args::PresetName;

/// Conventions of an engine, and the files that it loads.
pub(super) struct Preset {
    /// SPEC of its cubes.
    pub(super) cube: &'static str,
    /// Yaw and pitch of its cubes, in degrees.
    pub(super) turn: [f64; 2],
    /// Roughness of the levels of a chain.
    pub(super) roughness: RoughnessMap,
    /// Binary logarithm of the size of faces in the last level.
    pub(super) last: u32,
    /// Files in order; {name} is the folder's own name.
    pub(super) parts: &'static [(&'static str, Part)],
}

/// Content of a file.
#[derive(Clone, Copy)]
pub(super) enum Part {
    /// A cube of the world as it is, with its smaller copies.
    Sky,
    /// A panorama of the world as it is.
    Panorama,
    /// A cube of what falls on matt surfaces, over π.
    Diffuse,
    /// A chain of roughness as a cube with mip levels.
    Specular,
    /// Such a chain that also carries harmonics, under the name `sh`.
    SpecularWith(HarmonicPreset),
    /// Nine coefficients of the light.
    Harmonics(HarmonicPreset),
    /// A table of what surfaces reflect.
    Table { multiscatter: bool },
    /// A text; {name} is the folder's own name.
    Text(&'static str),
}

/// Cube that a program looks up by a direction of which it negates one axis, or whose own frame is left-handed.
const LEFT_HANDED: &str = "cube";

/// Cube that a program looks up by directions of a right-handed frame as they are: pictures are mirrored.
const RIGHT_HANDED: &str = "cube:order=lrudfb,flip=x";

/// `libs/image/src/Ktx1Bundle.cpp` reads KTX of version 1 with harmonics under `sh`; `libs/filamentapp/src/IBL.cpp`,
/// `loadFromKtx`, looks for these two names. Shaders look up world directions as they are; cmgen mirrors panoramas for that, and puts
/// their middle at +z. Roughness is that of `perceptualRoughnessToLod` in `surface_light_indirect.fs`, over levels down to 16 pixels.
static FILAMENT: Preset = Preset {
    cube: RIGHT_HANDED,
    turn: [0.0, 0.0],
    roughness: RoughnessMap::Filament,
    last: 4,
    parts: &[
        ("{name}_skybox.ktx", Part::Sky),
        ("{name}_ibl.ktx", Part::SpecularWith(HarmonicPreset::Filament)),
        ("harmonics.json", Part::Harmonics(HarmonicPreset::Filament)),
        ("dfg.exr", Part::Table { multiscatter: true }),
        ("README.txt", Part::Text(include_str!("texts/filament.txt"))),
    ],
};

/// Khronos' glTF-Sample-Viewer, `source/Renderer/shaders/ibl.glsl`: directions as they are, roughness times the last level, E/π, a
/// table of scale and bias by n·v and roughness. Its sampler puts a panorama's middle at +x.
static GLTF: Preset = Preset {
    cube: RIGHT_HANDED,
    turn: [90.0, 0.0],
    roughness: RoughnessMap::Gltf,
    last: 4,
    parts: &[
        ("sky.ktx2", Part::Sky),
        ("diffuse.ktx2", Part::Diffuse),
        ("specular.ktx2", Part::Specular),
        ("lut_ggx.png", Part::Table { multiscatter: false }),
        ("README.txt", Part::Text(include_str!("texts/gltf.txt"))),
    ],
};

/// three.js r187: `WebGLMaterials.js` negates x for cubes that are loaded; `PMREMGenerator.lodToRoughness` is Filament's, down to 8
/// pixels; the last level, times π, is the light on matt surfaces. `equirectUv` puts a panorama's middle at +x.
static THREE: Preset = Preset {
    cube: LEFT_HANDED,
    turn: [90.0, 0.0],
    roughness: RoughnessMap::Filament,
    last: 3,
    parts: &[
        ("sky.ktx2", Part::Sky),
        ("specular.ktx2", Part::Specular),
        ("probe.json", Part::Harmonics(HarmonicPreset::Three)),
        ("dfg.exr", Part::Table { multiscatter: false }),
        ("light.js", Part::Text(include_str!("texts/three.js"))),
        ("README.txt", Part::Text(include_str!("texts/three.txt"))),
    ],
};

/// Bevy: `environment_map.wesl` and `skybox.wesl` negate z; roughness times the last level; E/π; its own dfg.ktx2 has scale and bias.
static BEVY: Preset = Preset {
    cube: LEFT_HANDED,
    turn: [0.0, 0.0],
    roughness: RoughnessMap::Squared,
    last: 3,
    parts: &[
        ("sky.ktx2", Part::Sky),
        ("diffuse.ktx2", Part::Diffuse),
        ("specular.ktx2", Part::Specular),
        ("dfg.ktx2", Part::Table { multiscatter: false }),
        ("README.txt", Part::Text(include_str!("texts/bevy.txt"))),
    ],
};

/// Godot: `sky.glsl` puts a panorama's middle at +z, and shaders look cubes up by directions as they are. Its images have all levels, down
/// to one pixel, or none.
static GODOT: Preset = Preset {
    cube: RIGHT_HANDED,
    turn: [0.0, 0.0],
    roughness: RoughnessMap::Squared,
    last: 0,
    parts: &[
        ("sky.exr", Part::Panorama),
        ("environment.tres", Part::Text(include_str!("texts/godot.tres"))),
        ("diffuse.dds", Part::Diffuse),
        ("specular.dds", Part::Specular),
        ("probe.json", Part::Harmonics(HarmonicPreset::Godot)),
        ("dfg.exr", Part::Table { multiscatter: false }),
        ("README.txt", Part::Text(include_str!("texts/godot.txt"))),
    ],
};

/// Unreal Engine: left-handed, +x ahead, +z up, so that +x and −x are drawn turned by a quarter (its documentation, *Creating
/// Cubemaps*). Roughness is that of reflection captures, over all levels.
static UNREAL: Preset = Preset {
    cube: LEFT_HANDED,
    turn: [-90.0, 90.0],
    roughness: RoughnessMap::Unreal,
    last: 0,
    parts: &[
        ("sky.hdr", Part::Panorama),
        ("sky.dds", Part::Sky),
        ("diffuse.dds", Part::Diffuse),
        ("specular.dds", Part::Specular),
        ("dfg.exr", Part::Table { multiscatter: false }),
        ("README.txt", Part::Text(include_str!("texts/unreal.txt"))),
    ],
};

impl Preset {
    /// Returns the conventions of an engine.
    pub(super) fn of(name: PresetName) -> &'static Self {
        match name {
            PresetName::Filament => &FILAMENT,
            PresetName::Gltf => &GLTF,
            PresetName::Three => &THREE,
            PresetName::Bevy => &BEVY,
            PresetName::Godot => &GODOT,
            PresetName::Unreal => &UNREAL,
        }
    }
}

/// Puts the folder's name in its place in a text.
pub(super) fn named(text: &str, name: &str) -> String {
    text.replace("{name}", name)
}
