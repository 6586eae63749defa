//! Stands in for videos in programs built without them: no file is taken for a video, so that none of this is ever called.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use cosmorama::raster::{EncodedImage, FramePool};
use cosmorama_io::pending::Unfinished;
use cosmorama_io::{Header, ImageFile, IoError, Limits};
use cosmorama_spec::{FrameRate, Spec};

use super::{Coming, DamagedFrames, FrameDamage, FrameName, PictureSink, RawFiles, VideoPlan};
use crate::diagnostic::{Diagnostic, Result};

/// Videos among the inputs: none.
#[derive(Debug)]
pub struct Videos;

/// Videos that are made: none.
#[derive(Debug, Default)]
pub(crate) struct MadeVideos;

fn refusal(video: &Path) -> IoError {
    IoError::UnknownContent { path: video.to_owned() }
}

impl Videos {
    pub(crate) fn new(_: DamagedFrames, _: Arc<dyn RawFiles>) -> Self {
        Self
    }

    pub(crate) fn ending_with(self, _: &Unfinished) -> Self {
        self
    }

    pub(crate) fn header(&self, name: &FrameName) -> Result<Header, IoError> {
        Err(refusal(&name.video))
    }

    pub(crate) fn picture(&self, name: &FrameName, _: &Limits, _: &FramePool) -> Result<ImageFile, IoError> {
        Err(refusal(&name.video))
    }

    pub(crate) fn count(&self, video: &Path) -> Result<Option<u64>, IoError> {
        Err(refusal(video))
    }

    pub(crate) fn coming(&self, name: &FrameName, _: bool) -> Result<Coming, IoError> {
        Err(refusal(&name.video))
    }

    pub(crate) fn answer(&self) -> DamagedFrames {
        DamagedFrames::default()
    }

    pub(crate) fn damage(&self, _: &FrameName) -> Option<FrameDamage> {
        None
    }

    pub(crate) fn memory(&self, video: &Path) -> Result<u64, IoError> {
        Err(refusal(video))
    }

    pub(crate) fn rate(&self, video: &Path) -> Result<Option<FrameRate>, IoError> {
        Err(refusal(video))
    }

    pub(crate) fn begins(&self, video: &Path) -> Result<Option<Vec<u64>>, IoError> {
        Err(refusal(video))
    }

    /// Finds no projection.
    ///
    /// # Errors
    /// Always.
    pub fn spec(&self, video: &Path) -> Result<Option<(Spec, &'static str)>, IoError> {
        Err(refusal(video))
    }

    /// Finds no statements.
    ///
    /// # Errors
    /// Always.
    pub fn facts(&self, video: &Path) -> Result<Vec<(&'static str, String)>, IoError> {
        Err(refusal(video))
    }

    pub(crate) fn expect(&self, video: &Path, _: impl Iterator<Item = u64>) -> Result<(), IoError> {
        Err(refusal(video))
    }

    pub(crate) fn expect_rows(&self, _: &Path, _: Range<usize>) {}

    pub(crate) fn end(&self) -> std::result::Result<(), IoError> {
        Ok(())
    }

    pub(crate) fn faults(&self, video: &Path) -> Result<Vec<(Range<u64>, String)>, IoError> {
        Err(refusal(video))
    }

    pub(crate) fn varies(&self, _: &Path) -> Result<bool, IoError> {
        Ok(false)
    }

    pub(crate) fn complaints(&self, _: bool) -> Vec<String> {
        Vec::new()
    }
}

impl MadeVideos {
    pub(crate) fn holds_alpha(_: &Path, _: Option<&str>, _: bool) -> bool {
        false
    }

    pub(crate) fn memory(_: &Path, _: (usize, usize), _: &VideoPlan) -> u64 {
        0
    }

    pub(crate) fn percent(_: &Path, _: Option<&str>) -> u64 {
        100
    }

    pub(crate) fn check(_: &[(PathBuf, (usize, usize))], _: &VideoPlan, _: Option<&Videos>) -> Result<()> {
        Ok(())
    }

    pub(crate) fn start(
        _: &[(PathBuf, (usize, usize))],
        _: (&VideoPlan, Option<&Videos>),
        _: (Option<&PictureSink>, &Unfinished),
        _: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        Ok(Self)
    }

    pub(crate) fn holds(&self, _: &Path) -> bool {
        false
    }

    pub(crate) fn put(&self, path: &Path, _: usize, _: EncodedImage, _: &FramePool) -> Result<(), IoError> {
        Err(IoError::UnknownExtension { path: path.to_owned() })
    }

    pub(crate) fn leave_out(&self, _: usize, _: &FramePool) -> Result<(), IoError> {
        Ok(())
    }

    pub(crate) fn finish(&self) -> Result<Vec<Diagnostic>, IoError> {
        Ok(Vec::new())
    }
}
