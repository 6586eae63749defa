use std::path::Path;

use anyhow::Result;
use cosmorama::world::{CubeFaceFrame, Frame, Placement, SamplePositions, View};
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
        match geometry.to.as_ref().map(|spec| &spec.shape) {
            Some(Shape::Single(single)) => {
                let single = if format == Format::Exr { single.with_samples(SamplePositions::Edges) } else { *single };
                let view = single_view(single, geometry, pixels_per_radian)?;
                let name = output.to_owned();
                let views = vec![TargetView { name, files: Files::new(Path::new(output)), view }];
                Ok(Self { views, format, envmap: envmap(&single, format) })
            }
            Some(Shape::Cube(cube)) => Self::cube(output, cube, geometry, format, pixels_per_radian),
            None => Self::cube(output, &Cube::default(), geometry, format, pixels_per_radian),
        }
    }

    fn cube(
        output: &str,
        cube: &Cube,
        geometry: &GeometryArgs,
        format: Format,
        pixels_per_radian: f64,
    ) -> Result<Self> {
        let naming = cube.naming.unwrap_or(&Naming::presets()[0]);
        let set = FaceSet::named(output, naming)?;
        let frame = Frame::CubeFace(CubeFaceFrame);
        let (width, height) = size(frame, geometry.size, pixels_per_radian)?;
        let mut views = Vec::new();
        for file in set.faces().iter().filter(|file| cube.faces.contains(&file.face)) {
            let canvas = cube.canvas_of(file.face);
            let view = face_placement(cube, file.face, file.placement, canvas, geometry.orientation())
                .view(width, height)
                .map_err(|error| usage(error.to_string()))?;
            views.push(TargetView { name: file.face.name().to_owned(), files: Files::new(&file.path), view });
        }
        Ok(Self { views, format, envmap: None })
    }

    /// Their geometry.
    pub(crate) fn geometry(&self) -> Vec<View> {
        self.views.iter().map(|target| target.view).collect()
    }
}

fn single_view(single: Single, geometry: &GeometryArgs, pixels_per_radian: f64) -> Result<View> {
    let Placement { frame, orientation, mirror, canvas } = single.placement;
    if canvas.is_some() && geometry.size.is_none() {
        return Err(usage("--to has canvas=, so the size of the window on it must be given with --size WxH"));
    }
    let (width, height) = size(frame, geometry.size, pixels_per_radian)?;
    let placement = Placement { frame, orientation: orientation.within(geometry.orientation()), mirror, canvas };
    placement.view(width, height).map_err(|error| usage(format!("--to: {error}")))
}

fn size(frame: Frame, given: Option<SizeArg>, pixels_per_radian: f64) -> Result<(usize, usize)> {
    match given {
        Some(SizeArg { width, height }) => Ok((width, height.unwrap_or_else(|| frame.natural_height(width)))),
        None => frame.size_at(pixels_per_radian).map_err(|error| usage(format!("--to: {error} (--size)"))),
    }
}

/// OpenEXR's environment maps have their samples on the edges and show the whole sphere, unturned or turned.
fn envmap(single: &Single, format: Format) -> Option<EnvMap> {
    let Frame::Equirect(frame) = single.placement.frame else { return None };
    let whole = frame.horizontal.degrees() > 359.999 && frame.vertical.degrees() > 179.999;
    let by_format = single.samples != SphereSamples::Given(SamplePositions::Centres);
    let upright = single.placement.canvas.is_none() && single.placement.mirror == cosmorama::world::Mirror::default();
    (format == Format::Exr && whole && by_format && upright).then_some(EnvMap::LatLong)
}
