//! Inputs of pictures: one file, or a file for each face of a cube.

use std::path::Path;

use cosmorama::world::Blend;
use cosmorama_io::{EnvMap, FacePattern, FrameList, Header};
use cosmorama_spec::{Cube, Shape, Single, Spec};

use crate::detect::detection::{declared, detect};
use crate::detect::{GivenFaces, unless_damaged};
use crate::diagnostic::{Code, Diagnostic, FROM, Result, usage};
use crate::input::eye_view::{header, placed};
use crate::input::folder::{is_one_file, with_faces, with_sisters};
use crate::input::lists::hugin;
use crate::input::{Input, InputView, packed};
use crate::packing::EyePart;
use crate::packing::canvas::{canvas_of, fits_canvas, fits_shape, lies_on_canvas, whole};
use crate::source::{Access, Name, ViewFiles, unread, wanted_frames};

impl Input {
    /// Finds pictures, by their own name or by a Hugin project's.
    pub(crate) fn of_pictures(
        pattern: &Name,
        from: Option<&Spec>,
        wanted: Option<&FrameList>,
        access: Access,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        if hugin::is_project(pattern) {
            refuse_spec(pattern, from, "pictures")?;
            return hugin::find(pattern, access, warnings);
        }
        Self::of_eyes(pattern, from, wanted, access, warnings)
    }

    /// Finds the input for each eye, where a SPEC has two.
    fn of_eyes(
        pattern: &Name,
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
            // The second eye would only repeat the messages of the first.
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
        pattern: &Name,
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
            let place = |views: Vec<InputView>| views.into_iter().map(|view| placed(eye, view)).collect();
            input.worlds = input.worlds.into_iter().map(place).collect::<Result<_>>()?;
        }
        Ok(input)
    }

    /// Finds a panorama or another single picture, or all faces of a cube in one.
    fn one_file(
        pattern: &Name,
        shape: Option<&Shape>,
        (eye, access): (Option<EyePart>, Access),
        wanted: Option<&FrameList>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let files = ViewFiles::new(Path::new(pattern));
        if let Some(video) = files.video() {
            is_one_file(access.files, pattern, video)?;
        }
        let frames = wanted_frames::find(&files, access.files, wanted).map_err(with_faces)?;
        let path = files.path(frames[0]);
        if files.video().is_none() {
            is_one_file(access.files, pattern, &path)?;
        }
        let mut header = header(access, &path, eye)?;
        if let (None, Some(said)) = (shape, said_by(&files, access, warnings)?) {
            return Self::of_eyes(pattern, Some(&said), wanted, access, warnings);
        }
        let shape = match shape {
            Some(shape) => {
                let declared = declared(shape, pattern, &header, warnings)?;
                if matches!(shape, Shape::Single(single) if single.pose) {
                    // The pose has been applied.
                    header.metadata.pose = None;
                }
                declared
            }
            None => match detect(access, &path, &header, warnings).map_err(|error| with_sisters(error, &path))? {
                (shape, None) => shape,
                (shape, stereo) => {
                    let found = Spec { name: "what was found", shape, stereo, files: Vec::new() };
                    return Self::of_eyes(pattern, Some(&found), wanted, access, warnings);
                }
            },
        };
        let found = Self::of_file((pattern, files), (&path, header), shape, warnings);
        let (views, faces) = found.map_err(|error| unless_damaged((access.files, access.memory), vec![path], error))?;
        Ok(Self { worlds: vec![views], frames, faces, beside: Vec::new() })
    }

    /// Makes the views of one file, and describes them if they are the faces of a cube.
    fn of_file(
        (pattern, files): (&Name, ViewFiles),
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
            Shape::StMap(map) => return Err(unread::st_map(&map)),
            Shape::Calibrated(camera) => return Err(unread::calibration(&camera)),
        })
    }

    fn single(pattern: &Name, files: ViewFiles, path: &Path, header: Header, single: Single) -> Result<InputView> {
        let file = files.video().unwrap_or(path);
        let name = file.file_name().map_or_else(|| pattern.to_string(), |name| name.to_string_lossy().into_owned());
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
}

/// Returns the projection that a video names, by its spherical tags or its two streams, and tells of it.
fn said_by(files: &ViewFiles, access: Access, warnings: &mut Vec<Diagnostic>) -> Result<Option<Spec>> {
    let Some((video, videos)) = files.video().zip(access.files.videos()) else { return Ok(None) };
    let said = videos.spec(video)?;
    warnings.extend(said.as_ref().map(|(spec, by)| {
        let name = video.display();
        let message = format!("{name} is read as {FROM} {spec}, as its {by} say");
        Diagnostic::note(Code::Detected, message).about(name)
    }));
    Ok(said.map(|(spec, _)| spec))
}

/// Returns the note about a picture of one pixel, whose shape says nothing about its projection.
fn of_one_pixel(path: &Path, header: &Header) -> Option<Diagnostic> {
    let message = format!("{} is a single pixel: the same light is assumed in all directions", path.display());
    let is_one = (header.width, header.height) == (1, 1) && header.window.is_none();
    is_one.then(|| Diagnostic::note(Code::OnePixel, message).about(path.display()))
}

/// Refuses `--from` for a file that itself names the projections of its views or pictures.
pub(crate) fn refuse_spec(pattern: &str, from: Option<&Spec>, what: &str) -> Result<()> {
    match from {
        Some(spec) => Err(usage(format!("{pattern} says itself what its {what} are; leave out {FROM} {}", spec.name))),
        None => Ok(()),
    }
}
