mod places;
pub(crate) mod turn;

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use cosmorama_io::pending::{NewFolders, Pending, free_space};
use cosmorama_io::{Compression, Format, FramePattern};

use crate::diagnostic::{
    Code, ConvertError, Diagnostic, FRAMES, OVERWRITE, RESUME, Result, bail, failure, usage, usage_as,
};
use crate::input::Input;
use crate::job::{ConvertJob, Remade, Resumed, is_large};
use crate::settings::{Conversion, Existing, GeometrySettings};
use crate::source::ViewFiles;
use crate::source::memory_budget::human;
use crate::source::video::MadeVideos;
use crate::target::{Target, TargetFile};

use places::Places;

/// A frame with its outputs that are still to be made.
#[derive(Clone)]
pub(crate) struct FrameOutputs {
    /// Number of the frame; `None` where there is no sequence.
    pub(crate) frame: Option<u64>,
    /// Index of a target file and its path.
    pub(crate) files: Vec<(usize, PathBuf)>,
}

impl FrameOutputs {
    /// Visits the frame's outputs that are not among those of another.
    fn paths_beside<'a>(&'a self, other: &'a [(usize, PathBuf)]) -> impl Iterator<Item = &'a Path> {
        self.files.iter().filter(|file| !other.contains(file)).map(|(_, path)| path.as_path())
    }
}

/// Outputs of a conversion.
#[derive(Default)]
pub(crate) struct Outputs {
    /// Frames with outputs to make.
    pub(crate) frames: Vec<FrameOutputs>,
    /// Whether others follow, until the input ends, which is a stream.
    pub(crate) go_on: bool,
    /// Whether they are passed on to a stream, and become no files.
    is_passed_on: bool,
    /// Number of outputs that exist already.
    pub(crate) skipped: usize,
    /// Findings in the places of others.
    pub(crate) resumed: Resumed,
    /// Outputs in whose places something may be.
    taken: HashSet<PathBuf>,
    /// Folders that were created for outputs; they are removed with this value if they stay empty.
    _folders: NewFolders,
}

impl Outputs {
    /// Returns whether the outputs are frames of a sequence, even if there is only one.
    pub(crate) fn is_sequence(&self) -> bool {
        self.frames.iter().any(|frame| frame.frame.is_some())
    }

    /// Returns the number of frames; `None` while the input's end is not known.
    pub(crate) fn count(&self) -> Option<usize> {
        (!self.go_on).then_some(self.frames.len())
    }

    /// Returns whether there may be more frames than one.
    pub(crate) fn are_many(&self) -> bool {
        self.go_on || self.frames.len() > 1
    }

    /// Visits all outputs to make. A video is one output of all frames.
    pub(crate) fn paths(&self) -> impl Iterator<Item = &Path> {
        let before = std::iter::once(&[][..]).chain(self.frames.iter().map(|frame| &frame.files[..]));
        self.frames.iter().zip(before).flat_map(|(frame, before)| frame.paths_beside(before))
    }

    /// Returns the warnings about outputs that are made again, and about those that are kept without their word.
    pub(crate) fn warnings(&self) -> impl Iterator<Item = Diagnostic> {
        Remade::warning(&self.resumed.remade).into_iter().chain(self.resumed.warning())
    }

    /// Returns the frames of an input whose light is read, without any output.
    pub(crate) fn none(args: &Conversion, input: &Input) -> Self {
        let frames = input.frames.iter().map(|frame| FrameOutputs { frame: *frame, files: Vec::new() }).collect();
        Self { frames, go_on: go_on(args, input), ..Self::default() }
    }

    /// Plans the outputs of all frames, and checks them against the inputs, with what lies behind.
    pub(crate) fn plan(
        args: &Conversion,
        (input, behind): (&Input, Option<&ConvertJob>),
        target: &Target,
    ) -> Result<Self> {
        check_frame_markers(args, input, target)?;
        check_resume(args, target)?;
        check_order(args, input)?;
        let inputs = files_read((input, behind), &args.geometry);
        let (mut frames, mut made) = (Vec::<FrameOutputs>::new(), NewFolders::new(&args.unfinished));
        let (mut places, mut taken) = (Places::default(), HashSet::new());
        // Outputs by their places, as indices of a frame and of its file.
        let (mut folders, mut outputs) = (HashSet::new(), HashMap::new());
        for (index, &frame) in input.frames.iter().enumerate() {
            let FrameOutputs { files, .. } = Self::of_frame(frame, target);
            let is_begun = target.format.is_video() && !frames.is_empty() || args.sink.is_some();
            for (number, (_, path)) in files.iter().enumerate().filter(|_| !is_begun) {
                // Not the folder behind a link: if that is missing, its disk may not be mounted.
                if let (true, false, Some(folder)) = (args.make_folders, places.know_folder_of(path), path.parent()) {
                    make_folder(&mut made, folder)?;
                }
                let place = places.of(path);
                if inputs.contains(&place.file) {
                    return Err(is_input(path));
                }
                if place.is_taken {
                    taken.insert(path.clone());
                }
                let folder = place.file.parent().unwrap_or(Path::new("")).as_os_str();
                if !folders.contains(folder) {
                    // Finds a folder that is missing or read-only before hours of work, not after.
                    Pending::create(path, &args.unfinished)?;
                    folders.insert(folder.to_owned());
                }
                if let Some((frame, file)) = outputs.insert(place.file.into_os_string(), (index, number)) {
                    let other = if frame == index { &files[file].1 } else { &frames[frame].files[file].1 };
                    let (path, other) = (path.display(), other.display());
                    return Err(usage_as(
                        Code::SameFile,
                        format!(
                            "{path} and {other} lead to one file; remove the link that one of them is, or choose another name"
                        ),
                    ));
                }
            }
            frames.push(FrameOutputs { frame, files });
        }
        Ok(Self {
            frames,
            go_on: go_on(args, input),
            is_passed_on: args.sink.is_some(),
            taken,
            _folders: made,
            ..Self::default()
        })
    }

    /// Returns the outputs of a frame.
    pub(crate) fn of_frame(frame: Option<u64>, target: &Target) -> FrameOutputs {
        let files = target.files.iter().map(|file| file.files.file(frame)).enumerate().collect();
        FrameOutputs { frame, files }
    }

    /// Leaves out the outputs that a job need not make again, or refuses to replace them.
    pub(crate) fn leave_finished(&mut self, existing: Existing, job: &ConvertJob) -> Result<()> {
        let all = self.paths().count();
        match existing {
            Existing::Resume => self.resumed = Resumed::find(&mut self.frames, job)?,
            Existing::Refuse if !self.is_passed_on => {
                let numbered = if self.go_on { numbered(&job.target) } else { Vec::new() };
                let taken = self.paths().filter(|path| self.taken.contains(*path));
                let others = taken.filter(|path| !numbered.iter().any(|numbered| numbered == path));
                let all = others.chain(numbered.iter().map(PathBuf::as_path));
                let keep =
                    if job.is_resumable() { format!(", or keep what is there with {RESUME}") } else { String::new() };
                refuse_existing_or(all, &keep)?;
            }
            Existing::Refuse | Existing::Replace => {}
        }
        self.frames.retain(|frame| !frame.files.is_empty());
        self.skipped = all - self.paths().count();
        Ok(())
    }
}

/// Returns whether frames follow until the input ends.
fn go_on(args: &Conversion, input: &Input) -> bool {
    args.frames.is_none() && input.is_live(&*args.files)
}

/// Space on a disk for the outputs of a job.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Space {
    /// Bytes that a frame takes, about.
    pub(crate) frame: u64,
    /// Bytes that all frames take, about.
    pub(crate) all: u64,
    /// Bytes that are free, with those of files that are replaced; `None` where the system does not tell.
    pub(crate) free: Option<u64>,
    /// Whether a later run makes what does not fit.
    is_resumable: bool,
    /// Whether the disk may run full long after the work has begun.
    is_long: bool,
}

impl Space {
    /// Returns the space that the outputs of a job take.
    pub(crate) fn of(job: &ConvertJob, settings: &Conversion) -> Self {
        let Target { files, format, .. } = &job.target;
        let bytes = |file: &TargetFile| {
            let levels = file.levels().map(|sheet| job.light.file_bytes(sheet.size)).fold(0, u64::saturating_add);
            levels.saturating_add(job.layers.file_bytes(file.sheet.size))
        };
        let raw = files.iter().map(bytes).fold(0, u64::saturating_add);
        let frame = match format {
            Format::Video => {
                let codec = settings.video.codec.as_deref();
                (raw / 100).saturating_mul(MadeVideos::percent(Path::new(&settings.output), codec))
            }
            _ => compressed(raw, *format, settings.compression),
        };
        let frames = &job.outputs.frames;
        let taken = job.outputs.paths().filter(|path| job.outputs.taken.contains(*path));
        let replaced: u64 = taken.map(|path| std::fs::metadata(path).map_or(0, |file| file.len())).sum();
        let folder = frames.first().and_then(|frame| frame.files.first()).and_then(|(_, path)| path.parent());
        let folder = folder.filter(|_| !job.outputs.is_passed_on);
        let free = folder.and_then(free_space).map(|free| free.saturating_add(replaced));
        let all = frame.saturating_mul(frames.len() as u64);
        let is_long = frames.len() > 1 || is_large(&job.target);
        Self { frame, all, free, is_resumable: job.is_resumable(), is_long }
    }

    /// Returns the warning about a sequence, or a large picture, that does not fit.
    pub(crate) fn warning(self, outputs: &Outputs) -> Option<Diagnostic> {
        let free = self.free.filter(|free| *free < self.all && self.is_long)?;
        let path = outputs.paths().next()?;
        let fitting = free / self.frame.max(1);
        let (frames, needed, free, path) = (outputs.frames.len(), human(self.all), human(free), path.display());
        let (what, room) = match frames {
            1 => ("the picture needs".to_owned(), String::new()),
            _ => (format!("{frames} frames need"), format!(", room for about {fitting}")),
        };
        let then = if self.is_resumable && frames > 1 {
            format!("the frame is named, and {RESUME} goes on")
        } else {
            "nothing is left of it".to_owned()
        };
        let message = format!(
            "{what} about {needed} of disk, but only {free} are free where {path} goes{room}; free some, or write elsewhere. If it runs full, \
             {then}"
        );
        Some(Diagnostic::warning(Code::DiskSpace, message))
    }
}

/// Returns the bytes of a file whose samples have so many, about: those of rendered pictures with some noise. Flat ones take less.
pub(crate) fn compressed(raw: u64, format: Format, compression: Option<Compression>) -> u64 {
    let percent = match (format, compression) {
        (Format::Png | Format::Tiff | Format::Exr, Some(Compression::None)) => 100,
        (Format::Png | Format::Tiff, _) => 65,
        (Format::Exr, _) => 80,
        (Format::Jpeg, _) => 15,
        // A byte for each colour and one for all.
        (Format::Hdr, _) => 34,
        _ => 100,
    };
    (raw / 100).saturating_mul(percent)
}

/// Creates a missing folder, with those above it.
fn make_folder(made: &mut NewFolders, folder: &Path) -> Result<()> {
    made.make(folder).map_err(|error| {
        failure!(Unwritable: "the folder {} cannot be made ({error}); choose another, where you may write", folder.display())
    })
}

/// Checks frame markers: several frames need one in the output, one frame may do without, and one without frames is an
/// error.
fn check_frame_markers(args: &Conversion, input: &Input, target: &Target) -> Result<()> {
    let numbered = target.files.iter().all(|file| matches!(file.files, ViewFiles::Sequence(_)));
    if target.format.is_video() && numbered {
        return Err(usage(format!(
            "{} is a video, which holds all frames; name it without a frame marker, or name pictures, as in frames/####.png",
            args.output
        )));
    }
    let takes_all = target.files.iter().all(|file| file.files.has_frames());
    if input.frames.len() > 1 && args.to_stream && !takes_all {
        return Err(usage(format!(
            "{} frames cannot go to standard output, which takes one picture; choose one of them, as in {FRAMES} {}, or name \
             output files with ####",
            input.frames.len(),
            input.frames[0].unwrap_or_default()
        )));
    }
    if input.frames.len() > 1 && !takes_all {
        return Err(usage(format!(
            "{} frames cannot go into the one file {}; put #### or %04d where the frame number stands",
            input.frames.len(),
            args.output
        )));
    }
    if numbered && input.frames == [None] {
        return Err(usage(format!(
            "{} has a frame marker, but the input {} has none; give both one, or neither",
            args.output, args.input
        )));
    }
    Ok(())
}

/// Refuses what a stream that is read as it comes cannot give.
fn check_order(args: &Conversion, input: &Input) -> Result<()> {
    if input.is_live(&*args.files) && !args.reads_in_order() {
        return Err(usage(format!(
            "{} is a stream, whose frames come once, and its end is not known; read it from a file for this",
            args.input
        )));
    }
    Ok(())
}

/// Returns the patterns of frames' names.
fn patterns(target: &Target) -> impl Iterator<Item = &FramePattern> {
    target.files.iter().filter_map(|file| match &file.files {
        ViewFiles::Sequence(pattern) => Some(pattern),
        _ => None,
    })
}

/// Returns the files that exist and have the name of any frame.
fn numbered(target: &Target) -> Vec<PathBuf> {
    let existing = |pattern: &FramePattern| {
        // A folder that cannot be read has none; writing into it tells what is wrong.
        let frames = pattern.existing().unwrap_or_default();
        frames.into_iter().map(|frame| pattern.path(frame)).collect::<Vec<_>>()
    };
    patterns(target).flat_map(existing).collect()
}

/// Returns the numbers of frames whose first file exists.
fn numbered_frames(target: &Target) -> impl Iterator<Item = u64> {
    patterns(target).next().into_iter().flat_map(|pattern| pattern.existing().unwrap_or_default())
}

/// Refuses to go on with a video.
fn check_resume(args: &Conversion, target: &Target) -> Result<()> {
    if target.format.is_video() && args.existing == Existing::Resume {
        return Err(usage(format!(
            "{RESUME}: {} is a video, which is made whole or not at all; leave {RESUME} out, or name frames, as in frames/####.png",
            args.output
        )));
    }
    Ok(())
}

/// Returns every file that a job reads: of its input, of what lies behind, and those that its SPECs and paths name.
pub(crate) fn files_read(
    (input, behind): (&Input, Option<&ConvertJob>),
    geometry: &GeometrySettings,
) -> HashSet<PathBuf> {
    let specs = [&geometry.from, &geometry.to].into_iter().flatten();
    let named = specs.flat_map(|spec| spec.files.iter().cloned()).chain(geometry.pose_files());
    let behind = behind.into_iter().flat_map(ConvertJob::layers).flat_map(|job| job.input.files());
    input.files().chain(behind).chain(named).map(|path| real_path(&path)).collect()
}

/// Checks that an output does not replace one of its own inputs.
pub fn check_apart(path: &Path, inputs: &HashSet<PathBuf>) -> Result<()> {
    if inputs.contains(&real_path(path)) { Err(is_input(path)) } else { Ok(()) }
}

/// Returns the error about an output that is an input.
fn is_input(path: &Path) -> ConvertError {
    usage_as(Code::SameFile, format!("{}: the output would replace its own input; choose another name", path.display()))
}

/// Resolves the links of a path, whether the file exists or not.
pub fn real_path(path: &Path) -> PathBuf {
    if let Ok(real) = path.canonicalize() {
        return real;
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}

/// Refuses to replace files that exist.
///
/// # Errors
/// When one exists.
pub fn refuse_existing<'a>(files: impl Iterator<Item = &'a Path>) -> Result<()> {
    refuse_existing_or(files, "")
}

fn refuse_existing_or<'a>(files: impl Iterator<Item = &'a Path>, instead: &str) -> Result<()> {
    const SHOWN: usize = 5;
    let existing: Vec<&Path> = files.filter(|path| path.exists()).collect();
    let Some(first) = existing.first() else { return Ok(()) };
    if existing.len() == 1 {
        bail!(Exists: "{} exists; replace it with {OVERWRITE}{instead}", first.display());
    }
    let mut names: Vec<_> = existing.iter().take(SHOWN).map(|path| path.display().to_string()).collect();
    if existing.len() > SHOWN {
        names.push("…".to_owned());
    }
    bail!(Exists: "{} outputs exist ({}); replace them with {OVERWRITE}{instead}", existing.len(), names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_that_will_not_fit_are_told() {
        let frame =
            |number: u64| FrameOutputs { frame: Some(number), files: vec![(0, format!("dome_{number}.png").into())] };
        let of = |count: u64| Outputs { frames: (1..=count).map(frame).collect(), ..Outputs::default() };
        let told = |free: Option<u64>, count: u64, is_long: bool| {
            let space = Space { frame: 1 << 30, all: count << 30, free, is_resumable: true, is_long };
            let warning = space.warning(&of(count))?;
            Some((warning.code, warning.to_string()))
        };
        let (code, message) = told(Some(25 << 28), 10, true).unwrap();
        assert_eq!(code, Code::DiskSpace);
        let words = ["10 frames need about 10.0 GiB", "only 6.2 GiB are free", "dome_1.png", "room for about 6"];
        words.into_iter().for_each(|words| assert!(message.contains(words), "{message}"));
        assert_eq!(told(Some(10 << 30), 10, true), None);
        assert_eq!(told(None, 10, true), None, "nobody knows");
        assert_eq!(told(Some(1), 1, false), None, "a picture that does not fit fails soon enough");
        let (_, message) = told(Some(1 << 29), 1, true).unwrap();
        let words =
            ["the picture needs about 1.0 GiB", "512.0 MiB are free where dome_1.png goes;", "nothing is left of it"];
        words.into_iter().for_each(|words| assert!(message.contains(words), "{message}"));
    }

    #[test]
    fn kinds_of_files_differ_in_size() {
        let of = |format, compression| compressed(1000, format, compression);
        assert_eq!(of(Format::Png, Some(Compression::None)), 1000);
        assert!(of(Format::Jpeg, None) < of(Format::Png, None) && of(Format::Png, None) < of(Format::Tga, None));
    }
}
