use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use cosmorama::raster::{Channels, Depth, EncodedImage, FramePool, Samples};
use cosmorama_io::{Carried, Header, ImageFile, Limits, Window};
use rayon::prelude::*;

use crate::colour::FileColours;
use crate::diagnostic::{FRAMES, InPlace, Result, bail, failure};
use crate::input::InputView;
use crate::job::{ConvertJob, FrameOutputs};
use crate::packing::Place;
use crate::source::{Stamp, probe, read_in};

/// Image of a view in one frame, as in its file.
pub(crate) struct ViewImage {
    /// Index among the views that are present.
    pub(crate) view: usize,
    /// File of the image.
    pub(crate) path: PathBuf,
    /// Pixels of the image.
    pub(crate) image: EncodedImage,
    /// Conversion of its code values to light.
    pub(crate) colours: FileColours,
    /// Stamp of the file, from before it was read.
    pub(crate) stamp: Option<Stamp>,
    /// Metadata for the outputs, which get those of the first view.
    pub(crate) carried: Option<Arc<Carried>>,
    /// Pixels whose colour exceeded alpha and was cut, all told by the first view of a file.
    pub(crate) cut: usize,
}

/// Selection of a frame's views.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Which {
    /// All views.
    All,
    /// Views with a file for each frame.
    Moving,
    /// Views with one file for all frames.
    Still,
}

/// A file of a frame, and the views whose pixels it holds.
pub(crate) struct FrameFile<'a> {
    /// Path of the file.
    pub(crate) path: PathBuf,
    /// Views in it; at least one.
    views: Vec<FileView<'a>>,
}

/// A view in a file.
#[derive(Clone, Copy)]
struct FileView<'a> {
    /// Index among the views that are present.
    index: usize,
    input: &'a InputView,
    header: &'a Header,
}

impl<'a> FrameFile<'a> {
    /// Lists the files of a frame.
    pub(crate) fn all(job: &'a ConvertJob, frame: Option<u64>, which: Which) -> Vec<Self> {
        let mut files: Vec<Self> = Vec::new();
        // By name, since a world may have thousands of views.
        let mut places: HashMap<PathBuf, usize> = HashMap::new();
        for (index, (input, header, _)) in job.input.present().enumerate() {
            let view = FileView { index, input, header };
            let is_moving = input.files.has_frames();
            if which != Which::All && is_moving != (which == Which::Moving) {
                continue;
            }
            let path = input.files.path(frame);
            match places.entry(path) {
                Entry::Occupied(place) => files[*place.get()].views.push(view),
                Entry::Vacant(place) => {
                    files.push(Self { path: place.key().clone(), views: vec![view] });
                    place.insert(files.len() - 1);
                }
            }
        }
        files
    }

    /// Returns the indices of its views among those that are present.
    pub(crate) fn indices(&self) -> Vec<usize> {
        self.views.iter().map(|view| view.index).collect()
    }

    /// Checks by headers that the pictures of every frame are as large as the first frame's, before any is converted.
    ///
    /// # Errors
    /// Of the first frame that is not, or whose header cannot be read.
    pub(crate) fn check_frames(job: &'a ConvertJob) -> Result<()> {
        let check = |frame: &FrameOutputs| -> Result<()> {
            let later = Some(frame).filter(|frame| Some(&frame.frame) != job.input.frames.first());
            let files = later.map_or_else(Vec::new, |frame| Self::all(job, frame.frame, Which::Moving));
            files.iter().try_for_each(|file| file.check_header(job)).at(|| named(frame))
        };
        let frames = &job.outputs.frames;
        let checked: Vec<Result<()>> =
            if frames.len() > 1 { frames.par_iter().map(check).collect() } else { Vec::new() };
        checked.into_iter().collect()
    }

    fn check_header(&self, job: &ConvertJob) -> Result<()> {
        let header = probe(&*job.files, &self.path)?;
        self.check_size(job, (header.width, header.height), header.window)
    }

    /// Checks that a picture of this file is as large as that of the first frame.
    fn check_size(&self, job: &ConvertJob, found: (usize, usize), window: Option<Window>) -> Result<()> {
        let Some(FileView { input: first, header, .. }) = self.views.first() else { return Ok(()) };
        let expected = first.part.map_or((header.width, header.height), |part| part.of);
        if found == expected && window == header.window {
            return Ok(());
        }
        bail!(
            WrongSize: "{}: {}x{} pixels, but {}, of the first frame, has {}x{}{}; render it again as that one is, or convert frames \
             like it in a run of their own, with {FRAMES}",
            self.path.display(),
            found.0,
            found.1,
            first.files.path(job.input.frames[0]).display(),
            expected.0,
            expected.1,
            if found == expected { " at another place of its canvas" } else { "" }
        )
    }

    /// Reads the file into memory of a pool. If it is one of several, one thread does all the work.
    pub(crate) fn read(&self, job: &ConvertJob, pool: &FramePool) -> Result<Vec<ViewImage>> {
        let Self { path, views } = self;
        let Some(&FileView { input: first, header, .. }) = views.first() else { return Ok(Vec::new()) };
        let expected = first.part.map_or((header.width, header.height), |part| part.of);
        let stamp = job.files.stamp(path);
        let file = match job.decoded.take(path) {
            Some(file) => file,
            None => read_in(&*job.files, path, &Limits::memory(job.memory.bytes), pool)?,
        };
        let found = (file.image.width(), file.image.height());
        self.check_size(job, found, file.window)?;
        job.light.check_profile(path, &file.metadata)?;
        let image = if job.layers.leaves_picture_out() { blank(path, found)? } else { file.image };
        let file = ImageFile { image, ..file };
        let colours = job.light.colours(file.image.channels(), file.image.depth(), &file.metadata);
        let carried = job.light.carried(&file.metadata).filter(|_| views.iter().any(|view| view.index == 0));
        let view_image = |view: usize, image| {
            let (colours, carried) = (colours.clone(), carried.clone().filter(|_| view == 0));
            let cut = if view == views[0].index { file.metadata.cut_colours } else { 0 };
            ViewImage { view, path: path.clone(), image, colours, stamp, carried, cut }
        };
        if let (&[FileView { index, .. }], None) = (&views[..], first.part) {
            return Ok(vec![view_image(index, file.image)]);
        }
        let part = |&FileView { index, input, header }: &FileView<'_>| {
            let part = input.part.unwrap_or(Place::whole(expected));
            view_image(index, file.image.cropped_in(part.corner, (header.width, header.height), pool))
        };
        let parts = views.iter().map(part).collect();
        pool.give(file.image.into_samples());
        Ok(parts)
    }
}

/// Returns the black picture that stands in for numbers, which are no light.
fn blank(path: &Path, (width, height): (usize, usize)) -> Result<EncodedImage> {
    let samples = Samples::U8(vec![0; width.saturating_mul(height)]);
    let blank = EncodedImage::new(width, height, Channels::Grey, Depth::Eight, samples);
    blank.map_err(|error| failure!("{}: {error}", path.display()))
}

/// Returns the name of a frame in error messages.
pub(crate) fn named(frame: &FrameOutputs) -> String {
    frame.frame.map_or_else(|| "the frame".to_owned(), |number| format!("frame {number}"))
}
