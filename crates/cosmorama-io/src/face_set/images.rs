use cosmorama::camera::SamplePositions;
use cosmorama::raster::{EncodedImage, Image, Rgba};
use cosmorama::sphere::CubeFace;

use crate::header::ImageFile;

/// Pictures of the six faces of a cube, all upright as seen by a camera at the centre: the up face's bottom edge and
/// the down face's top edge touch the front.
#[derive(Clone, Debug)]
pub struct FaceImages {
    /// Files in the order of [`CubeFace::ALL`], their pixels turned upright.
    pub files: [ImageFile; 6],
    /// Position of the outermost samples of a face.
    pub samples: SamplePositions,
}

impl FaceImages {
    /// Returns the picture of a face.
    pub fn face(&self, face: CubeFace) -> &EncodedImage {
        &self.files[face as usize].image
    }

    /// Decodes the linear light of all faces, in the order of [`CubeFace::ALL`].
    pub fn to_light(&self) -> [Image<Rgba>; 6] {
        CubeFace::ALL.map(|face| self.files[face as usize].to_light())
    }
}
