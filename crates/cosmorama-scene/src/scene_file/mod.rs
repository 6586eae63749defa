//! Scene files: things, materials, lights, worlds and a camera, in TOML.

mod check;
mod error;
mod material;
mod written;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use cosmorama::raster::{Image, Rgba};
use cosmorama::sphere::{Angle, Orientation};
use toml::Spanned;

use crate::material::{Chrome, Highlight, Material, PictureKind, PictureReader, PictureSource};
use crate::model::{ModelFault, ModelSettings, bare, coat};
use crate::scene::{Object, Scene};
use crate::shade::Proxy;
use crate::shape::{Placing, Shape, Sphere};

use error::Source;
use written::{Key, ObjectEntry, Written, value};

pub use error::SceneFileError;

/// A scene file: what stands under which worlds, and how it is seen.
///
/// ```
/// use std::path::Path;
///
/// use cosmorama::raster::{Image, Rgba};
/// use cosmorama_scene::{ModelSettings, Object, PictureKind, PictureReader, PictureSource, SceneFile, SceneReader};
///
/// /// A reader for files that name none.
/// struct Nothing;
///
/// impl PictureReader for Nothing {
///     fn picture(&mut self, _: PictureSource, _: PictureKind) -> Result<Image<Rgba>, String> {
///         Err("no pictures here".to_owned())
///     }
/// }
///
/// impl SceneReader for Nothing {
///     fn model(&mut self, _: &Path, _: ModelSettings) -> Result<Object, String> {
///         Err("no models here".to_owned())
///     }
///
///     fn tell(&mut self, _: &Path, _: &str) {}
/// }
///
/// let text = "[[object]]\nshape = 'sphere'\nmaterial = 'gold'\n[material.gold]\nmetallic = 1\ncolor = '#ffcc66'\n";
/// let file = SceneFile::parse("scene.toml", text)?;
/// let scene = file.scene(&mut Nothing)?;
/// assert_eq!(scene.objects.len(), 1);
///
/// let wrong = SceneFile::parse("scene.toml", &text.replace("metallic", "metalic")).unwrap_err();
/// assert!(wrong.to_string().starts_with("scene.toml, line 5: unknown key `metalic`"));
/// assert!(wrong.to_string().contains("did you mean 'metallic'?"));
/// # Ok::<(), cosmorama_scene::SceneFileError>(())
/// ```
#[derive(Clone, Debug)]
pub struct SceneFile {
    source: Source,
    written: Written,
}

/// Reader of the files that a scene file names.
pub trait SceneReader: PictureReader {
    /// Reads a model, of as many triangles as the reader allows.
    ///
    /// # Errors
    /// When it cannot be read; the reason is told behind the line that names it.
    fn model(&mut self, path: &Path, settings: ModelSettings) -> Result<Object, String>;

    /// Receives a note on a thing of a model that was read before.
    fn tell(&mut self, path: &Path, note: &str);
}

/// A world that a scene file names.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedWorld {
    /// Its name in the file.
    pub name: String,
    /// Its image or pattern.
    pub image: Located,
    /// Its projection, if it is given.
    pub spec: Option<Located>,
    /// Walls that stand for it, if it is near.
    pub proxy: Option<Proxy>,
}

/// World that a scene file has behind its things.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileBackdrop {
    /// Its image or pattern.
    pub image: Located,
    /// Its projection, if it is given.
    pub spec: Option<Located>,
}

/// Value of a key of a scene file, and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Located<T = String> {
    /// Value.
    pub value: T,
    /// File and line.
    pub place: String,
}

/// Camera of a scene file, as far as it is given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileCamera {
    /// Its projection.
    pub projection: Option<Located>,
    /// Place of its eye.
    pub eye: Option<Located<[f64; 3]>>,
    /// Point that it looks at.
    pub target: Option<Located<[f64; 3]>>,
    /// Size of its picture.
    pub size: Option<Located>,
}

/// Materials that are read, by their names, and whether a ball has them.
type Materials = BTreeMap<(String, bool), Material>;

/// Models that are read. Each is read and built once, however many things are of it, and wherever they stand.
#[derive(Default)]
struct Models {
    /// Models by their files, their creases, and whether their files' own materials were asked for: those name pictures.
    read: BTreeMap<(PathBuf, Option<u64>, bool), Object>,
    /// Notes that were told of them.
    told: BTreeSet<(PathBuf, String)>,
}

impl Models {
    /// Returns a model as a thing has it, with its material and at its place.
    fn model(
        &mut self,
        path: PathBuf,
        settings: ModelSettings,
        reader: &mut dyn SceneReader,
    ) -> Result<Object, String> {
        let key = (path, settings.crease.map(|crease| crease.radians().to_bits()), settings.material.is_none());
        let Some(known) = self.read.get(&key) else {
            let object = reader.model(&key.0, settings)?;
            self.told.extend(bare(&object).map(|note| (key.0.clone(), note)));
            self.read.insert(key, object.clone());
            return Ok(object);
        };
        let (mut object, path) = (known.clone(), key.0);
        if let Some(material) = &settings.material {
            coat(&mut object, material).map_err(|why: ModelFault| format!("{}: {why}", path.display()))?;
        }
        if let (Shape::Mesh(mesh), Some(placing)) = (&object.shape, &settings.placing) {
            object.shape = Shape::Mesh(Arc::new(mesh.placed(placing)));
        }
        if let Some(note) = bare(&object)
            && self.told.insert((path.clone(), note.clone()))
        {
            reader.tell(&path, &note);
        }
        Ok(object)
    }
}

/// A reader that reads nothing.
struct Unread;

impl PictureReader for Unread {
    fn picture(&mut self, _: PictureSource, _: PictureKind) -> Result<Image<Rgba>, String> {
        Ok(Image::filled(1, 1, Rgba::BLACK))
    }
}

impl SceneFile {
    /// Greatest length of a scene file in bytes: that of all the things that one may have.
    pub const LONGEST: usize = 16 << 20;

    /// Reads a scene file's text. Names of files in it are relative to its own folder.
    ///
    /// # Errors
    /// When it is longer than [`LONGEST`](Self::LONGEST), is no TOML, has an unknown key, or one of its things has a material or world that it does not have.
    pub fn parse(path: impl AsRef<Path>, text: &str) -> Result<Self, SceneFileError> {
        let source = Source { path: path.as_ref().to_owned(), text: text.to_owned() };
        if text.len() > Self::LONGEST {
            return Err(source.error(None, format!("more than {} bytes, which no scene file is", Self::LONGEST)));
        }
        let written: Written = toml::from_str(text).map_err(|error| source.malformed(&error))?;
        let file = Self { source, written };
        file.check()?;
        Ok(file)
    }

    /// Returns the camera.
    pub fn camera(&self) -> FileCamera {
        let camera = &self.written.camera;
        FileCamera {
            projection: self.located(&camera.projection),
            eye: self.located(&camera.eye),
            target: self.located(&camera.target),
            size: self.located(&camera.size),
        }
    }

    /// Returns the world that is seen behind the things, in place of the one that they stand under; `None` without a `[backdrop]`.
    pub fn backdrop(&self) -> Option<FileBackdrop> {
        let entry = self.written.backdrop.as_ref()?;
        Some(FileBackdrop { image: self.image(&entry.image), spec: self.located(&entry.spec) })
    }

    /// Lists the worlds of the file. Number 0 of the scene is the one beside it, and the first of these is number 1.
    ///
    /// # Errors
    /// When one has walls that there are none of.
    pub fn worlds(&self) -> Result<Vec<NamedWorld>, SceneFileError> {
        let named = |(name, entry): (&String, &written::WorldEntry)| {
            let walls = |text: &Spanned<String>| {
                let walls = text.get_ref().parse().map_err(|error: String| {
                    self.source.error(Some(text.span()), format!("proxy = \"{}\": {error}", text.get_ref()))
                })?;
                Ok(Proxy { centre: value(&entry.centre).unwrap_or_default().into(), walls })
            };
            self.check_point("centre", &entry.centre)?;
            Ok(NamedWorld {
                name: name.clone(),
                image: self.image(&entry.image),
                spec: self.located(&entry.spec),
                proxy: entry.proxy.as_ref().map(walls).transpose()?,
            })
        };
        self.written.world.iter().map(named).collect()
    }

    /// Returns the things, with the pictures and models that they name.
    ///
    /// # Errors
    /// When a material is out of range, or a file cannot be read.
    pub fn scene(&self, reader: &mut dyn SceneReader) -> Result<Scene, SceneFileError> {
        let (mut materials, mut models) = (Materials::new(), Models::default());
        let mut scene = Scene::default();
        for (index, entry) in self.written.object.iter().enumerate() {
            let entry = entry.get_ref();
            let named = |name: &Spanned<String>| (name.get_ref().clone(), entry.file.is_none());
            let wanted = entry.material.as_ref().map(named);
            let material = wanted.map(|wanted| self.material(wanted, &mut materials, reader)).transpose()?;
            let number = |wanted: &Spanned<String>| self.written.world.keys().position(|name| name == wanted.get_ref());
            let world = entry.world.as_ref().and_then(number).map_or(0, |index| index + 1);
            let mut object = match &entry.file {
                Some(file) => self.model(entry, (file, material), (&mut models, reader))?,
                None => {
                    let name = entry.name_of_sphere(index);
                    Object::sphere(entry.sphere(), material.unwrap_or_default()).named(name)
                }
            };
            object.parts.iter_mut().for_each(|part| part.world = world);
            scene.objects.push(object);
        }
        self.check_unused(&materials)?;
        Ok(scene)
    }

    /// Reads a model. Its parts keep the names that its file gives them, behind that of the whole.
    fn model(
        &self,
        entry: &ObjectEntry,
        (file, material): (&Spanned<PathBuf>, Option<Material>),
        (models, reader): (&mut Models, &mut dyn SceneReader),
    ) -> Result<Object, SceneFileError> {
        let crease = value(&entry.crease).map(Angle::from_degrees);
        let settings = ModelSettings { crease, material, most: usize::MAX, placing: Some(entry.placing()) };
        let found = models.model(self.source.folder().join(file.get_ref()), settings, reader);
        let thing = entry.name.as_ref().map_or_else(String::new, |name| format!("object '{}': ", name.get_ref()));
        let wrong = |message: String| self.source.error(Some(file.span()), format!("{thing}{message}"));
        let mut object = found.map_err(wrong)?;
        if let Some(name) = &entry.name {
            object.parts.iter_mut().for_each(|part| part.name = format!("{}/{}", name.get_ref(), part.name));
        }
        Ok(object)
    }

    /// Returns a material by its name, as a ball has it, or a model. Each is read once.
    fn material(
        &self,
        wanted: (String, bool),
        made: &mut Materials,
        reader: &mut dyn SceneReader,
    ) -> Result<Material, SceneFileError> {
        if let Some(made) = made.get(&wanted) {
            return Ok(made.clone());
        }
        let (name, is_ball) = &wanted;
        let mut material = match self.written.material.get(name) {
            Some(entry) => entry.get_ref().material(entry.span(), &self.source, *is_ball, reader)?,
            None => usual(name),
        };
        material.chrome = material.chrome.map(|chrome| chrome.with_highlights(self.lights()));
        made.insert(wanted, material.clone());
        Ok(material)
    }

    /// Checks the materials that no thing has. Their pictures are not read.
    fn check_unused(&self, used: &Materials) -> Result<(), SceneFileError> {
        let is_used = |name: &String| [false, true].iter().any(|ball| used.contains_key(&(name.clone(), *ball)));
        for (_, entry) in self.written.material.iter().filter(|(name, _)| !is_used(name)) {
            entry.get_ref().material(entry.span(), &self.source, false, &mut Unread)?;
        }
        Ok(())
    }

    /// Returns the lights that shine on chrome; those that are wrong were told before.
    fn lights(&self) -> Vec<Highlight> {
        self.written.light.iter().filter_map(|light| light.highlight().ok()).collect()
    }

    /// Returns the name of an image from the program's own folder.
    fn image(&self, image: &Spanned<String>) -> Located {
        Located { value: self.source.beside(image.get_ref()), place: self.source.place(Some(image.span())) }
    }

    fn located<T: Clone>(&self, key: &Key<T>) -> Option<Located<T>> {
        let located =
            |key: &Spanned<T>| Located { value: key.get_ref().clone(), place: self.source.place(Some(key.span())) };
        key.as_ref().map(located)
    }
}

/// Materials that need no entry.
const USUAL: [&str; 5] = ["mirror", "matte", "mixed", "glass", CHROME];
const CHROME: &str = "chrome";

/// Returns the material of a name that needs no entry.
fn usual(name: &str) -> Material {
    match name {
        "matte" => Material::MATTE,
        "mixed" => Material::MIXED,
        "glass" => Material::GLASS,
        CHROME => Material::chrome(Chrome::earth_and_sky()),
        _ => Material::MIRROR,
    }
}

impl ObjectEntry {
    /// Returns the name that it has as a sphere.
    fn name_of_sphere(&self, index: usize) -> String {
        self.name.as_ref().map_or_else(|| Object::numbered("sphere", index), |name| name.get_ref().clone())
    }

    fn placing(&self) -> Placing {
        let [yaw, pitch, roll] = value(&self.rotate).unwrap_or_default().map(Angle::from_degrees);
        Placing {
            scale: value(&self.scale).unwrap_or(1.0),
            turn: Orientation::from_yaw_pitch_roll(yaw, pitch, roll),
            origin: value(&self.translate).unwrap_or_default().into(),
        }
    }

    fn sphere(&self) -> Sphere {
        let Placing { scale, turn, origin } = self.placing();
        Sphere { orientation: turn, ..Sphere::new(origin, scale) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Part;
    use glam::DVec3;

    const FILE: &str = r##"
[camera]
projection = "perspective:fov=30"
eye = [0, 1, 8]

[world.room]
image = "room.hdr"
centre = [0, 1.5, 0]
proxy = "box:8,3,6"

[material.gold]
metallic = 1
roughness = 0.3
color = "#ffcc66"

[[object]]
name = "left"
shape = "sphere"
material = "gold"
translate = [-1, 0, 0.5]
scale = 0.5

[[object]]
shape = "sphere"
material = "glass"
world = "room"

[backdrop]
image = "hills.exr"
spec = "perspective:fov=60"
"##;

    struct Nothing;

    impl PictureReader for Nothing {
        fn picture(&mut self, _: PictureSource, _: PictureKind) -> Result<Image<Rgba>, String> {
            Err("no such picture".to_owned())
        }
    }

    impl SceneReader for Nothing {
        fn model(&mut self, path: &Path, settings: ModelSettings) -> Result<Object, String> {
            Err(format!("no such model: {} at {}", path.display(), settings.placing.unwrap().origin))
        }

        fn tell(&mut self, _: &Path, note: &str) {
            panic!("{note}");
        }
    }

    fn error(from: &str, to: &str) -> String {
        let text = FILE.replacen(from, to, 1);
        assert_ne!(text, FILE, "{from}");
        SceneFile::parse("a.toml", &text).and_then(|file| file.scene(&mut Nothing)).unwrap_err().to_string()
    }

    #[test]
    fn things_are_those_of_the_file() {
        let file = SceneFile::parse("a.toml", FILE).unwrap();
        let scene = file.scene(&mut Nothing).unwrap();
        let parts: Vec<&Part> = scene.parts().collect();
        let [left, right] = parts.as_slice() else { panic!("{parts:?}") };
        assert_eq!((left.name.as_str(), right.name.as_str()), ("left", "sphere2"));
        let ball = scene.objects[0].shape.ball();
        assert_eq!((ball.centre, ball.radius), (DVec3::new(-1.0, 0.0, 0.5), 0.5));
        assert_eq!(left.material.finish.as_ref().map(|finish| finish.roughness), Some(0.3));
        assert_eq!((left.world, right.world, &right.material), (0, 1, &Material::GLASS));
        let worlds = file.worlds().unwrap();
        assert_eq!(worlds[0].image, Located { value: "room.hdr".to_owned(), place: "a.toml, line 7".to_owned() });
        let centre = DVec3::new(0.0, 1.5, 0.0);
        assert_eq!(worlds[0].proxy.map(|proxy| proxy.centre), Some(centre));
        let eye = Located { value: [0.0, 1.0, 8.0], place: "a.toml, line 4".to_owned() };
        assert_eq!(file.camera().eye, Some(eye));
        let at = |value: &str, line: usize| Located { value: value.to_owned(), place: format!("a.toml, line {line}") };
        let backdrop = FileBackdrop { image: at("hills.exr", 29), spec: Some(at("perspective:fov=60", 30)) };
        assert_eq!(file.backdrop(), Some(backdrop));
    }

    #[test]
    fn mistakes_have_a_line_and_what_may_be_meant() {
        for (from, to, says) in [
            ("roughness", "rougness", &["line 13: unknown key `rougness`", "did you mean 'roughness'?"][..]),
            ("\"gold\"\n", "\"gould\"\n", &["line 19: there is no material 'gould'", "did you mean 'gold'?"]),
            ("\"room\"\n", "\"rom\"\n", &["line 26: there is no world 'rom'", "did you mean 'room'?"]),
            ("box:8,3,6", "box:8,3", &["line 9", "box:8,3", "box:X,Y,Z"]),
            ("\"#ffcc66\"", "\"beige\"", &["line 14", "'beige'", "#rrggbb"]),
            ("metallic = 1", "metallic = 2", &["line 12", "2 is outside 0 to 1"]),
            ("roughness = 0.3", "roughness = 3", &["line 13", "3 is outside 0 to 1"]),
            ("metallic = 1", "metallic = \"all\"", &["line 12", "a number"]),
            ("\"sphere\"", "\"ball\"", &["line 18", "unknown name `ball`", "sphere"]),
            ("scale = 0.5", "scale = 0", &["line 21: scale = 0", "more than 0"]),
            ("scale = 0.5", "scale = nan", &["scale = NaN"]),
            ("scale = 0.5", "scale = 1e308", &["line 21: scale = 1e308", "up to 1e30"]),
            ("metallic = 1", "texture = \"lost.png\"", &["line 12", "no such picture"]),
            ("metallic = 1", "kind = \"mirror\"", &["line 13", "matte and metallic"]),
            ("shape = \"sphere\"", "file = \"horse.obj\"", &["line 18", "no such model: horse.obj at [-1, 0, 0.5]"]),
            ("shape = \"sphere\"", "", &["line 16", "a file = \"model.obj\""]),
            ("scale = 0.5", "crease = 40", &["line 21", "crease", "of a model's file"]),
            ("[-1, 0, 0.5]", "[-1, inf, 0.5]", &["line 20", "translate"]),
            ("[0, 1.5, 0]", "[0, nan, 0]", &["line 8", "centre"]),
            ("[0, 1, 8]", "[0, 1, inf]", &["line 4", "eye"]),
            ("[0, 1, 8]", "[0, 1]", &["line 4"]),
            ("[camera]", "[camera", &["line 2"]),
            ("metallic = 1", "normal_scale = 2", &["line 12", "normal_texture"]),
            ("metallic = 1", "wrap = 'mirror'", &["line 12", "wrap is for pictures"]),
            ("metallic = 1", "ior = [1, 2, 3]", &["line 12", "ior is one number here"]),
            ("spec = ", "from = ", &["line 30: unknown key `from`", "expected `image` or `spec`"]),
            ("image = \"hills.exr\"\n", "", &["line 28", "image"]),
            ("image = \"hills.exr\"", "image = 3", &["line 29", "string"]),
            ("metallic = 1", "ior = 9", &["line 12", "9 is outside"]),
            ("metallic = 1", "alpha = 1", &["line 12", "alpha is the square"]),
            ("metallic = 1", "surfaces = 3", &["line 12", "for the kind glass"]),
            ("metallic = 1", "dc = -1", &["line 12", "a coefficient of -1"]),
            ("metallic = 1", "chrome = '0=red'", &["line 12", "kind = \"chrome\""]),
            ("\n[material.gold]", "\n[material.unused]\nmetallic = 3\n[material.gold]", &["3 is outside 0 to 1"]),
        ] {
            let error = error(from, to);
            assert!(error.starts_with("a.toml") && says.iter().all(|part| error.contains(part)), "{to}: {error}");
        }
        assert!(SceneFile::parse("a.toml", "").is_err_and(|error| error.to_string().contains("[[object]]")));
    }
}
