use std::collections::HashSet;
use std::fs::File;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Error, Result, anyhow};
use cosmorama::filter::{Texture, Wrap};
use cosmorama::raster::{Image, Rgba, Transfer};
use cosmorama_convert::{MemoryBudget, real_path};
use cosmorama_io::{Limits, read, read_from};
use cosmorama_scene::{
    Chrome, Finish, Glass, Highlight, Material, MaterialError, Model, ModelCamera, ModelSettings, NamedWorld, Object,
    Paint, PictureKind, PictureReader, PictureSource, Refraction, Scene, SceneFile, SceneReader, Sphere,
};

use super::model::model;
use crate::args::{ObjectName, RefractName, ShadeArgs};
use crate::console::Console;
use crate::failure::usage;

/// Things under a world, as they were asked for.
pub(super) struct Things {
    pub(super) scene: Scene,
    /// The scene file, if they come from one.
    pub(super) file: Option<SceneFile>,
    /// Cameras that models' files have.
    pub(super) cameras: Vec<ModelCamera>,
    /// Other worlds that the scene file names.
    pub(super) worlds: Vec<NamedWorld>,
    /// Files that were read, by their real paths.
    pub(super) files: HashSet<PathBuf>,
    /// Memory of their triangles and pictures, at most.
    pub(super) bytes: u64,
}

impl Things {
    /// Returns the things that were asked for, with their pictures.
    pub(super) fn read(args: &ShadeArgs, console: &Console) -> Result<Self> {
        let budget = MemoryBudget::new(args.limits.memory);
        let whole = budget.bytes;
        let mut reader = Reader { console, budget, files: HashSet::new(), cameras: Vec::new() };
        let file = args.scene.as_deref().map(|path| scene_file(path, &mut reader)).transpose()?;
        let mut scene = match &file {
            Some(file) => file.scene(&mut reader)?,
            None => scene(args, &mut reader)?,
        };
        let worlds = file.as_ref().map_or_else(|| Ok(Vec::new()), SceneFile::worlds)?;
        let Reader { files, cameras, budget, .. } = reader;
        let bytes = whole.saturating_sub(budget.bytes);
        give_chrome(args, &mut scene)?;
        Ok(Self { scene, file, cameras, worlds, files, bytes })
    }
}

/// Reader of pictures and texts.
struct Reader<'a> {
    console: &'a Console,
    /// Memory that is left for more.
    budget: MemoryBudget,
    files: HashSet<PathBuf>,
    cameras: Vec<ModelCamera>,
}

impl PictureReader for Reader<'_> {
    fn picture(&mut self, source: PictureSource, kind: PictureKind) -> Result<Image<Rgba>, String> {
        let limits = Limits::memory(self.budget.bytes);
        let file = match source {
            PictureSource::File(path) => {
                self.files.insert(real_path(path));
                read(path, &limits)
            }
            PictureSource::Bytes(bytes) => read_from(Cursor::new(bytes), "a picture inside the file", &limits),
        };
        let file = file.map_err(|error| error.to_string())?;
        let transfer = match kind {
            PictureKind::Colour => file.transfer(),
            PictureKind::Numbers => Transfer::Linear,
        };
        let size = (file.image.width(), file.image.height());
        self.budget.check_picture(size).map_err(|error| error.to_string())?;
        self.spend(size.0 * size.1 * PIXEL_BYTES);
        // Colours and numbers are what they are, whatever alpha says of their place.
        Ok(file.image.without_alpha().to_light(&transfer))
    }
}

impl SceneReader for Reader<'_> {
    fn model(&mut self, path: &Path, settings: ModelSettings) -> Result<Object, String> {
        let settings = ModelSettings { most: self.most(), ..settings };
        self.read_model(path, &settings).map_err(|error| error.to_string())
    }

    fn tell(&mut self, path: &Path, note: &str) {
        self.console.warning(format_args!("{}: {note}", path.display()));
    }
}

/// Memory of a pixel of a picture on things, with its part of the pyramid.
const PIXEL_BYTES: usize = size_of::<Rgba>() * 4 / 3;

impl Reader<'_> {
    /// Returns the most triangles of another model.
    fn most(&self) -> usize {
        self.budget.count_of(Model::TRIANGLE_BYTES)
    }

    /// Sets memory aside for what was read.
    fn spend(&mut self, bytes: usize) {
        self.budget.bytes = self.budget.bytes.saturating_sub(bytes as u64);
    }

    fn read_model(&mut self, path: &Path, settings: &ModelSettings) -> Result<Object> {
        self.files.insert(real_path(path));
        let console = self.console;
        let model = model(path, settings, self, console)?;
        self.spend(model.kept_bytes());
        self.cameras.extend(model.cameras);
        Ok(model.object)
    }
}

fn scene_file(path: &Path, reader: &mut Reader) -> Result<SceneFile> {
    reader.files.insert(real_path(path));
    let mut bytes = Vec::new();
    // One byte more than may be read tells that there are more.
    let read = File::open(path).and_then(|file| file.take(SceneFile::LONGEST as u64 + 1).read_to_end(&mut bytes));
    read.map_err(|error| anyhow!("cannot open the scene file {}: {error}", path.display()))?;
    let text = String::from_utf8(bytes)
        .map_err(|_| anyhow!("{}: not a text; expected a scene file in TOML (docs/scenes.md)", path.display()))?;
    Ok(SceneFile::parse(path, &text)?)
}

/// Returns the things that options ask for.
fn scene(args: &ShadeArgs, reader: &mut Reader) -> Result<Scene> {
    let Some(asked) = &args.material.0 else { return own(args, reader) };
    if args.alpha.is_some() && asked.finish.is_some() {
        return Err(usage("--alpha: metallic-roughness has its own, as in --material roughness=0.5 for an α of 0.25"));
    }
    let material = Material {
        diffuse: args.dc.unwrap_or(asked.diffuse),
        specular: args.sc.unwrap_or(asked.specular),
        alpha: args.alpha.unwrap_or(asked.alpha),
        glass: glass(args, asked.glass)?,
        ..asked.clone()
    };
    material.check().map_err(|error| usage(format!("{}: {error}", option_of(&error))))?;
    let material = match &args.texture {
        Some(path) => textured(&material, path, args, reader)?,
        None => material,
    };
    if args.crease.is_some() && !matches!(args.object, ObjectName::Model(_)) {
        return Err(usage("--crease is for models; name one, as in --object teapot.obj"));
    }
    match &args.object {
        ObjectName::Sphere => Ok(Scene::sphere(material)),
        ObjectName::Spheres(_) if args.alpha.is_some() => {
            Err(usage("--alpha is for one sphere; those of spheres:N go from 1 to 0 by themselves"))
        }
        ObjectName::Spheres(count) => {
            Scene::spheres(*count, &material).map_err(|error| usage(format!("--object: {error}")))
        }
        ObjectName::Plate4 if material != Material::MIRROR => Err(usage(
            "plate4 has materials of its own: leave out --material, --texture, --dc, --sc, --alpha and options of glass",
        )),
        ObjectName::Plate4 => Ok(Scene::plate4()),
        ObjectName::Model(path) => {
            let settings =
                ModelSettings { crease: args.crease, material: Some(material), most: reader.most(), placing: None };
            Ok(Scene { objects: vec![reader.read_model(path, &settings)?] })
        }
    }
}

/// Returns a model with the materials of its file.
fn own(args: &ShadeArgs, reader: &mut Reader) -> Result<Scene> {
    let ObjectName::Model(path) = &args.object else {
        return Err(usage("--material own is for a model's file; name one, as in --object teapot.glb"));
    };
    let changes = [args.dc, args.sc, args.alpha].iter().any(Option::is_some) || args.texture.is_some();
    if changes || glass(args, None)?.is_some() {
        return Err(usage("--material own is what the file says: leave out --dc, --sc, --alpha and --texture"));
    }
    let settings = ModelSettings { crease: args.crease, material: None, most: reader.most(), placing: None };
    Ok(Scene { objects: vec![reader.read_model(path, &settings)?] })
}

/// Returns a material with a picture for its colour.
fn textured(material: &Material, path: &Path, args: &ShadeArgs, reader: &mut Reader) -> Result<Material> {
    let Some(finish) = material.paintable() else {
        return Err(usage(
            "--texture colours what is matt or metallic-roughness; add --material matte, or as in --material roughness=0.5",
        ));
    };
    let picture = reader.picture(PictureSource::File(path), PictureKind::Colour).map_err(Error::msg)?;
    let is_model = matches!(args.object, ObjectName::Model(_));
    let wrap = if is_model { [Wrap::Repeat; 2] } else { Sphere::wrap(Wrap::Repeat) };
    let map = Some(Arc::new(Texture::new(picture, wrap)));
    let base = Paint { map, ..finish.base.clone() };
    Ok(Material { finish: Some(Arc::new(Finish { base, ..finish })), ..material.clone() })
}

/// Returns the option that a number of a material comes from.
fn option_of(error: &MaterialError) -> &'static str {
    match error {
        MaterialError::Coefficient(_) => "--dc, --sc",
        MaterialError::Alpha(_) => "--alpha",
        MaterialError::Index(_) => "--ior",
        MaterialError::Absorption(_) => "--absorption",
        MaterialError::Surfaces(_) => "--surfaces",
        MaterialError::NotByElevation => "--chrome",
        MaterialError::Part(_) | MaterialError::Colour(_) | MaterialError::NormalScale(_) => "--material",
    }
}

/// Gives what is of chrome the table and the lights that options ask for, which are for nothing else. They go before those of a
/// scene file.
fn give_chrome(args: &ShadeArgs, scene: &mut Scene) -> Result<()> {
    if !scene.parts().any(|part| part.material.chrome.is_some()) {
        let message = match args.scene {
            Some(_) => {
                "--chrome and --highlight are for chrome, and nothing in the scene file is of it; leave them out"
            }
            None => "--chrome and --highlight are for chrome; add --material chrome",
        };
        let is_given = args.chrome.is_some() || !args.highlight.is_empty();
        return if is_given { Err(usage(message)) } else { Ok(()) };
    }
    if args.alpha.is_some() || matches!(args.object, ObjectName::Spheres(_)) {
        return Err(usage("chrome is one smooth sphere: leave out --alpha and spheres:N"));
    }
    let table = args.chrome.as_ref().map(|table| Chrome::new(&table.0, Vec::new()));
    let table = table.transpose().map_err(|error| usage(format!("--chrome: {error}")))?;
    let lights: Arc<[Highlight]> = args.highlight.iter().map(|name| name.0).collect();
    for chrome in scene.parts_mut().filter_map(|part| part.material.chrome.as_mut()) {
        let lights = if lights.is_empty() { chrome.highlights() } else { &lights };
        *chrome = table.as_ref().unwrap_or(chrome).clone().with_highlights(Arc::clone(lights));
    }
    Ok(())
}

/// Returns the glass that was asked for; options of glass are for nothing else.
fn glass(args: &ShadeArgs, asked: Option<Glass>) -> Result<Option<Glass>> {
    let given = args.ior.is_some() || args.absorption.is_some() || args.refract.is_some() || args.surfaces.is_some();
    let Some(usual) = asked else {
        let message = "--ior, --absorption, --refract and --surfaces are for glass; add --material glass";
        return if given { Err(usage(message)) } else { Ok(None) };
    };
    let is_bent = args.refract == Some(RefractName::Bent);
    if is_bent && (args.absorption.is_some() || args.surfaces.is_some()) {
        let message = "--refract bent goes no further than the first surface: leave out --absorption and --surfaces";
        return Err(usage(message));
    }
    Ok(Some(Glass {
        index: args.ior.map_or(usual.index, |index| index.0),
        absorption: args.absorption.map_or(usual.absorption, |absorption| absorption.0),
        refraction: if is_bent { Refraction::Bent } else { Refraction::Traced },
        surfaces: args.surfaces.unwrap_or(usual.surfaces),
        ..usual
    }))
}
