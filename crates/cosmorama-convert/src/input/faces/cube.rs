use cosmorama::layout::FacePart;
use cosmorama_io::{FaceFile, FrameList};
use cosmorama_spec::{Cube, Packing};

use crate::detect::GivenFaces;
use crate::diagnostic::{Diagnostic, FROM, Result, bail, usage};
use crate::input::faces::face_shape::size_of_missing;
use crate::input::folder::face_set;
use crate::input::{Face, FacePicture, Input};
use crate::packing::EyePart;
use crate::source::{Access, ViewFiles, wanted_frames};

impl Input {
    /// Finds the faces of a cube in files of their own.
    pub(crate) fn cube(
        pattern: &str,
        cube: &Cube,
        (eye, access): (Option<EyePart>, Access),
        wanted: Option<&FrameList>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        if let Some(Packing::OneImage(kind)) = cube.layout {
            return Err(usage(format!(
                "{pattern} names a file for each face, but {FROM} layout={kind} is for all faces in one image"
            )));
        }
        if cube.order.is_some() {
            return Err(usage(format!(
                "{pattern} names a file for each face, but order= is for faces in one image, which have no names; which \
                 face a file is, its name says, and naming= what names mean; if a file has the name of another face, rename it"
            )));
        }
        let set = face_set(pattern, cube.naming)?;
        let cube = &Cube { naming: Some(set.naming()), ..cube.clone() };
        let shown = |face: &&FaceFile| {
            let lies = cube.file_placement(face.face, face.placement);
            cube.faces.contains(&face.face) && FacePart::of(face.face, lies, cube.half).is_some()
        };
        let chosen: Vec<&FaceFile> = set.faces().iter().filter(shown).collect();
        if !chosen.iter().any(|face| face.present) {
            bail!(NotFound: "{pattern}: none of the faces asked for is there; there are {}", names(set.present()));
        }
        let files: Vec<ViewFiles> = chosen.iter().map(|face| ViewFiles::new(&face.path)).collect();
        let present = chosen.iter().zip(&files).filter(|(face, _)| face.present);
        let present: Vec<_> = present.map(|(face, files)| (face.face.name(), files)).collect();
        let frames = wanted_frames::find_of_faces(pattern, &present, access.files, wanted)?;
        let mut faces = Vec::new();
        for (face, files) in chosen.into_iter().zip(files) {
            faces.push(Face::probe(cube, face, files, (eye, access), frames[0])?);
        }
        let pictures: Vec<FacePicture> = faces.iter().filter_map(|face| face.picture(cube, frames[0])).collect();
        let size = size_of_missing(&pictures, cube.half, warnings)?;
        let lie: Vec<_> = faces.iter().map(Face::lies).collect();
        let is_whole = faces.iter().all(Face::is_whole);
        let given = GivenFaces::of_files(cube, set.naming(), &lie).filter(|_| is_whole);
        let views: Result<_> = faces.into_iter().map(|face| face.into_view(cube, size)).collect();
        Ok(Self { worlds: vec![views?], frames, faces: given, beside: Vec::new() })
    }
}

fn names<'a>(faces: impl Iterator<Item = &'a FaceFile>) -> String {
    faces.map(|face| face.face.name()).collect::<Vec<_>>().join(", ")
}
