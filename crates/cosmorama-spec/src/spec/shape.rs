use cosmorama::camera::{CameraModel, Placement, SamplePositions};

use super::fields::Fields;
use super::keys::Keys;
use super::{CalibrationSpec, Cube, Dual, StMapSpec};
use crate::SpecError;

/// Pictures that a SPEC stands for, by how they lie in files.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// One image.
    Single(Single),
    /// The faces of a cube, a file each or in one image.
    Cube(Cube),
    /// Two fisheyes in one image.
    Dual(Box<Dual>),
    /// One image of a measured camera, whose calibration is still to be read.
    Calibrated(CalibrationSpec),
    /// One image, and a map that is still to be read.
    StMap(StMapSpec),
}

impl Shape {
    /// Makes one image of a camera, placed as its keys say.
    pub(super) fn single(fields: &Fields, frame: CameraModel) -> Result<Self, SpecError> {
        let placement = Placement {
            frame,
            orientation: fields.orientation()?,
            mirror: fields.mirror()?,
            canvas: fields.canvas("canvas")?,
        };
        let samples = match &placement.frame {
            CameraModel::Equirect(frame) if fields.get("samples").is_some() => SphereSamples::Given(frame.samples),
            CameraModel::Equirect(_) => SphereSamples::ByFormat,
            _ => SphereSamples::NotAPanorama,
        };
        let any_shape = fields.get("hfov").is_some() && fields.get("vfov").is_some();
        Ok(Self::Single(Single { placement, samples, any_shape }))
    }
}

impl Shape {
    /// Returns the camera of one image.
    pub(in crate::spec) fn camera(&self) -> Option<CameraModel> {
        match self {
            Self::Single(single) => Some(single.placement.frame.clone()),
            Self::Calibrated(_) | Self::Cube(_) | Self::Dual(_) | Self::StMap(_) => None,
        }
    }

    /// Adds how one image lies in the world; the other shapes write that themselves.
    pub(in crate::spec) fn write_place(&self, keys: Keys) -> Keys {
        match self {
            Self::Single(Single { placement, .. }) => {
                keys.placed(placement.orientation, placement.mirror, placement.canvas)
            }
            Self::Calibrated(_) | Self::Cube(_) | Self::Dual(_) | Self::StMap(_) => keys,
        }
    }
}

/// One image, its projection given by a formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Single {
    /// Camera model and place in the world.
    pub placement: Placement,
    /// Position of a panorama's outermost samples.
    pub samples: SphereSamples,
    /// Whether the field of view was given both ways, so that any shape of pixels is meant.
    pub any_shape: bool,
}

/// Position of a panorama's outermost samples, and what decides it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SphereSamples {
    /// No choice: the projection is no panorama.
    NotAPanorama,
    /// Position that the file format has.
    ByFormat,
    /// Position that the SPEC gives.
    Given(SamplePositions),
}

impl Single {
    /// Places samples where a file format has them, unless the SPEC says where.
    pub fn with_samples(mut self, samples: SamplePositions) -> Self {
        if let (CameraModel::Equirect(frame), SphereSamples::ByFormat) = (&mut self.placement.frame, self.samples) {
            frame.samples = samples;
        }
        self
    }
}
