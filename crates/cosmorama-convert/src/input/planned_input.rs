use std::path::Path;

use cosmorama::camera::{CameraError, CameraModel, Placement, View};
use cosmorama::layout::{FacePart, FacePlacement};
use cosmorama::sphere::{CubeFace, Orientation};
use cosmorama::world::Blend;
use cosmorama_spec::{Shape, Size, Spec};

use crate::diagnostic::{ConvertError, FROM, Result, usage};
use crate::input::eye_view::placed;
use crate::input::{Input, InputView};
use crate::packing::eye::eye_size;
use crate::packing::face_view::face_placement;
use crate::packing::size::lens_image_size;
use crate::packing::{EyePart, Piece};
use crate::source::{ViewFiles, unread};

impl Input {
    /// Describes an input that does not exist yet, of a given size, or as fine as an output with so many pixels per
    /// radian.
    pub(crate) fn planned(from: &Spec, size: Option<Size>, pixels_per_radian: f64) -> Result<Self> {
        let Some(stereo) = from.stereo else {
            return Ok(Self {
                worlds: vec![views(from, size, pixels_per_radian)?],
                frames: vec![None],
                faces: None,
                beside: Vec::new(),
            });
        };
        let is_cube = matches!(from.shape, Shape::Cube(_));
        // The size of a cube is that of a face.
        let size = if is_cube { size } else { size.map(|size| eye_size(stereo.packing, size)).transpose()? };
        let world = |eye| {
            let part = EyePart { stereo: stereo.packing, eye };
            views(from, size, pixels_per_radian)?.into_iter().map(|view| placed(part, view)).collect()
        };
        Ok(Self {
            worlds: stereo.eyes().into_iter().map(world).collect::<Result<_>>()?,
            frames: vec![None],
            faces: None,
            beside: Vec::new(),
        })
    }
}

fn views(from: &Spec, given: Option<Size>, pixels_per_radian: f64) -> Result<Vec<InputView>> {
    let size = |frame: CameraModel| match given {
        Some(Size { width, height }) => Ok((width, height.unwrap_or_else(|| frame.natural_height(width)))),
        None => frame.size_at(pixels_per_radian).map_err(wrong),
    };
    match &from.shape {
        Shape::Single(single) => {
            let placement = Placement { canvas: None, ..single.placement.clone() };
            let (width, height) = size(placement.frame.clone())?;
            Ok(vec![view(from.name, placement.view(width, height).map_err(wrong)?, Blend::default())])
        }
        Shape::Cube(cube) => {
            let (width, height) = size(cube.frame())?;
            let lies = FacePlacement::UPRIGHT;
            let face = |&face: &CubeFace| {
                let placement = face_placement(cube, face, lies, None, Orientation::IDENTITY);
                Ok(view(face.name(), placement.view(width, height).map_err(wrong)?, cube.blend()))
            };
            cube.faces.iter().filter(|face| FacePart::of(**face, lies, cube.half).is_some()).map(face).collect()
        }
        Shape::Dual(dual) => {
            let image = lens_image_size(dual, given, Some(pixels_per_radian), FROM)?;
            let pieces = Piece::lenses(dual, image).map_err(|error| usage(format!("{FROM}: {error}")))?;
            let lens = |piece: &Piece| Ok(view(piece.name, piece.nominal().map_err(wrong)?, piece.blend));
            pieces.iter().map(lens).collect()
        }
        Shape::StMap(map) => Err(unread::st_map(map)),
        Shape::Calibrated(camera) => Err(unread::calibration(camera)),
    }
}

fn wrong(error: CameraError) -> ConvertError {
    usage(format!("{FROM}: {error}"))
}

fn view(name: &str, nominal: View, blend: Blend) -> InputView {
    let files = ViewFiles::new(Path::new(name));
    InputView {
        name: name.to_owned(),
        files,
        part: None,
        header: None,
        nominal,
        window: None,
        blend,
        mask: None,
        wanted: true,
    }
}
