use cosmorama::camera::{CameraModel, Placement, SamplePositions};

use super::fields::Fields;
use super::keys::Keys;
use super::{CalibrationSpec, Cube, Dual, StMapSpec};
use crate::SpecError;

/// Pictures that a SPEC describes, by how they are stored.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// One image.
    Single(Single),
    /// The faces of a cube, in a file each or in one image.
    Cube(Cube),
    /// Two fisheyes in one image.
    Dual(Box<Dual>),
    /// One image of a calibrated camera, whose file is still to be read.
    Calibrated(CalibrationSpec),
    /// One image and an st map, which is still to be read.
    StMap(StMapSpec),
}

impl Shape {
    /// Builds one image of a camera, with its orientation, mirroring and crop.
    pub(super) fn single(fields: &Fields, frame: CameraModel) -> Result<Self, SpecError> {
        let placement = Placement {
            frame,
            orientation: fields.orientation()?,
            mirror: fields.mirror()?,
            canvas: fields.canvas("canvas")?,
        };
        let samples = match &placement.frame {
            CameraModel::Equirect(frame) if fields.get("samples").is_some() => SphereSamples::Given(frame.samples),
            CameraModel::Equirect(_) => SphereSamples::ByFile,
            _ => SphereSamples::NotAPanorama,
        };
        let any_shape = fields.get("hfov").is_some() && fields.get("vfov").is_some();
        Ok(Self::Single(Single { placement, samples, any_shape, pose: false }))
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

    /// Adds the orientation, mirroring and crop of one image; other shapes write theirs elsewhere.
    pub(in crate::spec) fn write_place(&self, keys: Keys) -> Keys {
        match self {
            Self::Single(Single { placement, .. }) => {
                keys.placed(placement.orientation, placement.mirror, placement.canvas)
            }
            Self::Calibrated(_) | Self::Cube(_) | Self::Dual(_) | Self::StMap(_) => keys,
        }
    }
}

/// One image whose projection is a formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Single {
    /// Camera model and place in the world.
    pub placement: Placement,
    /// Position of a panorama's outermost samples.
    pub samples: SphereSamples,
    /// Whether the field of view is given both ways, so that pixels may have any shape.
    pub any_shape: bool,
    /// Whether a panorama is turned by the pose of the camera that its file gives.
    pub pose: bool,
}

/// Rule that decides the position of a panorama's outermost samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SphereSamples {
    /// Not applicable: the projection is not a panorama.
    NotAPanorama,
    /// The file's position: the edges in files with OpenEXR's `envmap` attribute, else centres.
    ByFile,
    /// The position in the SPEC.
    Given(SamplePositions),
}

/// Makes one image that looks straight ahead and is no crop.
impl From<CameraModel> for Single {
    fn from(frame: CameraModel) -> Self {
        let samples = match frame {
            CameraModel::Equirect(_) => SphereSamples::ByFile,
            _ => SphereSamples::NotAPanorama,
        };
        Self { placement: Placement::new(frame), samples, any_shape: false, pose: false }
    }
}

impl Single {
    /// Sets the file's position, unless the SPEC gives one.
    pub fn with_samples(mut self, samples: SamplePositions) -> Self {
        if let (CameraModel::Equirect(frame), SphereSamples::ByFile) = (&mut self.placement.frame, self.samples) {
            frame.samples = samples;
        }
        self
    }
}
