//! Tags that say that a video shows a whole world, or half of it, to one eye or to two.

mod boxes;
mod matroska;

use std::path::Path;

pub(crate) use boxes::{sound_fields, write_sound_fields};

use crate::VideoError;

/// Tags of spherical video (Google's Spherical Video V2: boxes `st3d` and `sv3d`; Matroska's StereoMode and Projection).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpatialTags {
    /// Places of the two eyes' pictures in a frame; `None` if nothing is said.
    pub stereo: Option<StereoMode>,
    /// Projection of the sphere; `None` for a flat picture.
    pub projection: Option<SphericalProjection>,
    /// Pose of the camera.
    pub pose: SphericalPose,
}

/// Places of the two eyes' pictures in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StereoMode {
    /// One picture for both eyes.
    Mono,
    /// The left eye above the right one.
    TopBottom,
    /// The left eye at the left.
    LeftRight,
}

/// Projection of a spherical video.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SphericalProjection {
    /// Equirectangular: the whole sphere, or a part of it.
    Equirect(Bounds),
    /// Six faces of a cube in one frame.
    Cubemap {
        /// Layout of the faces: 0 is three columns and two rows, right left up over down front back.
        layout: u32,
        /// Pixels around each face that belong to its neighbours.
        padding: u32,
    },
    /// A mesh, which is not read.
    Mesh,
}

/// Parts of the whole panorama that are outside of an equirectangular picture, in units of 2⁻³².
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Bounds {
    /// Part cut off above.
    pub top: u32,
    /// Part cut off below.
    pub bottom: u32,
    /// Part cut off at the left.
    pub left: u32,
    /// Part cut off at the right.
    pub right: u32,
}

/// Pose of a spherical camera, in degrees times 65536.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SphericalPose {
    /// Turn about the vertical axis, positive counter-clockwise seen from above, −180 to 180 degrees.
    pub yaw: i32,
    /// Turn about the axis to the right, positive upwards, −90 to 90 degrees.
    pub pitch: i32,
    /// Turn about the axis forward, positive clockwise, −180 to 180 degrees.
    pub roll: i32,
}

impl SpatialTags {
    /// Creates the tags of a panorama of the whole sphere.
    pub fn panorama(stereo: StereoMode) -> Self {
        let projection = Some(SphericalProjection::Equirect(Bounds::default()));
        Self { stereo: Some(stereo), projection, pose: SphericalPose::default() }
    }

    /// Creates the tags of VR180: the front half of the sphere for each eye, side by side.
    pub fn vr180() -> Self {
        let quarter = 1 << 30;
        let bounds = Bounds { left: quarter, right: quarter, ..Bounds::default() };
        Self {
            stereo: Some(StereoMode::LeftRight),
            projection: Some(SphericalProjection::Equirect(bounds)),
            pose: SphericalPose::default(),
        }
    }

    /// Returns the tags of a Matroska file with its own bounds, where ffprobe tells them in whole pixels.
    pub(crate) fn exact_in_matroska(self, path: &Path, size: (usize, usize)) -> Self {
        let Some(SphericalProjection::Equirect(told)) = self.projection else { return self };
        let exact = matroska::bounds(path, told, size).unwrap_or(told);
        Self { projection: Some(SphericalProjection::Equirect(exact)), ..self }
    }

    /// Reads the boxes of the first video track of an MP4 or MOV file; `None` if it has none.
    ///
    /// # Errors
    /// When the file cannot be read, or its boxes are damaged.
    pub fn read(path: &Path) -> Result<Option<Self>, VideoError> {
        boxes::read(path)
    }

    /// Writes the boxes into the first video track of an MP4 or MOV file, in place of those that are there. Frames do not move.
    ///
    /// # Errors
    /// When the file cannot be read or written, its boxes are damaged, or the projection is a mesh.
    pub fn write(&self, path: &Path) -> Result<(), VideoError> {
        boxes::write(path, self)
    }
}
