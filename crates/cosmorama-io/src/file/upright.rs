//! Turning of pictures when they are read: upright if their file says so, and faces as their naming requires.

use cosmorama::layout::FacePlacement;
use cosmorama::raster::{EncodedImage, FramePool, Sample, Samples};
use rayon::prelude::*;

use crate::codec::is_beside_others;
use crate::header::{Header, ImageFile};
use crate::metadata::orientation;

/// Number of rows that are turned together: the columns of the stored picture from which they come share cache lines.
const BAND: usize = 16;

impl Header {
    /// Returns the header of the picture as it is read: turned as the file's orientation says.
    pub(crate) fn upright(mut self) -> Self {
        (self.width, self.height) = orientation::turned((self.width, self.height), self.metadata.orientation);
        self
    }
}

impl ImageFile {
    /// Turns the pixels as the file's orientation says.
    pub(crate) fn upright(mut self, pool: &FramePool) -> Self {
        if let Some(orientation) = self.metadata.orientation {
            self.image = upright(self.image, orientation::placement(orientation), pool);
        }
        self
    }
}

/// Turns a picture upright. Memory comes from a pool, and the memory of the old picture goes back to it.
pub(crate) fn upright(image: EncodedImage, placement: FacePlacement, pool: &FramePool) -> EncodedImage {
    if placement == FacePlacement::UPRIGHT {
        return image;
    }
    let turn = Turn { width: image.width(), height: image.height(), count: image.channels().count(), placement };
    let samples = match image.samples() {
        Samples::U8(samples) => Samples::U8(turn.apply(samples, pool)),
        Samples::U16(samples) => Samples::U16(turn.apply(samples, pool)),
        Samples::Half(samples) => Samples::Half(turn.apply(samples, pool)),
        Samples::Float(samples) => Samples::Float(turn.apply(samples, pool)),
    };
    let (width, height) = turn.size();
    match EncodedImage::new(width, height, image.channels(), image.depth(), samples) {
        Ok(turned) => {
            let turned = turned.with_alpha_mode(image.alpha_mode());
            pool.give(image.into_samples());
            turned
        }
        // Cannot fail: the number and the type of samples are unchanged.
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

    /// Returns the column and row of the stored picture that a pixel of the turned picture shows.
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

    fn apply<S: Sample + Send + Sync>(&self, samples: &[S], pool: &FramePool) -> Vec<S> {
        let mut turned = pool.take::<S>(samples.len());
        let pitch = self.size().0 * self.count;
        let band = |(band, rows): (usize, &mut [S])| self.fill(samples, band * BAND, rows);
        // Other threads work on other files.
        if is_beside_others() {
            turned.chunks_mut(BAND * pitch).enumerate().for_each(band);
        } else {
            turned.par_chunks_mut(BAND * pitch).enumerate().for_each(band);
        }
        turned
    }

    /// Fills rows of the turned picture, from row `first` on.
    fn fill<S: Sample + Send + Sync>(&self, samples: &[S], first: usize, rows: &mut [S]) {
        let columns = self.size().0;
        let pitch = columns * self.count;
        for i in 0..columns {
            for (j, row) in (first..).zip(rows.chunks_exact_mut(pitch)) {
                let (column, line) = self.origin(i, j);
                let from = &samples[(line * self.width + column) * self.count..][..self.count];
                row[i * self.count..][..self.count].copy_from_slice(from);
            }
        }
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
            let image = upright(image, FacePlacement { quarter_turns, mirrored }, &FramePool::default());
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
        let image = upright(
            image.with_alpha_mode(cosmorama::raster::AlphaMode::Premultiplied),
            FacePlacement::HALF_TURN,
            &FramePool::default(),
        );
        assert_eq!(*image.samples(), Samples::Float(vec![4.0, 5.0, 6.0, 7.0, 0.0, 1.0, 2.0, 3.0]));
        assert_eq!(image.alpha_mode(), cosmorama::raster::AlphaMode::Premultiplied);
    }
}
