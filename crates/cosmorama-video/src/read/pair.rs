//! Two streams of one file whose frames are the halves of a picture, as cameras with two lenses store them.

use std::path::Path;

use cosmorama::raster::{EncodedImage, FramePool, Sample, Samples};

use super::{Fault, FrameCondition, ReadOptions, VideoFrame, VideoReader};
use crate::{Ffmpeg, StreamKind, VideoError, VideoInfo};

/// Place of the second half of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HalfPlace {
    /// To the right of the first.
    Beside,
    /// Below the first.
    Below,
}

impl HalfPlace {
    /// Returns the columns and rows of a picture whose halves have these.
    pub const fn whole(self, (width, height): (usize, usize)) -> (usize, usize) {
        match self {
            Self::Beside => (2 * width, height),
            Self::Below => (width, 2 * height),
        }
    }
}

/// Second half of a video's pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct SecondHalf {
    /// Stream that holds it.
    pub info: VideoInfo,
    /// Its place in a picture.
    pub place: HalfPlace,
}

/// Frames of two streams in step, each pair in one picture. Dropped early, it ends both programs.
#[derive(Debug)]
pub struct PairedReader {
    first: VideoReader,
    second: VideoReader,
    place: HalfPlace,
}

/// Columns that a row of faces in GoPro MAX's frames has more than three squares (4096x1344, 2272x736).
const SHARED_COLUMNS: usize = 64;

/// Extension of Insta360's videos, of which two square streams are the two lenses.
const INSTA360: &str = "insv";

impl Ffmpeg {
    /// Finds the stream that holds the second half of a video's pictures; `None` if the video has whole pictures.
    ///
    /// Two streams that are alike are halves if they have the shape of a camera's: GoPro MAX's rows of faces, one above the
    /// other, or Insta360's circles (`.insv`), one beside the other.
    ///
    /// # Errors
    /// When the stream cannot be read.
    pub fn second_half(&self, info: &VideoInfo) -> Result<Option<SecondHalf>, VideoError> {
        let mut videos = info.others.iter().filter(|other| other.kind == StreamKind::Video);
        let (Some(other), None) = (videos.next(), videos.next()) else { return Ok(None) };
        let Some(place) = place(&info.path, info.size()) else { return Ok(None) };
        let second = self.probe_stream(&info.path, other.index)?;
        Ok(are_alike(info, &second).then_some(SecondHalf { info: second, place }))
    }
}

/// Returns the place of the second of two halves of this size; `None` if such pictures are whole.
fn place(path: &Path, (width, height): (usize, usize)) -> Option<HalfPlace> {
    let is_insta360 = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(INSTA360));
    if width == 3 * height + SHARED_COLUMNS {
        Some(HalfPlace::Below)
    } else {
        (is_insta360 && width == height).then_some(HalfPlace::Beside)
    }
}

fn are_alike(first: &VideoInfo, second: &VideoInfo) -> bool {
    let of = |info: &VideoInfo| (info.size(), info.rate, info.is_variable, info.pixel_format.clone(), info.turn);
    of(first) == of(second)
}

impl PairedReader {
    /// Starts to decode both streams.
    ///
    /// # Errors
    /// As [`VideoReader::open`], for either.
    pub fn open(
        ffmpeg: &Ffmpeg,
        info: &VideoInfo,
        half: &SecondHalf,
        options: ReadOptions,
    ) -> Result<Self, VideoError> {
        // Each frame is held beside the picture of both.
        let options = ReadOptions { memory: options.memory / 4, ..options };
        let second = VideoReader::open(ffmpeg, &half.info, options.clone())?;
        Ok(Self { first: VideoReader::open(ffmpeg, info, options)?, second, place: half.place })
    }

    /// Returns the next frame that both streams have; `None` after the last. One that is skipped in either is left out.
    ///
    /// # Errors
    /// When a frame of either is damaged or missing and neither held nor skipped.
    pub fn next_frame(&mut self) -> Result<Option<VideoFrame>, VideoError> {
        self.next_frame_in(&FramePool::default())
    }

    /// Returns the next frame that both streams have, in memory of a pool; see [`next_frame`](Self::next_frame).
    ///
    /// # Errors
    /// As [`next_frame`](Self::next_frame).
    pub fn next_frame_in(&mut self, pool: &FramePool) -> Result<Option<VideoFrame>, VideoError> {
        let (mut first, mut second) = (self.first.next_frame_in(pool)?, self.second.next_frame_in(pool)?);
        while let (Some(one), Some(other)) = (&first, &second) {
            match one.index.cmp(&other.index) {
                std::cmp::Ordering::Less => first = self.first.next_frame_in(pool)?,
                std::cmp::Ordering::Greater => second = self.second.next_frame_in(pool)?,
                std::cmp::Ordering::Equal => {
                    let both = joined((one, other), self.place, pool)?;
                    [first, second].into_iter().flatten().for_each(|half| pool.give(half.image.into_samples()));
                    return Ok(Some(both));
                }
            }
        }
        Ok(None)
    }

    /// Returns the frames so far that were held or skipped in either stream.
    pub fn faults(&self) -> impl Iterator<Item = &Fault> {
        self.first.faults().iter().chain(self.second.faults())
    }

    /// Returns damage of either stream that was found by decoding once more; see [`VideoReader::foreseen`].
    pub fn foreseen(&self) -> impl Iterator<Item = &Fault> {
        self.first.foreseen().iter().chain(self.second.foreseen())
    }

    /// Returns damaged frames of either stream beside those that are asked for; see [`VideoReader::faults_beside`].
    pub fn faults_beside(&self) -> impl Iterator<Item = &Fault> {
        self.first.faults_beside().iter().chain(self.second.faults_beside())
    }
}

/// Puts two frames into one picture.
fn joined(
    (first, second): (&VideoFrame, &VideoFrame),
    place: HalfPlace,
    pool: &FramePool,
) -> Result<VideoFrame, VideoError> {
    let (one, other) = (&first.image, &second.image);
    let row = one.width() * one.channels().count();
    let samples = match (one.samples(), other.samples()) {
        (Samples::U8(one), Samples::U8(other)) => Samples::U8(both((one, other), (row, place), pool)),
        (Samples::U16(one), Samples::U16(other)) => Samples::U16(both((one, other), (row, place), pool)),
        // Streams that are alike have samples of one kind.
        (samples, _) => samples.clone(),
    };
    let (width, height) = place.whole((one.width(), one.height()));
    let image = EncodedImage::new(width, height, one.channels(), one.depth(), samples);
    let image = image
        .map_err(|error| VideoError::Run { program: "ffmpeg".to_owned(), source: std::io::Error::other(error) })?;
    let is_whole = [first, second].iter().all(|frame| frame.condition == FrameCondition::Whole);
    let condition = if is_whole { FrameCondition::Whole } else { FrameCondition::Held };
    Ok(VideoFrame { index: first.index, time: first.time, image, condition })
}

/// Returns the samples of two pictures with rows of so many samples, in one.
fn both<S: Sample>((first, second): (&[S], &[S]), (row, place): (usize, HalfPlace), pool: &FramePool) -> Vec<S> {
    let mut samples = pool.take(first.len() + second.len());
    match place {
        HalfPlace::Below => {
            let (one, other) = samples.split_at_mut(first.len());
            one.copy_from_slice(first);
            other.copy_from_slice(second);
        }
        HalfPlace::Beside => {
            let rows = first.chunks_exact(row).zip(second.chunks_exact(row));
            for (into, (one, other)) in samples.chunks_exact_mut(2 * row).zip(rows) {
                into[..row].copy_from_slice(one);
                into[row..].copy_from_slice(other);
            }
        }
    }
    samples
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_of_cameras_are_halves_and_others_are_not() {
        let of = |name: &str, size| place(Path::new(name), size);
        assert_eq!(of("GS010001.360", (4096, 1344)), Some(HalfPlace::Below));
        assert_eq!(of("renamed.mov", (2272, 736)), Some(HalfPlace::Below));
        assert_eq!(of("VID_00.INSV", (2880, 2880)), Some(HalfPlace::Beside));
        assert_eq!((of("a.mp4", (2880, 2880)), of("a.360", (3840, 1920))), (None, None));
    }

    #[test]
    fn rows_lie_beside_or_below_each_other() {
        let (halves, pool) = ((&[1_u8, 2, 3, 4][..], &[5, 6, 7, 8][..]), FramePool::default());
        assert_eq!(both(halves, (2, HalfPlace::Beside), &pool), [1, 2, 5, 6, 3, 4, 7, 8]);
        assert_eq!(both(halves, (2, HalfPlace::Below), &pool), [1, 2, 3, 4, 5, 6, 7, 8]);
    }
}
