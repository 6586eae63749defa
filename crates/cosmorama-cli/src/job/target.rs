use std::path::Path;

use anyhow::Result;
use cosmorama::sphere::CubeFace;
use cosmorama::world::{CubeFaceFrame, Frame, FrameError, Mirror, Placement, SamplePositions, View};
use cosmorama_io::{EnvMap, FacePattern, FaceSet, Format, Naming};

use super::Files;
use super::face_view::face_placement;
use crate::args::SizeArg;
use crate::args::convert::GeometryArgs;
use crate::failure::usage;
use crate::spec::{Cube, Shape, Single, Spec, SphereSamples};

/// An image to make.
pub(crate) struct TargetView {
    /// What messages call it.
    pub(crate) name: String,
    /// Its files.
    pub(crate) files: Files,
    /// Its geometry.
    pub(crate) view: View,
}

/// Everything that light goes to.
pub(crate) struct Target {
    /// The images of a frame: one, or the faces of a cube.
    pub(crate) views: Vec<TargetView>,
    /// The file format.
    pub(crate) format: Format,
    /// What OpenEXR's attribute says of it.
    pub(crate) envmap: Option<EnvMap>,
}

impl Target {
    /// Checks what an output's name says against `--to`.
    pub(crate) fn check_names(output: &str, geometry: &GeometryArgs) -> Result<Format> {
        let format = Format::from_extension(Path::new(output)).map_err(|error| usage(error.to_string()))?;
        let faces = FacePattern::parse(output).is_some();
        match geometry.to.as_ref() {
            None if !faces => Err(usage(
                "--to is missing: say which projection the output is to have, as in --to omnimax, --to fulldome, \
                 --to equirect or --to perspective:fov=60",
            )),
            Some(Spec { shape: Shape::Cube(_), .. }) if !faces => Err(usage(format!(
                "--to cube makes a file for each face, but {output} has no {{face}} or %c where a face's name stands"
            ))),
            Some(Spec { shape: Shape::Single(_), name }) if faces => {
                Err(usage(format!("{output} names the faces of a cube, but --to is {name}; expected --to cube")))
            }
            _ => Ok(format),
        }
    }

    /// The images that an output's name, its projection and the size stand for.
    pub(crate) fn resolve(output: &str, geometry: &GeometryArgs, pixels_per_radian: f64) -> Result<Self> {
        let format = Self::check_names(output, geometry)?;
        let pictures = Picture::all(geometry, Some(format), Some(pixels_per_radian))?;
        let naming = match geometry.to.as_ref().map(|spec| &spec.shape) {
            Some(Shape::Cube(cube)) if cube.naming.is_some() => naming(cube),
            // `%c` is Bourke's mark: one letter a face.
            _ if output.contains("%c") => Naming::named("bourke")?,
            _ => naming(&Cube::default()),
        };
        let mut views = Vec::new();
        for picture in &pictures {
            let (name, files) = match picture.face {
                Some(face) => (face.name().to_owned(), FaceSet::named(output, naming)?.face(face).path.clone()),
                None => (output.to_owned(), output.into()),
            };
            views.push(TargetView { name, files: Files::new(&files), view: picture.view });
        }
        let envmap = pictures.first().and_then(|picture| picture.envmap);
        Ok(Self { views, format, envmap })
    }

    /// Their geometry.
    pub(crate) fn geometry(&self) -> Vec<View> {
        self.views.iter().map(|target| target.view).collect()
    }
}

/// The geometry of an image to make.
pub(crate) struct Picture {
    /// The face of a cube that it is.
    pub(crate) face: Option<CubeFace>,
    /// The geometry.
    pub(crate) view: View,
    /// What OpenEXR's attribute says of it.
    envmap: Option<EnvMap>,
}

impl Picture {
    /// The images that `--to`, `--size` and the orientation stand for, for files of a format. Without a size, the
    /// centre gets so many pixels a radian.
    pub(crate) fn all(
        geometry: &GeometryArgs,
        format: Option<Format>,
        pixels_per_radian: Option<f64>,
    ) -> Result<Vec<Self>> {
        match geometry.to.as_ref().map(|spec| &spec.shape) {
            Some(Shape::Single(single)) => {
                if format == Some(Format::Exr) {
                    // OpenEXR's attribute, and its samples on the edges, are for the whole sphere alone.
                    let edges = single.with_samples(SamplePositions::Edges);
                    let view = single_view(edges, geometry, pixels_per_radian)?;
                    if let Some(envmap) = envmap(&edges).filter(|_| view.covers_sphere()) {
                        return Ok(vec![Self { face: None, view, envmap: Some(envmap) }]);
                    }
                }
                let view = single_view(*single, geometry, pixels_per_radian)?;
                Ok(vec![Self { face: None, view, envmap: None }])
            }
            Some(Shape::Cube(cube)) => Self::faces(cube, geometry, pixels_per_radian),
            None => Self::faces(&Cube::default(), geometry, pixels_per_radian),
        }
    }

    fn faces(cube: &Cube, geometry: &GeometryArgs, pixels_per_radian: Option<f64>) -> Result<Vec<Self>> {
        let (width, height) = size(Frame::CubeFace(CubeFaceFrame), geometry.size, pixels_per_radian)?;
        let picture = |&face: &CubeFace| {
            let (lies, canvas) = (naming(cube).placement(face), cube.canvas_of(face));
            let placement = face_placement(cube, face, lies, canvas, geometry.orientation());
            let view = placement.view(width, height).map_err(|error| usage(format!("--to: {error}")))?;
            Ok(Self { face: Some(face), view, envmap: None })
        };
        cube.faces.iter().map(picture).collect()
    }
}

/// How faces are named and lie, unless told: in words.
fn naming(cube: &Cube) -> &'static Naming {
    cube.naming.unwrap_or(&Naming::presets()[0])
}

fn single_view(single: Single, geometry: &GeometryArgs, pixels_per_radian: Option<f64>) -> Result<View> {
    let Placement { frame, orientation, mirror, canvas } = single.placement;
    if canvas.is_some() && geometry.size.is_none() {
        return Err(usage("--to has canvas=, so the size of the window on it must be given with --size WxH"));
    }
    let (width, height) = size(frame, geometry.size, pixels_per_radian)?;
    let placement = Placement { frame, orientation: orientation.within(geometry.orientation()), mirror, canvas };
    placement.view(width, height).map_err(|error| usage(format!("--to: {error}")))
}

fn size(frame: Frame, given: Option<SizeArg>, pixels_per_radian: Option<f64>) -> Result<(usize, usize)> {
    match (given, pixels_per_radian) {
        (Some(SizeArg { width, height }), _) => Ok((width, height.unwrap_or_else(|| frame.natural_height(width)))),
        (None, Some(pixels)) => frame.size_at(pixels).map_err(|error| match error {
            FrameError::SizeNeeded | FrameError::SizeUnbounded { .. } => {
                usage(format!("--to: {error}, with --size WxH"))
            }
            error => usage(format!("--to: {error}")),
        }),
        (None, None) => Err(usage("--size is missing: without an input, nothing tells how large the output is to be")),
    }
}

/// OpenEXR's environment maps have their samples on the edges and show the whole sphere.
fn envmap(single: &Single) -> Option<EnvMap> {
    let Frame::Equirect(frame) = single.placement.frame else { return None };
    let whole = frame.horizontal.degrees() > 359.999 && frame.vertical.degrees() > 179.999;
    let by_format = single.samples != SphereSamples::Given(SamplePositions::Centres);
    let upright = single.placement.canvas.is_none() && single.placement.mirror == Mirror::default();
    (whole && by_format && upright).then_some(EnvMap::LatLong)
}
