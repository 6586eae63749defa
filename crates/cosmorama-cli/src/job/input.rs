use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use cosmorama::sphere::{CubeFace, Orientation};
use cosmorama::world::{Blend, Canvas, FacePart, FacePlacement, Frame, FrameError, Placement, View};
use cosmorama_io::{FaceFile, FacePattern, FaceSet, FrameList, Header, Window, probe};

use super::detect::{declared, detect};
use super::face_shape::{FacePicture, usual_size};
use super::face_view::face_placement;
use super::packed::{self, FilePart};
use super::{Files, frames, st_map, world_file};
use crate::args::SizeArg;
use crate::failure::usage;
use crate::spec::{Cube, Packing, Shape, Single, Spec};

/// A view of the input: an image, or a face of a cube.
pub(crate) struct InputView {
    /// What messages call it.
    pub(crate) name: String,
    /// Its files.
    pub(crate) files: Files,
    /// Where it lies in a file that other views share.
    pub(crate) part: Option<FilePart>,
    /// What its first file says of itself; `None` where there is no file.
    pub(crate) header: Option<Header>,
    /// The geometry of its whole picture.
    pub(crate) nominal: View,
    /// The part of that which the file holds; `None` where there is no file.
    pub(crate) window: Option<(View, Canvas)>,
    /// How it takes part where other views show the same.
    pub(crate) blend: Blend,
    /// Whether anything of it is needed: what is not is not even read.
    pub(crate) wanted: bool,
}

/// Everything that light comes from.
pub(crate) struct Input {
    /// The views, missing ones too.
    pub(crate) views: Vec<InputView>,
    /// The frames to work on.
    pub(crate) frames: Vec<Option<u64>>,
}

impl Input {
    /// Finds and probes the files of an input.
    pub(crate) fn find(
        pattern: &str,
        from: Option<&Spec>,
        wanted: Option<&FrameList>,
        warnings: &mut Vec<String>,
    ) -> Result<Self> {
        let shape = from.map(|spec| (spec.name, &spec.shape));
        if world_file::is_world_file(pattern) {
            if let Some((name, _)) = shape {
                return Err(usage(format!("{pattern} says itself what its views are; leave out --from {name}")));
            }
            return world_file::find(pattern, wanted, warnings);
        }
        match (FacePattern::parse(pattern), shape) {
            (Some(_), Some((_, Shape::Cube(cube)))) => Self::cube(pattern, cube, wanted, warnings),
            (Some(_), None) => Self::cube(pattern, &Cube::default(), wanted, warnings),
            (Some(_), Some((name, Shape::Single(_) | Shape::StMap(_)))) => {
                Err(usage(format!("{pattern} names the faces of a cube, but --from is {name}; expected --from cube")))
            }
            (None, shape) => Self::one_file(pattern, shape.map(|(_, shape)| shape), wanted, warnings),
        }
    }

    /// An input that does not exist yet: of a size, or at parity with an output of so many pixels a radian.
    pub(crate) fn nominal(from: &Spec, size: Option<SizeArg>, pixels_per_radian: f64) -> Result<Self> {
        let wrong = |error: FrameError| usage(format!("--from: {error}"));
        let size = |frame: Frame| match size {
            Some(SizeArg { width, height }) => Ok((width, height.unwrap_or_else(|| frame.natural_height(width)))),
            None => frame.size_at(pixels_per_radian).map_err(wrong),
        };
        let view = |name: &str, placement: Placement, (width, height): (usize, usize)| {
            let nominal = placement.view(width, height).map_err(wrong)?;
            let files = Files::new(Path::new(name));
            Ok(InputView {
                name: name.to_owned(),
                files,
                part: None,
                header: None,
                nominal,
                window: None,
                blend: Blend::default(),
                wanted: true,
            })
        };
        let views: Result<Vec<InputView>> = match &from.shape {
            Shape::Single(single) => {
                let placement = Placement { canvas: None, ..single.placement };
                Ok(vec![view(from.name, placement, size(placement.frame)?)?])
            }
            Shape::Cube(cube) => {
                let size = size(cube.frame())?;
                let lies = FacePlacement::UPRIGHT;
                let face = |&face: &CubeFace| face_placement(cube, face, lies, None, Orientation::IDENTITY);
                let shown = cube.faces.iter().filter(|face| FacePart::of(**face, lies, cube.half).is_some());
                shown.map(|of| view(of.name(), face(of), size)).collect()
            }
            Shape::StMap(map) => return Err(st_map::unread(map)),
        };
        Ok(Self { views: views?, frames: vec![None] })
    }

    /// A panorama or another picture, or all faces of a cube.
    fn one_file(
        pattern: &str,
        shape: Option<&Shape>,
        wanted: Option<&FrameList>,
        warnings: &mut Vec<String>,
    ) -> Result<Self> {
        let files = Files::new(Path::new(pattern));
        let frames = frames::find(std::iter::once(&files), wanted)?;
        let path = files.path(frames[0]);
        is_one_file(pattern, &path)?;
        let header = probe(&path)?;
        let shape = match shape {
            Some(shape) => declared(shape, pattern, &header, warnings)?,
            None => detect(&path, &header, warnings)?,
        };
        let views = match shape {
            Shape::Single(single) => vec![Self::single(pattern, files, &path, header, single)?],
            Shape::Cube(cube) => packed::views(&files, &path, &header, &cube)?,
            Shape::StMap(map) => return Err(st_map::unread(&map)),
        };
        Ok(Self { views, frames })
    }

    fn single(pattern: &str, files: Files, path: &Path, header: Header, single: Single) -> Result<InputView> {
        let name = path.file_name().map_or_else(|| pattern.to_owned(), |name| name.to_string_lossy().into_owned());
        let mut placement = single.placement;
        let canvas = placement.canvas.or(header.window.map(canvas_of)).unwrap_or_else(|| whole(&header));
        fits_canvas(path, &header, canvas)?;
        placement.canvas = None;
        let nominal = placement.view(canvas.width, canvas.height).map_err(|error| usage(format!("--from: {error}")))?;
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
            wanted: true,
        })
    }

    fn cube(pattern: &str, cube: &Cube, wanted: Option<&FrameList>, warnings: &mut Vec<String>) -> Result<Self> {
        if let (Some(Packing::OneImage(_)), _) | (_, Some(_)) = (cube.layout, &cube.order) {
            return Err(usage(format!(
                "{pattern} names a file for each face, but --from is for all faces in one image"
            )));
        }
        let set = FaceSet::find(pattern, cube.naming)?;
        let cube = &Cube { naming: Some(set.naming()), ..cube.clone() };
        let shown = |face: &&FaceFile| {
            let lies = cube.file_placement(face.face, face.placement);
            cube.faces.contains(&face.face) && FacePart::of(face.face, lies, cube.half).is_some()
        };
        let chosen: Vec<&FaceFile> = set.faces().iter().filter(shown).collect();
        if !chosen.iter().any(|face| face.present) {
            bail!("{pattern}: none of the faces asked for is there; there are {}", names(set.present()));
        }
        let files: Vec<Files> = chosen.iter().map(|face| Files::new(&face.path)).collect();
        let present = || files.iter().zip(&chosen).filter(|(_, face)| face.present).map(|(files, _)| files);
        let frames = frames::find(present().collect::<Vec<_>>().into_iter(), wanted)?;
        let mut faces = Vec::new();
        for (face, files) in chosen.into_iter().zip(files) {
            faces.push(Face::probe(cube, face, files, frames[0])?);
        }
        let pictures: Vec<FacePicture> = faces.iter().filter_map(|face| face.picture(cube, frames[0])).collect();
        let size = usual_size(&pictures, warnings)?;
        let views: Result<_> = faces.into_iter().map(|face| face.into_view(cube, size)).collect();
        Ok(Self { views: views?, frames })
    }

    /// The views that have files and are wanted, with the geometry of what those hold.
    pub(crate) fn present(&self) -> impl Iterator<Item = (&InputView, &Header, &View)> {
        self.views
            .iter()
            .filter(|view| view.wanted)
            .filter_map(|input| Some((input, input.header.as_ref()?, &input.window.as_ref()?.0)))
    }

    /// Pixels a radian at the centre of the finest view.
    pub(crate) fn pixels_per_radian(&self) -> f64 {
        let views = self.views.iter().filter(|view| view.wanted);
        views.map(|view| view.nominal.pixels_per_radian()).fold(0.0, f64::max)
    }

    /// Texels of all files of a frame.
    pub(crate) fn texels(&self) -> usize {
        self.present().map(|(_, header, _)| header.width.saturating_mul(header.height)).fold(0, usize::saturating_add)
    }

    /// The files of a frame.
    pub(crate) fn paths(&self, frame: Option<u64>) -> Vec<PathBuf> {
        self.present().map(|(input, _, _)| input.files.path(frame)).collect()
    }
}

/// A face whose file has been looked at.
struct Face {
    face: CubeFace,
    placement: FacePlacement,
    files: Files,
    header: Option<Header>,
    canvas: Option<Canvas>,
}

impl Face {
    fn probe(cube: &Cube, file: &FaceFile, files: Files, frame: Option<u64>) -> Result<Self> {
        let header = file.present.then(|| probe(&files.path(frame))).transpose()?;
        let placement = cube.file_placement(file.face, file.placement);
        let part = FacePart::of(file.face, placement, cube.half);
        let canvas = header.as_ref().map(|header| {
            let declared = cube.canvas_of(file.face).or(header.window.map(canvas_of));
            let whole = || part.map_or_else(|| whole(header), |part| part.canvas(header.width, header.height));
            declared.unwrap_or_else(whole)
        });
        if let (Some(header), Some(canvas)) = (&header, canvas) {
            fits_canvas(&files.path(frame), header, canvas)?;
            lies_on_canvas(&files.path(frame), header, canvas)?;
        }
        Ok(Self { face: file.face, placement, files, header, canvas })
    }

    /// Its picture, if there is a file.
    fn picture(&self, cube: &Cube, frame: Option<u64>) -> Option<FacePicture> {
        let is_declared = cube.canvas_of(self.face).is_some();
        Some(FacePicture { face: self.face, path: self.files.path(frame), canvas: self.canvas?, is_declared })
    }

    fn into_view(self, cube: &Cube, (width, height): (usize, usize)) -> Result<InputView> {
        let outer = Orientation::IDENTITY;
        let canvas = self.canvas.unwrap_or(Canvas { width, height, left: 0, top: 0 });
        let nominal = face_placement(cube, self.face, self.placement, None, outer).view(canvas.width, canvas.height)?;
        let windowed = face_placement(cube, self.face, self.placement, Some(canvas), outer);
        let window = match &self.header {
            Some(header) => Some((windowed.view(header.width, header.height)?, canvas)),
            None => None,
        };
        Ok(InputView {
            name: self.face.name().to_owned(),
            files: self.files,
            part: None,
            header: self.header,
            nominal,
            window,
            blend: Blend::default(),
            wanted: true,
        })
    }
}

fn shape(canvas: &Canvas) -> String {
    format!("{}x{}", canvas.width, canvas.height)
}

fn names<'a>(faces: impl Iterator<Item = &'a FaceFile>) -> String {
    faces.map(|face| face.face.name()).collect::<Vec<_>>().join(", ")
}

/// A window larger than its canvas was declared by mistake.
fn fits_canvas(path: &Path, header: &Header, canvas: Canvas) -> Result<()> {
    if header.width <= canvas.width && header.height <= canvas.height {
        return Ok(());
    }
    Err(usage(format!(
        "{}: {}x{} pixels are no window of a canvas of {}; give canvas=WxH+X+Y the size of the whole picture",
        path.display(),
        header.width,
        header.height,
        shape(&canvas)
    )))
}

/// A folder or a wildcard was meant for the faces in it.
fn is_one_file(pattern: &str, path: &Path) -> Result<()> {
    let meant = if path.is_dir() {
        format!("is a folder; for the faces of a cube in it, write {}", path.join("{face}.png").display())
    } else if pattern.contains(['*', '?', '{']) && !path.exists() {
        "names no file; for the faces of a cube, write {face} or %c where a face's name stands, for frames ####"
            .to_owned()
    } else {
        return Ok(());
    };
    Err(usage(format!("{pattern} {meant}")))
}

/// A face that lies wholly beside its canvas was put there by mistake: one may reach beyond its edges, but not go round.
fn lies_on_canvas(path: &Path, header: &Header, canvas: Canvas) -> Result<()> {
    let overlaps = |start: i64, length: usize, whole: usize| start < whole as i64 && start + length as i64 > 0;
    if overlaps(canvas.left, header.width, canvas.width) && overlaps(canvas.top, header.height, canvas.height) {
        return Ok(());
    }
    Err(usage(format!(
        "{}: {}x{} pixels at {}, {} lie beside their canvas of {}; give canvas=WxH+X+Y the place of their first pixel in \
         the whole picture",
        path.display(),
        header.width,
        header.height,
        canvas.left,
        canvas.top,
        shape(&canvas)
    )))
}

/// The canvas of an image that is all of it.
fn whole(header: &Header) -> Canvas {
    Canvas { width: header.width, height: header.height, left: 0, top: 0 }
}

/// A window as a placement has it.
pub(super) fn canvas_of(window: Window) -> Canvas {
    Canvas { width: window.canvas_width, height: window.canvas_height, left: window.x as i64, top: window.y as i64 }
}
