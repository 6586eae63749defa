//! Two streams of one file whose frames are the halves of a picture, as cameras with two lenses store them.

use std::path::Path;

use cosmorama::layout::Arrangement;
use cosmorama::raster::{EncodedImage, Samples};

use super::{Fault, FrameCondition, ReadOptions, VideoFrame, VideoReader};
use crate::{Ffmpeg, StreamKind, VideoError, VideoInfo};

/// Second half of a video's pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct SecondHalf {
    /// Stream that holds it.
    pub info: VideoInfo,
    /// Arrangement of both halves in a picture, the first stream's first.
    pub arrangement: Arrangement,
}

/// Frames of two streams in step, each pair in one picture. Dropped early, it ends both programs.
#[derive(Debug)]
pub struct PairedReader {
    first: VideoReader,
    second: VideoReader,
    arrangement: Arrangement,
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
        let Some(arrangement) = arrangement(&info.path, info.size()) else { return Ok(None) };
        let second = self.probe_stream(&info.path, other.index)?;
        Ok(are_alike(info, &second).then_some(SecondHalf { info: second, arrangement }))
    }
}

/// Returns the arrangement of two halves of this size; `None` if such pictures are whole.
fn arrangement(path: &Path, (width, height): (usize, usize)) -> Option<Arrangement> {
    let is_insta360 = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(INSTA360));
    if width == 3 * height + SHARED_COLUMNS {
        Some(Arrangement::TopBottom)
    } else {
        (is_insta360 && width == height).then_some(Arrangement::SideBySide)
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
        Ok(Self { first: VideoReader::open(ffmpeg, info, options)?, second, arrangement: half.arrangement })
    }

    /// Returns the next frame that both streams have; `None` after the last. One that is skipped in either is left out.
    ///
    /// # Errors
    /// When a frame of either is damaged or missing and neither held nor skipped.
    pub fn next_frame(&mut self) -> Result<Option<VideoFrame>, VideoError> {
        let (mut first, mut second) = (self.first.next_frame()?, self.second.next_frame()?);
        while let (Some(one), Some(other)) = (&first, &second) {
            match one.index.cmp(&other.index) {
                std::cmp::Ordering::Less => first = self.first.next_frame()?,
                std::cmp::Ordering::Greater => second = self.second.next_frame()?,
                std::cmp::Ordering::Equal => return joined(one, other, self.arrangement).map(Some),
            }
        }
        Ok(None)
    }

    /// Returns the frames so far that were held or skipped in either stream.
    pub fn faults(&self) -> impl Iterator<Item = &Fault> {
        self.first.faults().iter().chain(self.second.faults())
    }
}

/// Puts two frames into one picture.
fn joined(first: &VideoFrame, second: &VideoFrame, arrangement: Arrangement) -> Result<VideoFrame, VideoError> {
    let (one, other) = (&first.image, &second.image);
    let row = one.width() * one.channels().count();
    let samples = match (one.samples(), other.samples()) {
        (Samples::U8(one), Samples::U8(other)) => Samples::U8(both(one, other, (row, arrangement))),
        (Samples::U16(one), Samples::U16(other)) => Samples::U16(both(one, other, (row, arrangement))),
        // Streams that are alike have samples of one kind.
        (samples, _) => samples.clone(),
    };
    let (width, height) = arrangement.whole((one.width(), one.height()));
    let image = EncodedImage::new(width, height, one.channels(), one.depth(), samples);
    let image = image
        .map_err(|error| VideoError::Run { program: "ffmpeg".to_owned(), source: std::io::Error::other(error) })?;
    let is_whole = [first, second].iter().all(|frame| frame.condition == FrameCondition::Whole);
    let condition = if is_whole { FrameCondition::Whole } else { FrameCondition::Held };
    Ok(VideoFrame { index: first.index, time: first.time, image, condition })
}

/// Returns the samples of two pictures with rows of so many samples, in one.
fn both<S: Copy>(first: &[S], second: &[S], (row, arrangement): (usize, Arrangement)) -> Vec<S> {
    match arrangement {
        Arrangement::TopBottom => [first, second].concat(),
        Arrangement::SideBySide => {
            let rows = first.chunks_exact(row).zip(second.chunks_exact(row));
            let mut samples = Vec::with_capacity(first.len() + second.len());
            rows.for_each(|(one, other)| {
                samples.extend_from_slice(one);
                samples.extend_from_slice(other);
            });
            samples
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_of_cameras_are_halves_and_others_are_not() {
        let of = |name: &str, size| arrangement(Path::new(name), size);
        assert_eq!(of("GS010001.360", (4096, 1344)), Some(Arrangement::TopBottom));
        assert_eq!(of("renamed.mov", (2272, 736)), Some(Arrangement::TopBottom));
        assert_eq!(of("VID_00.INSV", (2880, 2880)), Some(Arrangement::SideBySide));
        assert_eq!((of("a.mp4", (2880, 2880)), of("a.360", (3840, 1920))), (None, None));
    }

    #[test]
    fn rows_lie_beside_or_below_each_other() {
        let (one, other) = ([1, 2, 3, 4], [5, 6, 7, 8]);
        assert_eq!(both(&one, &other, (2, Arrangement::SideBySide)), [1, 2, 5, 6, 3, 4, 7, 8]);
        assert_eq!(both(&one, &other, (2, Arrangement::TopBottom)), [1, 2, 3, 4, 5, 6, 7, 8]);
    }
}
