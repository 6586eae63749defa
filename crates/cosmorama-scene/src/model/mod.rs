//! Models: things that files describe.

mod camera;
mod error;
mod file;
mod gltf;
mod mtl;
mod obj;
mod polygon;

use std::path::Path;
use std::sync::Arc;

use cosmorama::sphere::Angle;

use crate::material::{Material, PictureReader};
use crate::scene::{Object, Part};
use crate::shape::{Face, Mesh, Normals, Placing, Shape};

pub use camera::{ModelCamera, ModelLens};
pub use error::{ModelError, ModelFault};

/// Extensions of the files that are read.
pub const EXTENSIONS: [&str; 3] = [".obj", ".gltf", ".glb"];

/// A thing that a file describes.
#[derive(Clone, Debug)]
pub struct Model {
    /// The thing: a mesh, and the parts that the file names.
    pub object: Object,
    /// The file's own cameras.
    pub cameras: Vec<ModelCamera>,
    /// Parts of the file that were left out, to be told.
    pub notes: Vec<String>,
}

/// Settings of a file's reading.
#[derive(Clone, Debug)]
pub struct ModelSettings {
    /// Greatest angle between faces over which normals are smooth; `None` takes the file's own normals, and
    /// makes those that it lacks.
    pub crease: Option<Angle>,
    /// Material of all parts; `None` takes the file's own.
    pub material: Option<Material>,
    /// Greatest number of triangles.
    pub most: usize,
    /// Place of all of it; `None` leaves it where the file has it.
    pub placing: Option<Placing>,
}

impl ModelSettings {
    /// Returns the greatest number of bytes of a file.
    fn most_bytes(&self) -> u64 {
        self.most.saturating_mul(Model::TRIANGLE_BYTES) as u64
    }

    /// Checks that so many triangles, of so many vertices, may be read.
    fn check_counts(&self, triangles: usize, vertices: usize) -> Result<(), ModelFault> {
        let count = triangles.max(vertices / 3);
        if count > self.most { Err(ModelFault::TooLarge { count, most: self.most }) } else { Ok(()) }
    }
}

/// Triangles and parts of a file.
#[derive(Debug)]
struct Contents {
    faces: Vec<Face>,
    parts: Vec<Part>,
    cameras: Vec<ModelCamera>,
    notes: Vec<String>,
    /// Crease of normals that the file lacks.
    crease: Angle,
    /// Whether some of its surfaces are meant to be seen from one side alone.
    is_one_sided: bool,
}

impl Contents {
    /// Returns a file of nothing.
    fn new(crease: Angle) -> Self {
        let (faces, parts, cameras, notes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { faces, parts, cameras, notes, crease, is_one_sided: false }
    }
}

impl Model {
    /// Memory of a triangle at most, while it is read: as a face twice, with its normals, coordinates, edges and tree.
    pub const TRIANGLE_BYTES: usize = 1500;

    /// Returns the memory that its triangles take, at most.
    pub fn kept_bytes(&self) -> usize {
        /// Memory of a triangle once it is read.
        const TRIANGLE: usize = 500;
        self.object.shape.mesh().map_or(0, |mesh| mesh.count() * TRIANGLE)
    }

    /// Reads a model, with the pictures of its materials.
    ///
    /// # Errors
    /// When the file or a picture cannot be read, is not as its extension says, or describes no surface.
    pub fn read(path: &Path, settings: &ModelSettings, pictures: &mut dyn PictureReader) -> Result<Self, ModelError> {
        read(path, settings, pictures).map_err(|why| ModelError { path: path.to_owned(), why })
    }
}

fn read(path: &Path, settings: &ModelSettings, pictures: &mut dyn PictureReader) -> Result<Model, ModelFault> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let Contents { faces, parts, mut cameras, mut notes, crease, is_one_sided } = match extension.as_deref() {
        Some("obj") => obj::read(path, settings, pictures)?,
        Some("gltf" | "glb") => gltf::read(path, settings, pictures)?,
        _ => return Err(ModelFault::Extension),
    };
    let normals = Normals { kept: settings.crease.is_none(), crease: settings.crease.unwrap_or(crease) };
    let mut mesh = Mesh::mended(faces, normals)?;
    if let Some(placing) = &settings.placing {
        mesh = mesh.placed(placing);
        cameras.iter_mut().for_each(|camera| *camera = camera.placed(placing));
    }
    if mesh.skipped() > 0 {
        notes.push(format!("{} triangles without area are left out", mesh.skipped()));
    }
    if mesh.turned() > 0 {
        notes.push(format!(
            "{} of {} triangles faced the wrong way, and are turned round",
            mesh.turned(),
            mesh.count()
        ));
    }
    if is_one_sided && mesh.hole().is_some() {
        notes.push("surfaces of one side are seen from both".to_owned());
    }
    let mut object = Object { shape: Shape::Mesh(Arc::new(mesh)), parts };
    if let Some(material) = &settings.material {
        coat(&mut object, material)?;
    }
    for part in &object.parts {
        let fault = |why: String| ModelFault::Piece { piece: format!("material of {}", part.name), why };
        part.material.check().map_err(|error| fault(format!("is out of range: {error}")))?;
    }
    notes.extend(bare(&object));
    Ok(Model { object, cameras, notes })
}

/// Gives a model another material, on all parts.
///
/// # Errors
/// When the material has pictures, and the model no texture coordinates, or when it is glass, and the model is open.
pub(crate) fn coat(object: &mut Object, material: &Material) -> Result<(), ModelFault> {
    if material.has_pictures() && object.shape.mesh().is_some_and(|mesh| !mesh.has_maps()) {
        return Err(ModelFault::NoCoordinates);
    }
    object.parts.iter_mut().for_each(|part| part.material = material.clone());
    Ok(object.check_glass()?)
}

/// Tells which parts of a model have pictures that are not shown on all of them.
pub(crate) fn bare(object: &Object) -> Option<String> {
    let bare = object.shape.mesh()?.bare_parts();
    let is_bare = |(number, part): &(usize, &Part)| part.material.has_pictures() && bare.contains(number);
    let lost: Vec<&str> = object.parts.iter().enumerate().filter(is_bare).map(|(_, part)| part.name.as_str()).collect();
    let note = || format!("without texture coordinates, pictures are not shown on all of: {}", lost.join(", "));
    (!lost.is_empty()).then(note)
}
