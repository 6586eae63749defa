use cosmorama::camera::SamplePositions;
use cosmorama::layout::FacePlacement;
use cosmorama::raster::{EncodedImage, Image, Rgba, Samples};
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

/// Turns a picture upright.
pub(super) fn upright(image: EncodedImage, placement: FacePlacement) -> EncodedImage {
    if placement == FacePlacement::UPRIGHT {
        return image;
    }
    let turn = Turn { width: image.width(), height: image.height(), count: image.channels().count(), placement };
    let samples = match image.samples() {
        Samples::U8(samples) => Samples::U8(turn.apply(samples)),
        Samples::U16(samples) => Samples::U16(turn.apply(samples)),
        Samples::Half(samples) => Samples::Half(turn.apply(samples)),
        Samples::Float(samples) => Samples::Float(turn.apply(samples)),
    };
    let (width, height) = turn.size();
    match EncodedImage::new(width, height, image.channels(), image.depth(), samples) {
        Ok(turned) => turned.with_alpha_mode(image.alpha_mode()),
        // As many samples of the same type always fit.
        Err(_) => image,
    }
}

/// Shape of a picture, and the rotation that it needs.
struct Turn {
    width: usize,
    height: usize,
    /// Samples of a pixel.
    count: usize,
    placement: FacePlacement,
}

impl Turn {
    /// Returns columns and rows of the turned picture.
    fn size(&self) -> (usize, usize) {
        let is_sideways = self.placement.quarter_turns % 2 == 1;
        if is_sideways { (self.height, self.width) } else { (self.width, self.height) }
    }

    /// Returns the column and row of the picture that a pixel of the turned picture shows.
    fn origin(&self, i: usize, j: usize) -> (usize, usize) {
        let (right, bottom) = (self.width - 1, self.height - 1);
        let (i, j) = match self.placement.quarter_turns % 4 {
            0 => (i, j),
            1 => (j, bottom - i),
            2 => (right - i, bottom - j),
            _ => (right - j, i),
        };
        (if self.placement.mirrored { right - i } else { i }, j)
    }

    fn apply<S: Copy>(&self, samples: &[S]) -> Vec<S> {
        let (width, height) = self.size();
        let mut turned = Vec::with_capacity(samples.len());
        for j in 0..height {
            for i in 0..width {
                let (column, row) = self.origin(i, j);
                turned.extend_from_slice(&samples[(row * self.width + column) * self.count..][..self.count]);
            }
        }
        turned
    }
}

#[cfg(test)]
mod tests {
    use cosmorama::raster::{Channels, Depth};

    use super::*;

    #[test]
    fn pictures_are_mirrored_first_and_then_turned_clockwise() {
        let turned = |quarter_turns, mirrored| {
            // 1 2 3
            // 4 5 6
            let samples = Samples::U8(vec![1, 2, 3, 4, 5, 6]);
            let image = EncodedImage::new(3, 2, Channels::Grey, Depth::Eight, samples).unwrap();
            let image = upright(image, FacePlacement { quarter_turns, mirrored });
            let Samples::U8(samples) = image.samples() else { panic!("bytes") };
            (image.width(), samples.clone())
        };
        assert_eq!(turned(0, false), (3, vec![1, 2, 3, 4, 5, 6]));
        assert_eq!(turned(1, false), (2, vec![4, 1, 5, 2, 6, 3]));
        assert_eq!(turned(2, false), (3, vec![6, 5, 4, 3, 2, 1]));
        assert_eq!(turned(3, false), (2, vec![3, 6, 2, 5, 1, 4]));
        assert_eq!(turned(0, true), (3, vec![3, 2, 1, 6, 5, 4]));
        assert_eq!(turned(1, true), (2, vec![6, 3, 5, 2, 4, 1]));
    }

    #[test]
    fn channels_and_depth_stay() {
        let samples = Samples::Float((0..8).map(|i| i as f32).collect());
        let image = EncodedImage::new(2, 1, Channels::Rgba, Depth::Float, samples).unwrap();
        let image =
            upright(image.with_alpha_mode(cosmorama::raster::AlphaMode::Premultiplied), FacePlacement::HALF_TURN);
        assert_eq!(*image.samples(), Samples::Float(vec![4.0, 5.0, 6.0, 7.0, 0.0, 1.0, 2.0, 3.0]));
        assert_eq!(image.alpha_mode(), cosmorama::raster::AlphaMode::Premultiplied);
    }
}
