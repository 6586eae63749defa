use std::path::{Path, PathBuf};
use std::sync::Arc;

use cosmorama::camera::{Canvas, View};
use cosmorama::layout::FacePart;
use cosmorama::world::{Blend, ViewMask, WorldView};
use cosmorama_io::{EnvMap, FaceFile, FacePattern, FrameList, Header};
use cosmorama_spec::{Cube, Packing, Shape, Single, Spec};

use crate::detect::detection::{declared, detect};
use crate::detect::{GivenFaces, unless_damaged};
use crate::diagnostic::{Code, Diagnostic, FROM, Result, TO, bail, usage};
use crate::input::faces::face_shape::size_of_missing;
use crate::input::folder::{face_set, is_one_file, with_faces};
use crate::input::lists::{hugin, world_file};
use crate::input::spec_files::{calibration, st_map};
use crate::input::{Face, FacePicture, packed};
use crate::packing::canvas::{canvas_of, fits_canvas, fits_shape, lies_on_canvas, whole};
use crate::packing::{EyePart, Place};
use crate::source::{Access, ViewFiles, frames};

/// A view of the input: an image, a face of a cube, or one of two lenses.
#[derive(Clone)]
pub struct InputView {
    /// Name in messages.
    pub name: String,
    /// Its files.
    pub files: ViewFiles,
    /// Place in a file that several views share.
    pub part: Option<Place>,
    /// Header of its first file; `None` without a file.
    pub header: Option<Header>,
    /// Geometry of its whole picture.
    pub nominal: View,
    /// Part of it that the file holds; `None` without a file.
    pub window: Option<(View, Canvas)>,
    /// Blending with other views that show the same directions.
    pub blend: Blend,
    /// Mask, if not all pixels count.
    pub mask: Option<Arc<ViewMask>>,
    /// Whether anything of it is needed; other views are not read.
    pub wanted: bool,
}

impl InputView {
    /// Converts it to a view of a world, with the geometry of its whole picture or of its file.
    pub(crate) fn world_view(&self, view: View) -> WorldView {
        WorldView { name: self.name.clone(), view, blend: self.blend, mask: self.mask.clone() }
    }

    /// Returns its header and the geometry of its file, if there is a file and the view is wanted.
    pub(crate) fn present(&self) -> Option<(&Self, &Header, &View)> {
        Some((self, self.header.as_ref()?, &self.window.as_ref()?.0)).filter(|_| self.wanted)
    }
}

/// The input of a conversion: views, frames and files.
pub struct Input {
    /// Views, including missing ones: of one world, or of the left eye's and the right eye's.
    pub worlds: Vec<Vec<InputView>>,
    /// Frames to work on.
    pub frames: Vec<Option<u64>>,
    /// Arrangement of the views as faces of one cube, if they are whole faces.
    pub faces: Option<GivenFaces>,
    /// Files beside those of views: lists of views, masks, calibrations and maps.
    pub beside: Vec<PathBuf>,
}

/// Message for an output with two eyes and an input with one.
pub(crate) const SAME_FOR_BOTH: &str =
    "both eyes get the same picture, since the input has only one: there is no depth in it";

impl Input {
    /// Returns an empty input, for light by a formula.
    pub(crate) fn none() -> Self {
        Self { worlds: Vec::new(), frames: vec![None], faces: None, beside: Vec::new() }
    }

    /// Finds and probes the files of an input.
    pub(crate) fn find(
        pattern: &str,
        from: Option<&Spec>,
        wanted: Option<&FrameList>,
        access: Access,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let refuse_spec = |what: &str| match from {
            Some(spec) => {
                Err(usage(format!("{pattern} says itself what its {what} are; leave out {FROM} {}", spec.name)))
            }
            None => Ok(()),
        };
        if world_file::is_world_file(pattern) {
            refuse_spec("views")?;
            return world_file::find(pattern, wanted, access, warnings);
        }
        if hugin::is_project(pattern) {
            refuse_spec("pictures")?;
            return hugin::find(pattern, access, warnings);
        }
        Self::of_eyes(pattern, from, wanted, access, warnings)
    }

    /// Finds the input for each eye, where a SPEC has two.
    fn of_eyes(
        pattern: &str,
        from: Option<&Spec>,
        wanted: Option<&FrameList>,
        access: Access,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let Some(stereo) = from.and_then(|spec| spec.stereo) else {
            return Self::find_one(pattern, from, (None, access), wanted, warnings);
        };
        let mut found: Option<Self> = None;
        for eye in stereo.eyes() {
            // Whatever there is to say of the other eye has been said of the first.
            let mut said = Vec::new();
            let warnings = if found.is_some() { &mut said } else { &mut *warnings };
            let mut one = Self::find_one(
                pattern,
                from,
                (Some(EyePart { stereo: stereo.packing, eye }), access),
                wanted,
                warnings,
            )?;
            match &mut found {
                Some(found) => found.worlds.append(&mut one.worlds),
                None => found = Some(one),
            }
        }
        found.ok_or_else(|| usage("stereo=: no eye is left"))
    }

    /// Finds the input of one eye, or of both.
    fn find_one(
        pattern: &str,
        from: Option<&Spec>,
        (eye, access): (Option<EyePart>, Access),
        wanted: Option<&FrameList>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let shape = from.map(|spec| (spec.name, &spec.shape));
        let mut input = match (FacePattern::parse(pattern), shape) {
            (Some(_), Some((_, Shape::Cube(cube)))) => Self::cube(pattern, cube, (eye, access), wanted, warnings)?,
            (Some(_), None) => Self::cube(pattern, &Cube::default(), (eye, access), wanted, warnings)?,
            (Some(_), Some((name, Shape::Single(_) | Shape::Calibrated(_) | Shape::Dual(_) | Shape::StMap(_)))) => {
                let message =
                    format!("{pattern} names the faces of a cube, but {FROM} is {name}; expected {FROM} cube");
                return Err(usage(message));
            }
            (None, shape) => Self::one_file(pattern, shape.map(|(_, shape)| shape), (eye, access), wanted, warnings)?,
        };
        if let Some(eye) = eye {
            let place = |views: Vec<InputView>| views.into_iter().map(|view| eye.place(view)).collect();
            input.worlds = input.worlds.into_iter().map(place).collect::<Result<_>>()?;
        }
        Ok(input)
    }

    /// Provides as many worlds as the output has eyes, and reports what is dropped or duplicated.
    pub(crate) fn fit_eyes(&mut self, stereo: bool, warnings: &mut Vec<Diagnostic>) {
        match (self.worlds.len(), stereo) {
            (2, false) => {
                self.worlds.truncate(1);
                let message = format!(
                    "the left eye's picture is used, since the output is for one eye; say so with eye=left, or eye=right \
                     for the other, or {TO} with stereo="
                );
                warnings.push(Diagnostic::warning(Code::LeftEye, message));
            }
            (1, true) => warnings.push(Diagnostic::warning(Code::OneForBothEyes, SAME_FOR_BOTH)),
            _ => {}
        }
    }

    /// Finds a panorama or another single picture, or all faces of a cube in one.
    fn one_file(
        pattern: &str,
        shape: Option<&Shape>,
        (eye, access): (Option<EyePart>, Access),
        wanted: Option<&FrameList>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let files = ViewFiles::new(Path::new(pattern));
        let frames = frames::find(&files, wanted).map_err(with_faces)?;
        let path = files.path(frames[0]);
        is_one_file(access.files, pattern, &path)?;
        let header = header(access, &path, eye)?;
        let shape = match shape {
            Some(shape) => declared(shape, pattern, &header, warnings)?,
            None => match detect(access, &path, &header, warnings)? {
                (shape, None) => shape,
                (shape, stereo) => {
                    let found = Spec { name: "what was found", shape, stereo, files: Vec::new() };
                    return Self::of_eyes(pattern, Some(&found), wanted, access, warnings);
                }
            },
        };
        let found = Self::of_file((pattern, files), (&path, header), shape, warnings);
        let (views, faces) = found.map_err(|error| unless_damaged(access.files, vec![path], error))?;
        Ok(Self { worlds: vec![views], frames, faces, beside: Vec::new() })
    }

    /// Makes the views of one file, and describes them if they are the faces of a cube.
    fn of_file(
        (pattern, files): (&str, ViewFiles),
        (path, header): (&Path, Header),
        shape: Shape,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<(Vec<InputView>, Option<GivenFaces>)> {
        let envmap = header.metadata.envmap;
        Ok(match shape {
            Shape::Single(single) => {
                warnings.extend(of_one_pixel(path, &header));
                (vec![Self::single(pattern, files, path, header, single)?], None)
            }
            Shape::Cube(cube) => (packed::faces(&files, path, &header, &cube)?, GivenFaces::of_image(&cube, envmap)),
            Shape::Dual(dual) => (packed::lenses(&files, path, &header, &dual)?, None),
            Shape::StMap(map) => return Err(st_map::unread(&map)),
            Shape::Calibrated(camera) => return Err(calibration::unread(&camera)),
        })
    }

    fn single(pattern: &str, files: ViewFiles, path: &Path, header: Header, single: Single) -> Result<InputView> {
        let name = path.file_name().map_or_else(|| pattern.to_owned(), |name| name.to_string_lossy().into_owned());
        let mut placement = single.placement;
        let canvas = placement.canvas.or(header.window.map(canvas_of)).unwrap_or_else(|| whole(&header));
        fits_canvas(path, &header, canvas)?;
        lies_on_canvas(path.display(), (header.width, header.height), canvas)?;
        if !single.any_shape && placement.canvas.is_none() && header.metadata.envmap != Some(EnvMap::LatLong) {
            fits_shape(path, &placement.frame, canvas)?;
        }
        placement.canvas = None;
        let nominal = placement.view(canvas.width, canvas.height).map_err(|error| usage(format!("{FROM}: {error}")))?;
        placement.canvas = Some(canvas);
        let window = Some((placement.view(header.width, header.height)?, canvas));
        Ok(InputView {
            name,
            files,
            part: None,
            header: Some(header),
            nominal,
            window,
            blend: Blend::default(),
            mask: None,
            wanted: true,
        })
    }

    fn cube(
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
        let frames = frames::find_of_faces(pattern, &present, wanted)?;
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

    /// Returns warnings and notes about what the files say of themselves.
    pub(crate) fn diagnostics(&self) -> Vec<Diagnostic> {
        let mut told = self.turned();
        told.extend(self.complaints());
        told
    }

    /// Warns about files that ask to be rotated, which is ignored.
    fn turned(&self) -> Vec<Diagnostic> {
        let turned = self.present().filter_map(|(view, header, _)| Some((view, header.metadata.orientation?)));
        let mut told: Vec<Diagnostic> = turned
            .map(|(view, orientation)| {
                let path = view.files.path(self.frames[0]);
                let message = format!(
                    "{} asks for being turned or mirrored (orientation {orientation}), but its pixels are taken as they are \
                     stored; turn it first, as with magick -auto-orient",
                    path.display()
                );
                Diagnostic::warning(Code::Orientation, message).about(path.display())
            })
            .collect();
        // Faces may share a file.
        told.dedup();
        told
    }

    /// Warns about statements of files that are ignored.
    fn complaints(&self) -> Vec<Diagnostic> {
        let told = |(view, header, _): (&InputView, &Header, _)| -> Vec<Diagnostic> {
            let path = view.files.path(self.frames[0]);
            let path = path.display();
            let complaint = |words| Diagnostic::warning(Code::Metadata, format!("{path}: {words}")).about(&path);
            let note = |words| Diagnostic::note(Code::Metadata, format!("{path}: {words}")).about(&path);
            let metadata = &header.metadata;
            metadata.complaints.iter().map(complaint).chain(metadata.notes.iter().map(note)).collect()
        };
        let mut told: Vec<Diagnostic> = self.present().flat_map(told).collect();
        // Faces may share a file.
        told.dedup();
        told
    }

    /// Visits the views that have files and are wanted, with the geometry of those files.
    pub(crate) fn present(&self) -> impl Iterator<Item = (&InputView, &Header, &View)> {
        self.views().filter_map(InputView::present)
    }

    /// Visits all views of all worlds.
    pub(crate) fn views(&self) -> impl Iterator<Item = &InputView> {
        self.worlds.iter().flatten()
    }

    /// Returns pixels per radian at the centre of the finest view.
    pub(crate) fn pixels_per_radian(&self) -> f64 {
        let views = self.views().filter(|view| view.wanted);
        views.map(|view| view.nominal.pixels_per_radian()).fold(0.0, f64::max)
    }

    /// Returns the number of texels in all files of a frame.
    pub(crate) fn texels(&self) -> usize {
        self.present().map(|(_, header, _)| header.width.saturating_mul(header.height)).fold(0, usize::saturating_add)
    }

    /// Visits every file that is read.
    pub(crate) fn files(&self) -> impl Iterator<Item = PathBuf> {
        self.frames.iter().flat_map(|frame| self.paths(*frame)).chain(self.beside.iter().cloned())
    }

    /// Returns the files of a frame.
    pub(crate) fn paths(&self, frame: Option<u64>) -> Vec<PathBuf> {
        self.present().map(|(input, _, _)| input.files.path(frame)).collect()
    }
}

/// Reads the header of a file, or of an eye's picture in it.
pub(crate) fn header(access: Access, path: &Path, eye: Option<EyePart>) -> Result<Header> {
    let header = access.probe(path)?;
    eye.map_or(Ok(header.clone()), |eye| eye.header(path, &header))
}

/// Returns the note about a picture of one pixel, which is no shape to tell a projection by.
fn of_one_pixel(path: &Path, header: &Header) -> Option<Diagnostic> {
    let message = format!("{} is a single pixel: the same light is assumed in all directions", path.display());
    let is_one = (header.width, header.height) == (1, 1) && header.window.is_none();
    is_one.then(|| Diagnostic::note(Code::OnePixel, message).about(path.display()))
}

fn names<'a>(faces: impl Iterator<Item = &'a FaceFile>) -> String {
    faces.map(|face| face.face.name()).collect::<Vec<_>>().join(", ")
}
